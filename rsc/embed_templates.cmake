# Writes the robots of templates.txt with their files into one C++ file:
#   cmake -DOUT=FILE -DTEMPLATES=templates.txt -DEXAMPLES=FOLDER -P embed_templates.cmake
# The path of the schema is removed: it is only valid in the repository.
file(STRINGS ${TEMPLATES} lines REGEX "^[a-z]")
include(${CMAKE_CURRENT_LIST_DIR}/../cmake/pack.cmake)
set(files_of "")
set(rows "")
foreach(line ${lines})
  string(REGEX MATCH "^([a-z_]+) ([a-z_]+) ([a-z_.]+) (.*)$" all "${line}")
  set(name ${CMAKE_MATCH_1})
  set(example ${CMAKE_MATCH_2})
  set(said "\"${CMAKE_MATCH_3}\", \"${CMAKE_MATCH_4}\"")
  file(GLOB files ${EXAMPLES}/${example}/*.rsl ${EXAMPLES}/${example}/*.json ${EXAMPLES}/${example}/*.csv)
  string(APPEND files_of "constexpr TemplateFile k_${name}[] = {\n")
  foreach(file ${files})
    get_filename_component(file_name ${file} NAME)
    file(READ ${file} text)
    string(REGEX REPLACE "\n *\"\\$schema\": [^\n]*" "" text "${text}")
    embed(piece "${text}")
    string(APPEND files_of "    {\"${file_name}\", ${piece}},\n")
  endforeach()
  string(APPEND files_of "};\n")
  string(APPEND rows "    {\"${name}\", ${said}, k_${name}},\n")
endforeach()
pack(packed)
file(WRITE ${OUT} "// Made from ${TEMPLATES} by rsc/embed_templates.cmake.
#include \"rsc/templates.hpp\"

namespace robosync::tool {
namespace {

${packed}
${files_of}
constexpr Template kTemplates[] = {
${rows}};

}  // namespace

std::span<const Template> templates() {
  return kTemplates;
}

}  // namespace robosync::tool
")
