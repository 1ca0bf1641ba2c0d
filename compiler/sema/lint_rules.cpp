// W0202, W0204, W0207: rules against each other, and against their own responses.
#include <algorithm>
#include <map>
#include <set>

#include "compiler/config/units.hpp"
#include "compiler/ir/walk.hpp"
#include "compiler/sema/implication.hpp"
#include "compiler/sema/lints.hpp"

namespace robosync::compiler {
namespace {

std::set<std::size_t> actuators_of(const ProgramRule& rule) {
  std::set<std::size_t> result;
  for_each_response(rule, [&](const ProgramBlock& block) {
    for_each_of<ProgramCommand>(block, [&](const ProgramCommand& command) {
      result.insert(command.actuators.begin(), command.actuators.end());
    });
  });
  return result;
}

// ---- W0202

// Does `higher` own its actuators whenever `lower` could begin?
bool always_before(const ProgramRule& higher, const ProgramRule& lower) {
  if (higher.cooldown != 0 || lower.waiting != 0) return false;
  if (lower.kind != vm::RuleKind::when && lower.kind != vm::RuleKind::while_) return false;
  if (higher.kind == vm::RuleKind::while_) return implies(lower.condition, higher.condition);
  // Two that begin in the same step; afterwards the lower one's moment is over.
  return higher.kind == vm::RuleKind::when && lower.kind == vm::RuleKind::when &&
         lower.cooldown == 0 && implies(lower.condition, higher.condition) &&
         implies(higher.condition, lower.condition);
}

struct Known {
  const ProgramRule* rule = nullptr;
  std::set<std::size_t> actuators;
};

// Pairs of rules that are looked at in one program; more than a robot's memory holds rules for.
constexpr std::size_t kMostPairs = 500'000;

bool share(const std::set<std::size_t>& a, const std::set<std::size_t>& b) {
  auto at_a = a.begin(), at_b = b.begin();
  while (at_a != a.end() && at_b != b.end()) {
    if (*at_a == *at_b) return true;
    ++(*at_a < *at_b ? at_a : at_b);
  }
  return false;
}

void lint_order(const LintInput& input) {
  std::vector<Known> higher;
  std::size_t pairs = 0;
  for (const ProgramBehavior& behavior : input.program.behaviors) {
    std::vector<Known> own;
    for (const ProgramRule& rule : behavior.rules) {
      pairs += higher.size();
      if (pairs > kMostPairs) return;
      Known known{&rule, actuators_of(rule)};
      const auto first = std::find_if(higher.begin(), higher.end(), [&](const Known& other) {
        return share(other.actuators, known.actuators) && always_before(*other.rule, rule);
      });
      if (first != higher.end())
        input.diagnostics
            .report(Code::W0202,
                    "this rule never runs: a more important one has its actuator "
                    "whenever it could")
            .label(rule.span)
            .label(first->rule->span, "this one", false);
      own.push_back(std::move(known));
    }
    std::move(own.begin(), own.end(), std::back_inserter(higher));
  }
}

// ---- W0204

// How long a response takes at least, in milliseconds: what it waits, and what its commands say.
class Duration {
public:
  std::int64_t of(const ProgramBlock& block) {
    add(block);
    return std::max(now_, latest());
  }

private:
  void add(const ProgramBlock& block) {
    for (const ProgramStatement& statement : block) {
      if (const auto* command = std::get_if<ProgramCommand>(&statement.node)) add(*command);
      if (const auto* wait = std::get_if<ProgramWait>(&statement.node))
        now_ += std::max<std::int64_t>(constant(wait->duration), 0);
      if (std::holds_alternative<ProgramThen>(statement.node)) now_ = std::max(now_, latest());
    }
  }

  void add(const ProgramCommand& command) {
    std::int64_t takes = 0;
    for (const ProgramArgument& argument : command.arguments)
      if (argument.param == vm::Param::over || argument.param == vm::Param::for_)
        takes = std::max<std::int64_t>(takes, constant(argument.value));
    for (const std::size_t actuator : command.actuators)
      busy_[actuator] = std::max(busy_[actuator], now_) + takes;
  }

  static std::int64_t constant(const Expression& expression) {
    return expression.operation == Operation::constant ? expression.constant : 0;
  }

  [[nodiscard]] std::int64_t latest() const {
    std::int64_t result = 0;
    for (const auto& [actuator, until] : busy_)
      result = std::max(result, until);
    return result;
  }

  std::int64_t now_ = 0;
  std::map<std::size_t, std::int64_t> busy_;
};

void lint_cooldown(const ProgramRule& rule, Diagnostics& diagnostics) {
  if (rule.cooldown == 0 || rule.restarting) return;
  const std::int64_t takes = Duration().of(rule.then_response);
  if (takes <= rule.cooldown) return;
  const Unit& second = canonical_unit(vm::Dimension::duration);
  diagnostics
      .report(Code::W0204, "the COOLDOWN is over before the response: it takes " +
                               format_value(takes, second) + ", the COOLDOWN " +
                               format_value(rule.cooldown, second))
      .label(rule.span)
      .helps("a COOLDOWN counts from the start of the response; make it longer than that");
}

// ---- W0207

bool never_ends(const ProgramRule& rule) {
  return std::any_of(rule.then_response.begin(), rule.then_response.end(),
                     [&](const ProgramStatement& statement) {
                       const auto* loop = std::get_if<ProgramRepeat>(&statement.node);
                       if (loop == nullptr) return false;
                       return loop->kind == RepeatKind::forever ||
                              (loop->kind == RepeatKind::while_ && loop->control == rule.condition);
                     });
}

void lint_level(const ProgramRule& rule, Diagnostics& diagnostics) {
  if (rule.kind != vm::RuleKind::when || !never_ends(rule)) return;
  diagnostics
      .report(Code::W0207,
              "this goes on whether the condition still holds or not: WHEN only starts it")
      .label(rule.span)
      .helps("WHILE repeats its response as long as the condition holds, and ends it then");
}

}  // namespace

void lint_rules(const LintInput& input) {
  lint_order(input);
  for (const ProgramBehavior& behavior : input.program.behaviors) {
    for (const ProgramRule& rule : behavior.rules) {
      lint_cooldown(rule, input.diagnostics);
      lint_level(rule, input.diagnostics);
    }
  }
}

}  // namespace robosync::compiler
