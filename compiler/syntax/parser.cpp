// See parser.hpp. A text passes through the lexer, the split into items (layout.hpp) and the grammar;
// where the grammar stops, repair.hpp takes over.
#include "compiler/syntax/parser.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "compiler/diagnostics/plain_text.hpp"
#include "compiler/syntax/articles.hpp"
#include "compiler/syntax/builder.hpp"
#include "compiler/syntax/examples.hpp"
#include "compiler/syntax/expect_within.hpp"
#include "compiler/syntax/foreign_text.hpp"
#include "compiler/syntax/foreign_words.hpp"
#include "compiler/syntax/heads.hpp"
#include "compiler/syntax/indented_blocks.hpp"
#include "compiler/syntax/layout.hpp"
#include "compiler/syntax/lexer.hpp"
#include "compiler/syntax/line_starts.hpp"
#include "compiler/syntax/number_words.hpp"
#include "compiler/syntax/reader.hpp"
#include "compiler/syntax/repair.hpp"
#include "compiler/syntax/torn_names.hpp"

namespace robosync::compiler {

namespace {

// More source than fits on any robot, and as many messages as a person will read.
constexpr std::size_t largest_source = 16U << 20U;
constexpr std::size_t most_mistakes = 30;

// A block with a correct head and nothing in it: the search for a repair would find none.
struct EmptyBlock {
  Span head_end;  // the last word of its head
  std::string_view missing, help;
};

std::optional<EmptyBlock> empty_block(const Tokens& tokens) {
  constexpr std::size_t longest = 40;  // words of an empty block
  std::vector<TokenKind> kinds;
  Span head_end;
  for (const Token& token : tokens) {
    if (token.kind == Kinds::NEWLINE) continue;
    kinds.push_back(token.kind);
    if (token.kind != Kinds::END) head_end = token.span;
    if (kinds.size() > longest) return std::nullopt;
  }
  using Head = std::vector<TokenKind>;
  if (kinds == Head{Kinds::TEST, Kinds::STRING, Kinds::END})
    return EmptyBlock{head_end, "a step", "a step begins with `AT`, `EXPECT` or `WAIT`"};
  if (kinds == Head{Kinds::BEHAVIOR, Kinds::NAME, Kinds::PRIORITY, Kinds::QUANTITY, Kinds::END})
    return EmptyBlock{head_end, "a rule",
                      "a rule begins with `WHEN`, `WHILE`, `EVERY` or `AT START`"};
  const bool motion = kinds.size() >= 5 && kinds[0] == Kinds::MOTION && kinds[2] == Kinds::OF &&
                      std::find(kinds.begin(), kinds.end(), Kinds::AT) == kinds.end();
  const auto is_list = [](TokenKind kind) { return kind == Kinds::NAME || kind == Kinds::COMMA; };
  if (motion && kinds.back() == Kinds::END &&
      std::all_of(kinds.begin() + 3, kinds.end() - 1, is_list))
    return EmptyBlock{head_end, "a row",
                      "a row is a time and a value for each actuator: `AT 0s 10deg`"};
  return std::nullopt;
}

// Detects repairs that lead nowhere. A second message about the same place is a consequence: the first repair there was
// not what the user meant. When several repairs in a row do not get the grammar farther, the rest of the line is left out.
class Standstill {
public:
  // The grammar has stopped at this place in the text.
  void stop_at(std::uint32_t place) {
    const bool farther = !stopped_ || place > farthest_;
    mends_ = farther ? 0 : mends_ + 1;
    if (farther) farthest_ = place;
    stopped_ = true;
  }
  [[nodiscard]] bool too_long() const { return mends_ > most_mends; }
  // Leaving out lines does not help either.
  [[nodiscard]] bool hopeless() const { return mends_ > 4 * most_mends; }
  // Should this be reported?
  bool is_new(const Diagnostic& diagnostic) {
    if (diagnostic.labels.empty()) return true;
    const Span place = diagnostic.labels.front().span;
    const bool known = std::ranges::find(said_, place.begin) != said_.end();
    said_.push_back(place.begin);
    return mends_ == 0 || !known;
  }

private:
  static constexpr unsigned most_mends =
      6;  // a line may lack WHEN, a condition, DO, a command, END
  bool stopped_ = false;
  std::uint32_t farthest_ = 0;
  unsigned mends_ = 0;  // without getting farther
  std::vector<std::uint32_t> said_;
};

// Leaves out the line from `at` on; false when nothing there is in the text.
bool leave_out_line(Tokens& tokens, std::size_t at) {
  std::size_t end = at;
  bool written = false;
  for (; end < tokens.size() && tokens[end].kind != Kinds::NEWLINE; ++end)
    written = written || tokens[end].span.end > tokens[end].span.begin;
  const auto begin = tokens.begin();
  if (written)
    tokens.erase(begin + static_cast<std::ptrdiff_t>(at), begin + static_cast<std::ptrdiff_t>(end));
  return written;
}

class Parser {
public:
  Parser(const SourceMap& sources, FileId file, Diagnostics& diagnostics, const Vocabulary* robot)
      : robot_(robot),
        sources_(sources),
        source_(sources.file(file)),
        file_(file),
        diagnostics_(diagnostics),
        reader_(source_) {}

