// See number_words.hpp.
#include "compiler/syntax/number_words.hpp"

#include <string>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/rewritten.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kNumbers[] = {"ONE", "TWO",   "THREE", "FOUR", "FIVE",
                                         "SIX", "SEVEN", "EIGHT", "NINE", "TEN"};
constexpr std::string_view kTimes[] = {"ONCE", "TWICE", "THRICE"};

template <std::size_t n>
unsigned place_in(const std::string_view (&words)[n], std::string_view word) {
  for (unsigned at = 0; at < n; ++at)
    if (ascii::same(words[at], word)) return at + 1;
  return 0;
}

class NumberWords {
public:
  NumberWords(const Tokens& tokens, const SourceFile& source, const Vocabulary* robot)
      : tokens_(tokens), source_(source), robot_(robot) {}

  // How many tokens stand for a number here; 0: none. After it, better() is what to write.
  [[nodiscard]] std::size_t read(std::size_t at) {
    if (at == 0 || tokens_[at].kind != Kinds::NAME) return 0;
    const std::string_view word = text(at);
    counts_ = is_behind_condition(at) && is(at + 1, Kinds::WITHIN);
    if (const unsigned times = place_in(kTimes, word); counts_ && times > 0)
      return found(std::to_string(times) + " TIMES", 1);
    counts_ = false;
    const unsigned number = number_in_words(word);
    if (number == 0 || knows(robot_, word)) return 0;
    if (is_behind_condition(at) && is(at + 1, Kinds::TIMES) && is(at + 2, Kinds::WITHIN))
      return found(std::to_string(number), 1);
    const Unit* const unit = is(at + 1, Kinds::NAME) ? find_unit(text(at + 1)) : nullptr;
    if (unit == nullptr || !takes_amount(tokens_[at - 1].kind)) return 0;
    return found(std::to_string(number) + std::string(unit->spelling), 2);
  }

  [[nodiscard]] const std::string& better() const { return better_; }
  [[nodiscard]] bool counts() const { return counts_; }  // with its TIMES

private:
  [[nodiscard]] std::string_view text(std::size_t at) const {
    return source_.text(tokens_[at].span);
  }
  [[nodiscard]] bool is(std::size_t at, TokenKind kind) const {
    return at < tokens_.size() && tokens_[at].kind == kind;
  }
  [[nodiscard]] bool is_behind_condition(std::size_t at) const {
    return is_one_of(tokens_[at - 1].kind, {Kinds::QUANTITY, Kinds::NAME, Kinds::CLOSE,
                                            Kinds::STRING, Kinds::TRUE, Kinds::FALSE});
  }
  static bool takes_amount(TokenKind kind) {
    return is_preposition(kind) ||
           is_one_of(kind, {Kinds::WITHIN, Kinds::WAIT, Kinds::EVERY, Kinds::COOLDOWN});
  }
  std::size_t found(std::string better, std::size_t count) {
    better_ = std::move(better);
    return count;
  }

  const Tokens& tokens_;
  const SourceFile& source_;
  const Vocabulary* robot_;
  std::string better_;
  bool counts_ = false;
};

}  // namespace

unsigned number_in_words(std::string_view word) {
  return place_in(kNumbers, word);
}

void mend_number_words(Tokens& tokens, const SourceFile& source, const Vocabulary* robot,
                       Diagnostics& diagnostics) {
  Rewritten rewritten(tokens);
  NumberWords words(tokens, source, robot);
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const std::size_t count = words.read(at);
    if (count == 0) {
      rewritten.keep(at);
      continue;
    }
    const Span last = tokens[at + count - 1].span;
    const Span place{last.file, tokens[at].span.begin, last.end};
    diagnostics.report(Code::E0004, "a number is written in digits")
        .label(place)
        .helps("write `" + words.better() + "`")
        .fix(place, words.better(), Applicability::likely);
    const Span end{last.file, last.end, last.end};
    Tokens& others = rewritten.other(at);
    others.push_back({Kinds::QUANTITY, end});  // without a text, it has no further mistakes
    if (words.counts()) others.push_back({Kinds::TIMES, end});
    at += count - 1;
  }
  rewritten.finish();
}

}  // namespace robosync::compiler
