// See format.hpp. BlockWalk tells which blocks are open; the innermost block and the first word of a line determine its
// indentation.
#include "compiler/syntax/format.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/source/ascii.hpp"
#include "compiler/source/utf8.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/breaks.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/layout.hpp"
#include "compiler/syntax/lexer.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kIndent = 2;         // columns per level
constexpr std::size_t kBeforeComment = 2;  // columns, at least
constexpr std::size_t kWidest = 100;       // columns, of a block that stands on one line

// Takes a space on either side. Minus is not here: it may be a sign.
bool is_spaced(TokenKind kind) {
  return is_relation(kind) || is_one_of(kind, {Kinds::PLUS, Kinds::STAR, Kinds::SLASH});
}

// A word that is an operator.
bool is_word_between(TokenKind kind) {
  return is_one_of(kind, {Kinds::AND, Kinds::OR, Kinds::MOD});
}

// Is there a space between two words of a line? `written`: the writer had put one there.
bool is_space_between(TokenKind left, TokenKind right, bool written) {
  if (is_one_of(right, {Kinds::COMMA, Kinds::CLOSE, Kinds::COLON}) || left == Kinds::OPEN)
    return false;
  return written || is_one_of(left, {Kinds::COMMA, Kinds::COLON}) || is_spaced(left) ||
         is_spaced(right) || left == Kinds::CLOSE || is_word_between(left);
}

// Counts code points, which take one column each in what programs are written in.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

// The tokens that the grammar sees: without the line ends that do not count.
Tokens without_idle_ends(Tokens& all) {
  std::vector<std::uint32_t> order;
  significant(all, order);
  Tokens seen;
  for (const std::uint32_t place : order)
    seen.push_back(all[place]);
  return seen;
}

// Keywords that are names become names.
void set_names(Tokens& tokens, const ast::Tree& tree) {
  for (const Span& name : tree.keyword_names)
    std::ranges::lower_bound(tokens, name.begin, {}, [](const Token& token) {
      return token.span.begin;
    })->kind = Kinds::NAME;
}

// ---- indentation

struct Block {
  TokenKind opener = TokenKind{};
  std::size_t level = 0;  // of the line that opens it
  bool body = false;      // its DO has been read
};

bool has_do(TokenKind opener) {
  return is_one_of(opener,
                   {Kinds::WHEN, Kinds::WHILE, Kinds::EVERY, Kinds::AT, Kinds::IF, Kinds::SAFETY});
}

// Words of a rule that are aligned with its first word. In its body, those of its head are something else.
bool is_part_of_rule(TokenKind first, bool in_body) {
  if (is_one_of(first, {Kinds::DO, Kinds::ELSE, Kinds::ELSE_IF, Kinds::RESUME})) return true;
  return !in_body && is_one_of(first, {Kinds::WHEN, Kinds::PRIORITY, Kinds::COOLDOWN, Kinds::MARGIN,
                                       Kinds::WAITING, Kinds::RESTARTING});
}

// The level of the block's statements, and of comments between them.
std::size_t inner_level(const Block& block) {
  // The rule of a SAFETY and the statements of an OPTION are one level deeper.
  const bool twice = is_one_of(block.opener, {Kinds::SAFETY, Kinds::PICK});
  return block.level + (twice ? 2U : 1U);
}

std::size_t level_in(const Block& block, TokenKind first) {
  if (first == Kinds::END) return block.level;
  if (block.opener == Kinds::PICK && first == Kinds::OPTION) return block.level + 1;
  if (!has_do(block.opener)) return inner_level(block);
  if (is_part_of_rule(first, block.body)) return inner_level(block) - 1;
  return inner_level(block) + (block.body ? 0U : 1U);  // a condition continues
}

std::size_t level_of_comment(const std::vector<Block>& blocks) {
  if (blocks.empty()) return 0;
  const Block& block = blocks.back();
  const bool outside = has_do(block.opener) ? !block.body : block.opener == Kinds::PICK;
  return inner_level(block) - (outside ? 1U : 0U);
}

