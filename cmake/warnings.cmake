# One list of warnings for every target that is ours: link robosync_warnings.
add_library(robosync_warnings INTERFACE)
target_compile_options(robosync_warnings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor -Werror>)
# gcc 12 sees members of std::variant that are never there, the more the more it inlines. On the host clang-tidy
# looks for what this warning is about; on the board, where there are no variants, it stays.
if(NOT CMAKE_CROSSCOMPILING)
  target_compile_options(robosync_warnings INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-maybe-uninitialized>)
endif()
# Every include is written from the top of the repository, so that it names its layer.
target_include_directories(robosync_warnings INTERFACE ${PROJECT_SOURCE_DIR})
