# The port is part of the runtime, which does not link without one.
target_sources(robosync_runtime PRIVATE port/host/machine.cpp)
