// Diagnostics as SARIF 2.1.0, the format in which code hosts and editors read a checker's results.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

// One run of rsc over some programs.
class SarifLog {
public:
  explicit SarifLog(std::string version) : version_(std::move(version)) {}

  void add(const Diagnostics& diagnostics, const SourceMap& sources);
  // A program that could not be checked, for example because it cannot be read.
  void add_unchecked(std::string_view path, std::string_view why);
  // The log as one JSON object, with a newline.
  [[nodiscard]] std::string text() const;

private:
  std::string version_;               // of rsc
  std::vector<std::string> results_;  // each a JSON object, as are these:
  std::vector<std::string> unchecked_;
};

}  // namespace robosync::compiler
