// Diagnostics for people. See render.hpp.
#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "compiler/diagnostics/render.hpp"
#include "compiler/diagnostics/snippet.hpp"
#include "compiler/source/sorting.hpp"
#include "compiler/source/utf8.hpp"

namespace robosync::compiler {

namespace {

// Escape sequences for the terminal; all empty without colour.
struct Style {
  std::string_view error, warning, note, quiet, strong, off;
};

constexpr Style kPlain{};
constexpr Style kColored{"\x1b[1;31m", "\x1b[1;33m", "\x1b[1;36m",
                         "\x1b[34m",   "\x1b[1m",    "\x1b[0m"};

class Renderer {
public:
  Renderer(const SourceMap& sources, bool color)
      : sources_(sources), style_(color ? kColored : kPlain) {}

  std::string render(const Diagnostic& diagnostic) {
    text_.clear();
    level_ = diagnostic.level;
    write_title(diagnostic);
    const std::vector<Label> labels = in_reading_order(diagnostic.labels);
    measure_gutter(labels);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const bool same_file = i > 0 && labels[i - 1].span.file == labels[i].span.file;
      if (!same_file) write_place(head_of_file(labels, i));
      write_label(labels[i], same_file ? &labels[i - 1] : nullptr);
    }
    for (const std::string& help : diagnostic.help)
      write_help(help);
    return text_;
  }

private:
  std::string_view level_color(Level level) const {
    switch (level) {
      case Level::error:
        return style_.error;
      case Level::warning:
        return style_.warning;
      case Level::note:
        break;
    }
    return style_.note;
  }

  void write(std::string_view color, std::string_view text) {
    text_ += color;
    text_ += text;
    if (!color.empty()) text_ += style_.off;
  }

  void write_title(const Diagnostic& diagnostic) {
    const std::string head = std::string(level_name(diagnostic.level)) + "[" +
                             std::string(code_name(diagnostic.code)) + "]";
    write(level_color(diagnostic.level), head);
    write(style_.strong, ": " + utf8::printable(diagnostic.message));
    text_ += '\n';
  }

  // The file of the first primary label comes first; within a file, top to bottom.
  static std::vector<Label> in_reading_order(std::vector<Label> labels) {
    const auto primary = std::find_if(labels.begin(), labels.end(),
                                      [](const Label& label) { return label.primary; });
    const FileId leading = primary == labels.end() ? FileId{0} : primary->span.file;
    sort_stably(labels, [leading](const Label& a, const Label& b) {
      const bool a_leads = a.span.file == leading;
      const bool b_leads = b.span.file == leading;
      if (a_leads != b_leads) return a_leads;
      if (a.span.file != b.span.file) return a.span.file < b.span.file;
      return a.span.begin < b.span.begin;
    });
    return labels;
  }

  // The place shown for a message leads to the mistake, not to a secondary label.
  static const Label& head_of_file(const std::vector<Label>& labels, std::size_t first) {
    const FileId file = labels[first].span.file;
    for (const Label& label : std::span(labels).subspan(first))
      if (label.primary && label.span.file == file) return label;
    return labels[first];
  }

  Position place(Span span) const { return sources_.file(span.file).position(span.begin); }

  void measure_gutter(const std::vector<Label>& labels) {
    std::size_t digits = 1;
    for (const Label& label : labels) {
      digits = std::max(digits, std::to_string(place(label.span).line).size());
    }
    gutter_ = digits + 1;
  }

  void write_place(const Label& label) {
    const Position position = place(label.span);
    write(style_.quiet, std::string(gutter_, ' ') + "--> ");
    text_ += utf8::printable(sources_.file(label.span.file).name());
    text_ += ':' + std::to_string(position.line) + ':' + std::to_string(position.column) + '\n';
  }

  void write_gutter(std::string_view number) {
    write(style_.quiet, std::string(gutter_ - number.size(), ' ') + std::string(number) + " | ");
  }

  // `previous` is in the same file, or null.
  void write_label(const Label& label, const Label* previous) {
    const std::uint32_t line = place(label.span).line;
    const std::uint32_t line_before = previous != nullptr ? place(previous->span).line : 0;
    if (previous != nullptr && line > line_before + 1) {
      write(style_.quiet, std::string(gutter_ - 1, ' ') + "...\n");
    }
    const SourceFile& file = sources_.file(label.span.file);
    const std::size_t start = file.line_start(line);
    const Snippet snippet =
        make_snippet(file.line(line), label.span.begin - start,
                     std::max(label.span.end, label.span.begin) - start, label.primary ? '^' : '-');
    // Repeated when a long line is cut elsewhere for this label.
    if (previous == nullptr || line != line_before || snippet.source != shown_) {
      write_gutter(std::to_string(line));
      text_ += snippet.source + '\n';
    }
    shown_ = snippet.source;
    write_gutter("");
    const std::string note = label.text.empty() ? "" : " " + utf8::printable(label.text);
    write(label.primary ? level_color(level_) : style_.quiet, snippet.marker + note);
    text_ += '\n';
  }

  void write_help(const std::string& help) {
    write(style_.quiet, std::string(gutter_ + 1, ' ') + "= ");
    write(style_.strong, "help:");
    text_ += ' ' + utf8::printable(help) + '\n';
  }

  const SourceMap& sources_;
  Style style_;
  std::string text_;
  std::string shown_;  // the line of source above the last marker
  Level level_ = Level::error;
  std::size_t gutter_ = 2;
};

}  // namespace

std::string render_human(const Diagnostics& diagnostics, const SourceMap& sources, bool color,
                         std::size_t most_errors) {
  Renderer renderer(sources, color);
  std::string text;
  std::size_t errors = 0;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    if (diagnostic.level == Level::error && ++errors > most_errors) continue;
    if (!text.empty()) text += '\n';
    text += renderer.render(diagnostic);
  }
  if (errors > most_errors) text += "\nand " + std::to_string(errors - most_errors) + " more\n";
  return text;
}

}  // namespace robosync::compiler
