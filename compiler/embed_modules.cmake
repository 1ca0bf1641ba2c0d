# Writes every module of the library into one C++ file: cmake -DOUT=… -DFOLDER=… -P embed_modules.cmake
file(GLOB modules ${FOLDER}/*.rsl)
list(SORT modules)
list(LENGTH modules count)
set(rows "")
foreach(module ${modules})
  get_filename_component(name ${module} NAME_WE)
  file(READ ${module} text)
  string(APPEND rows "    {\"${name}\", R\"rsl(${text})rsl\"},\n")
endforeach()
file(WRITE ${OUT} "// Made from stdlib/*.rsl by compiler/embed_modules.cmake.
#include <array>

#include \"compiler/modules.hpp\"

namespace robosync::compiler {
namespace {

constexpr std::array<ModuleText, ${count}> kTexts = {{
${rows}}};

}  // namespace

std::span<const ModuleText> module_texts() {
  return kTexts;
}

}  // namespace robosync::compiler
")
