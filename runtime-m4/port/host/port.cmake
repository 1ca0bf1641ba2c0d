# The processor is part of the runtime, which needs one to link.
target_sources(robosync_runtime PRIVATE port/host/machine.cpp)
