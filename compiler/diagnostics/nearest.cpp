// See nearest.hpp.
#include "compiler/diagnostics/nearest.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace robosync::compiler {

namespace {

// Words come from outside. Nobody misspells a longer one, and the work is quadratic.
constexpr std::size_t longest_word = 64;

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool equal(char a, char b) {
  return lower(a) == lower(b);
}

// Three rows of the distance matrix: a swap looks two rows back.
struct Rows {
  std::vector<std::size_t> before, previous, current;
};

void fill_row(Rows& rows, std::string_view a, std::string_view b, std::size_t i) {
  rows.current[0] = i;
  for (std::size_t j = 1; j <= b.size(); ++j) {
    const std::size_t changed = rows.previous[j - 1] + (equal(a[i - 1], b[j - 1]) ? 0U : 1U);
    std::size_t best = std::min({rows.previous[j] + 1, rows.current[j - 1] + 1, changed});
    const bool swapped = i > 1 && j > 1 && equal(a[i - 1], b[j - 2]) && equal(a[i - 2], b[j - 1]);
    if (swapped) best = std::min(best, rows.before[j - 2] + 1);
    rows.current[j] = best;
  }
}

}  // namespace

std::size_t mistakes(std::string_view a, std::string_view b) {
  if (a.size() > longest_word || b.size() > longest_word) return std::max(a.size(), b.size());
  Rows rows{std::vector<std::size_t>(b.size() + 1), std::vector<std::size_t>(b.size() + 1),
            std::vector<std::size_t>(b.size() + 1)};
  for (std::size_t j = 0; j <= b.size(); ++j)
    rows.previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    fill_row(rows, a, b, i);
    std::swap(rows.before, rows.previous);
    std::swap(rows.previous, rows.current);
  }
  return rows.previous[b.size()];
}

bool is_near(std::string_view word, std::string_view candidate) {
  const std::size_t longer = std::max(word.size(), candidate.size());
  const std::size_t wrong = mistakes(word, candidate);
  if (wrong == 0) return true;
  if (word.empty() || longer < 2) return false;
  if (longer > 2) return wrong <= std::max<std::size_t>(1, longer / 3);
  const bool swapped = word.size() == 2 && candidate.size() == 2 && equal(word[0], candidate[1]) &&
                       equal(word[1], candidate[0]);
  return swapped || (word.size() == 1 && wrong == 1);
}

std::optional<std::string> nearest(std::string_view word, std::span<const std::string> candidates) {
  std::optional<std::string> best;
  std::size_t fewest = 0;
  for (const std::string& candidate : candidates) {
    if (!is_near(word, candidate)) continue;
    const std::size_t wrong = mistakes(word, candidate);
    if (best && wrong >= fewest) continue;
    best = candidate;
    fewest = wrong;
  }
  return best;
}

}  // namespace robosync::compiler
