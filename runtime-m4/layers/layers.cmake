# The layers, their drivers, the safety monitor, and the runtime that joins them.
target_sources(robosync_runtime PRIVATE
  runtime.cpp
  layers/adaptation.cpp
  layers/algorithms.cpp
  layers/arbiter.cpp
  layers/behavior.cpp
  layers/budget.cpp
  layers/carried.cpp
  layers/checks.cpp
  layers/command_pool.cpp
  layers/control.cpp
  layers/program_threads.cpp
  layers/feed_queue.cpp
  layers/frames.cpp
  layers/kept.cpp
  layers/link_share.cpp
  layers/mailbox.cpp
  layers/memory.cpp
  layers/median.cpp
  layers/name_key.cpp
  layers/performance.cpp
  layers/processing.cpp
  layers/loaded_program.cpp
  layers/report.cpp
  layers/safety_region.cpp
  layers/sampler.cpp
  layers/sensor.cpp
  layers/thresholds.cpp
  layers/trace.cpp
  layers/triggers.cpp
  layers/variables.cpp
  layers/workspace.cpp
  guard/counted_drive.cpp
  guard/displays.cpp
  guard/output_guard.cpp
  guard/sensor_pins.cpp
  safety/rule_key.cpp
  safety/safety_rules.cpp
  safety/monitor.cpp
  drivers/algorithm.cpp
  drivers/axes.cpp
  drivers/board_part.cpp
  drivers/differential_drive.cpp
  drivers/digital_input.cpp
  drivers/ear.cpp
  drivers/encoder.cpp
  drivers/hc_sr04.cpp
  drivers/analog_input.cpp
  drivers/hts221.cpp
  drivers/i2c_register.cpp
  drivers/i2c_word.cpp
  drivers/lights.cpp
  drivers/lis3mdl.cpp
  drivers/lsm303agr.cpp
  drivers/lsm6dsl.cpp
  drivers/max34451.cpp
  drivers/mcp3008.cpp
  drivers/microphone.cpp
  drivers/motor.cpp
  drivers/mpu6050.cpp
  drivers/player.cpp
  drivers/power.cpp
  drivers/pwm.cpp
  drivers/pca9685.cpp
  drivers/pca9685_servo.cpp
  drivers/served.cpp
  drivers/servo.cpp
  drivers/axes_chip.cpp
  drivers/spectrum.cpp
  drivers/spi_register.cpp
  drivers/ssd1306.cpp
  drivers/ssd1306_face.cpp
  drivers/tones.cpp
  drivers/virtual_actuator.cpp
  drivers/virtual_motion.cpp
  drivers/virtual_output.cpp
  drivers/virtual_sensor.cpp
  drivers/vl53l0x.cpp
  drivers/way.cpp
  drivers/ws2812_face.cpp
  drivers/ws2812_strip.cpp)
# In rsc small code is worth more than fast code, but for what is compiled with -O2 below and in kernel.cmake.
if(NOT CMAKE_CROSSCOMPILING AND NOT ROBOSYNC_SANITIZE)
  target_compile_options(robosync_runtime PRIVATE -Os)
endif()
# On the board they are on the way of each sample of a motion sensor, or of a block of sound. Link-time optimization would make
# the spectrum cost more or less with each change elsewhere.
if(CMAKE_CROSSCOMPILING)
  set_source_files_properties(drivers/axes.cpp drivers/lsm303agr.cpp drivers/axes_chip.cpp PROPERTIES COMPILE_OPTIONS -O2)
  set_source_files_properties(drivers/spectrum.cpp PROPERTIES COMPILE_OPTIONS "-O2;-fno-lto")
endif()
set_source_files_properties(layers/median.cpp PROPERTIES COMPILE_OPTIONS -O2)
# Every reading passes through this, in the step thread. There is only one such thread: its stack has room for it.
set_source_files_properties(layers/processing.cpp layers/thresholds.cpp PROPERTIES COMPILE_OPTIONS "-O2")
# … and what comes of it through these.
if(CMAKE_CROSSCOMPILING)
  set_source_files_properties(layers/checks.cpp layers/mailbox.cpp layers/command_pool.cpp layers/behavior.cpp
    layers/triggers.cpp layers/arbiter.cpp layers/variables.cpp PROPERTIES COMPILE_OPTIONS "-O2")
endif()
# The path from a reading in its mailbox to the pins in their safe state.
set_source_files_properties(safety/safety_rules.cpp PROPERTIES COMPILE_OPTIONS "-O2")
