# Writes the texts of texts.hpp into one C++ file:
#   cmake -DOUT=FILE -DSOURCE=TOP_OF_THE_REPOSITORY -P embed_texts.cmake
# The module itself is the one that docs/algorithms.md shows.
include(${CMAKE_CURRENT_LIST_DIR}/../../cmake/pack.cmake)
macro(add_file file_name)
  string(APPEND rows "    {\"${file_name}\", ${piece}},\n")
endmacro()

file(READ ${SOURCE}/docs/algorithms.md page)
string(REGEX MATCH "```c\n([^`]+)```" block "${page}")
set(module "${CMAKE_MATCH_1}")
file(READ ${SOURCE}/runtime-m4/algorithms/robosync_module.h header)
file(READ ${SOURCE}/rsc/modules/count_on_m4.c.in counting)
set(rows "")
embed(piece "${module}")
add_file(modules/heartbeat.c)
embed(piece "${header}")
add_file(modules/robosync_module.h)
file(GLOB files RELATIVE ${SOURCE}/rsc/new_module ${SOURCE}/rsc/new_module/*)
foreach(file ${files})
  file(READ ${SOURCE}/rsc/new_module/${file} text)
  embed(piece "${text}")
  add_file(${file})
endforeach()
embed(counting_piece "${counting}")
pack(packed)
file(WRITE ${OUT} "// Made by rsc/modules/embed_texts.cmake.
#include \"rsc/modules/texts.hpp\"

namespace robosync::tool {
namespace {

${packed}
constexpr TemplateFile kFiles[] = {
${rows}};
constexpr compiler::EmbeddedText kCounting = ${counting_piece};

}  // namespace

std::span<const TemplateFile> new_module_files() {
  return kFiles;
}
std::string_view module_header() {
  return kFiles[1].text();
}
std::string_view counting_program() {
  return kCounting.text();
}

}  // namespace robosync::tool
")
