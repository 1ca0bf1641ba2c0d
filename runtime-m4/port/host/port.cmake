# The machine is part of the runtime, which needs one to link; the simulator is built on both.
target_sources(robosync_runtime PRIVATE port/host/machine.cpp)

set(simulator_sources)
foreach(file simulator host_board)
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/port/host/${file}.cpp)
    list(APPEND simulator_sources port/host/${file}.cpp)
  endif()
endforeach()
if(simulator_sources)
  add_library(robosync_simulator STATIC ${simulator_sources})
  target_link_libraries(robosync_simulator PUBLIC robosync_runtime)
  robosync_one_by_one(robosync_simulator)
endif()
