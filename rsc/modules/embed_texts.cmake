# Writes the texts of texts.hpp into one C++ file:
#   cmake -DOUT=FILE -DSOURCE=TOP_OF_THE_REPOSITORY -P embed_texts.cmake
# The module itself is the one that docs/algorithms.md shows.
function(embed file_name text)
  string(APPEND rows "    {\"${file_name}\", R\"text(${text})text\"},\n")
  set(rows "${rows}" PARENT_SCOPE)
endfunction()

file(READ ${SOURCE}/docs/algorithms.md page)
string(REGEX MATCH "```c\n([^`]+)```" block "${page}")
set(module "${CMAKE_MATCH_1}")
file(READ ${SOURCE}/runtime-m4/algorithms/robosync_module.h header)
file(READ ${SOURCE}/rsc/modules/count_on_m4.c.in counting)
set(rows "")
embed(modules/heartbeat.c "${module}")
embed(modules/robosync_module.h "${header}")
file(GLOB files RELATIVE ${SOURCE}/rsc/new_module ${SOURCE}/rsc/new_module/*)
foreach(file ${files})
  file(READ ${SOURCE}/rsc/new_module/${file} text)
  embed(${file} "${text}")
endforeach()
file(WRITE ${OUT} "// Made by rsc/modules/embed_texts.cmake.
#include \"rsc/modules/texts.hpp\"

namespace robosync::tool {
namespace {

constexpr TemplateFile kFiles[] = {
${rows}};
constexpr std::string_view kCounting = R\"text(${counting})text\";

}  // namespace

std::span<const TemplateFile> new_module_files() {
  return kFiles;
}
std::string_view module_header() {
  return kFiles[1].text;
}
std::string_view counting_program() {
  return kCounting;
}

}  // namespace robosync::tool
")
