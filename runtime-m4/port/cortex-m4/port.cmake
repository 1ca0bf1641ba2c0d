target_sources(robosync_runtime PRIVATE
  port/cortex-m4/machine.cpp port/cortex-m4/mode.cpp port/cortex-m4/tick.cpp port/cortex-m4/switch.S port/cortex-m4/isolation.cpp
  port/cortex-m4/sandbox.S
  port/cortex-m4/fault.cpp port/cortex-m4/fault.S
  port/cortex-m4/memory.cpp port/cortex-m4/divide.S)
if("ROBOSYNC_CLOCK_IS_SYSTICK" IN_LIST board_clock)
  target_sources(robosync_runtime PRIVATE port/cortex-m4/strikes_systick.cpp)
endif()
if(board_idle)
  set_source_files_properties(port/cortex-m4/switch.S PROPERTIES COMPILE_DEFINITIONS ROBOSYNC_IDLE_WORKS)
endif()
set_source_files_properties(port/cortex-m4/machine.cpp port/cortex-m4/tick.cpp port/cortex-m4/strikes_systick.cpp
                            PROPERTIES COMPILE_OPTIONS "-O2")
# The compiler must not turn these functions into calls of themselves.
set_source_files_properties(port/cortex-m4/memory.cpp PROPERTIES COMPILE_OPTIONS
  "-ffreestanding;-fno-builtin;-fno-tree-loop-distribute-patterns;-fno-strict-aliasing")
