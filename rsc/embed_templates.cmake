# Writes the robots of templates.def, each with its files, into one C++ file:
#   cmake -DOUT=FILE -DTEMPLATES=templates.def -DEXAMPLES=FOLDER -P embed_templates.cmake
# The path of the schema is left out: it is that of the repository.
file(STRINGS ${TEMPLATES} lines REGEX "^TEMPLATE")
set(files_of "")
set(rows "")
foreach(line ${lines})
  string(REGEX REPLACE "^TEMPLATE\\(([a-z_]+), ([a-z_]+), (.*)\\)$" "\\1;\\2;\\3" parts "${line}")
  list(GET parts 0 name)
  list(GET parts 1 example)
  list(GET parts 2 said)
  file(GLOB files ${EXAMPLES}/${example}/*.rsl ${EXAMPLES}/${example}/*.json ${EXAMPLES}/${example}/*.csv)
  string(APPEND files_of "constexpr TemplateFile k_${name}[] = {\n")
  foreach(file ${files})
    get_filename_component(file_name ${file} NAME)
    file(READ ${file} text)
    string(REGEX REPLACE "\n *\"\\$schema\": [^\n]*" "" text "${text}")
    string(APPEND files_of "    {\"${file_name}\", R\"text(${text})text\"},\n")
  endforeach()
  string(APPEND files_of "};\n")
  string(APPEND rows "    {\"${name}\", ${said}, k_${name}},\n")
endforeach()
file(WRITE ${OUT} "// Made from ${TEMPLATES} by rsc/embed_templates.cmake.
#include \"rsc/templates.hpp\"

namespace robosync::tool {
namespace {

${files_of}
constexpr Template kTemplates[] = {
${rows}};

}  // namespace

std::span<const Template> templates() {
  return kTemplates;
}

}  // namespace robosync::tool
")
