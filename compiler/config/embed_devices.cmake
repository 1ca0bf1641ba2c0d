# Writes every device descriptor into one C++ file: cmake -DOUT=… -DFOLDER=… -P embed_devices.cmake
file(GLOB descriptors ${FOLDER}/*.json)
list(SORT descriptors)
set(rows "")
foreach(descriptor ${descriptors})
  get_filename_component(name ${descriptor} NAME_WE)
  file(READ ${descriptor} text)
  string(APPEND rows "    {\"${name}\", R\"json(${text})json\"},\n")
endforeach()
file(WRITE ${OUT} "// Made from stdlib/devices/*.json by compiler/config/embed_devices.cmake.
#include \"compiler/config/devices.hpp\"

namespace robosync::compiler {
namespace {

constexpr DeviceText kTexts[] = {
${rows}};

}  // namespace

std::span<const DeviceText> device_texts() {
  return kTexts;
}

}  // namespace robosync::compiler
")
