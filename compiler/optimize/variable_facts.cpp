// Iterates to a fixed point. At first a variable has only its initial value. Then all responses are followed repeatedly, each
// time with the values that they were found to write, until nothing is added. A range that has grown a few times is widened, so
// that the iteration ends.
//
// A response to AT START runs once. If it does not pause, it never sees its own earlier writes, so they do not feed back into it.
#include "compiler/optimize/variable_facts.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "compiler/ir/walk.hpp"
#include "compiler/optimize/flow.hpp"

namespace robosync::compiler {
namespace {

constexpr unsigned kPatience = 3;     // changes before a growing range is widened
constexpr unsigned kMaxChanges = 12;  // changes before it is widened to the variable's limits

// The values that a response writes to a variable.
struct WrittenFacts {
  std::optional<Fact> fact;
  unsigned changes = 0;
};

struct WritingResponse {  // a response and its writes
  ir::Block* block = nullptr;
  bool once = false;
  bool safety = false;
  std::vector<WrittenFacts> writes{};  // by variable
};

// The numbers of a program: growth often stops at one of them.
using Thresholds = std::set<vm::Value>;
const Thresholds kNoThresholds;

void add_numbers(const Expression& expression, Thresholds& thresholds) {
  if (expression.operation == Operation::constant && expression.constant != vm::kUnknown) {
    thresholds.insert(expression.constant);
    thresholds.insert(-expression.constant);
  }
  for (const Expression& operand : expression.operands)
    add_numbers(operand, thresholds);
}

void add_numbers(const ir::Block& block, Thresholds& thresholds) {
  for_each_statement(block, [&](const ir::Statement& statement) {
    for_each_expression(statement,
                        [&](const Expression& expression) { add_numbers(expression, thresholds); });
  });
}

// Widens `next` in the directions in which it has grown. `whole` is not affected, because sums that saturate are not whole.
Fact widened(const Fact& before, Fact next, const ir::Variable& variable,
             const Thresholds& thresholds) {
  if (next.low < before.low) {
    const auto above = thresholds.upper_bound(next.low);
    const vm::Value least = above == thresholds.begin() ? variable.min : *std::prev(above);
    next.low = std::max(least, variable.min);
  }
  if (next.high > before.high) {
    const auto most = thresholds.lower_bound(next.high);
    next.high = std::min(most == thresholds.end() ? variable.max : *most, variable.max);
  }
  return next;
}

class Prover {
public:
  Prover(ir::Program& program, const Robot& robot) : program_(program), robot_(robot) {
    for (ir::Rule& rule : program.safety)
      add(rule.then_response, false, true);
    for (ir::Behavior& behavior : program.behaviors)
      for (ir::Rule& rule : behavior.rules) {
        add(rule.then_response, rule.kind == vm::RuleKind::start, false);
        add(rule.else_response, false, false);
      }
    count_shifts();
    for (const WritingResponse& response : responses_)
      add_numbers(*response.block, thresholds_);
  }

  VariableFacts prove() {
    while (true) {
      VariableFacts anytime = without(nullptr);
      bool grew = false;
      for (WritingResponse& response : responses_)
        if (follow(response, anytime)) grew = true;
      if (!grew) return anytime;
    }
  }

private:
  void add(ir::Block& block, bool start, bool safety) {
    if (block.empty()) return;
    responses_.push_back({&block, start && !pauses(block), safety,
                          std::vector<WrittenFacts>(program_.variables.size())});
  }
  void count_shifts();
  bool follow(WritingResponse& response, const VariableFacts& anytime);
  [[nodiscard]] VariableFacts without(const WritingResponse* response) const;
  [[nodiscard]] Fact initial(std::size_t place) const;
  [[nodiscard]] Fact shifted(std::size_t place, const Fact& result, const Fact& difference) const;

  ir::Program& program_;
  const Robot& robot_;
  std::vector<WritingResponse> responses_;
  Thresholds thresholds_;
  std::vector<std::int64_t> shifts_;  // statements that RAISE or LOWER each variable
};

void Prover::count_shifts() {
  shifts_.resize(program_.variables.size());
  for (const WritingResponse& response : responses_)
    for_each_of<ir::Set>(std::as_const(*response.block), [&](const ir::Set& set) {
      if (set.relative) ++shifts_[set.variable];
    });
}

// A band is unknown if its input is, or between bands. A KEPT value may come from another program.
Fact Prover::initial(std::size_t place) const {
  const ir::Variable& variable = program_.variables[place];
  if (variable.kind == vm::VariableKind::band) return {false, true, 0, vm::kValueMax};
  if (variable.kind == vm::VariableKind::kept)
    return known_between(variable.min, variable.max, false);
  const Fact start = fact_of(variable.initial);
  if (variable.fade == 0) return start;
  Fact fading = either(start, fact_of(variable.fades_to));
  fading.whole = false;  // while it fades
  return fading;
}

// Several responses may add to the variable in the same step, whatever value each of them saw.
Fact Prover::shifted(std::size_t place, const Fact& result, const Fact& difference) const {
  const ir::Variable& variable = program_.variables[place];
  Fact sum = result;
  if (difference.low < 0) sum.low = variable.min;
  if (difference.high > 0) sum.high = variable.max;
  const std::int64_t most = (std::int64_t{variable.max} - variable.min) * (shifts_[place] + 1);
  const bool whole_limits =
      variable.min % vm::kScale == 0 && variable.max % vm::kScale == 0 && most <= vm::kValueMax;
  sum.whole = result.whole && difference.whole && whole_limits;
  return sum;
}

// The facts that hold after all responses. Leaves out the writes of `response`, which runs once; null: leaves out none.
VariableFacts Prover::without(const WritingResponse* response) const {
  VariableFacts facts;
  for (std::size_t i = 0; i < program_.variables.size(); ++i) {
    Fact fact = initial(i);
    for (const WritingResponse& other : responses_) {
      const bool counts = &other != response || shifts_[i] > 0;
      if (counts && other.writes[i].fact) fact = either(fact, *other.writes[i].fact);
    }
    if (program_.variables[i].fade != 0) fact.whole = false;
    facts.push_back(fact);
  }
  return facts;
}

// True if the response wrote more than before.
bool Prover::follow(WritingResponse& response, const VariableFacts& anytime) {
  Flow flow(program_, robot_, anytime);
  const VariableFacts entry = response.once ? without(&response) : anytime;
  const WriteFacts found = flow.follow(*response.block, entry, !response.safety);
  bool grew = false;
  for (std::size_t i = 0; i < anytime.size(); ++i) {
    if (!found.results[i]) continue;
    Fact next = *found.results[i];
    if (found.differences[i]) next = shifted(i, next, *found.differences[i]);
    auto& [before, changes] = response.writes[i];
    if (before) next = either(*before, next);
    if (before == next) continue;
    const bool last = ++changes > kMaxChanges;
    const Thresholds& stops = last ? kNoThresholds : thresholds_;
    if (before && changes > kPatience) next = widened(*before, next, program_.variables[i], stops);
    before = next;
    grew = true;
  }
  return grew;
}

}  // namespace

VariableFacts prove_variables(ir::Program& program, const Robot& robot) {
  return Prover(program, robot).prove();
}

}  // namespace robosync::compiler
