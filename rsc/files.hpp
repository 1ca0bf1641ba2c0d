// Reads whole files. Messages name the file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "rsc/failure.hpp"

namespace robosync::tool {

// Both throw Failure (outside) when the file cannot be read, or is larger than 16 MiB.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& path);

// With this extension, in any order. Of a large folder only some thousand entries are looked at.
[[nodiscard]] std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                                          std::string_view extension);

// This user's cache folder; empty if there is none. It may not exist yet.
[[nodiscard]] std::filesystem::path cache_folder();

// Calls `work` for each file. A Failure that it throws is printed immediately and does not stop the others. Returns
// the worst exit code.
[[nodiscard]] Exit for_each_file(const std::vector<std::string>& files,
                                 const std::function<void(const std::string&)>& work);

// Where programs and configurations are read from: the disk, unless an editor has newer texts (lsp/).
class Texts {
public:
  Texts() = default;
  virtual ~Texts() = default;
  Texts(const Texts&) = delete;
  Texts& operator=(const Texts&) = delete;

  // As read_text().
  [[nodiscard]] virtual std::string read(const std::filesystem::path& path) const;
  [[nodiscard]] virtual bool has(const std::filesystem::path& path) const;
};

// Where find_configuration() looks, in this order.
[[nodiscard]] std::vector<std::filesystem::path> places_of_configuration(
    const std::filesystem::path& program, const std::string& config);

// `config` if it is not empty, else STEM.json beside `program`, else robot.json beside it. Throws
// Failure (outside) if there is none, (program) if the file with that name is a scenario or a trace.
[[nodiscard]] std::filesystem::path find_configuration(const std::filesystem::path& program,
                                                       const std::string& config,
                                                       const Texts& texts = Texts());

}  // namespace robosync::tool
