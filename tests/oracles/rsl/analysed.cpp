#include "tests/oracles/rsl/analysed.hpp"

#include <stdexcept>

#include "compiler/config/robot_reader.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/sema/analyze.hpp"
#include "compiler/syntax/parser.hpp"

namespace robosync::oracle {

Analysed::Analysed(const std::string& name, const std::string& rsl, const std::string& json) {
  const compiler::FileId text = sources_.add(name, rsl);
  const compiler::FileId config = sources_.add("robot.json", json);
  const auto require_no_mistake = [this] {
    if (diagnostics_.errors() > 0)
      throw std::runtime_error(compiler::render_human(diagnostics_, sources_, false));
  };
  tree_ = compiler::parse(sources_, text, diagnostics_);
  modules_ = compiler::load_modules(tree_, sources_, {}, diagnostics_);
  auto robot = compiler::read_robot(sources_, config, diagnostics_);
  require_no_mistake();
  robot_ = std::move(robot.value());
  compiler::Trees trees{&tree_};
  for (const compiler::Module& module : modules_)
    trees.push_back(module.tree.get());
  program_ = compiler::analyze(trees, robot_, sources_, diagnostics_);
  require_no_mistake();
}

compiler::ChannelRef Analysed::channel(std::string_view sensor, std::string_view channel) const {
  for (std::size_t s = 0; s < robot_.sensors.size(); ++s) {
    if (robot_.sensors[s].name.text != sensor) continue;
    for (std::size_t c = 0; c < robot_.sensors[s].channels.size(); ++c)
      if (robot_.sensors[s].channels[c].name.text == channel) return {s, c};
  }
  throw std::runtime_error("no channel " + std::string(sensor) + " " + std::string(channel));
}

}  // namespace robosync::oracle
