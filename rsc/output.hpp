// What a verb writes for its user, without destroying what is not its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace robosync::tool {

// Throws Failure when `path` is one of `inputs` (usage), whatever link it is named by, is there already and is what a
// person has written, a scenario say (usage), would be taken for the configuration of a program because of its name
// (usage), or is a directory (outside). Inputs that are not there are ignored.
void check_output(const std::filesystem::path& path, const std::vector<std::string>& inputs);
// … for all that are not empty, and when two of them are one file (usage).
void check_outputs(const std::vector<std::string>& paths, const std::vector<std::string>& inputs);

// It goes to this program's stdout, so nothing else should.
[[nodiscard]] bool is_stdout(const std::filesystem::path& path);

// A file has the new content or is as it was, whatever happens; a link to one is replaced by it, as
// the C compiler does. Devices, pipes and links that dangle are written through. Throws Failure
// (outside).
void write_output(const std::filesystem::path& path, std::span<const std::byte> bytes);

// … for what was read and is written again: a link stays, and the file that it leads to is changed.
void write_edited(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Over what is there, and all of it is there when this returns: for what knows no other files and no renaming. Throws
// Failure (outside).
void write_in_place(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace robosync::tool
