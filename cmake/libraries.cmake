# What the package is compiled with, and the libraries that it uses besides ROS's.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

find_package(Eigen3 REQUIRED)

# Libraries whose CMake files are not to be relied on. Assimp's ask for zlib's development files on Debian 12, which Debian does not
# install with them, and on Ubuntu 20.04 name a directory that is not there; the others' are not in every version.
# find_directly(NAME HEADER PACKAGE [LIBRARY])
function(find_directly name header package)
  find_path(${name}_INCLUDE_DIR ${header})
  if(NOT ${name}_INCLUDE_DIR)
    message(FATAL_ERROR "${package} is not installed: no ${header}")
  endif()
  add_library(${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${name} INTERFACE ${${name}_INCLUDE_DIR})
  foreach(library ${ARGN})
    find_library(${name}_LIBRARY ${library})
    if(NOT ${name}_LIBRARY)
      message(FATAL_ERROR "${package} is not installed: no library ${library}")
    endif()
    target_link_libraries(${name} INTERFACE ${${name}_LIBRARY})
  endforeach()
endfunction()
find_directly(ASSIMP assimp/Importer.hpp libassimp-dev assimp)
find_directly(CLI11 CLI/CLI.hpp libcli11-dev)
find_directly(NLOHMANN_JSON nlohmann/json.hpp nlohmann-json3-dev)
find_directly(TBB tbb/parallel_for.h libtbb-dev tbb)

# Embree casts the camera's rays. Without it everything else is built. Cables are its round linear curves, which it has since 3.12.
option(VERLET_CABLE_CAMERA "The camera, where Embree is installed" ON)
# find_embree(VARIABLE): whether it is there; then EMBREE is a target as above.
function(find_embree variable)
  set(${variable} OFF PARENT_SCOPE)
  find_path(EMBREE_INCLUDE_DIR embree3/rtcore.h)
  find_library(EMBREE_LIBRARY embree3)
  set(version 0)
  if(EMBREE_INCLUDE_DIR AND EMBREE_LIBRARY)
    file(STRINGS ${EMBREE_INCLUDE_DIR}/embree3/rtcore_config.h version REGEX "#define RTC_VERSION [0-9]+")
    string(REGEX REPLACE ".* ([0-9]+)$" "\\1" version "${version}")
  endif()
  if(version LESS 31200)
    message(WARNING "Embree 3.12 or newer (libembree-dev) is not installed to build with: the camera is neither built nor tested")
    return()
  endif()
  add_library(EMBREE INTERFACE IMPORTED GLOBAL)
  target_include_directories(EMBREE INTERFACE ${EMBREE_INCLUDE_DIR})
  target_link_libraries(EMBREE INTERFACE ${EMBREE_LIBRARY})
  set(${variable} ON PARENT_SCOPE)
endfunction()
set(VERLET_CABLE_HAS_VIEW OFF)
if(VERLET_CABLE_CAMERA)
  find_embree(VERLET_CABLE_HAS_VIEW)
endif()

# Debian's liburdfdom-dev names itself as a package, but rosdep knows it by the key in package.xml.
#catkin_lint: ignore missing_depend
find_package(urdfdom REQUIRED)
find_package(yaml-cpp REQUIRED)

# Contraction into fused multiply-adds would make results depend on the processor and on the compiler's mood.
add_compile_options(-Wall -Wextra -Wpedantic -ffp-contract=off)

# precompile_headers(TARGET HEADER...): reads the headers that cost most once a target. Compiler caches cannot keep what is compiled
# so; with one (CMAKE_CXX_COMPILER_LAUNCHER) nothing is precompiled. Every file includes what it uses all the same.
function(precompile_headers target)
  if(TARGET ${target} AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# reuse_precompiled_headers(TARGET OTHER): those of a target that is compiled with the same options.
function(reuse_precompiled_headers target other)
  if(TARGET ${target} AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()

# compile_in_batches(TARGET): several files at once, which read their headers once. Likewise not with a compiler cache, which keeps
# single files.
function(compile_in_batches target)
  if(TARGET ${target} AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# What is beside the core runs a little, and is not worth the compiler's time. At -O1 GCC 12 is wrong about empty std::optionals that
# are copied.
set(options_beside_the_core $<$<CONFIG:Release>:-O1> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
