// The compiler's input: texts. It opens no files itself.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace robosync::compiler {

struct Input {
  std::string name;  // as messages show it
  std::string text;
};

// Reads the module that `USE "file"` in the file `user` refers to. The returned name is the same for the same file.
// Nothing when it cannot be read.
using ModuleReader =
    std::function<std::optional<Input>(const std::string& user, const std::string& file)>;

}  // namespace robosync::compiler
