// What each diagnostic means, for `rsc explain CODE`. The texts stand once, in codes.def.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler::explain {

struct CodeText {
  Code code;
  std::string_view meaning;  // what is wrong, and why rsc minds
  std::string_view wrong;    // an example that gets the diagnostic; may be empty
  std::string_view mended;   // the same without the mistake; empty only when `wrong` is
};

[[nodiscard]] std::span<const CodeText> code_texts();

// "E0301", in any case. Nothing when there is no such code.
[[nodiscard]] std::optional<Code> find_code(std::string_view name);

// Title, meaning, example and mend, as they are printed.
[[nodiscard]] std::string code_text(Code code);

}  // namespace robosync::compiler::explain
