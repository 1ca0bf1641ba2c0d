# The board's end of the link.
target_sources(robosync_runtime PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/keeper.cpp
  ${CMAKE_CURRENT_LIST_DIR}/number_store.cpp
  ${CMAKE_CURRENT_LIST_DIR}/program_store.cpp
  ${CMAKE_CURRENT_LIST_DIR}/server.cpp
  ${CMAKE_CURRENT_LIST_DIR}/trace_ring.cpp)
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/server.cpp PROPERTIES
  COMPILE_DEFINITIONS "ROBOSYNC_VERSION=\"${PROJECT_VERSION}\"")
