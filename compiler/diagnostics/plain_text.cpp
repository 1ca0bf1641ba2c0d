// See plain_text.hpp.
#include "compiler/diagnostics/plain_text.hpp"

#include <algorithm>
#include <string>

#include "compiler/source/character_names.hpp"
#include "compiler/source/utf8.hpp"

namespace robosync::compiler {

namespace {

constexpr const char* kSaveAsUtf8 =
    "save it as UTF-8: most editors offer the encoding in \"Save as\"";

// With or without a byte order mark: without it, every second byte of ASCII text is NUL.
bool is_utf16(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  constexpr std::size_t looked_at = 64;
  constexpr std::size_t least = 4;
  const std::string_view head = text.substr(0, looked_at);
  if (head.size() < least) return false;
  std::size_t odd = 0, even = 0;
  for (std::size_t i = 0; i < head.size(); ++i)
    if (head[i] == '\0') ++(i % 2 == 0 ? even : odd);
  return std::min(odd, even) == 0 && std::max(odd, even) * 3 > head.size();
}

bool turns_direction(char32_t point) {
  return (0x202A <= point && point <= 0x202E) || (0x2066 <= point && point <= 0x2069);
}

bool is_ascii(std::string_view text) {
  return std::ranges::none_of(text,
                              [](char c) { return (static_cast<unsigned char>(c) & 0x80U) != 0; });
}

class Check {
public:
  Check(const SourceMap& sources, FileId file, Code code, Diagnostics& diagnostics)
      : text_(sources.file(file).text()), file_(file), code_(code), diagnostics_(diagnostics) {}

  bool run() {
    if (is_utf16(text_)) {
      report("this file is UTF-16, but rsc reads UTF-8", 0, 0).helps(kSaveAsUtf8);
      return false;
    }
    if (const std::size_t nul = text_.find('\0'); nul != std::string_view::npos) {
      report("there is a NUL byte (U+0000) here, which is not valid text", nul, 1)
          .helps("delete it; if you cannot see it, retype the line");
      return false;
    }
    return is_ascii(text_) || look_at_each();
  }

private:
  Diagnostic& report(std::string message, std::size_t at, std::size_t size) {
    const auto begin = static_cast<std::uint32_t>(at);
    return diagnostics_.report(code_, std::move(message))
        .label({file_, begin, begin + static_cast<std::uint32_t>(size)});
  }

  bool look_at_each() {
    for (std::size_t at = 0; at < text_.size();) {
      const utf8::CodePoint point = utf8::decode(text_, at);
      if (point.value == utf8::replacement && point.size == 1) {
        report("this is not UTF-8 text", at, 1).helps(kSaveAsUtf8);
        return false;
      }
      if (turns_direction(point.value)) {
        report(
            utf8::describe(point.value) + " makes what follows look different from what rsc reads",
            at, point.size)
            .helps("delete it: it is not allowed in a program, not even in texts and comments");
        return false;
      }
      at += point.size;
    }
    return true;
  }

  std::string_view text_;
  FileId file_;
  Code code_;
  Diagnostics& diagnostics_;
};

}  // namespace

bool is_plain_text(const SourceMap& sources, FileId file, Code code, Diagnostics& diagnostics) {
  return Check(sources, file, code, diagnostics).run();
}

}  // namespace robosync::compiler
