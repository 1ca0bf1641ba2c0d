// A program up to where the reference interpreter takes it over: parsed and analysed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/ir/program.hpp"
#include "compiler/modules.hpp"
#include "compiler/source/source_file.hpp"
#include "tests/oracles/rsl/interpreter.hpp"

namespace robosync::oracle {

class Analysed {
public:
  // Throws std::runtime_error with all messages where there is a mistake. `name` says where modules
  // are looked for.
  Analysed(const std::string& name, const std::string& rsl, const std::string& json);

  [[nodiscard]] const compiler::ir::Program& program() const { return program_; }
  [[nodiscard]] const compiler::Robot& robot() const { return robot_; }
  [[nodiscard]] compiler::ChannelRef channel(std::string_view sensor,
                                             std::string_view channel) const;

private:
  compiler::SourceMap sources_;
  compiler::Diagnostics diagnostics_;
  compiler::ast::Tree tree_;
  std::vector<compiler::Module> modules_;
  compiler::Robot robot_;
  compiler::ir::Program program_;
};

}  // namespace robosync::oracle
