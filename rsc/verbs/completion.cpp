// rsc completion bash|fish|zsh
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/usage.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

using Script = std::string (*)(const std::vector<VerbUsage>&);
constexpr std::array<std::pair<std::string_view, Script>, 3> kShells = {
    {{"bash", bash_completion}, {"fish", fish_completion}, {"zsh", zsh_completion}}};

}  // namespace

void add_completion(Options& options) {
  auto shell = std::make_shared<std::string>();
  options.argument("bash|fish|zsh", *shell, "the shell", Options::Need::required);
  options.runs([shell] {
    for (const auto& [name, script] : kShells)
      if (name == *shell) {
        std::cout << script(all_usage());
        return;
      }
    throw Failure(Exit::usage, fmt::format("the shell is bash, fish or zsh, not `{}`", *shell));
  });
}

}  // namespace robosync::tool
