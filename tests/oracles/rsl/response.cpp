#include "tests/oracles/rsl/response.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <utility>

#include "compiler/ir/walk.hpp"

namespace robosync::oracle {

Sight Response::sight(const Surroundings& around) const {
  return {around.snapshot, &output_.seen, &locals_, &around.chance};
}

Number Response::number(const compiler::Expression& expression) const {
  return around_->evaluator.number(expression, sight(*around_));
}

Truth Response::truth(const compiler::Expression& expression) const {
  return around_->evaluator.truth(expression, sight(*around_));
}

// ---- the walk

bool Response::may_go_on(const Surroundings& around) {
  if (around.now <= paused_at_) return false;  // "Every wait takes at least until the next step."
  if (pause_ == Pause::follow) return true;    // "in each step"
  if (pause_ == Pause::commands)
    return around.commands_done && around.now >= waits_since_ + kLeastPause;
  const bool over = until_ && around.now >= *until_;
  if (pause_ == Pause::time) return over;
  const bool holds = over || around.evaluator.truth(*condition_, sight(around)) == true;
  return holds && !comes_too_soon(around.now);
}

// "It goes on then, even if the condition no longer holds."
bool Response::comes_too_soon(Millis now) {
  if (now >= waits_since_ + kLeastPause) return false;
  pause_ = Pause::time;
  until_ = waits_since_ + kLeastPause;
  came_too_soon_ = true;
  return true;
}

std::optional<Millis> Response::wait_ends() const {
  if (pause_ == Pause::commands) return waits_since_ + kLeastPause;
  return pause_ == Pause::time ? until_ : std::nullopt;
}

Output Response::run(const Surroundings& around) {
  around_ = &around;
  follows_on_ = false;
  if (pause_ == Pause::follow) places_.push_back({&follow_->body, 0, nullptr, 0, true});
  pause_ = Pause::none;
  output_ = {};
  sums_.clear();
  while (!places_.empty() && pause_ == Pause::none) {
    Place& place = places_.back();
    if (place.next == place.block->size()) {
      leave_block();
      continue;
    }
    const compiler::ir::Statement& statement = (*place.block)[place.next++];
    std::visit([this](const auto& node) { run(node); }, statement.node);
  }
  // What stands behind a pause is nothing if all blocks are at their end.
  return std::exchange(output_, {});
}

void Response::leave_block() {
  Place& place = places_.back();
  bool again = false;
  if (place.follow && !(until_ && around_->now >= *until_)) {
    pause_ = Pause::follow;
    paused_at_ = around_->now;
    follows_on_ = true;
  } else if (place.follow && comes_too_soon(around_->now)) {
    follows_on_ = true;  // nobody hears that it is over
  }
  if (place.loop != nullptr) switch (place.loop->kind) {
      case compiler::ir::RepeatKind::times:
        again = --place.rounds > 0;
        break;
      case compiler::ir::RepeatKind::while_:
        again = truth(place.loop->control) == true;
        break;
      case compiler::ir::RepeatKind::forever:
        again = true;
        break;
    }
  if (again)
    place.next = 0;
  else
    places_.pop_back();
}

void Response::pause(Pause why, Number duration) {
  pause_ = why;
  came_too_soon_ = false;
  paused_at_ = around_->now;
  waits_since_ = around_->now;
  until_.reset();
  if (why == Pause::time) until_ = around_->now + std::max<Millis>(duration.value_or(0), 0);
}

// ---- statements

void Response::run(const compiler::ir::Command& node) {
  Order order{rule_, &node, {}};
  for (const compiler::ir::Argument& argument : node.arguments)
    order.given.emplace_back(argument.param, number(argument.value));
  output_.effects.emplace_back(Commanded{node.actuators, std::move(order)});
}

void Response::run(const compiler::ir::Local& node) {
  locals_[node.number] = number(node.value);
}

void Response::run(const compiler::ir::Set& node) {
  const Number given = number(node.value);
  if (!given) return;
  Change& change = output_.changes[node.variable];
  const compiler::ir::Variable& variable = around_->variables[node.variable];
  const Number before = around_->snapshot.variables[node.variable];
  Number& sum = sums_.emplace(node.variable, before).first->second;
  sum = node.relative ? add(sum, given) : Number(clamped(variable, *given));
  output_.seen[node.variable] = clamped(variable, *sum);
  if (!node.relative || change.set)
    change = {sum, 0};
  else  // what counts is the difference that it made
    change.raise = *subtract(sum, before);
}

void Response::run(const compiler::ir::Wait& node) {
  pause(Pause::time, number(node.duration));
}

void Response::run(const compiler::ir::WaitUntil& node) {
  const Number within = node.within ? number(*node.within) : std::nullopt;
  pause(Pause::condition, std::nullopt);
  condition_ = &node.condition;
  if (node.within) until_ = around_->now + std::max<Millis>(within.value_or(0), 0);
}

// "Brought up to date in each step", from the next one on, "until FOR is over".
void Response::run(const compiler::ir::Follow& node) {
  const Number lasts = node.lasts ? number(*node.lasts) : std::nullopt;
  pause(Pause::follow, std::nullopt);
  follow_ = &node;
  if (node.lasts) until_ = around_->now + std::max<Millis>(lasts.value_or(0), 0);
}

void Response::run(const compiler::ir::Then&) {
  pause(Pause::commands, std::nullopt);
}

void Response::run(const compiler::ir::If& node) {
  const Truth side = truth(node.condition);
  if (side) enter(*side ? node.then_block : node.else_block);
}

void Response::run(const compiler::ir::Repeat& node) {
  std::int64_t rounds = 0;
  if (node.kind == compiler::ir::RepeatKind::times) {
    rounds = (number(node.control).value_or(0) + 999) / 1000;
    if (rounds < 1) return;
  }
  if (node.kind == compiler::ir::RepeatKind::while_ && truth(node.control) != true) return;
  places_.push_back({&node.body, 0, &node, rounds, false});
}

void Response::run(const compiler::ir::Pick& node) {
  std::int64_t sum = 0;
  for (const compiler::ir::Option& option : node.options)
    sum += option.weight;
  std::int64_t drawn = node.options.size() > 1 ? *around_->chance.draw(0, sum - 1) : 0;
  for (const compiler::ir::Option& option : node.options) {
    if (drawn < option.weight) return enter(option.body);
    drawn -= option.weight;
  }
}

void Response::run(const compiler::ir::Log& node) {
  std::vector<Number> values;
  for (const compiler::Expression& value : node.values)
    values.push_back(number(value));
  output_.effects.emplace_back(Said{node.alert, node.text, std::move(values)});
}

void Response::run(const compiler::ir::Halt&) {}  // of SAFETY rules, which have no responses

// ---- about blocks

std::set<std::size_t> actuators_of(const compiler::ir::Block& block) {
  std::set<std::size_t> result;
  compiler::for_each_statement(block, [&](const compiler::ir::Statement& statement) {
    if (const auto* command = std::get_if<compiler::ir::Command>(&statement.node))
      result.insert(command->actuators.begin(), command->actuators.end());
    if (const auto* halt = std::get_if<compiler::ir::Halt>(&statement.node))
      result.insert(halt->actuators.begin(), halt->actuators.end());
  });
  return result;
}

void for_each_condition(const compiler::ir::Block& block,
                        const std::function<void(const compiler::Expression&)>& visit) {
  compiler::for_each_statement(block, [&](const compiler::ir::Statement& statement) {
    if (const auto* choice = std::get_if<compiler::ir::If>(&statement.node))
      visit(choice->condition);
    if (const auto* wait = std::get_if<compiler::ir::WaitUntil>(&statement.node))
      visit(wait->condition);
    if (const auto* loop = std::get_if<compiler::ir::Repeat>(&statement.node))
      if (loop->kind == compiler::ir::RepeatKind::while_) visit(loop->control);
  });
}

namespace {

// Thousandths of the dimension's own unit in one of these; what no drawn program writes is left out.
const std::map<std::string, std::int64_t> kUnits = {
    {"", 1000},  {"mm", 1000},  {"cm", 10'000}, {"m", 1'000'000}, {"ms", 1},
    {"s", 1000}, {"deg", 1000}, {"%", 1000},    {"C", 1000},      {"min", 60'000}};

// "Without needless zeros", rounded to a thousandth of the unit.
std::string shown(const Number& value, const std::string& unit) {
  if (!value) return "unknown";
  const std::int64_t size = std::abs(*value) * 1000;
  const std::int64_t rounded = (size + kUnits.at(unit) / 2) / kUnits.at(unit);
  std::string text = (*value < 0 ? "-" : "") + std::to_string(rounded / 1000) + "." +
                     std::to_string(1000 + rounded % 1000).substr(1);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + unit;
}

// `words`: "|calm|happy".
std::string shown_word(const Number& value, const std::string& words) {
  if (!value) return "unknown";
  std::istringstream rest(words.substr(1));
  std::string word;
  for (auto left = *value / 1000; left >= 0; --left)
    std::getline(rest, word, '|');
  return word;
}

}  // namespace

// A place is a unit in curly brackets.
std::string filled_in(const std::string& text, const std::vector<Number>& values) {
  std::string result = text;
  std::size_t from = 0;
  for (const Number& value : values) {
    const std::size_t begin = result.find('{', from);
    const std::size_t end = result.find('}', from);
    if (begin == std::string::npos || end == std::string::npos) break;
    const std::string what = result.substr(begin + 1, end - begin - 1);
    const std::string written =
        what.starts_with('|') ? shown_word(value, what) : shown(value, what);
    result.replace(begin, end + 1 - begin, written);
    from = begin + written.size();
  }
  return result;
}

}  // namespace robosync::oracle
