// USE: the library's modules (stdlib/*.rsl, built into the compiler) and the program's own.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/input.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

struct ModuleText {  // one built-in module
  std::string_view name;
  std::string_view text;
};
[[nodiscard]] std::span<const ModuleText> module_texts();

// The module that has a DEFINE or a MOTION of this name; empty when none has. `is_motion`, if given, says which of the two it is.
[[nodiscard]] std::string_view module_with(std::string_view name, bool* is_motion = nullptr);

struct Module {
  FileId file = 0;
  std::unique_ptr<const ast::Tree> tree;  // its address stays the same when the list grows
};

// The modules that `program` uses, directly or through others, each once. If `read` is empty, there are no
// files. A module that cannot be read is reported at its USE.
[[nodiscard]] std::vector<Module> load_modules(const ast::Tree& program, SourceMap& sources,
                                               const ModuleReader& read, Diagnostics& diagnostics,
                                               const Vocabulary* robot = nullptr);

}  // namespace robosync::compiler
