// See nearest.hpp.
#include "compiler/diagnostics/nearest.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/source/ascii.hpp"

namespace robosync::compiler {

namespace {

// Words come from outside, and the work is quadratic. Nobody misspells a longer word.
constexpr std::size_t longest_word = 64;

// Three rows of the distance matrix: a swap looks two rows back.
using Row = std::array<std::size_t, longest_word + 1>;
struct Rows {
  std::array<Row, 3> storage;
  Row* before = &storage[0];
  Row* previous = &storage[1];
  Row* current = &storage[2];

  void advance() {
    std::swap(before, previous);
    std::swap(previous, current);
  }
};

void fill_row(const Rows& rows, std::string_view a, std::string_view b, std::size_t i) {
  const Row& before = *rows.before;
  const Row& previous = *rows.previous;
  Row& current = *rows.current;
  current[0] = i;
  for (std::size_t j = 1; j <= b.size(); ++j) {
    const std::size_t changed = previous[j - 1] + (ascii::same(a[i - 1], b[j - 1]) ? 0U : 1U);
    std::size_t best = std::min({previous[j] + 1, current[j - 1] + 1, changed});
    const bool swapped =
        i > 1 && j > 1 && ascii::same(a[i - 1], b[j - 2]) && ascii::same(a[i - 2], b[j - 1]);
    if (swapped) best = std::min(best, before[j - 2] + 1);
    current[j] = best;
  }
}

// The most mistakes at which a word of this length still matches.
std::size_t tolerated(std::size_t longer) {
  return std::max<std::size_t>(1, longer / 3);
}

// The length of the common prefix, which has no mistakes.
std::size_t common_start(std::string_view a, std::string_view b) {
  const auto ends = std::mismatch(a.begin(), a.end(), b.begin(), b.end(),
                                  [](char x, char y) { return ascii::same(x, y); });
  return static_cast<std::size_t>(ends.first - a.begin());
}

// A cheap test that rules out most candidates.
bool lengths_differ_too_much(std::string_view a, std::string_view b) {
  const auto [shorter, longer] = std::minmax({a.size(), b.size()});  // by value
  return longer - shorter > tolerated(longer);
}

// The number of mistakes in `word`, if `candidate` may be meant.
std::optional<std::size_t> mistakes_if_near(std::string_view word, std::string_view candidate) {
  if (lengths_differ_too_much(word, candidate)) return std::nullopt;
  const std::size_t longer = std::max(word.size(), candidate.size());
  const std::size_t wrong = mistakes(word, candidate);
  if (wrong == 0) return wrong;
  bool near = false;
  if (longer > 2) {
    near = wrong <= tolerated(longer);
  } else if (longer == 2 && !word.empty()) {
    const bool swapped = word.size() == 2 && candidate.size() == 2 &&
                         ascii::same(word[0], candidate[1]) && ascii::same(word[1], candidate[0]);
    near = swapped || (word.size() == 1 && wrong == 1);
  }
  return near && !word.empty() ? std::optional(wrong) : std::nullopt;
}

}  // namespace

std::size_t mistakes(std::string_view a, std::string_view b) {
  if (a.size() > longest_word || b.size() > longest_word) return std::max(a.size(), b.size());
  const std::size_t common = common_start(a, b);
  a.remove_prefix(common);
  b.remove_prefix(common);
  if (a.empty() || b.empty()) return a.size() + b.size();
  Rows rows;
  for (std::size_t j = 0; j <= b.size(); ++j)
    (*rows.previous)[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    fill_row(rows, a, b, i);
    rows.advance();
  }
  return (*rows.previous)[b.size()];
}

bool is_near(std::string_view word, std::string_view candidate) {
  return mistakes_if_near(word, candidate).has_value();
}

std::optional<std::string> nearest(std::string_view word, std::span<const std::string> candidates) {
  const std::string* best = nullptr;
  std::size_t fewest = 0;
  for (const std::string& candidate : candidates) {
    const auto wrong = mistakes_if_near(word, candidate);
    if (!wrong || (best != nullptr && *wrong >= fewest)) continue;
    best = &candidate;
    fewest = *wrong;
  }
  return best == nullptr ? std::nullopt : std::optional(*best);
}

namespace {

// True when `meant` is the only candidate within one typing slip of `word`.
bool is_only_slip(std::string_view word, std::string_view meant,
                  std::span<const std::string> candidates) {
  const auto one_slip = [word](std::string_view candidate) {
    return !lengths_differ_too_much(word, candidate) && mistakes(word, candidate) == 1;
  };
  return one_slip(meant) && std::ranges::none_of(candidates, [&](const std::string& candidate) {
           return !ascii::same(candidate, meant) && one_slip(candidate);
         });
}

}  // namespace

bool did_you_mean(Diagnostic& diagnostic, Span place, std::string_view word,
                  std::span<const std::string> candidates, std::string_view quotes) {
  const auto near = nearest(word, candidates);
  if (!near) return false;
  const std::string quote(quotes);
  diagnostic.helps("did you mean `" + *near + "`?")
      .fix(place, quote + *near + quote,
           is_only_slip(word, *near, candidates) ? Applicability::certain : Applicability::likely);
  return true;
}

void doubt_numbered(Diagnostic& diagnostic, std::string_view word) {
  const auto core = [](std::string_view text) {
    std::string letters;
    for (const char c : text)
      if (ascii::is_letter(c) || ascii::is_digit(c)) letters += ascii::lower(c);
    return letters;
  };
  const std::string written = core(word);
  for (Fix& fix : diagnostic.fixes) {
    const std::string meant = core(fix.replacement);
    if (written != meant && std::ranges::any_of(written + meant, ascii::is_digit))
      fix.applicability = Applicability::likely;
  }
}

}  // namespace robosync::compiler
