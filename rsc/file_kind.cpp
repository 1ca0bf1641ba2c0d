// Looks for keys that only one kind of file has. The text is not trusted.
#include "rsc/file_kind.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include "companion/words_file.hpp"
#include "compiler/source/ascii.hpp"

namespace robosync::tool {
namespace {

constexpr std::size_t kBeginning = std::size_t{64} * 1024;
constexpr std::string_view kSpace = " \t\r\n";

// A string that is a value has no colon after it.
bool has_key(std::string_view text, std::string_view key) {
  for (std::size_t at = text.find(key); at != std::string_view::npos; at = text.find(key, at + 1)) {
    const std::size_t end = at + key.size();
    const bool quoted = at > 0 && text[at - 1] == '"' && end < text.size() && text[end] == '"';
    if (!quoted) continue;
    const std::size_t next = text.find_first_not_of(kSpace, end + 1);
    if (next != std::string_view::npos && text[next] == ':') return true;
  }
  return false;
}

// "time (s)", one of the cells.
bool names_times(std::string_view line) {
  constexpr std::string_view kBetween = ",;\t\r\"\xEF\xBB\xBF";
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(kBetween), line.size());
    const std::string_view name = line.substr(0, std::min(line.find_first_of(" ("), end));
    if (compiler::ascii::same(name, "time")) return true;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return false;
}

struct Beginning {
  std::string_view text;
  FileKind kind;
};
constexpr std::array kBeginnings = {Beginning{kKeyWords, FileKind::key},
                                    Beginning{companion::kFirstLineOfAny, FileKind::words},
                                    Beginning{"\x7F"
                                              "ELF",
                                              FileKind::library},
                                    Beginning{"RIFF", FileKind::sound},
                                    Beginning{"FORM", FileKind::sound},
                                    Beginning{"fLaC", FileKind::sound},
                                    Beginning{"OggS", FileKind::sound}};

struct Mark {
  std::string_view key;
  FileKind kind;
};
// The order matters: robot.json has durations, too.
constexpr std::array kMarks = {
    Mark{"traceEvents", FileKind::perfetto},    Mark{"sensors", FileKind::configuration},
    Mark{"actuators", FileKind::configuration}, Mark{"stimuli", FileKind::scenario},
    Mark{"duration", FileKind::scenario},       Mark{"kept", FileKind::kept}};

}  // namespace

FileKind kind_of_text(std::string_view text) {
  for (const Beginning& one : kBeginnings)
    if (text.starts_with(one.text)) return one.kind;
  const std::string_view first = text.substr(0, text.find('\n'));
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return FileKind::other;
  if (text[begin] != '{') return names_times(first) ? FileKind::recording : FileKind::other;
  if (has_key(first, "event")) return has_key(first, "hex") ? FileKind::replay : FileKind::trace;
  const auto* const mark =
      std::ranges::find_if(kMarks, [&](const Mark& one) { return has_key(text, one.key); });
  return mark == kMarks.end() ? FileKind::other : mark->kind;
}

FileKind kind_of_file(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (compiler::ascii::same(extension, ".rsl")) return FileKind::program;
  if (extension == ".c" || extension == ".h") return FileKind::source;
  std::ifstream file(path, std::ios::binary);
  std::string text(kBeginning, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return kind_of_text(text);
}

std::string_view describe(FileKind kind) {
  switch (kind) {
    case FileKind::program:
      return "a program";
    case FileKind::configuration:
      return "the configuration of a robot";
    case FileKind::scenario:
      return "a scenario";
    case FileKind::recording:
      return "a recording in CSV";
    case FileKind::kept:
      return "a file of kept numbers";
    case FileKind::trace:
      return "a trace";
    case FileKind::replay:
      return "a recording for rsc replay";
    case FileKind::perfetto:
      return "a trace for Perfetto";
    case FileKind::key:
      return "the key of a robot's owner";
    case FileKind::words:
      return "a file of taught words";
    case FileKind::source:
      return "a source in C";
    case FileKind::library:
      return "a compiled module or program";
    case FileKind::sound:
      return "a sound";
    case FileKind::other:
      break;
  }
  return "something else";
}

}  // namespace robosync::tool
