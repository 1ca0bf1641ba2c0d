# The algorithm modules of the firmware, as modules.def lists them, and who judges an image by them. Plain C; each by itself, since
# they use the same names.
set(module_list ${CMAKE_CURRENT_SOURCE_DIR}/algorithms/modules.def)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${module_list})
file(STRINGS ${module_list} modules REGEX "^MODULE")
list(TRANSFORM modules REPLACE "^MODULE\\(([a-z0-9_]+).*" "algorithms/\\1.c")
add_library(robosync_algorithms STATIC algorithms/modules.cpp algorithms/judge.cpp ${modules})
target_link_libraries(robosync_algorithms PUBLIC robosync_warnings robosync_vm)
set(module_options -std=c11 -Wall -Wextra -Wconversion -Wshadow -Werror)
target_compile_options(robosync_algorithms PRIVATE "$<$<COMPILE_LANGUAGE:C>:${module_options}>")
set_target_properties(robosync_algorithms PROPERTIES UNITY_BUILD OFF)