  ast::Tree parse() {
    if (source_.text().size() > largest_source) {
      diagnostics_
          .report(Code::E0013, "this file has " + std::to_string(source_.text().size()) +
                                   " bytes, and rsc reads at most " +
                                   std::to_string(largest_source))
          .label({file_, 0, 0});
      return {};
    }
    if (!is_plain_text(sources_, file_, Code::E0002, diagnostics_)) return {};
    tokens_ = lex_but_foreign_text(source_, file_, robot_, diagnostics_);
    leave_out_articles(tokens_, source_, robot_, diagnostics_);
    mend_number_words(tokens_, source_, robot_, diagnostics_);
    mend_expectations(tokens_, source_, diagnostics_);
    find_strange_lines();
    mend_foreign_words(tokens_, source_, robot_, diagnostics_);
    mend_indented_blocks(tokens_, source_, diagnostics_);
    mend_line_starts(tokens_, source_, diagnostics_);
    mend_torn_names(tokens_, source_, diagnostics_);
    mend_heads(tokens_, source_, diagnostics_);
    if (robot_ != nullptr) mend_robot_names(tokens_, source_, *robot_);
    mend_names(tokens_, source_, diagnostics_);
    mend_lost_heads(tokens_, diagnostics_);
    const std::vector<Region> regions = split_into_regions(tokens_, source_);
    program_.items.reserve(regions.size());
    for (const Region& region : regions) {
      const auto begin = tokens_.begin() + static_cast<std::ptrdiff_t>(region.begin);
      const auto end = tokens_.begin() + static_cast<std::ptrdiff_t>(region.end);
      piece_.assign(begin, end);
      const bool goes_on = parse_piece(piece_);
      if (diagnostics_.has_errors())
        diagnostics_.doubt({file_, begin->span.begin, std::prev(end)->span.end});
      if (!goes_on) break;
    }
    program_.labels = reader_.take_labels();
    return std::move(program_);
  }

private:
  // In a line where the lexer left out a character, anything missing is a consequence.
  void find_strange_lines() {
    for (const Diagnostic& diagnostic : diagnostics_.all())
      if (diagnostic.code == Code::E0002 && diagnostic.labels.front().span.file == file_) {
        strange_places_.insert(diagnostic.labels.front().span.begin);
        if (diagnostic.fixes.empty() && diagnostic.message.starts_with(kStrangeCharacter))
          strange_lines_.push_back(line_of(diagnostic));
      }
  }
  std::size_t line_of(const Diagnostic& diagnostic) const {
    return source_.position(diagnostic.labels.front().span.begin).line;
  }
  bool is_consequence(const Diagnostic& diagnostic) const {
    return !strange_places_.empty() && !diagnostic.labels.empty() &&
           (strange_places_.contains(diagnostic.labels.front().span.begin) ||
            std::ranges::binary_search(strange_lines_, line_of(diagnostic)));
  }

