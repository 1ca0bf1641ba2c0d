#include "compiler/sema/statements.hpp"

#include <algorithm>
#include <utility>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/texts.hpp"

namespace robosync::compiler {
namespace {

// More than an image has room for.
constexpr std::size_t kMaxStatements = 4096;       // of a response
constexpr std::size_t kMaxAllStatements = 65'536;  // of a program
constexpr std::string_view kStop = "STOP";

Span first_word(Span span, std::string_view word) {
  span.end = std::min(span.end, span.begin + static_cast<std::uint32_t>(word.size()));
  return span;
}

}  // namespace

void Statements::begin_response() {
  statements_ = 0;
  locals_ = 0;
  depth_ = 0;
}

ir::Block Statements::response(const ast::Block& block) {
  begin_response();
  return this->block(block);
}

ir::Block Statements::safety(const ast::Block& block) {
  safety_ = true;
  ir::Block result = response(block);
  safety_ = false;
  return result;
}

ir::Block Statements::block(const ast::Block& block) {
  ir::Block result;
  if (!block.empty() && depth_ == vm::kMaxBlocks) {
    diagnostics_
        .report(Code::E0407, "blocks are nested more than " + std::to_string(vm::kMaxBlocks) +
                                 " levels deep, including those of DEFINEs")
        .label(block.front().span);
    return result;
  }
  ++depth_;
  for (const ast::Stmt& stmt : block)
    add(stmt, result);
  --depth_;
  return result;
}

void Statements::add(const ast::Stmt& stmt, ir::Block& result) {
  if (!within_budget(stmt.span) || (safety_ && !allowed_in_safety(stmt))) return;
  const ChooseNumber choose = [&](const NumberList& list, Typed index) {
    return choose_number(list, std::move(index), stmt.span, result);
  };
  const ChooseNumber* const outer = expressions_.set_choice(safety_ ? nullptr : &choose);
  std::visit([&](const auto& node) { add(node, stmt.span, result); }, stmt.node);
  expressions_.set_choice(outer);
}

bool Statements::within_budget(Span span) {
  ++statements_;
  ++all_;
  if (statements_ <= kMaxStatements && all_ <= kMaxAllStatements) return true;
  const bool first = statements_ == kMaxStatements + 1 || all_ == kMaxAllStatements + 1;
  const bool response = statements_ > kMaxStatements;
  if (first)
    diagnostics_
        .report(Code::E0407, "with all its DEFINEs, this " +
                                 std::string(response ? "response" : "program") +
                                 " has more than " +
                                 std::to_string(response ? kMaxStatements : kMaxAllStatements) +
                                 " statements, the most that rsc allows")
        .label(span, "from here on");
  return false;
}

// A DEFINE is allowed, because its statements are checked when it is expanded.
bool Statements::allowed_in_safety(const ast::Stmt& stmt) {
  const auto is = [&]<typename... Nodes>(std::variant<Nodes...>*) {
    return (std::holds_alternative<Nodes>(stmt.node) || ...);
  };
  using Allowed = std::variant<ast::Stop, ast::Log, ast::Set, ast::Signal, ast::Call>;
  if (is(static_cast<Allowed*>(nullptr))) return true;
  const auto* command = std::get_if<ast::Command>(&stmt.node);
  if (command != nullptr && is_restart(*command)) return true;
  if (command != nullptr && command->arguments.empty() &&
      (names_.find_define(command->verb.text) != nullptr ||
       expressions_.find_binding(command->verb.text) != nullptr))
    return true;
  diagnostics_.report(Code::E0404, "a SAFETY rule cannot do this")
      .label(stmt.span)
      .helps("it can STOP, ALERT, LOG, SET, SIGNAL and RESTART; let a BEHAVIOR do the rest");
  return false;
}

std::uint16_t Statements::line_of(Span span) const {
  constexpr FileId kProgram = 0;
  if (span.file != kProgram) return 0;
  const std::uint32_t line = sources_.file(span.file).position(span.begin).line;
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(line, UINT16_MAX));
}

