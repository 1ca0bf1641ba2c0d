// Collects behaviours: their priorities from RSL and robot.json, the actuators they may command, their order.
#pragma once

#include <map>
#include <set>

#include "compiler/config/robot.hpp"
#include "compiler/ir/program.hpp"
#include "compiler/sema/names.hpp"

namespace robosync::compiler {

class Behaviors {
public:
  Behaviors(const Robot& robot, Diagnostics& diagnostics)
      : robot_(robot), configs_(index_of(robot.behaviors)), diagnostics_(diagnostics) {}

  void add(const ast::Behavior& behavior, std::vector<ir::Rule> rules);
  // Adds a rule outside a BEHAVIOR as its own behaviour, below all others unless it has a PRIORITY.
  void add_rule(ir::Rule rule, const std::optional<ast::Name>& priority, Span span);
  // Reports what can be checked only when all are known, and returns the behaviours, highest priority first.
  [[nodiscard]] std::vector<ir::Behavior> finish();

private:
  struct Numbered {
    int number = 0;
    Span span;           // where it is written
    bool in_rsl = true;  // else in robot.json
  };

  const BehaviorConfig* config_of(const ast::Behavior& behavior) const;
  std::optional<Numbered> priority_of(const ast::Behavior& behavior, const BehaviorConfig* config);
  std::optional<Numbered> written_priority(const ast::Name& digits);
  void claim(const Numbered& priority);
  void report_taken();
  [[nodiscard]] std::optional<int> next_free(int number) const;
  void check_action(const BehaviorConfig& config, const ir::Behavior& behavior, Span name);
  void check_count(Span span);
  void report_count();

  const Robot& robot_;
  NameIndex configs_;
  Diagnostics& diagnostics_;
  std::vector<ir::Behavior> behaviors_;
  std::set<std::string> names_;  // folded names of the behaviours added
  std::map<int, Span> priorities_;
  std::vector<std::pair<Numbered, Span>> taken_;  // a priority used again, and its first use
  std::int16_t next_unnumbered_ = 0;
  std::optional<Span> one_too_many_;
};

}  // namespace robosync::compiler
