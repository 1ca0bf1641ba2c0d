// "Did you mean": finds the candidate nearest to a misspelt word.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

// The number of mistakes between two words: letters left out, added, changed, or two neighbours swapped
// (Damerau–Levenshtein, optimal string alignment). ASCII case is ignored.
[[nodiscard]] std::size_t mistakes(std::string_view a, std::string_view b);

// True when `word` may be a misspelling of `candidate`: at most a third of the longer word's letters
// are wrong. In words of three letters one mistake is allowed; in shorter ones, only a swapped or
// missing letter.
[[nodiscard]] bool is_near(std::string_view word, std::string_view candidate);

// The nearest candidate for which `is_near` holds; the first one of several equals.
[[nodiscard]] std::optional<std::string> nearest(std::string_view word,
                                                 std::span<const std::string> candidates);

// Suggests the nearest candidate for `word`, found at `place`: as help, and as a fix enclosed in `quotes`. The fix is
// certain when this is the only candidate within one typing slip. False when none is near.
bool did_you_mean(Diagnostic& diagnostic, Span place, std::string_view word,
                  std::span<const std::string> candidates, std::string_view quotes = "");

// Names with digits, such as those of chips and boards, have relatives: `tmp102` is not `tmp105` misspelt. Makes the fix of such
// a `word` likely, unless only case and characters such as `-` and `_` differ.
void doubt_numbered(Diagnostic& diagnostic, std::string_view word);

}  // namespace robosync::compiler
