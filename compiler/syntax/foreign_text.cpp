// See foreign_text.hpp. A line is recognised by its first word and its last sign; a block continues to its closing brace, or as
// far as it is indented. Only what contains a sure sign of another language, such as a call, is left out: in a block that holds
// lines of RSL, each wrong line has its own message.
#include "compiler/syntax/foreign_text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/examples.hpp"
#include "compiler/syntax/foreign_ranges.hpp"
#include "compiler/syntax/functions.hpp"
#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/lexer.hpp"
#include "compiler/syntax/lexer_state.hpp"
#include "compiler/syntax/one_line_blocks.hpp"
#include "compiler/syntax/pasted.hpp"
#include "compiler/syntax/spoken_words.hpp"
#include "compiler/syntax/word_list.hpp"

namespace robosync::compiler {
namespace {

enum class Gap : std::uint8_t { name, condition, command };
struct Hint {
  std::string_view words, text;
  Gap gap;
};
constexpr std::array kHints = {
#define HINT(words, gap, text) Hint{words, text, Gap::gap},
#include "compiler/syntax/foreign_hints.def"
#undef HINT
};
constexpr std::size_t kOtherCall = kHints.size() - 1;

constexpr std::string_view kForeignHeads = "switch class async try";
constexpr std::string_view kHatEnds = "clicked pressed";
// What follows the number of a line in BASIC, and no number in RSL.
constexpr std::string_view kNumbered = "print let goto gosub input rem next dim if return";

// A line of the text, from its first to its last sign that is no blank.
struct TextLine {
  std::string_view text, word;  // its first word, behind the number of a line of BASIC
  std::size_t number = 0;       // how long that is, with the blanks behind it
  std::uint32_t begin = 0;
  std::size_t indentation = 0;
  const Keyword* keyword = nullptr;  // its first word

  [[nodiscard]] bool empty() const { return text.empty() || text.front() == '#'; }
  [[nodiscard]] bool ends_with(char c) const { return !text.empty() && text.back() == c; }
  [[nodiscard]] bool begins_with(std::initializer_list<TokenKind> kinds) const {
    return keyword != nullptr && is_one_of(keyword->kind, kinds);
  }
  [[nodiscard]] std::string_view behind_word() const { return text.substr(number + word.size()); }
  [[nodiscard]] std::string_view last_word() const {
    return text.substr(text.find_last_of(" \t") + 1);
  }
  // How many more braces it opens than it closes.
  [[nodiscard]] std::ptrdiff_t braces() const {
    return std::ranges::count(text, '{') - std::ranges::count(text, '}');
  }
  // The name that the line calls, such as `write` of `servo.write(90)`; empty if it calls none.
  [[nodiscard]] std::string_view called() const {
    std::string_view name = word, rest = behind_word();
    while (rest.starts_with('.') && word_length(rest.substr(1)) > 0) {
      name = rest.substr(1, word_length(rest.substr(1)));
      rest.remove_prefix(1 + name.size());
    }
    return rest.starts_with('(') ? name : std::string_view();
  }
};

// Of `10 ` in `10 PRINT "hi"`; 0 if there is none.
std::size_t number_length(std::string_view text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::size_t word = std::min(text.find_first_not_of(" \t", digits), text.size());
  return digits > 0 && word > digits && ascii::is_letter(text.substr(word).front()) ? word : 0;
}

TextLine line_of(const SourceFile& source, std::uint32_t number) {
  TextLine line;
  const std::string_view whole = source.line(number);
  line.text = ascii::trimmed(whole);
  line.indentation = static_cast<std::size_t>(line.text.data() - whole.data());
  line.begin = source.line_start(number) + static_cast<std::uint32_t>(line.indentation);
  line.number = number_length(line.text);
  const std::string_view words = line.text.substr(line.number);
  line.word = words.substr(0, word_length(words));
  line.keyword = find_keyword(line.word);
  return line;
}

struct LineRange {
  std::size_t begin = 0, end = 0;
};

class ForeignText {
public:
  ForeignText(const Tokens& tokens, const SourceFile& source, const Vocabulary* robot)
      : tokens_(tokens), source_(source), robot_(robot) {
    lines_.reserve(source.lines());
    for (std::uint32_t number = 1; number <= source.lines(); ++number)
      lines_.push_back(line_of(source, number));
  }

  [[nodiscard]] std::vector<Span> find() const {
    std::vector<Span> found;
    for (std::size_t at = 0; at < lines_.size();) {
      const LineRange lines = together(at);
      if (is_foreign(lines)) found.push_back(span(lines));
      at = std::max(lines.end, at + 1);
    }
    return found;
  }

