// Where the scenarios of a robot, and the recordings that they play, say its sensors and channels (docs/scenario.md).
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "rsc/lsp/workspace.hpp"

namespace robosync::tool::lsp {

class Scenarios {
public:
  // Those beside this robot.json. None if there are several robots: it is not known whose they are.
  Scenarios(const Workspace& workspace, const std::filesystem::path& robot);

  [[nodiscard]] const compiler::SourceMap& sources() const { return sources_; }
  [[nodiscard]] std::vector<compiler::Span> sensor(std::string_view name) const;
  [[nodiscard]] std::vector<compiler::Span> channel(std::string_view sensor,
                                                    std::string_view name) const;

private:
  friend class ScenarioReader;
  // Empty spans: it is said elsewhere, or not at all.
  struct Said {
    std::string_view sensor_name;
    compiler::Span sensor{}, channel{};
  };

  compiler::SourceMap sources_;
  std::vector<Said> said_;
};

}  // namespace robosync::tool::lsp
