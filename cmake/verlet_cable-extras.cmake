# For packages that find_package this one: its headers are C++17, which the compiler of ROS Noetic does not default to.
# 98 is older than 17, and the greater number.
if(NOT CMAKE_CXX_STANDARD OR CMAKE_CXX_STANDARD LESS 17 OR CMAKE_CXX_STANDARD EQUAL 98)
  set(CMAKE_CXX_STANDARD 17)
  set(CMAKE_CXX_STANDARD_REQUIRED ON)
endif()