// ---- lines

enum class Table : std::uint8_t { none, motion, bands };

struct Line {
  std::size_t level = 0;
  std::vector<std::string> cells{};  // one, except in rows of a table
  std::string_view comment{};
  // The lexer warns that this may not be meant as a comment, because it is so near to the code: it stays there.
  bool is_doubtful = false;
  Table table = Table::none;
  bool begins_item = false;  // outside all blocks, or right inside a BEHAVIOR
  bool is_long = false;      // … and the item has more lines
  bool is_apart = false;     // a blank line is above it

  [[nodiscard]] bool is_blank() const { return cells.empty() && comment.empty(); }
  [[nodiscard]] bool is_comment() const { return cells.empty() && !comment.empty(); }
};

bool touch(const Token& left, const Token& right) {
  return left.span.end == right.span.begin;
}

using Words = std::span<const Token>;  // of one line

bool begins_cell(Table table, Words tokens, std::size_t at) {
  const TokenKind kind = tokens[at].kind;
  if (table == Table::bands)
    return is_one_of(kind, {Kinds::BELOW, Kinds::ABOVE, Kinds::BETWEEN, Kinds::OTHERWISE});
  // The first cell is AT and a time. A minus alone is a key; one that touches a number is its sign.
  const bool signed_number =
      tokens[at - 1].kind == Kinds::MINUS && touch(tokens[at - 1], tokens[at]);
  return table == Table::motion && at > 1 && !signed_number;
}

// True for a minus that subtracts. Its spacing distinguishes it from a sign, except inside brackets, where two values are
// never adjacent.
bool is_operator(Table table, Words tokens, std::size_t at, int depth) {
  if (tokens[at].kind != Kinds::MINUS || at == 0 || at + 1 == tokens.size() ||
      (table == Table::motion && depth == 0))
    return false;
  const Token& left = tokens[at - 1];
  return is_one_of(left.kind, {Kinds::CLOSE, Kinds::QUANTITY, Kinds::NAME}) &&
         (depth > 0 || touch(left, tokens[at]) || !touch(tokens[at], tokens[at + 1]));
}

class Formatter {
public:
  Formatter(const SourceMap& sources, FileId file, const ast::Tree& tree)
      : source_(sources.file(file)), all_(lex(source_, file, ignored_)) {
    seen_ = without_idle_ends(all_);
    set_names(all_, tree);
    set_names(seen_, tree);
    places_ = places_of(seen_);
  }

  // False when a line holds anything but words and comments.
  bool read() {
    BlockWalk walk(seen_);
    for (std::uint32_t number = 1; start_of(number) < source_.text().size(); ++number)
      if (!read_line(number, walk)) return false;
    return true;
  }

  std::string write() {
    align_tables();
    separate_items();
    align_comments();
    std::string text;
    bool blank = true;  // no blank lines at the beginning
    for (const Line& line : lines_) {
      if (line.is_blank() && blank) continue;
      if (line.is_apart && !blank) text += '\n';
      blank = line.is_blank();
      text += shown(line) + '\n';
    }
    if (blank && !text.empty()) text.pop_back();
    return text;
  }

private:
  std::size_t start_of(std::uint32_t number) const {
    const std::string_view line = source_.line(number);
    return line.data() == nullptr ? source_.text().size() : source_.line_start(number);
  }

  Tokens tokens_of(std::size_t end) {
    Tokens found;
    for (; next_ < all_.size() && all_[next_].span.begin < end; ++next_)
      if (all_[next_].kind != Kinds::NEWLINE) found.push_back(all_[next_]);
    return found;
  }

  bool is_doubtful(std::string_view comment) const {
    if (comment.empty()) return false;
    const auto begin = static_cast<std::size_t>(comment.data() - source_.text().data());
    return std::ranges::any_of(ignored_.all(), [begin](const Diagnostic& diagnostic) {
      return diagnostic.code == Code::W0103 && diagnostic.labels.front().span.begin == begin;
    });
  }

