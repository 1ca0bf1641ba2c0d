target_sources(robosync_runtime PRIVATE
  kernel/assertions.cpp
  kernel/kernel.cpp
  kernel/mutex.cpp
  kernel/scheduler.cpp
  kernel/threads.cpp
  kernel/timer_queue.cpp)
# The paths that bench/ counts; the rest of the runtime is built for size.
set_source_files_properties(kernel/kernel.cpp PROPERTIES COMPILE_OPTIONS "-O2")
