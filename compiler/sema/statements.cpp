#include "compiler/sema/statements.hpp"

#include <algorithm>
#include <utility>

namespace robosync::compiler {
namespace {

// An image has room for fewer.
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

ProgramBlock Statements::response(const ast::Block& block) {
  begin_response();
  return this->block(block);
}

ProgramBlock Statements::safety(const ast::Block& block) {
  safety_ = true;
  ProgramBlock result = response(block);
  safety_ = false;
  return result;
}

ProgramBlock Statements::block(const ast::Block& block) {
  ProgramBlock result;
  if (!block.empty() && depth_ == vm::kMaxBlocks) {
    diagnostics_
        .report(Code::E0407, "blocks stand in each other more than " +
                                 std::to_string(vm::kMaxBlocks) +
                                 " levels deep, those of DEFINEs included")
        .label(block.front().span);
    return result;
  }
  ++depth_;
  for (const ast::Stmt& stmt : block)
    add(stmt, result);
  --depth_;
  return result;
}

void Statements::add(const ast::Stmt& stmt, ProgramBlock& result) {
  if (!within_budget(stmt.span) || (safety_ && !allowed_in_safety(stmt))) return;
  std::visit([&](const auto& node) { add(node, stmt.span, result); }, stmt.node);
}

bool Statements::within_budget(Span span) {
  ++statements_;
  ++all_;
  if (statements_ <= kMaxStatements && all_ <= kMaxAllStatements) return true;
  const bool first = statements_ == kMaxStatements + 1 || all_ == kMaxAllStatements + 1;
  if (first)
    diagnostics_
        .report(Code::E0407, statements_ > kMaxStatements
                                 ? "this response becomes too long with all its DEFINEs"
                                 : "this program becomes too long with all its DEFINEs")
        .label(span, "from here on");
  return false;
}

// DEFINEs are looked into, so they pass.
bool Statements::allowed_in_safety(const ast::Stmt& stmt) {
  const auto is = [&]<typename... Nodes>(std::variant<Nodes...>*) {
    return (std::holds_alternative<Nodes>(stmt.node) || ...);
  };
  using Allowed = std::variant<ast::Stop, ast::Alert, ast::Log, ast::Set, ast::Signal, ast::Call>;
  if (is(static_cast<Allowed*>(nullptr))) return true;
  const auto* command = std::get_if<ast::Command>(&stmt.node);
  if (command != nullptr && command->arguments.empty() &&
      names_.find_define(command->verb.text) != nullptr)
    return true;
  diagnostics_.report(Code::E0404, "a SAFETY rule cannot do this")
      .label(stmt.span)
      .helps("it can STOP, ALERT, LOG, SET and SIGNAL; let a BEHAVIOR do the rest");
  return false;
}

std::uint16_t Statements::line_of(Span span) const {
  constexpr FileId kProgram = 0;
  if (span.file != kProgram) return 0;
  const std::uint32_t line = sources_.file(span.file).position(span.begin).line;
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(line, UINT16_MAX));
}

void Statements::add(const ast::Command& node, Span span, ProgramBlock& result) {
  if (node.arguments.empty())
    if (DefineName* define = names_.find_define(node.verb.text))
      return run(*define, {}, span, result);
  for (ProgramCommand& command : commands_.translate(node))
    put(std::move(command), span, result);
}

void Statements::add(const ast::Wait& node, Span span, ProgramBlock& result) {
  if (node.duration == nullptr) return;
  Typed duration = expressions_.duration(*node.duration, "WAIT");
  if (duration.is_number()) put(ProgramWait{std::move(duration.code)}, span, result);
}

void Statements::add(const ast::WaitUntil& node, Span span, ProgramBlock& result) {
  if (node.condition == nullptr) return;
  ProgramWaitUntil wait;
  Typed condition = expressions_.condition(*node.condition);
  bool good = condition.type == Type::condition;
  wait.condition = std::move(condition.code);
  if (node.within != nullptr) {
    Typed within = expressions_.duration(*node.within, "WITHIN");
    good = good && within.is_number();
    wait.within = std::move(within.code);
  }
  if (good) put(std::move(wait), span, result);
}

void Statements::add(const ast::Then&, Span span, ProgramBlock& result) {
  put(ProgramThen{}, span, result);
}

void Statements::add(const ast::Stop& node, Span span, ProgramBlock& result) {
  if (safety_) return halt(node, span, result);
  if (node.name) return stop_actuator(*node.name, span, result);
  for (const ActuatorConfig& actuator : robot_.actuators)
    stop_actuator({actuator.name.text, first_word(span, kStop)}, span, result);
}

// STOP is a word of the language and, for one actuator, its verb.
void Statements::stop_actuator(const ast::Name& name, Span span, ProgramBlock& result) {
  if (!commands_.find_stopped(name)) return;
  ast::Command command;
  command.verb = {std::string(kStop), first_word(span, kStop)};
  command.arguments.push_back({name.span, ast::Preposition::none, ast::Word{name}});
  const Bindings* outer = expressions_.set_bindings(nullptr);  // a name here is an actuator's
  for (ProgramCommand& stop : commands_.translate(command))
    put(std::move(stop), span, result);
  expressions_.set_bindings(outer);
}

void Statements::halt(const ast::Stop& node, Span span, ProgramBlock& result) {
  ProgramHalt halt;
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

}  // namespace robosync::compiler
