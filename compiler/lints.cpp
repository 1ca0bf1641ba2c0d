// See lints.hpp.
#include "compiler/lints.hpp"

#include <optional>
#include <string_view>

#include "compiler/source/ascii.hpp"
#include "compiler/source/utf8.hpp"

namespace robosync::compiler {

namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view next_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  std::size_t end = 0;
  while (end < text.size() &&
         (ascii::is_letter(text[end]) || ('0' <= text[end] && text[end] <= '9')))
    ++end;
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

// The level that a comment such as `# allow W0203` gives this lint.
std::optional<LintLevel> level_in(std::string_view comment, Code code) {
  const std::string_view word = next_word(comment);
  if (next_word(comment) != code_name(code)) return std::nullopt;
  if (ascii::same(word, "allow")) return LintLevel::allow;
  if (ascii::same(word, "warn")) return LintLevel::warn;
  if (ascii::same(word, "deny")) return LintLevel::deny;
  return std::nullopt;
}

// The level in the comments directly above the line that the lint reports.
std::optional<LintLevel> level_above(const Diagnostic& diagnostic, const SourceMap& sources) {
  if (diagnostic.labels.empty()) return std::nullopt;
  const Span place = diagnostic.labels.front().span;
  const SourceFile& file = sources.file(place.file);
  for (std::uint32_t line = file.line_of(place.begin); line > 1; --line) {
    std::string_view text = utf8::without_byte_order_mark(file.line(line - 1));
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (!text.starts_with('#') && !text.starts_with('%')) return std::nullopt;
    if (const auto level = level_in(text.substr(1), diagnostic.code)) return level;
  }
  return std::nullopt;
}

std::optional<LintLevel> level_of(const Diagnostic& diagnostic, const SourceMap& sources,
                                  const Robot* robot, const LintLevels& asked) {
  if (const auto above = level_above(diagnostic, sources)) return above;
  if (const auto found = asked.levels.find(diagnostic.code); found != asked.levels.end())
    return found->second;
  if (robot == nullptr) return std::nullopt;
  const auto found = robot->lints.find(diagnostic.code);
  return found != robot->lints.end() ? std::optional(found->second) : std::nullopt;
}

}  // namespace

void apply_lints(Diagnostics& diagnostics, const SourceMap& sources, const Robot* robot,
                 const LintLevels& asked) {
  Diagnostics kept;
  for (Diagnostic diagnostic : diagnostics.all()) {
    if (is_lint(diagnostic.code)) {
      const auto level = level_of(diagnostic, sources, robot, asked);
      if (level == LintLevel::allow) continue;
      if (level) diagnostic.level = level == LintLevel::deny ? Level::error : Level::warning;
    }
    if (asked.deny_warnings && diagnostic.level == Level::warning) diagnostic.level = Level::error;
    kept.add(std::move(diagnostic));
  }
  diagnostics = std::move(kept);
}

}  // namespace robosync::compiler
