# One list of warnings for every target that is ours: link robosync_warnings.
add_library(robosync_warnings INTERFACE)
target_compile_options(robosync_warnings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor -Werror>)
# Every include is written from the top of the repository, so that it names its layer.
target_include_directories(robosync_warnings INTERFACE ${PROJECT_SOURCE_DIR})
