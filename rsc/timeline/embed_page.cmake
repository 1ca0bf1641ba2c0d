# Writes the parts of the page, without the script's lines of comment, into one C++ file:
#   cmake -DOUT=FILE -DFOLDER=rsc/timeline -P embed_page.cmake
file(READ ${FOLDER}/timeline.html html)
file(READ ${FOLDER}/timeline.css style)
file(READ ${FOLDER}/timeline.js script)
string(REGEX REPLACE "\n *//[^\n]*" "" script "${script}")
file(WRITE ${OUT} "// Made from ${FOLDER}/timeline.* by rsc/timeline/embed_page.cmake.
#include \"rsc/timeline/page.hpp\"

namespace robosync::tool {

PageParts page_parts() {
  return {R\"part(${html})part\", R\"part(${style})part\", R\"part(${script})part\"};
}

}  // namespace robosync::tool
")
