# The simulated robot, on the host's processor (port/host): the engine of rsc run.
add_library(robosync_simulator STATIC sim/simulator.cpp sim/host_board.cpp)
target_link_libraries(robosync_simulator PUBLIC robosync_runtime)
