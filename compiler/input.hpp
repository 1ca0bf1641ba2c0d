// What is handed to the compiler: texts. It opens no files itself.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace robosync::compiler {

struct Input {
  std::string name;  // as it shall stand in messages
  std::string text;
};

// What `USE "file"` in the file called `user` means: the module with the name of its own, the same
// for the same file. Nothing when it cannot be read.
using ModuleReader =
    std::function<std::optional<Input>(const std::string& user, const std::string& file)>;

}  // namespace robosync::compiler