void Statements::add(const ast::Command& node, Span span, ir::Block& result) {
  if (node.arguments.empty())
    if (const Binding* binding = expressions_.find_binding(node.verb.text))
      return run(*binding, node.verb, {}, span, result);
  if (node.arguments.empty())
    if (DefineName* define = names_.find_define(node.verb.text))
      return run(*define, {}, span, result);
  if (is_restart(node)) return restart(node, span, result);
  if (commands_.is_follow(node)) return follow(node, span, result);
  if (const auto choice = find_choice(node.arguments)) {
    const auto say = [&](const ChosenText& chosen, ir::Block& into) {
      for (ir::Command& command : commands_.translate(node, &chosen))
        put(std::move(command), span, into);
    };
    return choose(*choice, span, say, result);
  }
  for (ir::Command& command : commands_.translate(node)) {
    if (commands_.lacks_content(command, span) || commands_.gives_too_much(node, command)) return;
    commands_.note_no_amount(node, command);
    put(std::move(command), span, result);
  }
}

void Statements::add(const ast::Wait& node, Span span, ir::Block& result) {
  if (node.duration == nullptr) return;
  Typed duration = expressions_.duration(*node.duration, "WAIT");
  if (duration.is_number()) put(ir::Wait{std::move(duration.code)}, span, result);
}

// A condition that is evaluated repeatedly. Code put before the statement would run only once, so none is allowed.
Typed Statements::asked_again(const ast::Expr& condition) {
  const ChooseNumber* const choice = expressions_.set_choice(nullptr);
  Typed result = expressions_.condition(condition);
  expressions_.set_choice(choice);
  return result;
}

void Statements::add(const ast::WaitUntil& node, Span span, ir::Block& result) {
  if (node.condition == nullptr) return;
  if (const auto* time = std::get_if<ast::Quantity>(&node.condition->node)) {
    diagnostics_.report(Code::E0302, "`WAIT UNTIL` takes a condition, but this is a number")
        .label(node.condition->span)
        .helps("to wait for a time, write `WAIT " + std::string(time->digits) +
               std::string(time->unit.empty() ? "s" : time->unit) + "`");
    return;
  }
  ir::WaitUntil wait;
  Typed condition = asked_again(*node.condition);
  bool good = condition.type == Type::condition;
  wait.condition = std::move(condition.code);
  if (node.within != nullptr) {
    Typed within = expressions_.duration(*node.within, "WITHIN");
    good = good && within.is_number();
    wait.within = std::move(within.code);
  }
  if (good) put(std::move(wait), span, result);
}

void Statements::add(const ast::Then&, Span span, ir::Block& result) {
  put(ir::Then{}, span, result);
}

void Statements::add(const ast::Stop& node, Span span, ir::Block& result) {
  if (node.name)
    if (const Binding* binding = expressions_.find_binding(node.name->text))
      return stop_given(*binding, *node.name, span, result);
  if (safety_) return halt(node, span, result);
  if (node.name) return stop_actuator(*node.name, span, result);
  for (const ActuatorConfig& actuator : robot_.actuators)
    stop_actuator({actuator.name.text, first_word(span, kStop)}, span, result);
}

void Statements::stop_given(const Binding& binding, const ast::Name& name, Span span,
                            ir::Block& result) {
  const ast::Name actuator{binding.actuator, name.span};
  if (!actuator.text.empty())
    return safety_ ? halt({actuator}, span, result) : stop_actuator(actuator, span, result);
  if (!is_open(binding)) expressions_.report_given(binding, name, "an actuator");
}

// STOP is a word of the language; for one actuator it is also a verb.
void Statements::stop_actuator(const ast::Name& name, Span span, ir::Block& result) {
  if (!commands_.find_stopped(name)) return;
  ast::Command command;
  command.verb = {kStop, first_word(span, kStop)};
  ast::Argument& named = command.arguments.emplace_back();
  named.span = name.span;
  named.value = ast::Word{name};
  const Bindings* outer = expressions_.set_bindings(nullptr);  // a name here means an actuator
  for (ir::Command& stop : commands_.translate(command))
    put(std::move(stop), span, result);
  expressions_.set_bindings(outer);
}