  bool read_line(std::uint32_t number, BlockWalk& walk) {
    const std::size_t begin = source_.line_start(number);
    const std::string_view text = source_.line(number);
    const Tokens tokens = tokens_of(begin + text.size());
    const std::size_t code = tokens.empty() ? 0 : tokens.back().span.end - begin;
    const std::string_view comment =
        ascii::trimmed(utf8::without_byte_order_mark(text.substr(std::min(code, text.size()))));
    if (!comment.empty() && comment.front() != '#' && comment.front() != '%') return false;
    if (tokens.empty())
      lines_.push_back({.level = level_of_comment(blocks_)});
    else
      add_lines(tokens, !comment.empty(), walk);
    lines_.back().comment = comment;
    lines_.back().is_doubtful = is_doubtful(comment);
    return true;
  }

  void add_lines(Words words, bool has_comment, BlockWalk& walk) {
    skip_to(words.front(), walk);
    std::size_t breakable = breakable_of(words, has_comment);
    while (!words.empty()) {
      const std::size_t length = length_of_line(words, breakable);
      add_line(words.first(length), walk);
      words = words.subspan(length);
      breakable -= std::min(breakable, length);
    }
  }

  // A line break may stand in front of so many of the words of a line. A comment stays beside what it is about: not that
  // END, if the block began further up.
  std::size_t breakable_of(Words words, bool has_comment) const {
    std::size_t last = words.size() - 1;
    while (has_comment && last > 0 && words[last].kind == Kinds::END &&
           places_[at_ + last].partner < at_)
      --last;
    return last + 1;
  }

  // How many of the words stand on the line that the first of them begins.
  std::size_t length_of_line(Words words, std::size_t breakable) const {
    std::size_t length = 1;
    const std::size_t partner = places_[at_].partner;
    if (partner > at_ && partner < at_ + words.size() && fits(words.first(partner + 1 - at_)))
      length = partner + 1 - at_;
    while (length < words.size() && (length >= breakable || !places_[at_ + length].begins_line))
      ++length;
    return length;
  }

  bool fits(Words words) const {
    const std::string text = cells_of(words, Table::none).front();
    return kIndent * level_of(words.front().kind) + width_of(text) <= kWidest;
  }

  void add_line(Words words, BlockWalk& walk) {
    Line line;
    line.level = level_of(words.front().kind);
    line.table = table_of(words);
    line.cells = cells_of(words, line.table);
    note_item(line, words.front().kind);
    for (std::size_t i = 0; i < words.size(); ++i)
      step(walk, line.level);
    lines_.push_back(std::move(line));
  }

  // The rules and variables of a BEHAVIOR are items of it; its END is no line of the last of them.
  void note_item(Line& line, TokenKind first) {
    const bool of_behavior = blocks_.size() == 1 && blocks_.back().opener == Kinds::BEHAVIOR;
    const bool inside = of_behavior && first != Kinds::END;
    line.begins_item = (blocks_.empty() || inside) && !is_within_statement();
    if (!line.begins_item || inside) lines_[of_behavior ? behavior_ : item_].is_long = true;
    if (!line.begins_item) return;
    item_ = lines_.size();
    if (!inside) behavior_ = item_;
  }

  // Passes the end of the line before, if it counts.
  void skip_to(const Token& token, BlockWalk& walk) {
    while (at_ < seen_.size() && seen_[at_].span.begin < token.span.begin)
      walk.step(at_++);
  }

  void step(BlockWalk& walk, std::size_t level) {
    const TokenKind kind = seen_[at_].kind;
    walk.step(at_++);
    if (!blocks_.empty() && is_one_of(kind, {Kinds::DO, Kinds::ELSE, Kinds::ELSE_IF}))
      blocks_.back().body = kind != Kinds::ELSE_IF;
    if (walk.open().size() < blocks_.size()) blocks_.pop_back();
    if (walk.open().size() > blocks_.size()) blocks_.push_back({kind, level});
  }

