// Lists of words in one text, with blanks between them: shorter than an array of texts.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "compiler/source/ascii.hpp"

namespace robosync::compiler {

// Ignores case.
[[nodiscard]] inline bool has_word(std::string_view words, std::string_view word) {
  while (!words.empty() && !word.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    if (ascii::same(words.substr(0, end), word)) return true;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return false;
}

}  // namespace robosync::compiler
