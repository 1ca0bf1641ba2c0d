// rsc fmt's lines: however a program is spread over lines, no two statements share one, items stand apart, and nothing but
// line ends and blanks changes.
#include <algorithm>
#include <map>
#include <random>

#include <catch2/catch.hpp>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/layout.hpp"
#include "compiler/syntax/lexer.hpp"
#include "compiler/syntax/walk.hpp"
#include "tests/compiler/syntax/styled.hpp"
#include "tests/support/share.hpp"
#include "tests/support/without_lines.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

namespace fs = std::filesystem;
using robosync::test::without_lines;

// ---- other line breaks

class Relayer {
public:
  Relayer(const std::string& text, std::mt19937& random) : random_(random) {
    file_ = sources_.add("robot.rsl", text);
    Diagnostics ignored;
    Tokens all = lex(sources_.file(file_), file_, ignored);
    std::vector<std::uint32_t> order;
    significant(all, order);
    for (const std::uint32_t place : order)
      seen_.push_back(all[place]);
    for (const Span& name : parse(sources_, file_, ignored).keyword_names)
      std::ranges::find(seen_, name.begin, [](const Token& token) {
        return token.span.begin;
      })->kind = Kinds::NAME;
  }

  std::string relaid() {
    const std::string_view text = sources_.file(file_).text();
    std::string made;
    std::size_t before = seen_.size();  // the last word
    for (std::size_t at = 0; at < seen_.size(); ++at) {
      if (seen_[at].kind == Kinds::NEWLINE) continue;
      const std::size_t end = before < at ? seen_[before].span.end : 0;
      const std::string_view gap = text.substr(end, seen_[at].span.begin - end);
      made += before < at ? between(before, at, gap) : std::string(gap);
      made += sources_.text(seen_[at].span);
      before = at;
    }
    return made + std::string(before < seen_.size() ? text.substr(seen_[before].span.end) : text);
  }

private:
  bool is(std::size_t at, TokenKind kind) const { return seen_[at].kind == kind; }

  // The line ends behind OPTION, OPTION 40% and SAFETY name may be there or not.
  bool is_optional(std::size_t left, std::size_t right) const {
    if (is(left, Kinds::OPTION)) return !is(right, Kinds::QUANTITY);
    return left > 0 && ((is(left, Kinds::QUANTITY) && is(left - 1, Kinds::OPTION)) ||
                        is(left - 1, Kinds::SAFETY));
  }

  // Beside words only: the place of a sign may tell what it is. A line does not begin with what also begins an item, or may be
  // meant to.
  bool may_break(std::size_t left, std::size_t right) const {
    const TokenKind before = seen_[left].kind, behind = seen_[right].kind;
    const Keyword* word = find_keyword(sources_.text(seen_[right].span));
    if (word != nullptr && (word->roles & role::item) != 0) return false;
    return (is_keyword(before) && (roles_of(before) & role::before) != 0) ||
           (is_keyword(behind) && (roles_of(behind) & role::after) != 0) ||
           (before == Kinds::COMMA && is_one_of(behind, {Kinds::STRING, Kinds::QUANTITY})) ||
           is_optional(left, right);
  }

  std::string between(std::size_t left, std::size_t right, std::string_view gap) {
    if (gap.find_first_of("#%") != std::string_view::npos) return std::string(gap);
    const bool counts = right - left > 1 && !is_optional(left, right);
    const bool broken = gap.find_first_of("\r\n") != std::string_view::npos;
    // ELSE IF on one line would be another word.
    const bool must = counts || (broken && is(left, Kinds::ELSE) && is(right, Kinds::IF));
    if (must || (may_break(left, right) && random_() % 2 == 0))
      return std::string(1 + random_() % 6 / 4, '\n');
    return broken ? " " : std::string(gap);
  }

  std::mt19937& random_;
  SourceMap sources_;
  FileId file_ = 0;
  Tokens seen_;
};

// ---- what the style promises

// Words, in small letters, and comments, in their order.
std::vector<std::string> contents(const std::string& text) {
  SourceMap sources;
  Diagnostics ignored;
  const FileId file = sources.add("robot.rsl", text);
  std::vector<std::string> found;
  std::size_t at = 0;
  for (const Token& token : lex(sources.file(file), file, ignored)) {
    const std::string gap = text.substr(at, token.span.begin - at);
    const std::size_t comment = gap.find_first_of("#%");
    if (comment != std::string::npos)
      found.push_back(gap.substr(comment, gap.find_last_not_of(" \t\r\n") + 1 - comment));
    at = token.span.end;
    if (token.kind == Kinds::NEWLINE) continue;
    found.emplace_back(token.kind == Kinds::ELSE_IF ? "else if" : sources.text(token.span));
    std::ranges::transform(found.back(), found.back().begin(), ascii::lower);
  }
  return found;
}

// The lines of a program, and how many statements stand on each.
class Lines {
public:
  explicit Lines(const std::string& text) {
    file_ = sources_.add("robot.rsl", text);
    Diagnostics diagnostics;
    tree_ = parse(sources_, file_, diagnostics);
    REQUIRE(diagnostics.errors() == 0);
  }

