# The board's end of the link.
#
# ROBOSYNC_AUTHENTICATION lets a board have an owner, who signs orders. By default it is on if the board has a store, since the
# owner's key must survive a loss of power. Without it the firmware is some 10 KB smaller.
set(keeps_keys ON)
if(store_bytes EQUAL 0)
  set(keeps_keys OFF)
endif()
option(ROBOSYNC_AUTHENTICATION "The board can be paired with an owner (docs/security.md)" ${keeps_keys})
if(ROBOSYNC_AUTHENTICATION)
  include(${CMAKE_CURRENT_LIST_DIR}/signatures.cmake)
  list(APPEND runtime_definitions ROBOSYNC_AUTHENTICATION)
  target_sources(robosync_runtime PRIVATE
    ${CMAKE_CURRENT_LIST_DIR}/key_store.cpp ${CMAKE_CURRENT_LIST_DIR}/order_gate.cpp)
endif()
target_sources(robosync_runtime PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/keeper.cpp
  ${CMAKE_CURRENT_LIST_DIR}/number_store.cpp
  ${CMAKE_CURRENT_LIST_DIR}/program_store.cpp
  ${CMAKE_CURRENT_LIST_DIR}/server.cpp
  ${CMAKE_CURRENT_LIST_DIR}/trace_ring.cpp)
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/server.cpp PROPERTIES
  COMPILE_DEFINITIONS "ROBOSYNC_VERSION=\"${PROJECT_VERSION}\"")
