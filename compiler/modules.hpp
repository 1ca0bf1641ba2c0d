// USE: the modules of the library (stdlib/*.rsl, built into the compiler) and the program's own.
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

struct ModuleText {  // one module as built in
  std::string_view name;
  std::string_view text;
};
[[nodiscard]] std::span<const ModuleText> module_texts();

// The module that gives a DEFINE or a MOTION of this name; empty when none does.
[[nodiscard]] std::string_view module_with(std::string_view name);

struct Module {
  FileId file = 0;
  std::unique_ptr<const ast::Tree> tree;  // stays where it is when the list grows
};

// What `program` uses, and what that uses; each module once. `read` may be empty: then there are no
// files. What cannot be read is reported where it is used.
[[nodiscard]] std::vector<Module> load_modules(const ast::Tree& program, SourceMap& sources,
                                               const ModuleReader& read, Diagnostics& diagnostics,
                                               const Vocabulary* robot = nullptr);

}  // namespace robosync::compiler
