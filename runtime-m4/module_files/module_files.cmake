# Modules in files: on a computer only. What runs in a module's process is not instrumented: sanitizers call the operating system there,
# which nothing may.
add_library(robosync_module_files STATIC
  module_files/confine.cpp module_files/description.cpp module_files/process.cpp module_files/registry.cpp module_files/worker.cpp)
target_link_libraries(robosync_module_files PUBLIC robosync_warnings ${CMAKE_DL_LIBS})
# A module has a process of its own: what talks with it waits for it.
if(NOT ROBOSYNC_SANITIZE)
  target_compile_options(robosync_module_files PRIVATE -Os)
endif()
set_source_files_properties(module_files/worker.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS -fno-sanitize=all)