  void report(const std::vector<Span>& found, Diagnostics& diagnostics) const {
    constexpr std::size_t most = 3;  // places shown
    const Examples examples(tokens_, source_, robot_);
    Diagnostic& message =
        diagnostics.report(Code::E0001, "this is written in another language, not in RSL");
    const std::size_t shown = std::min(found.size(), most);
    for (std::size_t at = 0; at < shown; ++at)
      message.label(first_line(found[at]), at == 0 ? "" : "and here", at == 0);
    message.appears_in_more(found.size() - shown);
    const std::vector<Said> all = hints(found);
    if (all.empty())
      message.helps(fmt::format(
          "a rule of RSL is `WHEN {} DO {} END`; robot.json says what parts the robot has",
          examples.condition({}), examples.command({}, true)));
    for (const Said& said : all) {
      const Hint& hint = kHints[said.hint];
      const std::string name = hint.gap == Gap::condition ? examples.condition({})
                               : hint.gap == Gap::command ? examples.command(said.about, true)
                                                          : std::string(said.about);
      message.helps(fmt::format(fmt::runtime(hint.text), name));
    }
  }

private:
  // ---- lines

  // Can no line of RSL look like this?
  [[nodiscard]] bool is_sure(const TextLine& line) const {
    if (line.number > 0) return has_word(kNumbered, line.word);
    if (is_markup(line) || is_item(line) || has_keys(line)) return true;
    if (line.keyword != nullptr && line.called() == line.word) return false;
    if (line.begins_with({Kinds::FROM})) return line.text.find(" import ") != std::string::npos;
    if (line.begins_with({Kinds::FOR})) return ascii::trimmed(line.behind_word()).starts_with('(');
    if (is_hat(line)) return true;
    if (has_word(kForeignHeads, line.word)) return line.ends_with('{') || line.ends_with(':');
    const std::string_view name = line.called();
    if (name.empty()) return false;
    return name != line.word ||
           !(is_defined(name) || is_verb(name) || find_function(name) != nullptr);
  }

  // `<robot name="bot">`
  [[nodiscard]] static bool is_markup(const TextLine& line) {
    return line.text.size() > 2 && line.text.front() == '<' && line.ends_with('>') &&
           (ascii::is_letter(line.text[1]) || line.text[1] == '/' || line.text[1] == '!' ||
            line.text[1] == '?');
  }
  // `name: touch` in YAML, and in RSL behind STATE or LIST only
  [[nodiscard]] static bool is_key(const TextLine& line) {
    return line.keyword == nullptr && !line.word.empty() &&
           ascii::trimmed(line.behind_word()).starts_with(':');
  }
  // `- name: touch`
  [[nodiscard]] static bool is_item(const TextLine& line) {
    if (!line.text.starts_with("- ")) return false;
    const std::string_view item = ascii::trimmed(line.text.substr(2));
    const std::string_view rest = item.substr(word_length(item));
    return rest.size() < item.size() && (rest == ":" || rest.starts_with(": "));
  }
  // `sensors:` above a line that is indented, and has a key
  [[nodiscard]] bool has_keys(const TextLine& line) const {
    const TextLine* const below = &line + 1;
    return is_key(line) && line.ends_with(':') && below < lines_.data() + lines_.size() &&
           below->indentation > line.indentation && (is_key(*below) || is_item(*below));
  }

  // `when green flag clicked`, `on button A pressed`
  [[nodiscard]] bool is_hat(const TextLine& line) const {
    const TextLine* const below = &line + 1;
    const bool rule = below < lines_.data() + lines_.size() && below->begins_with({Kinds::DO});
    return (line.begins_with({Kinds::WHEN}) || ascii::same(line.word, "ON")) && !rule &&
           has_word(kHatEnds, line.last_word()) &&
           line.text.find_first_of("<>=(") == std::string_view::npos &&
           !has_word(line.text, "IS") && !has_word(line.text, "BECOMES");
  }

  [[nodiscard]] bool is_verb(std::string_view word) const {
    return robot_ != nullptr && !robot_->command(word, "", false).empty();
  }

  // Modules may define what is not defined here.
  [[nodiscard]] bool is_defined(std::string_view name) const {
    constexpr std::size_t most = 4096;  // tokens: the text may come from outside
    for (std::size_t at = 1; at < std::min(tokens_.size(), most); ++at)
      if ((tokens_[at - 1].kind == Kinds::USE && hint_of(name) == kOtherCall) ||
          (tokens_[at - 1].kind == Kinds::DEFINE &&
           ascii::same(source_.text(tokens_[at].span), name)))
        return true;
    return false;
  }