void Statements::halt(const ast::Stop& node, Span span, ir::Block& result) {
  ir::Halt halt;
  if (node.name) {
    auto target = commands_.find_stopped(*node.name);
    if (!target) return;
    halt.group = target->group;
    halt.actuators = std::move(target->actuators);
  } else {
    halt.all = true;
    for (std::size_t i = 0; i < robot_.actuators.size(); ++i)
      halt.actuators.push_back(i);
  }
  put(std::move(halt), span, result);
}

// ---- IF, REPEAT and PICK ONE

namespace {

// Does the loop end on its own, or pause in every turn?
bool is_bounded(const ir::Repeat& loop) {
  const bool counted =
      loop.kind == ir::RepeatKind::times && loop.control.operation == Operation::constant;
  return counted || std::any_of(loop.body.begin(), loop.body.end(), ir::is_pause);
}

}  // namespace

// Each ELSE IF is an IF in the ELSE of the one before, so it is one level deeper.
std::size_t Statements::else_ifs_of(const ast::If& node) {
  std::size_t count = 0;
  for (const ast::If* last = &node; last->else_block.size() == 1; ++count) {
    last = std::get_if<ast::If>(&last->else_block.front().node);
    if (last == nullptr) break;
  }
  return count;
}

bool Statements::has_room_for(const ast::If& node, Span span) {
  const std::size_t room = vm::kMaxBlocks - std::min<std::size_t>(depth_ + 1, vm::kMaxBlocks);
  const std::size_t count = else_ifs_of(node);
  if (room == 0 || count <= room) return true;
  diagnostics_
      .report(Code::E0407, "this IF has " + std::to_string(count) + " ELSE IFs; " +
                               (depth_ > 1 ? "inside other blocks, " : "") +
                               "an IF can have at most " + std::to_string(room) +
                               (depth_ > 1 ? " here" : ""))
      .label(span)
      .helps(
          "split it: an IF with one half of them on its DO side and the other half on its ELSE "
          "side");
  return false;
}

void Statements::add(const ast::If& node, Span span, ir::Block& result) {
  if (!has_room_for(node, span)) return;
  ir::If choice;
  Typed condition = node.condition ? expressions_.condition(*node.condition) : Typed{};
  choice.condition = std::move(condition.code);
  choice.then_block = block(node.then_block);
  choice.else_block = block(node.else_block);
  if (condition.type == Type::condition) put(std::move(choice), span, result);
}

void Statements::add(const ast::Repeat& node, Span span, ir::Block& result) {
  ir::Repeat loop;
  const std::size_t errors = diagnostics_.errors();
  bool good = true;
  if (node.times != nullptr) {
    good = repeat_times(*node.times, loop);
  } else if (node.condition != nullptr) {
    loop.kind = ir::RepeatKind::while_;
    Typed condition = asked_again(*node.condition);
    good = condition.type == Type::condition;
    loop.control = std::move(condition.code);
  } else {
    loop.kind = ir::RepeatKind::forever;
  }
  loop.body = block(node.body);
  if (!good || diagnostics_.errors() > errors) return;  // the mistake may be in a WAIT
  if (!is_bounded(loop)) {
    diagnostics_.report(Code::E0403, "this loop never waits, so it would block the robot")
        .label({span.file, span.begin, node.body.empty() ? span.end : node.body.front().span.begin})
        .helps("put a WAIT, WAIT UNTIL or THEN in it, outside any IF");
    return;
  }
  put(std::move(loop), span, result);
}

bool Statements::repeat_times(const ast::Expr& times, ir::Repeat& result) {
  result.kind = ir::RepeatKind::times;
  Typed count =
      expressions_.amount(times, {&canonical_unit(vm::Dimension::number), "TIMES", times.span});
  if (!count.is_number()) return false;
  result.control = std::move(count.code);
  if (result.control.operation != Operation::constant) return true;
  const vm::Value value = result.control.constant;
  if (value > 0 && value % vm::kScale == 0) return true;
  diagnostics_
      .report(Code::E0509, value > 0 ? "TIMES must be a whole number" : "TIMES must be above 0")
      .label(times.span);
  return false;
}

