# The algorithm modules of the firmware (modules.def), and who judges an image by them. Plain C; each by itself, since they use
# the same names.
add_library(robosync_algorithms STATIC algorithms/modules.cpp algorithms/judge.cpp
  algorithms/touch_levels.c algorithms/imu_gestures.c)
target_link_libraries(robosync_algorithms PUBLIC robosync_warnings robosync_vm)
target_compile_options(robosync_algorithms PRIVATE
  $<$<COMPILE_LANGUAGE:C>:-std=c11 -Wall -Wextra -Wconversion -Wshadow -Werror>)
set_target_properties(robosync_algorithms PROPERTIES UNITY_BUILD OFF)
