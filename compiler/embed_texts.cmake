# Writes every file of a folder of the library into one C++ file, as rows of a name and a text:
#   cmake -DOUT=FILE -DFOLDER=FOLDER -DSUFFIX=rsl|json -DHEADER=… -DTYPE=… -DFUNCTION=… -P embed_texts.cmake
# HEADER declares the struct TYPE {name, text} and FUNCTION, which gives all rows.
file(GLOB files ${FOLDER}/*.${SUFFIX})
list(SORT files)
set(rows "")
foreach(file ${files})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND rows "    {\"${name}\", R\"text(${text})text\"},\n")
endforeach()
file(WRITE ${OUT} "// Made from ${FOLDER}/*.${SUFFIX} by compiler/embed_texts.cmake.
#include \"${HEADER}\"

namespace robosync::compiler {
namespace {

constexpr ${TYPE} kTexts[] = {
${rows}};

}  // namespace

std::span<const ${TYPE}> ${FUNCTION}() {
  return kTexts;
}

}  // namespace robosync::compiler
")