  // May it belong to the lines of another language that are next to it?
  [[nodiscard]] bool is_doubtful(const TextLine& line) const {
    if (line.number > 0) return true;
    if (line.empty() || is_verb(line.word)) return false;
    if (line.keyword != nullptr &&
        !line.begins_with({Kinds::IF, Kinds::WHILE, Kinds::FOR, Kinds::ELSE, Kinds::LET}))
      return false;
    const std::string_view rest = ascii::trimmed(line.behind_word());
    return std::string_view(";{:").find(line.text.back()) != std::string_view::npos ||
           is_key(line) || is_definition(line) || rest.starts_with('=') ||
           has_word("import return", line.word);
  }

  [[nodiscard]] static bool is_definition(const TextLine& line) {
    return std::ranges::any_of(kForeignDefines,
                               [&](std::string_view one) { return ascii::same(one, line.word); });
  }

  // ---- blocks

  // The index after the last line of what begins at `at`.
  [[nodiscard]] std::size_t block_end(std::size_t at) const {
    const TextLine& head = lines_[at];
    std::size_t end = at + 1;
    std::ptrdiff_t depth = head.braces();
    const bool brace_below = is_definition(head) && end < lines_.size() && lines_[end].text == "{";
    if (brace_below) depth += lines_[end++].braces();
    if (depth > 0) {
      while (end < lines_.size() && depth > 0)
        depth += lines_[end++].braces();
      return end;
    }
    if (is_hat(head)) return hat_end(at);
    if (head.ends_with(':') || is_definition(head)) return indented_end(at);
    return end;
  }

  // The blocks below a hat of Scratch: they may be indented or not.
  [[nodiscard]] std::size_t hat_end(std::size_t at) const {
    std::size_t end = at + 1;
    while (end < lines_.size() && !lines_[end].empty() && !begins_item(lines_[end]))
      ++end;
    return end;
  }
  [[nodiscard]] static bool begins_item(const TextLine& line) {
    return line.keyword != nullptr && (line.keyword->roles & (role::item | role::part)) != 0;
  }

  [[nodiscard]] std::size_t indented_end(std::size_t at) const {
    std::size_t end = at + 1;
    for (std::size_t next = end; next < lines_.size(); ++next) {
      const bool inside = lines_[next].indentation > lines_[at].indentation;
      if (!lines_[next].empty() && !inside) break;
      if (inside) end = next + 1;
    }
    const bool closed = end > at + 1 && end < lines_.size() &&
                        lines_[end].begins_with({Kinds::END}) &&
                        lines_[end].indentation == lines_[at].indentation;
    return closed ? end + 1 : end;
  }

  // The doubtful lines that follow one another from `at` on, with their blocks.
  [[nodiscard]] LineRange together(std::size_t at) const {
    std::size_t end = at;
    for (std::size_t next = at; next < lines_.size();) {
      if (next > at && lines_[next].empty()) {
        ++next;
        continue;
      }
      if (!is_doubtful(lines_[next]) && !is_sure(lines_[next])) break;
      next = end = block_end(next);
    }
    return {at, end};
  }

  // A text in brackets alone has its own message.
  [[nodiscard]] bool is_foreign(const LineRange& lines) const {
    const bool sure = std::ranges::any_of(line(lines.begin), line(lines.end),
                                          [this](const TextLine& one) { return is_sure(one); });
    return sure && (lines.end > lines.begin + 1 || !is_text_in_brackets(lines_[lines.begin]));
  }
  [[nodiscard]] static bool is_text_in_brackets(const TextLine& line) {
    return (line.behind_word().starts_with("(\"") || line.behind_word().starts_with("('")) &&
           line.ends_with(')');
  }
  [[nodiscard]] std::vector<TextLine>::const_iterator line(std::size_t at) const {
    return lines_.begin() + static_cast<std::ptrdiff_t>(at);
  }

  // ---- what is said

  [[nodiscard]] Span span(const LineRange& lines) const {
    const TextLine &first = lines_[lines.begin], &last = lines_[lines.end - 1];
    return {tokens_.front().span.file, first.begin,
            last.begin + static_cast<std::uint32_t>(last.text.size())};
  }

  [[nodiscard]] Span first_line(Span found) const {
    const auto first = std::ranges::find(lines_, found.begin, &TextLine::begin);
    found.end = found.begin + static_cast<std::uint32_t>(first->text.size());
    return found;
  }

  [[nodiscard]] static std::size_t hint_of(std::string_view word) {
    const auto* const found =
        std::ranges::find_if(kHints, [word](const Hint& one) { return has_word(one.words, word); });
    return found == kHints.end() ? kOtherCall : static_cast<std::size_t>(found - kHints.begin());
  }

  struct Said {
    std::size_t hint;
    std::string_view about;  // the word that the text is about
  };