  std::size_t level_of(TokenKind first) const {
    const std::size_t level = blocks_.empty() ? 0 : level_in(blocks_.back(), first);
    return level + (goes_on(first) ? 1U : 0U);
  }

  bool is_within_statement() const {
    return at_ > 0 && seen_[at_ - 1].kind != Kinds::NEWLINE && !places_[at_].begins_line;
  }

  // True when the line continues the one before and is not part of a block; level_in() handles conditions.
  bool goes_on(TokenKind first) const {
    if (!is_within_statement() || is_one_of(first, {Kinds::SMOOTH, Kinds::PRIORITY})) return false;
    if (!blocks_.empty()) {
      const Block& block = blocks_.back();
      if (has_do(block.opener) ? !block.body
                               : block.opener == Kinds::CHECK && first == Kinds::MARGIN)
        return false;
    }
    return (roles_of(seen_[at_ - 1].kind) & role::begins) == 0;
  }

  Table table_of(Words tokens) const {
    if (blocks_.empty()) return Table::none;
    const TokenKind opener = blocks_.back().opener;
    if (opener == Kinds::MOTION && tokens.front().kind == Kinds::AT) return Table::motion;
    const bool band = std::ranges::any_of(tokens, [](const Token& token) {
      return is_one_of(token.kind, {Kinds::BELOW, Kinds::ABOVE, Kinds::BETWEEN, Kinds::OTHERWISE});
    });
    return opener == Kinds::CHECK && band ? Table::bands : Table::none;
  }

  std::vector<std::string> cells_of(Words tokens, Table table) const {
    std::vector<std::string> cells{text_of(tokens.front())};
    int depth = 0;
    for (std::size_t i = 1; i < tokens.size(); ++i) {
      const Token& left = tokens[i - 1];
      const Token& right = tokens[i];
      if (depth == 0 && begins_cell(table, tokens, i)) {
        cells.emplace_back(text_of(right));
      } else {
        if (is_space_between(left.kind, right.kind, !touch(left, right)) ||
            is_operator(table, tokens, i, depth) || is_operator(table, tokens, i - 1, depth))
          cells.back() += ' ';
        cells.back() += text_of(right);
      }
      depth += (right.kind == Kinds::OPEN ? 1 : 0) - (right.kind == Kinds::CLOSE ? 1 : 0);
    }
    return cells;
  }

  std::string text_of(const Token& token) const {
    if (token.kind == Kinds::ELSE_IF) return "ELSE IF";
    std::string text(source_.text(token.span));
    if (is_keyword(token.kind)) std::ranges::transform(text, text.begin(), ascii::upper);
    return text;
  }

  // Calls take(first, end) for each run of lines that belong together.
  template <class Together, class Take>
  void each_run(Together together, Take take) {
    for (std::size_t first = 0; first < lines_.size();) {
      std::size_t end = first + 1;
      while (end < lines_.size() && together(lines_[end - 1], lines_[end]))
        ++end;
      take(std::span(lines_).subspan(first, end - first));
      first = end;
    }
  }

  void align_tables() {
    each_run([](const Line& a, const Line& b) { return a.table == b.table && a.level == b.level; },
             [](std::span<Line> lines) {
               if (lines.front().table == Table::none) return;
               for (std::size_t column = 0; column + 1 < most_cells(lines); ++column)
                 pad_column(lines, column);
             });
  }

  static std::size_t most_cells(std::span<const Line> lines) {
    std::size_t most = 0;
    for (const Line& line : lines)
      most = std::max(most, line.cells.size());
    return most;
  }

  // Pads a column so that the cells after it are aligned.
  static void pad_column(std::span<Line> lines, std::size_t column) {
    std::size_t width = 0;
    for (const Line& line : lines)
      if (line.cells.size() > column + 1) width = std::max(width, width_of(line.cells[column]));
    for (Line& line : lines)
      if (line.cells.size() > column + 1)
        line.cells[column].append(width + 1 - width_of(line.cells[column]), ' ');
  }

