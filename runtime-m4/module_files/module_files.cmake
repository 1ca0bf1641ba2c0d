# Modules in files: on a computer only. The code in a module's process is not instrumented: sanitizers would call the operating system
# there, which nothing may.
add_library(robosync_module_files STATIC
  module_files/confine.cpp module_files/description.cpp module_files/process.cpp module_files/registry.cpp module_files/worker.cpp)
target_link_libraries(robosync_module_files PUBLIC robosync_warnings ${CMAKE_DL_LIBS})
# A module has its own process, and this code only waits for it, so it need not be fast.
if(NOT ROBOSYNC_SANITIZE)
  target_compile_options(robosync_module_files PRIVATE -Os)
endif()
set_source_files_properties(module_files/worker.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS -fno-sanitize=all)
