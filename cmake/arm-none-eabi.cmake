# Cross-compiles for a Cortex-M4F with Debian's gcc-arm-none-eabi and newlib.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR cortex-m4)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_ASM_COMPILER arm-none-eabi-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

# soft: the product computes in integers. Otherwise the compiler would move them through FPU registers, which must be saved
# at each context switch once a thread has used them. Code that is linked to it may use the FPU (softfp).
set(m4_flags "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=soft -ffunction-sections -fdata-sections")
set(CMAKE_C_FLAGS_INIT "${m4_flags}")
set(CMAKE_ASM_FLAGS_INIT "${m4_flags}")
set(CMAKE_CXX_FLAGS_INIT
    "${m4_flags} -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-use-cxa-atexit -fno-unwind-tables -fno-asynchronous-unwind-tables")
# Optimises for size by default on the board; files on the hot path set -O2 themselves. For a debugger, add -g, which takes a third
# more time and changes no code: cmake --preset m4 -D CMAKE_CXX_FLAGS_RELEASE="-Os -g".
set(CMAKE_CXX_FLAGS_RELEASE "-Os" CACHE STRING "")
set(CMAKE_C_FLAGS_RELEASE "-Os" CACHE STRING "")