  // In the order of the text.
  [[nodiscard]] std::vector<Said> hints(const std::vector<Span>& found) const {
    std::vector<Said> all;
    auto next = found.begin();
    for (const TextLine& line : lines_) {
      while (next != found.end() && next->end <= line.begin)
        ++next;
      if (next == found.end()) break;
      if (next->begin <= line.begin) add_hints(line, all);
    }
    constexpr std::size_t most = 4;
    if (all.size() > most) all.resize(most);
    return all;
  }

  void add_hints(const TextLine& line, std::vector<Said>& all) const {
    const auto add = [&all](std::size_t hint, std::string_view about) {
      if (std::ranges::find(all, hint, &Said::hint) == all.end()) all.push_back({hint, about});
    };
    const std::string_view rest = ascii::trimmed(line.behind_word());
    const std::string_view name = rest.substr(0, word_length(rest)), called = line.called();
    if (is_hat(line))
      add(hint_of(has_word(line.text, "flag") ? "flag" : line.last_word()), name);
    else if (is_definition(line) || ascii::same(line.word, "CLASS"))
      add(hint_of(name) == kOtherCall ? hint_of("class") : hint_of(name), name);
    else if (!called.empty() && line.keyword == nullptr)
      add(hint_of(called), line.word);
    else if (hint_of(line.word) != kOtherCall)
      add(hint_of(line.word), line.word);
  }

  const Tokens& tokens_;
  const SourceFile& source_;
  const Vocabulary* robot_;
  std::vector<TextLine> lines_;
};

// Most texts have none: a quick look tells.
bool may_be_foreign(const Tokens& tokens, const SourceFile& source) {
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
    const std::string_view word = source.text(tokens[at].span);
    const bool named = tokens[at].kind == Kinds::NAME, last = tokens[at + 1].kind == Kinds::NEWLINE;
    if (named && last && has_word(kHatEnds, word)) return true;
    if (!starts_line(tokens, at)) continue;
    const std::string_view rest = source.text().substr(tokens[at].span.end, 1);
    if (is_one_of(tokens[at].kind,
                  {Kinds::FROM, Kinds::FOR, Kinds::QUANTITY, Kinds::LESS, Kinds::MINUS}) ||
        (named && (rest == "(" || rest == "." || rest == ":" || has_word(kForeignHeads, word))))
      return true;
  }
  return false;
}

bool is_in(const Token& token, Span place) {
  const bool ends = token.span.begin == place.end && token.kind != Kinds::NEWLINE;
  return place.begin <= token.span.begin && (token.span.begin < place.end || ends);
}

// Is a statement missing where the walk has come to?
bool wants_statement(const BlockWalk& walk, const Tokens& tokens) {
  return !walk.open().empty() &&
         !is_one_of(tokens[walk.open().back()].kind,
                    {Kinds::BEHAVIOR, Kinds::TEST, Kinds::CHECK, Kinds::MOTION, Kinds::SAFETY});
}

// Removes the tokens in these places.
void leave_out(Tokens& tokens, const std::vector<Span>& places) {
  Tokens kept;
  BlockWalk walk(tokens);
  auto next = places.begin();
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    while (next != places.end() && next->end < tokens[at].span.begin)
      ++next;
    if (next == places.end() || !is_in(tokens[at], *next)) {
      walk.step(at);
      kept.push_back(tokens[at]);
      continue;
    }
    const bool first = at == 0 || !is_in(tokens[at - 1], *next);
    if (!first || !wants_statement(walk, tokens)) continue;
    const Span place{next->file, next->begin, next->begin};
    kept.push_back({Kinds::LOG, place});
    kept.push_back({Kinds::STRING, place});
  }
  tokens = std::move(kept);
}

}  // namespace

Tokens lex_but_foreign_text(const SourceFile& source, FileId file, const Vocabulary* robot,
                            Diagnostics& diagnostics) {
  Diagnostics said;
  Tokens tokens = lex(source, file, said);
  std::vector<Span> places;
  if (may_be_foreign(tokens, source)) {
    const ForeignText text(tokens, source, robot);
    places = text.find();
    if (!places.empty()) text.report(places, diagnostics);
    leave_out(tokens, places);
  }
  for (const auto& more : {leave_out_pasted(tokens, source, diagnostics),
                           mend_foreign_ranges(tokens, source, diagnostics),
                           mend_spoken_words(tokens, source, robot, diagnostics),
                           mend_one_line_blocks(tokens, source, said, diagnostics)})
    places.insert(places.end(), more.begin(), more.end());
  for (const Diagnostic& diagnostic : said.all()) {
    const std::uint32_t at = diagnostic.labels.front().span.begin;
    if (std::ranges::none_of(places, [at](Span one) { return one.begin <= at && at < one.end; }))
      diagnostics.add(diagnostic);
  }
  return tokens;
}

}  // namespace robosync::compiler
