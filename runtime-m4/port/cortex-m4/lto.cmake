# Link-time optimization of the whole runtime saves a tenth of the firmware's flash. It is off for files
# that are time-critical and measured in instructions (kernel), for code that assembler and the compiler
# itself refer to (port), and where bench/ detects that a reading arrives and a command leaves (mailbox,
# servo).
target_compile_options(robosync_runtime PRIVATE -flto -ffat-lto-objects)
file(GLOB as_it_stands CONFIGURE_DEPENDS
  ${CMAKE_CURRENT_SOURCE_DIR}/kernel/*.cpp ${CMAKE_CURRENT_SOURCE_DIR}/port/cortex-m4/*.cpp)
list(APPEND as_it_stands
  ${CMAKE_CURRENT_SOURCE_DIR}/layers/mailbox.cpp ${CMAKE_CURRENT_SOURCE_DIR}/drivers/servo.cpp)
set_property(SOURCE ${as_it_stands} APPEND PROPERTY COMPILE_OPTIONS -fno-lto)
