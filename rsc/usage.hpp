// The command line as help shows it, for shell completion and the manual page.
#pragma once

#include <string>
#include <vector>

namespace robosync::tool {

struct OptionUsage {
  std::vector<std::string> names;  // "--format", "-o"; empty: positional
  std::string value;               // "FILE", "human|json"; empty: a flag
  std::string description;
};

struct VerbUsage {
  std::string name, summary, example;
  std::vector<OptionUsage> options;
};

// Every verb, in the order of `rsc help`, with its options as cli.cpp has declared them.
[[nodiscard]] std::vector<VerbUsage> all_usage();

[[nodiscard]] std::string bash_completion(const std::vector<VerbUsage>& verbs);
[[nodiscard]] std::string fish_completion(const std::vector<VerbUsage>& verbs);
[[nodiscard]] std::string zsh_completion(const std::vector<VerbUsage>& verbs);
// In roff, for section 1.
[[nodiscard]] std::string manual_page(const std::vector<VerbUsage>& verbs);

}  // namespace robosync::tool