void Statements::add(const ast::PickOne& node, Span span, ir::Block& result) {
  ir::Pick pick;
  std::int64_t sum = 0;
  bool good = true;
  const auto has_weight = [](const ast::Option& option) { return option.weight != nullptr; };
  const bool weighted = std::any_of(node.options.begin(), node.options.end(), has_weight);
  for (const ast::Option& option : node.options) {
    ir::Option made{vm::kScale, block(option.body)};
    if (option.weight != nullptr) {
      const auto value = weight(*option.weight);
      good = good && value;
      made.weight = value.value_or(vm::kScale);
    } else if (weighted) {
      diagnostics_.report(Code::E0509, "the other options have a weight, but this one has none")
          .label(option.span)
          .helps("give every option a weight, or none");
      good = false;
    }
    sum += made.weight;
    pick.options.push_back(std::move(made));
  }
  if (good && sum > vm::kValueMax)
    diagnostics_
        .report(Code::E0304, "the weights of these options add up to " +
                                 std::to_string(sum / vm::kScale) + "; the limit is " +
                                 std::to_string(vm::kValueMax / vm::kScale))
        .label(span);
  else if (good && !pick.options.empty())
    put(std::move(pick), span, result);
}

// A plain number or a percentage; only the ratios count.
std::optional<vm::Value> Statements::weight(const ast::Expr& expr) {
  const auto value = expressions_.constant(expr, "the weight of an OPTION");
  if (!value) return std::nullopt;
  const vm::Dimension dimension = value->dimension();
  if (dimension != vm::Dimension::number && dimension != vm::Dimension::percent) {
    diagnostics_
        .report(Code::E0301, "the weight of an OPTION is a percentage, but this is " +
                                 std::string(dimension_phrase(dimension)))
        .label(expr.span);
    return std::nullopt;
  }
  if (value->code.constant > 0) return value->code.constant;
  diagnostics_.report(Code::E0509, "the weight of an OPTION must be above 0").label(expr.span);
  return std::nullopt;
}

// ---- SET, RAISE, LOWER and SIGNAL

namespace {

// The words of `SET mood TO very happy`, which the grammar reads as a value.
std::optional<std::string> label_of(const ast::Expr& expr) {
  const auto* operand = std::get_if<ast::Operand>(&expr.node);
  if (operand == nullptr) return std::nullopt;
  std::string label(operand->name.text);
  if (operand->channel) label.append(" ").append(operand->channel->text);
  return label;
}

// Why it cannot be set; empty if it can.
std::string_view why_not(vm::VariableKind kind) {
  switch (kind) {
    case vm::VariableKind::band:
      return "it follows the value that it checks";
    case vm::VariableKind::signal:
      return "use SIGNAL to send it";
    case vm::VariableKind::timer:
      return "RESTART sets it back to 0";
    default:
      return "";
  }
}

}  // namespace

// A declaration for a variable that is set to `value`: a STATE if the value is a word that is not a name.
std::string Statements::declaration_of(const ast::Name& name, const ast::Expr* value) {
  const auto word = value != nullptr ? label_of(*value) : std::nullopt;
  if (!word || !names_.kind_of(*word).empty() || names_.find_sensor(*word))
    return "REMEMBER " + std::string(name.text) + " = 0";
  return "STATE " + std::string(name.text) + ": " + *word + ", …";
}

std::string Statements::how_to_change(const ast::Name& name) const {
  const auto target = names_.find_target(name.text);
  if (!target || target->actuators.empty()) return "only a REMEMBER, STATE or FEELING can be set";
  const ActuatorConfig& actuator = robot_.actuators[target->actuators.front()];
  return "an actuator takes commands: " + name.shown() + " knows " +
         list_names(verb_names(actuator));
}

