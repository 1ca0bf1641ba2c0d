// Lines that only the robot's names tell from other mistakes: a sentence as a condition, a command behind a comma. See
// habits.hpp.
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/syntax/examples.hpp"
#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/mistaken_line.hpp"

namespace robosync::compiler {
namespace {

class RobotLines : private MistakenLine {
public:
  RobotLines(const Tokens& tokens, const SourceFile& source, const Attempt& failure,
             const Examples& examples, Diagnostics& diagnostics)
      : MistakenLine(tokens, source, failure, diagnostics), examples_(examples) {}

  // `WHEN I see a person`
  std::optional<Edit> sentence() {
    if (stop_ >= tokens_.size()) return std::nullopt;
    std::size_t first = stop_;
    while (first > begin_ && is(first - 1, Kinds::NAME))
      --first;
    const bool asks = first > 0 && begins_question(tokens_[first - 1].kind);
    if (!asks || stop_ < first + 2 || !is_plain_word(stop_) || examples_.is_sensor(text(first)))
      return std::nullopt;
    std::size_t end = stop_;
    while (end < end_ && is(end, Kinds::NAME) && !examples_.is_verb(text(end)))
      ++end;
    if (end < end_ && !is(end, Kinds::DO) && !is(end, Kinds::NAME)) return std::nullopt;
    const bool lacks_do = is(end, Kinds::NAME);
    report(Code::E0001, "this is not a condition: a condition names a sensor and what it measures",
           span(first, end))
        .helps("write a condition such as `" + examples_.condition(words(first, end)) + "`" +
               (lacks_do ? ", and `DO` before the command" : ""));
    Tokens condition{missing(Kinds::QUANTITY, first), missing(Kinds::LESS, first),
                     missing(Kinds::QUANTITY, first)};
    if (lacks_do) condition.push_back(missing(Kinds::DO, end));
    return change(first, end - first, std::move(condition));
  }

  // `SAY "a", SHOW eyes happy`: the grammar has read `SHOW eyes` as a part of the text.
  std::optional<Edit> joined_command() {
    if (stop_ >= tokens_.size()) return std::nullopt;
    const auto block = open_block();
    const bool speaks =
        begins_with(Kinds::NAME) || begins_with(Kinds::LOG) || begins_with(Kinds::ALERT);
    if (!speaks || stop_ < statement_ + 2 || asks_before(stop_) || !block ||
        is_one_of(tokens_[*block].kind, {Kinds::TEST, Kinds::CHECK, Kinds::MOTION}))
      return std::nullopt;
    std::size_t comma = stop_ - 1;
    while (comma > statement_ && is(comma, Kinds::NAME))
      --comma;
    if (!is(comma, Kinds::COMMA) || !begins_command(comma + 1)) return std::nullopt;
    Span gap = tokens_[comma].span;
    gap.end = tokens_[comma + 1].span.begin;
    report(Code::E0001, "a comma cannot join two commands", tokens_[comma].span)
        .helps(kOwnLine)
        .fix(gap, "\n" + std::string(indentation(tokens_[statement_], source_), ' '),
             Applicability::likely);
    return change(comma, statement_end() - comma);
  }

private:
  // Neither a command without its DO nor a misspelt word of RSL.
  bool is_plain_word(std::size_t at) const {
    constexpr std::size_t shortest = 3;  // to be a slip of another word
    return is(at, Kinds::NAME) && !examples_.is_verb(text(at)) &&
           (text(at).size() < shortest || nearest_keyword(text(at), ~0U) == nullptr);
  }

  std::vector<std::string_view> words(std::size_t first, std::size_t end) const {
    std::vector<std::string_view> found;
    for (; first < end; ++first)
      found.push_back(text(first));
    return found;
  }

  bool begins_command(std::size_t at) const {
    const unsigned roles = roles_of(tokens_[at].kind);
    if (at == stop_) return (roles & role::statement) != 0 && (roles & role::opens) == 0;
    return examples_.is_verb(text(at));
  }

  const Examples& examples_;
};

}  // namespace

std::optional<Edit> explain_joined_command(const Tokens& tokens, const SourceFile& source,
                                           const Attempt& failure, const Examples& examples,
                                           Diagnostics& diagnostics) {
  return RobotLines(tokens, source, failure, examples, diagnostics).joined_command();
}

std::optional<Edit> explain_sentence(const Tokens& tokens, const SourceFile& source,
                                     const Attempt& failure, const Examples& examples,
                                     Diagnostics& diagnostics) {
  return RobotLines(tokens, source, failure, examples, diagnostics).sentence();
}

}  // namespace robosync::compiler
