// The meaning of each diagnostic, for `rsc explain CODE`. The texts are in codes.def.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler::explain {

struct CodeText {
  Code code;
  std::string_view meaning;  // what is wrong, and why rsc reports it
  std::string_view wrong;    // an example with the mistake; may be empty
  std::string_view mended;   // the same without the mistake; may be empty
};

[[nodiscard]] std::span<const CodeText> code_texts();

// "E0301", in any case. nullopt if there is no such code.
[[nodiscard]] std::optional<Code> find_code(std::string_view name);

// The title, meaning, example and fix, as printed.
[[nodiscard]] std::string code_text(Code code);

}  // namespace robosync::compiler::explain