  // False when nothing more should be read.
  bool parse_piece(Tokens& tokens) {
    if (const auto deep = nested_too_deeply(tokens)) {
      diagnostics_
          .report(Code::E0012,
                  deep->in_blocks ? "more than " + std::to_string(kDeepestBlock) +
                                        " blocks are nested here, the most that rsc reads"
                                  : "more than " + std::to_string(kDeepestBracket) +
                                        " brackets or signs are open here, the most that rsc reads")
          .label(tokens[deep->at].span)
          .helps(deep->in_blocks ? "put the inner part into a DEFINE of its own"
                                 : std::string(kSimplify));
      return false;
    }
    if (const auto empty = empty_block(tokens)) {
      const Span end = empty->head_end;
      diagnostics_
          .report(Code::E0008, std::string(empty->missing) + " is missing after `" +
                                   std::string(source_.text(end)) + "`")
          .label({end.file, end.end, end.end}, "here")
          .helps(std::string(empty->help));
      return true;
    }
    Standstill standstill;
    for (;;) {
      // Reports from the actions count only if the piece was read to its end.
      Diagnostics said;
      Attempt attempt = reader_.read(tokens, &said);
      if (attempt.complete) {
        for (const Diagnostic& diagnostic : said.all())
          diagnostics_.add(diagnostic);
        std::ranges::move(attempt.items, std::back_inserter(program_.items));
        std::ranges::move(attempt.keyword_names, std::back_inserter(program_.keyword_names));
        return true;
      }
      if (mistakes_ == most_mistakes || budget_.work == 0) return give_up(tokens);
      if (!mend_one(tokens, attempt, standstill)) return true;
    }
  }

  // False when nothing more of the piece should be read.
  bool mend_one(Tokens& tokens, const Attempt& attempt, Standstill& standstill) {
    const std::size_t at = attempt.stopped_at;
    standstill.stop_at(at < tokens.size() ? tokens[at].span.begin : tokens.back().span.end);
    if (standstill.too_long()) return !standstill.hopeless() && leave_out_line(tokens, at);
    if (!examples_) examples_.emplace(tokens_, source_, robot_);
    Diagnostics said;
    mend(tokens, attempt, reader_, *examples_, said, budget_);
    std::size_t kept = 0;
    for (const Diagnostic& diagnostic : said.all()) {
      if (!standstill.is_new(diagnostic) || is_consequence(diagnostic)) continue;
      diagnostics_.add(diagnostic);
      ++kept;
    }
    if (kept > 0) ++mistakes_;
    return true;
  }

  bool give_up(const Tokens& tokens) {
    diagnostics_
        .report(Code::E0013,
                mistakes_ == most_mistakes
                    ? "more than " + std::to_string(most_mistakes) +
                          " mistakes, the most that rsc looks for in a file: the rest was not read"
                    : "mistakes that take too long to sort out: the rest of the file was not read")
        .label(tokens.front().span);
    return false;
  }

  const Vocabulary* robot_;
  const SourceMap& sources_;
  const SourceFile& source_;
  FileId file_;
  Diagnostics& diagnostics_;
  Reader reader_;
  Tokens tokens_;
  std::optional<Examples> examples_;  // only a program with a mistake needs them
  Tokens piece_;                      // the piece being read; reused, to keep its memory
  ast::Tree program_;
  Budget budget_;
  std::vector<std::size_t> strange_lines_;
  std::set<std::uint32_t> strange_places_;  // of signs that RSL does not use
  std::size_t mistakes_ = 0;
};

}  // namespace

ast::Tree parse(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                const Vocabulary* robot) {
  return Parser(sources, file, diagnostics, robot).parse();
}

}  // namespace robosync::compiler
