// For each behaviour: emits the code of its rules, then lays out the frame that the code needs, then writes the records.
#include "compiler/codegen/rules.hpp"

#include <algorithm>
#include <set>

#include "compiler/codegen/expression_emitter.hpp"
#include "compiler/codegen/response_emitter.hpp"
#include "compiler/ir/walk.hpp"

namespace robosync::compiler {
namespace {

// A rule whose code has been emitted; the record lacks only the place of the code.
struct RuleDraft {
  vm::Rule record{};
  Span span;
  std::optional<CodeDraft> condition;
  std::optional<ResponseCode> then_response, else_response;
};

// The variables whose new value must be clamped on the robot.
void find_clamped(const ir::Block& block, std::set<std::size_t>& clamped) {
  for_each_of<ir::Set>(block, [&](const ir::Set& set) {
    if (needs_clamping(set)) clamped.insert(set.variable);
  });
}

Source source_of(const ir::Rule& rule) {
  return {rule.line, rule.span};
}

CodeDraft make_condition(Parts& parts, const Expression& expression, vm::RuleKind kind,
                         const Source& source, const LocalCells& locals) {
  CodeDraft code;
  code.mark(source);
  ExpressionEmitter emitter(parts, code, TimeWords::evaluated);
  emitter.locals() = locals;
  const Cell result = emitter.condition(expression);
  const bool number = kind == vm::RuleKind::every;
  code.emit(number ? vm::Opcode::ret_number : vm::Opcode::ret, result);
  return code;
}

RuleDraft draft_without_response(Parts& parts, const Expression& condition, vm::RuleKind kind,
                                 const Source& source, const LocalCells& locals) {
  RuleDraft draft;
  draft.span = source.span;
  draft.record.line = source.line;
  draft.record.kind = kind;
  draft.record.modifiers = vm::kNoModifiers;
  draft.condition = make_condition(parts, condition, kind, source, locals);
  return draft;
}

// Makes inputs of everything that a rule reads or sets.
class Listener {
public:
  explicit Listener(Parts& parts) : parts_(parts) {}

  void listen(const ir::Rule& rule) {
    listen(rule.condition);
    if (rule.resume) listen(*rule.resume);
    listen(rule.then_response);
    listen(rule.else_response);
  }

private:
  void listen(const Expression& expression) {
    if (expression.operation == Operation::input)
      (void)parts_.frame.read(parts_.tables.input(expression.channel));
    if (expression.operation == Operation::variable)
      (void)parts_.frame.read(parts_.tables.variable(expression.index));
    for (const Expression& operand : expression.operands)
      listen(operand);
  }
  void listen(const ir::Block& block) {
    for_each_statement(block, [this](const ir::Statement& statement) {
      if (const auto* set = std::get_if<ir::Set>(&statement.node))
        (void)parts_.frame.read(parts_.tables.variable(set->variable));
      for_each_expression(statement, [this](const Expression& expression) { listen(expression); });
    });
  }

  Parts& parts_;
};

class RuleWriter {
public:
  RuleWriter(const ir::Program& program, const ir::Program& written, const Tables& tables,
             Strings& strings, Diagnostics& diagnostics)
      : program_(program),
        written_(written),
        tables_(tables),
        strings_(strings),
        diagnostics_(diagnostics) {}

  RuleSections write() {
    reserve_limits();
    if (!program_.safety.empty()) add({vm::kSafetyPriority, {}, program_.safety}, written_.safety);
    for (std::size_t i = 0; i < program_.behaviors.size(); ++i)
      if (!program_.behaviors[i].rules.empty())
        add(program_.behaviors[i], written_.behaviors[i].rules);
    return std::move(sections_);
  }

private:
  void reserve_limits();
  void add(const ir::Behavior& behavior, const std::vector<ir::Rule>& written);
  std::vector<RuleDraft> make_drafts(Parts& parts, const ir::Behavior& behavior);
  RuleDraft draft(Parts& parts, const ir::Rule& rule);
  std::uint8_t modifiers(const ir::Rule& rule);
  static std::string title(const ir::Behavior& behavior);  // for a behaviour with rules
  bool fits(const Parts& parts, const ir::Behavior& behavior, std::size_t rules);
  void add(RuleDraft& draft, const Frame& frame, std::uint32_t& actuators);
  std::uint16_t add(const ResponseCode& response, const Frame& frame);

