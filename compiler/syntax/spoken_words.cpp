// See spoken_words.hpp.
#include "compiler/syntax/spoken_words.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/rewritten.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kBetweenWords = " \t";
constexpr std::string_view kBlockEnd = " END";

bool is_letter(char c) {
  return ascii::lower(c) >= 'a' && ascii::lower(c) <= 'z';
}

// Is it a sentence rather than words and numbers of RSL? A comma alone does not tell: it also separates values.
bool is_sentence(std::string_view text) {
  if (text.find_first_of("\"<>=();:{}") != std::string_view::npos) return false;
  for (std::size_t at = 1; at < text.size(); ++at) {
    const bool ends =
        at + 1 == text.size() || kBetweenWords.find(text[at + 1]) != std::string_view::npos;
    const bool behind_letter = is_letter(text[at - 1]);
    if (behind_letter && ends && std::string_view("!?.").find(text[at]) != std::string_view::npos)
      return true;
    if (behind_letter && text[at] == '\'' && !ends && is_letter(text[at + 1])) return true;
  }
  return false;
}

// `Hello, friend`
bool greets(std::string_view text) {
  const std::size_t comma = text.find(',');
  const std::string_view first = text.substr(0, comma);
  const auto is_small = [](char c) { return c >= 'a' && c <= 'z'; };
  return comma != std::string_view::npos && first.size() > 1 && !is_small(first.front()) &&
         std::ranges::all_of(first.substr(1), is_small) &&
         text.find_first_of("\"'<>=();:{}0123456789") == std::string_view::npos;
}

class SpokenWords {
public:
  SpokenWords(const Tokens& tokens, const SourceFile& source, const Vocabulary* robot)
      : tokens_(tokens), source_(source), robot_(robot) {}

  // What the command at `at` says without quotes; empty: nothing.
  [[nodiscard]] Span said_at(std::size_t at) {
    if (!is_say(at)) return {};
    std::size_t first = at + 1;
    if (names_actuator(first)) ++first;
    const Span place = rest_of_line(first);
    const std::string_view text = source_.text(place);
    const bool is_text = is_sentence(text) || (greets(text) && is_new(text));
    return tokens_[first].kind != Kinds::STRING && is_text ? place : Span{};
  }

private:
  [[nodiscard]] std::string_view text(std::size_t at) const {
    return source_.text(tokens_[at].span);
  }

  [[nodiscard]] bool is_say(std::size_t at) const {
    const bool begins = at == 0 || is_one_of(tokens_[at - 1].kind, {Kinds::NEWLINE, Kinds::DO,
                                                                    Kinds::ELSE, Kinds::OPTION});
    return begins && tokens_[at].kind == Kinds::NAME && ascii::same(text(at), "SAY") &&
           at + 1 < tokens_.size() && tokens_[at + 1].kind != Kinds::NEWLINE;
  }

  [[nodiscard]] bool names_actuator(std::size_t at) const {
    return robot_ != nullptr && tokens_[at].kind == Kinds::NAME && at + 1 < tokens_.size() &&
           tokens_[at + 1].kind != Kinds::NEWLINE &&
           !robot_->part(Vocabulary::Part::actuator, text(at)).empty();
  }

  // Without a comment and the END of its block.
  [[nodiscard]] Span rest_of_line(std::size_t first) const {
    const Span begin = tokens_[first].span;
    std::string_view text = source_.text().substr(begin.begin);
    text = text.substr(0, text.find_first_of("\r\n#%"));
    if (const std::size_t last = text.find_last_not_of(kBetweenWords);
        last != std::string_view::npos)
      text = text.substr(0, last + 1);
    if (text.size() > kBlockEnd.size() && text.ends_with(kBlockEnd))
      text.remove_suffix(kBlockEnd.size());
    return {begin.file, begin.begin, begin.begin + static_cast<std::uint32_t>(text.size())};
  }

  // Can the word before the comma be no name? A module may declare others.
  [[nodiscard]] bool is_new(std::string_view said) {
    constexpr std::size_t most = 20;  // searches of the whole text
    if (++searches_ > most) return true;
    const std::string_view word = said.substr(0, said.find(','));
    if (knows(robot_, word)) return false;
    bool is_said = false;
    return std::ranges::none_of(tokens_, [&](const Token& token) {
      const bool is_name = token.kind == Kinds::NAME;
      const bool is_other =
          token.kind == Kinds::USE || (is_name && !is_said && source_.text(token.span) == word);
      is_said = is_name && ascii::same(source_.text(token.span), "SAY");
      return is_other;
    });
  }

  const Tokens& tokens_;
  const SourceFile& source_;
  const Vocabulary* robot_;
  std::size_t searches_ = 0;
};

}  // namespace

std::vector<Span> mend_spoken_words(Tokens& tokens, const SourceFile& source,
                                    const Vocabulary* robot, Diagnostics& diagnostics) {
  std::vector<Span> places;
  Rewritten rewritten(tokens);
  SpokenWords words(tokens, source, robot);
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const Span said =
        places.empty() || places.back().end <= tokens[at].span.begin ? words.said_at(at) : Span{};
    if (said.end == 0) {
      rewritten.keep(at);
      continue;
    }
    const std::string quoted = fmt::format("\"{}\"", source.text(said));
    diagnostics.report(Code::E0003, "what is said goes in quotes")
        .label(said)
        .helps(fmt::format("write `{}`", quoted))
        .fix(said, quoted, Applicability::likely);
    places.push_back(said);
    Tokens& others = rewritten.other(at);
    others.push_back(tokens[at]);
    while (tokens[++at].span.begin < said.begin)
      others.push_back(tokens[at]);
    others.push_back({Kinds::STRING, said});
    while (at < tokens.size() && tokens[at].span.begin < said.end)
      ++at;
    --at;
  }
  rewritten.finish();
  return places;
}

}  // namespace robosync::compiler
