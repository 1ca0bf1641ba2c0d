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
constexpr std::size_t most_glyphs = 4 * widest;
constexpr std::string_view ellipsis = "...";

// A code point of the line, and its place on the terminal.
struct Glyph {
  std::size_t byte, size;  // in the line
  std::size_t column, width;
};

Glyph make_glyph(std::string_view line, std::size_t byte, std::size_t column) {
  if (line[byte] == '\t') return {byte, 1, column, tab_stop - column % tab_stop};
  const utf8::CodePoint point = utf8::decode(line, byte);
  const bool shown = point.value != utf8::replacement && utf8::is_printable(point.value);
  return {byte, point.size, column, shown ? utf8::width(point.value) : 1U};
}

// Glyphs of the line from `first` on, up to a width of `widest` columns. A long run of glyphs without
// width is cut as well.
std::vector<Glyph> lay_out(std::string_view line, std::size_t first) {
  std::vector<Glyph> glyphs;
  glyphs.reserve(std::min(line.size() - first, widest));
  std::size_t column = 0;
  for (std::size_t byte = first;
       byte < line.size() && column < widest && glyphs.size() < most_glyphs;) {
    glyphs.push_back(make_glyph(line, byte, column));
    column += glyphs.back().width;
    byte += glyphs.back().size;
  }
  return glyphs;
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
  const std::vector<Glyph> glyphs = lay_out(line, 0);
  const std::size_t columns = glyphs.empty() ? 0 : glyphs.back().column + glyphs.back().width;
  const bool whole_line_fits = columns < widest && glyphs.size() < most_glyphs;
  if (whole_line_fits) return 0;
  std::size_t start = std::min(begin, line.size());
  for (std::size_t steps = 0; steps < context && start > 0; ++steps)
    start -= size_before(line, start);
  return start;
}

}  // namespace

Snippet make_snippet(std::string_view line, std::size_t begin, std::size_t end, char mark) {
  const std::size_t first = first_shown(line, begin);
  const std::vector<Glyph> glyphs = lay_out(line, first);
  Snippet snippet;
  std::size_t mark_column = 0;
  std::size_t mark_width = 0;
  std::size_t bytes_shown = first;
  for (const Glyph& glyph : glyphs) {
    if (line[glyph.byte] == '\t')
      snippet.source.append(glyph.width, ' ');
    else
      utf8::append_printable(snippet.source, line.substr(glyph.byte, glyph.size));
    if (glyph.byte < begin) mark_column = glyph.column + glyph.width;
    if (glyph.byte >= begin && glyph.byte < end) mark_width += glyph.width;
    bytes_shown = glyph.byte + glyph.size;
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