  const ir::Program& program_;
  const ir::Program& written_;
  const Tables& tables_;
  Strings& strings_;
  Diagnostics& diagnostics_;
  RuleSections sections_;
};

// min_k and max_k reach only the first constants, so the limits that they need are added first.
void RuleWriter::reserve_limits() {
  std::set<std::size_t> clamped;
  for_each_rule(program_, [&](const ir::Rule& rule) {
    for_each_response(rule, [&](const ir::Block& block) { find_clamped(block, clamped); });
  });
  for (const std::size_t place : clamped) {
    const ir::Variable& variable = program_.variables[place];
    if (variable.min > vm::kValueMin) (void)sections_.pool.constant(variable.min);
    if (variable.max < vm::kValueMax) (void)sections_.pool.constant(variable.max);
  }
  const std::size_t limits = sections_.pool.constants().size();
  if (limits > kMaxConst8)
    diagnostics_
        .report(Code::E0407, "the variables that responses set have " + std::to_string(limits) +
                                 " different limits; the most is " + std::to_string(kMaxConst8))
        .label({});
}

void RuleWriter::add(const ir::Behavior& behavior, const std::vector<ir::Rule>& written) {
  Parts parts{program_, tables_, strings_, sections_.pool, sections_.timers, diagnostics_};
  for (const ir::Rule& rule : written)
    Listener(parts).listen(rule);
  std::vector<RuleDraft> drafts = make_drafts(parts, behavior);
  if (!fits(parts, behavior, drafts.size())) return;
  const std::vector<std::uint32_t> inputs = parts.frame.inputs();
  vm::Behavior record{};
  record.priority = behavior.priority;
  record.name = behavior.name.empty() ? vm::kNoIndex : strings_.offset(behavior.name);
  record.first_input = place_row(sections_.inputs, {inputs.begin(), inputs.end()});
  record.input_count = static_cast<std::uint8_t>(inputs.size());
  record.rule_count = static_cast<std::uint8_t>(drafts.size());
  record.first_rule = static_cast<std::uint16_t>(sections_.rules.size());
  record.locals = static_cast<std::uint8_t>(parts.frame.locals());
  record.cells = static_cast<std::uint8_t>(parts.frame.cells());
  for (RuleDraft& one : drafts)
    add(one, parts.frame, record.actuators);
  sections_.behaviors.push_back(record);
}

// The watch rules follow the others.
std::vector<RuleDraft> RuleWriter::make_drafts(Parts& parts, const ir::Behavior& behavior) {
  std::vector<RuleDraft> drafts;
  for (const ir::Rule& rule : behavior.rules) {
    drafts.push_back(draft(parts, rule));
    if (rule.resume)
      drafts.push_back(
          draft_without_response(parts, *rule.resume, vm::RuleKind::resume, source_of(rule), {}));
  }
  for (const Watch& watch : parts.watches)
    drafts.push_back(draft_without_response(parts, watch.time_word, vm::RuleKind::watch,
                                            watch.source, watch.locals));
  return drafts;
}

RuleDraft RuleWriter::draft(Parts& parts, const ir::Rule& rule) {
  RuleDraft draft;
  draft.span = rule.span;
  draft.record.line = rule.line;
  draft.record.kind = rule.kind;
  draft.record.modifiers = modifiers(rule);
  if (rule.kind != vm::RuleKind::start)
    draft.condition = make_condition(parts, rule.condition, rule.kind, source_of(rule), {});
  draft.then_response = emit_response(parts, rule.then_response);
  if (rule.kind == vm::RuleKind::when_else)
    draft.else_response = emit_response(parts, rule.else_response);
  return draft;
}

std::uint8_t RuleWriter::modifiers(const ir::Rule& rule) {
  if (rule.cooldown == 0 && rule.waiting == 0 && !rule.restarting) return vm::kNoModifiers;
  const vm::Modifiers wanted{
      rule.cooldown, rule.waiting, static_cast<std::uint8_t>(rule.restarting ? 1 : 0), {}};
  auto& all = sections_.modifiers;
  const auto same = std::find_if(all.begin(), all.end(), [&](const vm::Modifiers& one) {
    return one.cooldown == wanted.cooldown && one.waiting == wanted.waiting &&
           one.restarting == wanted.restarting;
  });
  const auto place = static_cast<std::uint8_t>(same - all.begin());
  if (same == all.end()) all.push_back(wanted);
  return place;
}

std::string RuleWriter::title(const ir::Behavior& behavior) {
  if (!behavior.name.empty()) return "the behaviour `" + behavior.name + "`";
  if (behavior.priority == vm::kSafetyPriority) return "all SAFETY rules together";
  return "the rule on line " + std::to_string(behavior.rules.front().line);
}

bool RuleWriter::fits(const Parts& parts, const ir::Behavior& behavior, std::size_t rules) {
  const auto check = [&](std::size_t count, std::size_t limit, const char* what) {
    if (count <= limit) return true;
    diagnostics_
        .report(Code::E0407, "for " + title(behavior) + " the robot needs " +
                                 std::to_string(count) + " " + what + "; the limit is " +
                                 std::to_string(limit))
        .label(behavior.rules.front().span);
    return false;
  };
  return check(parts.frame.cells(), vm::kMaxCells, "cells for its inputs and values") &&
         check(parts.frame.writable(), vm::kMaxWritable, "variables to set") &&
         check(rules, UINT8_MAX, "rules, those for time words in responses included");
}

void RuleWriter::add(RuleDraft& draft, const Frame& frame, std::uint32_t& actuators) {
  vm::Rule& record = draft.record;
  record.then_response = record.else_response = vm::kNoIndex;
  if (draft.condition) {
    const CodeObject object = frame.resolve(*draft.condition);
    record.condition_start = static_cast<std::uint16_t>(sections_.pool.add(object));
    record.condition_length = static_cast<std::uint16_t>(object.words.size());
  }
  if (draft.then_response) {
    record.then_response = add(*draft.then_response, frame);
    actuators |= draft.then_response->actuators;
  }
  if (draft.else_response) {
    record.else_response = add(*draft.else_response, frame);
    actuators |= draft.else_response->actuators;
  }
  sections_.rules.push_back(record);
  sections_.places.push_back(draft.span);
}

std::uint16_t RuleWriter::add(const ResponseCode& response, const Frame& frame) {
  const CodeObject object = frame.resolve(response.code);
  vm::Response record{};
  record.start = static_cast<std::uint16_t>(sections_.pool.add(object));
  record.length = static_cast<std::uint16_t>(object.words.size());
  record.actuators = response.actuators;
  auto& all = sections_.responses;
  const auto same = std::find_if(all.begin(), all.end(), [&](const vm::Response& other) {
    return other.start == record.start && other.length == record.length;
  });
  const auto place = static_cast<std::uint16_t>(same - all.begin());
  if (same == all.end()) all.push_back(record);
  return place;
}

}  // namespace

RuleSections make_rules(const ir::Program& program, const ir::Program& written,
                        const Tables& tables, Strings& strings, Diagnostics& diagnostics) {
  return RuleWriter(program, written, tables, strings, diagnostics).write();
}

}  // namespace robosync::compiler
