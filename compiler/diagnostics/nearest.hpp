// "Did you mean": the candidate nearest to a misspelt word.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

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

}  // namespace robosync::compiler
