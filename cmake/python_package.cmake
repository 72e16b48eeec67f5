# The Python package as setup.py has it built: everything beside its modules, in the directory CMAKE_INSTALL_PREFIX, so that the
# programs find each other, and nothing of an installed ROS package is needed. Where to install, setup.py says by catkin's names.

file(STRINGS package.xml version_line REGEX "<version>" LIMIT_COUNT 1)
string(REGEX REPLACE ".*<version>(.*)</version>.*" "\\1" ${PROJECT_NAME}_VERSION ${version_line})
set(BUILD_SHARED_LIBS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)  # programs are named like the directories of their parts

include(cmake/without_ros.cmake)
