// Writes a verb's output files without destroying files that are not its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rsc/file_kind.hpp"

namespace robosync::tool {

struct Output {
  std::string_view path;  // empty: not asked for
  FileKind again =
      FileKind::other;  // what may be replaced although it matters: an older output of this kind
};

// Throws Failure if the path is one of `inputs` (usage), even through a link; exists and is a file that matters, such
// as a scenario (usage); would be taken for the configuration of a program because of its name (usage); or is a
// directory (outside). Inputs that do not exist are ignored.
void check_output(const Output& output, const std::vector<std::string>& inputs);
// The same for several, and if two of them are the same file (usage).
void check_outputs(std::initializer_list<Output> outputs, const std::vector<std::string>& inputs);

// `path` is this program's stdout, so nothing else should be printed there.
[[nodiscard]] bool is_stdout(const std::filesystem::path& path);

// Atomic: a file has either the new or the old content, whatever happens. A link to a file is replaced, as C
// compilers do. Devices, pipes and dangling links are written through. Throws Failure (outside).
void write_output(const std::filesystem::path& path, std::span<const std::byte> bytes);

// The same for a file that was read and is rewritten: a link stays, and its target is changed.
void write_edited(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Overwrites the file in place; all bytes are on the medium on return. For drives that know no other files and no
// renaming. Throws Failure (outside).
void write_in_place(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace robosync::tool
