# The simulated robot, on the host's processor (port/host): the engine of rsc run.
add_library(robosync_simulator STATIC sim/simulator.cpp sim/host_board.cpp)
target_link_libraries(robosync_simulator PUBLIC robosync_runtime)
# In a unity build its Impl would be taken for one that several sources see, with types that only one has.
set_source_files_properties(sim/simulator.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
# As in layers.cmake: small code for rsc.
if(NOT ROBOSYNC_SANITIZE)
  target_compile_options(robosync_simulator PRIVATE -Os)
endif()
