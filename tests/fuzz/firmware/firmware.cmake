# Runs the fuzzer's images on the board, behind the MPU: build/m4/bench/fuzz_vm, run by
# tests/fuzz/test_board.py.
set(fuzz ${PROJECT_SOURCE_DIR}/tests/fuzz)
bench_firmware(fuzz_vm ${fuzz}/firmware/main.cpp ${fuzz}/firmware/sandbox.cpp ${fuzz}/exercise.cpp)
target_link_libraries(fuzz_vm PRIVATE robosync_vm)
