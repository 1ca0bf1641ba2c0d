// See number_words.hpp.
#include "compiler/syntax/number_words.hpp"

#include <iterator>
#include <string>
#include <string_view>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/rewritten.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kNumbers[] = {"ONE", "TWO",   "THREE", "FOUR", "FIVE",
                                         "SIX", "SEVEN", "EIGHT", "NINE", "TEN"};
constexpr std::string_view kTimes[] = {"ONCE", "TWICE", "THRICE"};

// 1 for the first; 0: it is none of them.
template <std::size_t n>
std::size_t place_in(const std::string_view (&words)[n], std::string_view word) {
  for (std::size_t at = 0; at < n; ++at)
    if (ascii::same(words[at], word)) return at + 1;
  return 0;
}

}  // namespace

void mend_number_words(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  Rewritten rewritten(tokens);
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const auto is = [&](std::size_t place, TokenKind kind) {
      return place < tokens.size() && tokens[place].kind == kind;
    };
    const std::string_view word = source.text(tokens[at].span);
    const bool is_name = is(at, Kinds::NAME) || is(at, Kinds::ONE);
    const std::size_t number = is_name ? place_in(kNumbers, word) : 0;
    const std::size_t times = is(at, Kinds::NAME) && is(at + 1, Kinds::WITHIN) && at > 0 &&
                                      tokens[at - 1].kind != Kinds::OR
                                  ? place_in(kTimes, word)
                                  : 0;
    const Unit* const unit = number > 0 && is(at + 1, Kinds::NAME)
                                 ? find_unit(source.text(tokens[at + 1].span))
                                 : nullptr;
    if (times == 0 && unit == nullptr && (number == 0 || !is(at + 1, Kinds::TIMES))) {
      rewritten.keep(at);
      continue;
    }
    Span place = tokens[at].span;
    std::string better = std::to_string(number + times);
    if (times > 0) better += " TIMES";
    if (unit != nullptr) {
      better += unit->spelling;
      place.end = tokens[++at].span.end;
    }
    diagnostics.report(Code::E0004, "a number is written in digits")
        .label(place)
        .helps("write `" + better + "`")
        .fix(place, better, Applicability::likely);
    Tokens& others = rewritten.other(unit != nullptr ? at - 1 : at);
    const Span end{place.file, place.end, place.end};
    others.push_back({Kinds::QUANTITY, end});  // without a text, it has no further mistakes
    if (times > 0) others.push_back({Kinds::TIMES, end});
  }
  rewritten.finish();
}

}  // namespace robosync::compiler