// The variable that a statement may set; with `number`, one that it may calculate with.
VariableName* Statements::settable(const ast::Name& name, bool number, const ast::Expr* value) {
  if (name.text.empty()) return nullptr;
  VariableName* variable = names_.find_variable(name.text);
  if (expressions_.find_binding(name.text) != nullptr) {
    diagnostics_.report(Code::E0508, name.shown() + " is a parameter, which cannot be set")
        .label(name.span);
    return nullptr;
  }
  if (variable != nullptr && variable->taken) return nullptr;
  if (variable == nullptr) {
    const std::string kind = names_.kind_of(name.text);
    if (!kind.empty()) {
      diagnostics_.report(Code::E0508, name.shown() + " is " + kind + ", which cannot be set")
          .label(name.span)
          .helps(how_to_change(name));
      return nullptr;
    }
    Diagnostic& d = diagnostics_.report(Code::E0501, no_variable(name)).label(name.span);
    if (diagnostics_.may_search(names_.variables().size()))
      did_you_mean(d, name.span, name.text, names_.variable_names());
    if (d.help.empty()) d.helps("declare it at the top: `" + declaration_of(name, value) + "`");
    return nullptr;
  }
  if (const std::string_view why = why_not(variable->kind); !why.empty()) {
    diagnostics_
        .report(Code::E0508,
                name.shown() + " is " + names_.kind_of(name.text) + ", which cannot be set")
        .label(name.span)
        .helps(std::string(why));
    return nullptr;
  }
  if (!number || variable->kind != vm::VariableKind::state) return variable;
  diagnostics_.report(Code::E0508, name.shown() + " is a STATE, which cannot be raised or lowered")
      .label(name.span)
      .helps("write `SET " + std::string(name.text) + " TO " + variable->labels.front() + "`");
  return nullptr;
}

// Checks constants only; the robot limits other values at run time.
bool Statements::in_range(const VariableName& variable, const Typed& value) {
  if (!value.is_constant()) return true;
  const vm::Value number = value.code.constant;
  if (number >= variable.low && number <= variable.high) return true;
  diagnostics_
      .report(Code::E0509, variable.name.shown() + " goes from " +
                               format_value(variable.low, *variable.unit) + " to " +
                               format_value(variable.high, *variable.unit))
      .label(value.span, "outside that range")
      .label(variable.name.span, "its range", false);
  return false;
}

void Statements::add(const ast::Set& node, Span span, ir::Block& result) {
  VariableName* variable = settable(node.name, false, node.value.get());
  if (variable == nullptr || node.value == nullptr || !variable->ready) return;
  if (variable->kind == vm::VariableKind::state) return set_label(node, *variable, span, result);
  Typed value = expressions_.amount(
      *node.value, {variable->unit, std::string(node.name.text), variable->unit_span, false,
                    variable->kind == vm::VariableKind::plain});
  if (!value.is_number() || !in_range(*variable, value)) return;
  put(ir::Set{variable->index, std::move(value.code), false}, span, result);
}

void Statements::set_label(const ast::Set& node, const VariableName& variable, Span span,
                           ir::Block& result) {
  const auto label = label_of(*node.value);
  if (!label) {
    diagnostics_.report(Code::E0306, node.name.shown() + " is a word, but this is not")
        .label(node.value->span)
        .helps("it can be " + list_names(variable.labels, "or"));
    return;
  }
  const auto place =
      find_label(names_, variable.labels, {*label, node.value->span}, node.name.text, diagnostics_);
  if (place)
    put(ir::Set{variable.index, make_constant_code(label_value(*place)), false}, span, result);
}

void Statements::add(const ast::Raise& node, Span span, ir::Block& result) {
  VariableName* variable = settable(node.name, true);
  if (variable == nullptr || node.by == nullptr || !variable->ready) return;
  Typed by = expressions_.amount(
      *node.by,
      {variable->unit, node.lower ? "LOWER … BY" : "RAISE … BY", variable->unit_span, true});
  if (!by.is_number()) return;
  if (node.lower && by.is_constant())
    by.code.constant = -by.code.constant;
  else if (node.lower)
    by.code = make_unary(Operation::negate, std::move(by.code));
  put(ir::Set{variable->index, std::move(by.code), true}, span, result);
}

