# What tests/timing/ measures with: build/m4/bench/timing.
set(folder ${PROJECT_SOURCE_DIR}/tests/timing/firmware)
bench_firmware(timing ${folder}/main.cpp ${folder}/robot.cpp ${folder}/stimuli.cpp)
target_link_libraries(timing PRIVATE robosync_vm)

# The runtime as the firmware has it, linked in the same way: build/m4/bench/path.elf.
robosync_elf(timing_path bench/path ${folder}/path.cpp
             ${PROJECT_SOURCE_DIR}/bench/firmware/driven.cpp ${PROJECT_SOURCE_DIR}/bench/firmware/semihosting.cpp)
