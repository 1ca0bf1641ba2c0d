# Writes every file of a library folder into one C++ file, as rows of a name and a text:
#   cmake -DOUT=FILE -DFOLDER=FOLDER -DSUFFIX=rsl|json -DHEADER=… -DTYPE=… -DFUNCTION=… -P embed_texts.cmake
# HEADER declares the struct TYPE {name, text} and FUNCTION, which returns all rows. The row of a device also has the
# fields it is looked up by: {name, text, is it a sensor?, its type, is it the default of its type?}.
include(${CMAKE_CURRENT_LIST_DIR}/../cmake/pack.cmake)
file(GLOB files ${FOLDER}/*.${SUFFIX})
list(SORT files)
set(rows "")
foreach(file ${files})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  # Nobody sees the JSON, so most of the spaces between its tokens are left out. Within a string, a quote has a backslash before it.
  if(SUFFIX STREQUAL json)
    string(REGEX REPLACE "\n *" "" text "${text}")
    string(REGEX REPLACE "([^\\])\": " "\\1\":" text "${text}")
    string(REGEX REPLACE ", ([[{\"])" ",\\1" text "${text}")
  endif()
  set(found_by "")
  if(TYPE STREQUAL DeviceText)
    string(JSON kind GET "${text}" kind)
    string(JSON type GET "${text}" type)
    string(JSON default ERROR_VARIABLE not_there GET "${text}" default)
    set(is_sensor false)
    set(is_default false)
    if(kind STREQUAL sensor)
      set(is_sensor true)
    endif()
    if(default STREQUAL ON)
      set(is_default true)
    endif()
    set(found_by ", ${is_sensor}, \"${type}\", ${is_default}")
  endif()
  embed(piece "${text}")
  string(APPEND rows "      {\"${name}\", EmbeddedText${piece}.text()${found_by}},\n")
endforeach()
pack(packed)
file(WRITE ${OUT} "// Made from ${FOLDER}/*.${SUFFIX} by compiler/embed_texts.cmake.
#include \"${HEADER}\"
#include \"compiler/source/embedded.hpp\"

namespace robosync::compiler {
namespace {

${packed}
}  // namespace

std::span<const ${TYPE}> ${FUNCTION}() {
  static const ${TYPE} kTexts[] = {
${rows}  };
  return kTexts;
}

}  // namespace robosync::compiler
")
