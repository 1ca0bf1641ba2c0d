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

  // `RAISE left_arm`, `RAISE left_arm TO 40deg`: an actuator is moved, not raised.
  std::optional<Edit> raised_actuator() {
    const std::size_t name = statement_ + 1;
    if (stop_ != statement_ + 2 || !(begins_with(Kinds::RAISE) || begins_with(Kinds::LOWER)) ||
        !is(name, Kinds::NAME) || !examples_.is_actuator(text(name)))
      return std::nullopt;
    std::string better = examples_.command(text(name), true);
    const std::size_t place = better.find(" TO ");
    if (is(stop_, Kinds::TO) && place != std::string::npos)
      better = better.substr(0, better.find(' ')) + " " + text(name, statement_end());
    say(Code::E0508, span(statement_, name + 1), "`{0}` changes a number, and `{1}` is none",
        "an actuator takes commands, such as `{2}`", text(statement_), text(name), better);
    return change(stop_, statement_end() - stop_,
                  {missing(Kinds::BY, stop_), missing(Kinds::QUANTITY, stop_)});
  }

  // `RAISE`, `LOWER BY 3`
  std::optional<Edit> raised_nothing() {
    const bool raises = begins_with(Kinds::RAISE) || begins_with(Kinds::LOWER);
    const bool ends = stop_ == statement_ + 1 && stop_ == statement_end();
    const bool goes_on = is(statement_ + 1, Kinds::BY) || is(statement_ + 1, Kinds::TO);
    if (!raises || stop_ > statement_ + 2 || !(ends || goes_on)) return std::nullopt;
    report(Code::E0008, "a name is missing after " + quote(statement_), tokens_[statement_].span)
        .helps(examples_.written_like(tokens_, stop_));
    const std::size_t rest = statement_ + 1;
    return change(
        rest, statement_end() - rest,
        {missing(Kinds::NAME, rest), missing(Kinds::BY, rest), missing(Kinds::QUANTITY, rest)});
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

std::optional<Edit> explain_raised(const Tokens& tokens, const SourceFile& source,
                                   const Attempt& failure, const Examples& examples,
                                   Diagnostics& diagnostics) {
  RobotLines lines(tokens, source, failure, examples, diagnostics);
  if (failure.stopped_at >= tokens.size()) return std::nullopt;
  if (auto actuator = lines.raised_actuator()) return actuator;
  return lines.raised_nothing();
}

std::optional<Edit> explain_sentence(const Tokens& tokens, const SourceFile& source,
                                     const Attempt& failure, const Examples& examples,
                                     Diagnostics& diagnostics) {
  return RobotLines(tokens, source, failure, examples, diagnostics).sentence();
}

}  // namespace robosync::compiler
