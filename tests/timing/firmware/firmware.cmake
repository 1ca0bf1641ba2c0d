# What tests/timing/ measures with: build/m4/bench/timing.
set(folder ${PROJECT_SOURCE_DIR}/tests/timing/firmware)
bench_firmware(timing ${folder}/main.cpp ${folder}/robot.cpp ${folder}/stimuli.cpp)
target_link_libraries(timing PRIVATE robosync_vm)
