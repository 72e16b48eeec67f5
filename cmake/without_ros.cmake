# What knows no ROS: the core, compiled for speed, and what is beside it.
add_subdirectory(src/core)
add_compile_options(${options_beside_the_core})
add_subdirectory(src/mesh_reader)
add_subdirectory(src/scene)
add_subdirectory(src/edit_requests)
add_subdirectory(src/world_events)
add_subdirectory(src/tools)
add_subdirectory(src/python)
