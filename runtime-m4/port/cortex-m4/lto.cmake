# The runtime is optimized as a whole when the firmware is linked, which saves a tenth of the flash. Not
# so what is in a hurry and measured by instructions (kernel), what assembler and the compiler itself
# refer to (port), and where bench/ sees a reading arrive and a command leave (mailbox, servo): these
# are compiled as they stand.
target_compile_options(robosync_runtime PRIVATE -flto -ffat-lto-objects)
file(GLOB as_it_stands CONFIGURE_DEPENDS
  ${CMAKE_CURRENT_SOURCE_DIR}/kernel/*.cpp ${CMAKE_CURRENT_SOURCE_DIR}/port/cortex-m4/*.cpp)
list(APPEND as_it_stands
  ${CMAKE_CURRENT_SOURCE_DIR}/layers/mailbox.cpp ${CMAKE_CURRENT_SOURCE_DIR}/drivers/servo.cpp)
set_property(SOURCE ${as_it_stands} APPEND PROPERTY COMPILE_OPTIONS -fno-lto)
