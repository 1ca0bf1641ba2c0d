// Files: whole, with messages that name them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rsc/failure.hpp"

namespace robosync::tool {

// Both throw Failure (outside) when the file cannot be read, or is larger than 16 MiB.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& path);

// For what can be made again, of this user; empty when there is no such place. It may have to be created.
[[nodiscard]] std::filesystem::path cache_folder();

// Does `work` with each file. One that it throws a Failure for does not silence the others: that is said at once, and
// the worst exit of all is given.
[[nodiscard]] Exit for_each_file(const std::vector<std::string>& files,
                                 const std::function<void(const std::string&)>& work);

// Where programs and configurations are read: the disk, unless somebody has newer texts (lsp/).
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
// Failure (outside) when there is none, (program) when what has that name is a scenario or a trace.
[[nodiscard]] std::filesystem::path find_configuration(const std::filesystem::path& program,
                                                       const std::string& config,
                                                       const Texts& texts = Texts());

}  // namespace robosync::tool
