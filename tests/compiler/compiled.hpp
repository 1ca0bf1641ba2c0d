// Programs and configurations through the whole compiler, for the tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/compiler.hpp"
#include "compiler/diagnostics/render.hpp"
#include "tests/support/golden.hpp"
#include "vm/disassembler.hpp"
#include "vm/verifier.hpp"

namespace robosync::compiler::testing {

using robosync::testing::read_file;

inline std::filesystem::path source_folder() {
  return ROBOSYNC_SOURCE_DIR;
}

// All files with the extension in these folders of the repository and in their subfolders, sorted.
inline std::vector<std::filesystem::path> files_in(std::initializer_list<std::string_view> folders,
                                                   std::string_view extension) {
  std::vector<std::filesystem::path> found;
  for (const std::string_view folder : folders)
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(source_folder() / folder))
      if (entry.path().extension() == extension) found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

// Wrong and doubtful programs, and the robot that they share.
inline std::filesystem::path messages_folder() {
  return source_folder() / "tests/compiler/diagnostics/golden";
}

inline std::filesystem::path disassembly_folder() {
  return source_folder() / "tests/compiler/codegen/disassembly";
}

inline Result compile_text(std::string program, std::string configuration,
                           bool source_lines = false) {
  return compile({"robot.rsl", std::move(program)}, {"robot.json", std::move(configuration)},
                 {.source_lines = source_lines});
}

inline std::string common_robot() {
  return read_file(messages_folder() / "robot.json");
}

inline std::string messages(const Result& result) {
  return render_human(result.diagnostics, result.sources, false, SIZE_MAX);
}

inline vm::Image view(const Result& result) {
  vm::Image image;
  REQUIRE(vm::view_image(result.image, image));
  return image;
}

inline std::string disassembly(const Result& result) {
  const vm::Image image = view(result);
  std::string text;
  char line[128];
  for (const vm::Word word : image.code) {
    vm::disassemble(image, word, line);
    text += std::string(line) + "\n";
  }
  return text;
}

}  // namespace robosync::compiler::testing