  void check() {
    for (const ast::Item& item : tree_.items)
      std::visit([this](const auto& node) { note(node); }, item.node);
    for (const auto& [line, statements] : statements_) {
      INFO("line " << line);
      REQUIRE(statements == 1);
    }
    REQUIRE(sources_.file(file_).text().find("\n\n\n") == std::string_view::npos);
    for (std::size_t i = 1; i < tree_.items.size(); ++i)
      check_gap(tree_.items[i - 1].span, tree_.items[i].span);
  }

private:
  std::uint32_t first(const Span& span) const { return sources_.file(file_).line_of(span.begin); }
  std::uint32_t last(const Span& span) const { return sources_.file(file_).line_of(span.end); }
  bool is_long(const Span& span) const { return first(span) != last(span); }

  void check_gap(const Span& left, const Span& right) const {
    unsigned blank = 0;
    for (std::uint32_t line = last(left) + 1; line < first(right); ++line)
      blank += sources_.file(file_).line(line).empty() ? 1U : 0U;
    INFO("line " << first(right));
    if (is_long(left) || is_long(right)) REQUIRE(blank > 0);
  }

  static bool has_blocks(const ast::Stmt& statement) {
    bool found = false;
    std::visit(
        [&](const auto& node) {
          ast::for_each_block_of(node, [&](const ast::Block& /*block*/) { found = true; });
        },
        statement.node);
    return found;
  }

  // Behind DO, ELSE or OPTION there is one statement without blocks, or none.
  void check_begins(const ast::Block& block) const {
    const std::string_view text = sources_.file(file_).text();
    for (std::size_t i = 0; i < block.size(); ++i) {
      const std::uint32_t begin = block[i].span.begin, end = block[i].span.end;
      const bool alone = i + 1 == block.size() ||
                         text.substr(end, block[i + 1].span.begin - end).find("DO") != text.npos;
      if (alone && !has_blocks(block[i])) continue;
      const std::size_t before = text.substr(0, begin).find_last_not_of(' ');
      INFO("line " << first(block[i].span));
      REQUIRE((before == text.npos || text[before] == '\n'));
    }
  }

  // An IF on one line does not count; its one statement does.
  void count(const ast::Stmt& statement) {
    const Span& span = statement.span;
    if (has_blocks(statement) && !is_long(span)) return;
    const std::uint32_t end = has_blocks(statement) ? first(span) : last(span);
    for (std::uint32_t line = first(span); line <= end; ++line)
      ++statements_[line];
  }

  void note(const ast::Block& block) {
    check_begins(block);
    ast::for_each_statement(block, [this](const ast::Stmt& statement) {
      std::visit(
          [this](const auto& node) {
            ast::for_each_block_of(node, [this](const ast::Block& one) { check_begins(one); });
          },
          statement.node);
      count(statement);
    });
  }
  void note(const ast::Define& define) { note(define.body); }
  void note(const ast::Safety& safety) { note(safety.body); }
  void note(const ast::Rule& rule) {
    ast::for_each_block(rule, [this](const ast::Block& block) { note(block); });
  }
  void note(const ast::Behavior& behavior) {
    for (const ast::Rule& rule : behavior.rules)
      note(rule);
  }
  template <class Node>
  void note(const Node& /*without statements*/) {}

  SourceMap sources_;
  FileId file_ = 0;
  ast::Tree tree_;
  std::map<std::uint32_t, unsigned> statements_;
};

std::string checked(const std::string& text) {
  const std::string once = styled(text);
  INFO(text << "----\n" << once);
  REQUIRE_FALSE(once.empty());
  REQUIRE(once != "changed");
  REQUIRE(contents(once) == contents(text));
  REQUIRE(styled(once) == once);
  Lines(once).check();
  return once;
}

const fs::path kStyle = source_folder() / "tests/compiler/syntax/style";

}  // namespace

TEST_CASE("no two statements share a line, however a program is laid out") {
  std::mt19937 random(3);
  std::vector<fs::path> paths = programs();
  paths.push_back(kStyle / "before.rsl");
  for (const fs::path& path : paths) {
    INFO(path);
    const std::string text = read_file(path);
    checked(text);
    for (int i = 0; i < robosync::test::share_of(10); ++i)
      checked(Relayer(text, random).relaid());
  }
}

TEST_CASE("no two statements share a line of a program that lacks a word, either") {
  std::mt19937 random(4);
  each_without_a_word([&](const std::string& other) {
    if (random() % 3 == 0 && !styled(other).empty()) checked(Relayer(other, random).relaid());
  });
}

TEST_CASE("a program means the same, however it is laid out") {
  std::mt19937 random(5);
  for (const char* const example : {"quizmaster", "museum_guide", "safe_arms", "simon_says"}) {
    const fs::path folder = source_folder() / "examples" / example;
    const std::string robot = read_file(folder / "robot.json");
    const std::string text = read_file(folder / "robot.rsl");
    const std::string other = Relayer(text, random).relaid();
    INFO(other);
    const Result before = compile_text(text, robot), after = compile_text(styled(other), robot);
    REQUIRE_FALSE(before.image.empty());
    const bool same = without_lines(after.image) == without_lines(before.image);
    CHECK(same);
  }
}
