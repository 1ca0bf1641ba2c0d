# Writes the parts of the page, without the script's lines of comment, into one C++ file:
#   cmake -DOUT=FILE -DFOLDER=rsc/timeline -P embed_page.cmake
include(${CMAKE_CURRENT_LIST_DIR}/../../cmake/pack.cmake)
file(READ ${FOLDER}/timeline.html html)
file(READ ${FOLDER}/timeline.css style)
file(READ ${FOLDER}/timeline.js script)
string(REGEX REPLACE "\n *//[^\n]*" "" script "${script}")
embed(html_piece "${html}")
embed(style_piece "${style}")
embed(script_piece "${script}")
pack(packed)
file(WRITE ${OUT} "// Made from ${FOLDER}/timeline.* by rsc/timeline/embed_page.cmake.
#include \"rsc/timeline/page.hpp\"

namespace robosync::tool {
namespace {

${packed}
}  // namespace

PageParts page_parts() {
  return {${html_piece}, ${style_piece}, ${script_piece}};
}

}  // namespace robosync::tool
")