void Statements::add(const ast::Signal& node, Span span, ir::Block& result) {
  const VariableName* variable = names_.find_variable(node.name.text);
  const bool good = variable != nullptr && variable->kind == vm::VariableKind::signal;
  // Adds a thousandth; any change would do.
  if (good) put(ir::Set{variable->index, make_constant_code(1), true}, span, result);
}

// ---- RESTART

bool Statements::is_restart(const ast::Command& node) const {
  return same_name(node.verb.text, kRestart) && !names_.is_verb(kRestart);
}

// `RESTART idle TO 5s`
bool Statements::restarts_at(const ast::Command& node) {
  const ast::Word* const word =
      node.arguments.size() < 2 ? nullptr : plain_word(node.arguments.front());
  const VariableName* const timer =
      word != nullptr ? names_.find_variable(word->name.text) : nullptr;
  if (timer == nullptr || timer->kind != vm::VariableKind::timer) return false;
  const Span rest{word->name.span.file, word->name.span.end, node.arguments.back().span.end};
  diagnostics_.report(Code::E0513, "RESTART always sets a TIMER back to 0")
      .label({rest.file, node.arguments[1].span.begin, rest.end})
      .helps("write `RESTART " + std::string(word->name.text) + "`")
      .fix(rest, "", Applicability::likely);
  return true;
}

void Statements::restart(const ast::Command& node, Span span, ir::Block& result) {
  const auto* const word =
      node.arguments.size() == 1 ? std::get_if<ast::Word>(&node.arguments.front().value) : nullptr;
  const VariableName* const timer =
      word != nullptr ? names_.find_variable(word->name.text) : nullptr;
  if (timer != nullptr && timer->kind == vm::VariableKind::timer) {
    Expression now;
    now.operation = Operation::now;
    return put(ir::Set{timer->index, std::move(now), false}, span, result);
  }
  if (restarts_at(node)) return;
  Diagnostic& d =
      diagnostics_.report(Code::E0513, "RESTART sets a TIMER back to 0, but this is not a TIMER")
          .label(word != nullptr ? word->name.span : span);
  std::vector<std::string> timers;
  for (const VariableName& one : names_.variables())
    if (one.kind == vm::VariableKind::timer) timers.emplace_back(one.name.text);
  // Not certain: the TIMER's declaration may be the misspelt one, and conditions use the name, too.
  if (word != nullptr && did_you_mean(d, word->name.span, word->name.text, timers))
    d.fixes.back().applicability = Applicability::likely;
  if (d.help.empty())
    d.helps(timers.empty() ? "declare it at the top: `TIMER idle`"
                           : "TIMERs: " + list_names(timers));
}

// ---- LOG and ALERT

void Statements::add(const ast::Log& node, Span span, ir::Block& result) {
  const auto choice = find_choice(node.arguments);
  if (!choice) return put_log(node, nullptr, span, result);
  const auto log = [&](const ChosenText& chosen, ir::Block& into) {
    put_log(node, &chosen, span, into);
  };
  choose(*choice, span, log, result);
}

void Statements::put_log(const ast::Log& node, const ChosenText* chosen, Span span,
                         ir::Block& result) {
  constexpr auto kMaxValues = static_cast<std::size_t>(vm::Param::count_);
  TextBuilder text(expressions_, diagnostics_);
  bool good = true;
  for (std::size_t i = 0; i < node.arguments.size(); ++i)
    good = (chosen != nullptr && chosen->at == i ? text.add(chosen->text, chosen->span)
                                                 : text.add(node.arguments[i])) &&
           good;
  if (text.values().size() > kMaxValues) {
    diagnostics_
        .report(Code::E0407, std::string(node.alert ? "this ALERT" : "this LOG") + " has " +
                                 std::to_string(text.values().size()) + " values; the limit is " +
                                 std::to_string(kMaxValues))
        .label(span);
    return;
  }
  if (good) put(ir::Log{node.alert, text.text(), std::move(text.values())}, span, result);
}

}  // namespace robosync::compiler