  static std::string code_of(const Line& line) {
    std::string text(line.cells.empty() ? 0 : kIndent * line.level, ' ');
    for (const std::string& cell : line.cells)
      text += cell;
    return text;
  }

  void align_comments() {
    const auto has_both = [](const Line& line) {
      return !line.comment.empty() && !line.cells.empty() && !line.is_doubtful;
    };
    columns_.clear();
    each_run(
        [&](const Line& a, const Line& b) { return has_both(a) && has_both(b) && !b.is_apart; },
        [&](std::span<Line> lines) {
          std::size_t width = 0;
          for (const Line& line : lines)
            width = std::max(width, width_of(code_of(line)));
          const std::size_t before = lines.front().is_doubtful ? 1 : kBeforeComment;
          columns_.insert(columns_.end(), lines.size(), width + before);
        });
  }

  // A comment right above an item belongs to it.
  void separate_items() {
    std::array<const Line*, 2> before{};  // outside all blocks, and inside the BEHAVIOR
    for (std::size_t at = 0; at < lines_.size(); ++at) {
      const Line& line = lines_[at];
      if (!line.begins_item) continue;
      std::size_t first = at;
      while (first > 0 && lines_[first - 1].is_comment())
        --first;
      const std::size_t inside = std::min<std::size_t>(line.level, 1);
      if (before[inside] != nullptr)
        lines_[first].is_apart = before[inside]->is_long || line.is_long;
      before[inside] = &line;
      if (inside == 0) before[1] = nullptr;
    }
  }

  std::string shown(const Line& line) const {
    std::string text = code_of(line);
    if (line.comment.empty()) return text;
    const std::size_t column = columns_[static_cast<std::size_t>(&line - lines_.data())];
    text.append(line.cells.empty() ? kIndent * line.level : column - width_of(text), ' ');
    return text + std::string(line.comment);
  }

  Diagnostics ignored_;
  const SourceFile& source_;
  Tokens all_, seen_;
  std::size_t next_ = 0;      // in all_
  std::size_t at_ = 0;        // in seen_
  std::size_t item_ = 0;      // its first line, in lines_
  std::size_t behavior_ = 0;  // … of the item outside all blocks
  std::vector<Place> places_;
  std::vector<Block> blocks_;
  std::vector<Line> lines_;
  std::vector<std::size_t> columns_;  // of the comment in each line
};

// The line ends that the style may add: behind OPTION, behind its weight, and behind the name of a SAFETY.
bool is_optional_end(const Tokens& tokens, std::size_t at) {
  if (tokens[at].kind != Kinds::NEWLINE || at < 2) return false;
  const TokenKind before = tokens[at - 2].kind, last = tokens[at - 1].kind;
  return last == Kinds::OPTION || (last == Kinds::QUANTITY && before == Kinds::OPTION) ||
         before == Kinds::SAFETY;
}

// The words of a text, as the grammar sees them.
std::vector<std::pair<TokenKind, std::string>> words_of(const SourceMap& sources, FileId file) {
  Diagnostics ignored;
  Tokens all = lex(sources.file(file), file, ignored);
  std::vector<std::pair<TokenKind, std::string>> words;
  const Tokens seen = without_idle_ends(all);
  for (std::size_t at = 0; at < seen.size(); ++at) {
    if (is_optional_end(seen, at)) continue;
    const Token& token = seen[at];
    const bool named = token.kind != Kinds::NEWLINE && !is_keyword(token.kind);
    words.emplace_back(token.kind, named ? sources.text(token.span) : "");
  }
  return words;
}

}  // namespace

std::optional<std::string> formatted(const SourceMap& sources, FileId file, const ast::Tree& tree) {
  Formatter formatter(sources, file, tree);
  if (!formatter.read()) return std::nullopt;
  std::string text = formatter.write();
  SourceMap after;
  const FileId same = after.add(sources.file(file).name(), text);
  if (words_of(sources, file) != words_of(after, same)) return std::nullopt;
  return text;
}

}  // namespace robosync::compiler
