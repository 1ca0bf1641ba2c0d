// "Did you mean": the candidate nearest to a misspelt word.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

// Mistakes between two words: letters left out, added, changed, or two neighbours swapped
// (Damerau–Levenshtein, optimal string alignment). ASCII case is ignored.
[[nodiscard]] std::size_t mistakes(std::string_view a, std::string_view b);

// True when `word` may be a misspelling of `candidate`: at most a third of the longer one's letters
// are wrong. One mistake is forgiven in words of three letters and in swapped or missing letters of
// shorter ones.
[[nodiscard]] bool is_near(std::string_view word, std::string_view candidate);

// The nearest of the candidates that `is_near`; of equal ones the first.
[[nodiscard]] std::optional<std::string> nearest(std::string_view word,
                                                 std::span<const std::string> candidates);

// Offers the nearest candidate in the place of `word`, which stands at `place`: as help, and as a fix, between
// `quotes`. The fix is certain when one slip of the hand gives this candidate and no other one. False when none is near.
bool did_you_mean(Diagnostic& diagnostic, Span place, std::string_view word,
                  std::span<const std::string> candidates, std::string_view quotes = "");

}  // namespace robosync::compiler
