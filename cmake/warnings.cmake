# One list of warnings for all of our own targets: link robosync_warnings.
add_library(robosync_warnings INTERFACE)
target_compile_options(robosync_warnings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor -Werror>)
# gcc 12 reports uninitialised members of std::variant that are never active, more often the more it inlines. On the
# host, clang-tidy looks for the same mistakes; on the board, where there are no variants, the warning stays on.
if(NOT CMAKE_CROSSCOMPILING)
  target_compile_options(robosync_warnings INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-maybe-uninitialized>)
endif()
# Every include starts at the top of the repository, so that it names its layer.
target_include_directories(robosync_warnings INTERFACE ${PROJECT_SOURCE_DIR})
