// See snippet.hpp.
#include "compiler/diagnostics/snippet.hpp"

#include <algorithm>
#include <vector>

#include "compiler/source/utf8.hpp"

namespace robosync::compiler {

namespace {

constexpr std::size_t tab_stop = 4;
constexpr std::size_t widest = 100;  // columns of source that are shown
constexpr std::size_t context = 30;  // columns kept before the marked place when a line is cut
constexpr std::string_view ellipsis = "...";

// What one code point of the line became.
struct Cell {
  std::string text;
  std::size_t byte;    // where it starts in the line
  std::size_t column;  // where it starts on the terminal
  std::size_t width;
};

Cell make_cell(std::string_view line, std::size_t byte, std::size_t column, utf8::CodePoint point) {
  if (line[byte] == '\t') {
    const std::size_t width = tab_stop - column % tab_stop;
    return {std::string(width, ' '), byte, column, width};
  }
  std::string text = utf8::printable(line.substr(byte, point.size));
  const bool shown = point.value != utf8::replacement && utf8::is_printable(point.value);
  return {std::move(text), byte, column, shown ? utf8::width(point.value) : 1U};
}

// Cells of the line from `first` on, until they are `limit` columns wide.
std::vector<Cell> lay_out(std::string_view line, std::size_t first, std::size_t limit) {
  std::vector<Cell> cells;
  std::size_t column = 0;
  for (std::size_t byte = first; byte < line.size() && column < limit;) {
    const utf8::CodePoint point = utf8::decode(line, byte);
    cells.push_back(make_cell(line, byte, column, point));
    column += cells.back().width;
    byte += point.size;
  }
  return cells;
}

// Where to start so that the marked place can be seen: 0, or `context` code points before it.
std::size_t first_shown(std::string_view line, std::size_t begin) {
  std::size_t columns = 0;
  for (const Cell& cell : lay_out(line, 0, widest))
    columns = cell.column + cell.width;
  const bool whole_line_fits = columns < widest;
  const bool mark_is_early = begin + context < widest;
  if (whole_line_fits || mark_is_early) return 0;
  std::size_t start = std::min(begin, line.size());
  for (std::size_t steps = 0; steps < context && start > 0; ++steps) {
    --start;
    while (start > 0 && (static_cast<unsigned char>(line[start]) & 0xC0U) == 0x80U)
      --start;
  }
  return start;
}

}  // namespace

Snippet make_snippet(std::string_view line, std::size_t begin, std::size_t end, char mark) {
  const std::size_t first = first_shown(line, begin);
  const std::vector<Cell> cells = lay_out(line, first, widest);
  Snippet snippet;
  std::size_t mark_column = 0;
  std::size_t mark_width = 0;
  std::size_t bytes_shown = first;
  for (const Cell& cell : cells) {
    snippet.source += cell.text;
    if (cell.byte < begin) mark_column = cell.column + cell.width;
    if (cell.byte >= begin && cell.byte < end) mark_width += cell.width;
    bytes_shown = cell.byte + utf8::decode(line, cell.byte).size;
  }
  snippet.marker =
      std::string(mark_column, ' ') + std::string(std::max<std::size_t>(mark_width, 1), mark);
  if (first > 0) {
    snippet.source.insert(0, ellipsis);
    snippet.marker.insert(0, ellipsis.size(), ' ');
  }
  if (bytes_shown < line.size()) snippet.source += ellipsis;
  return snippet;
}

}  // namespace robosync::compiler
