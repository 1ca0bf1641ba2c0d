# The kernel's tests on the board, with its assertions on: build/…/kernel-test.elf, run by
# tests/runtime-m4/kernel/run_qemu.sh.
set(folder ${PROJECT_SOURCE_DIR}/tests/runtime-m4/kernel/firmware)
robosync_elf(robosync_kernel_test_asserted kernel-test
  ${folder}/main.cpp ${folder}/scheduling.cpp ${folder}/registers.cpp ${folder}/interrupts.cpp
  ${folder}/mutex.cpp ${folder}/../mutex_cases.cpp ${folder}/faults.cpp ${folder}/isolation.cpp ${folder}/calls.cpp ${folder}/sandbox.cpp
  ${folder}/devices.cpp ${folder}/division.cpp ${folder}/idle.cpp ${folder}/contexts.cpp)
target_link_options(robosync_kernel_test_asserted PRIVATE -Wl,--defsym=without_arena=1)
target_compile_options(robosync_kernel_test_asserted PRIVATE -mfloat-abi=softfp)  # its threads use the FPU
# Random use over hours of virtual time: build/…/kernel-stress.elf, run by tests/runtime-m4/kernel/run_stress.sh.
robosync_elf(robosync_kernel_stress_asserted kernel-stress ${folder}/stress.cpp)
target_link_options(robosync_kernel_stress_asserted PRIVATE -Wl,--defsym=without_arena=1 -Wl,--wrap=PendSV_Handler)
