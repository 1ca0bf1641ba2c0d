// Diagnostics as SARIF 2.1.0, the format in which code hosts and editors read a checker's results.
#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

// One run of rsc over some programs.
class SarifLog {
public:
  explicit SarifLog(std::string version) : version_(std::move(version)) {}

  void add(const Diagnostics& diagnostics, const SourceMap& sources);
  // The log as one JSON object, with a newline.
  [[nodiscard]] std::string text() const;

private:
  std::string version_;               // of rsc
  std::vector<std::string> results_;  // each a JSON object
};

}  // namespace robosync::compiler
