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
constexpr std::size_t most_cells = 4 * widest;
constexpr std::string_view ellipsis = "...";

// A code point of the line, and its place on the terminal.
struct Cell {
  std::size_t byte, size;  // in the line
  std::size_t column, width;
};

Cell make_cell(std::string_view line, std::size_t byte, std::size_t column) {
  if (line[byte] == '\t') return {byte, 1, column, tab_stop - column % tab_stop};
  const utf8::CodePoint point = utf8::decode(line, byte);
  const bool shown = point.value != utf8::replacement && utf8::is_printable(point.value);
  return {byte, point.size, column, shown ? utf8::width(point.value) : 1U};
}

// Cells of the line from `first` on, up to a width of `widest` columns. A long run of cells without
// width is cut as well.
std::vector<Cell> lay_out(std::string_view line, std::size_t first) {
  std::vector<Cell> cells;
  cells.reserve(std::min(line.size() - first, widest));
  std::size_t column = 0;
  for (std::size_t byte = first;
       byte < line.size() && column < widest && cells.size() < most_cells;) {
    cells.push_back(make_cell(line, byte, column));
    column += cells.back().width;
    byte += cells.back().size;
  }
  return cells;
}

// The bytes of the code point that ends before `at`; `at` must not be 0.
std::size_t size_before(std::string_view line, std::size_t at) {
  constexpr std::size_t longest = 4;
  std::size_t size = 1;
  while (size < longest && size < at &&
         (static_cast<unsigned char>(line[at - size]) & 0xC0U) == 0x80U)
    ++size;
  return size;
}

// Where to start so that the marked place is visible: 0, or `context` code points before it.
std::size_t first_shown(std::string_view line, std::size_t begin) {
  if (begin + context < widest) return 0;  // the mark is near the start
  const std::vector<Cell> cells = lay_out(line, 0);
  const std::size_t columns = cells.empty() ? 0 : cells.back().column + cells.back().width;
  const bool whole_line_fits = columns < widest && cells.size() < most_cells;
  if (whole_line_fits) return 0;
  std::size_t start = std::min(begin, line.size());
  for (std::size_t steps = 0; steps < context && start > 0; ++steps)
    start -= size_before(line, start);
  return start;
}

}  // namespace

Snippet make_snippet(std::string_view line, std::size_t begin, std::size_t end, char mark) {
  const std::size_t first = first_shown(line, begin);
  const std::vector<Cell> cells = lay_out(line, first);
  Snippet snippet;
  std::size_t mark_column = 0;
  std::size_t mark_width = 0;
  std::size_t bytes_shown = first;
  for (const Cell& cell : cells) {
    if (line[cell.byte] == '\t')
      snippet.source.append(cell.width, ' ');
    else
      utf8::append_printable(snippet.source, line.substr(cell.byte, cell.size));
    if (cell.byte < begin) mark_column = cell.column + cell.width;
    if (cell.byte >= begin && cell.byte < end) mark_width += cell.width;
    bytes_shown = cell.byte + cell.size;
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
