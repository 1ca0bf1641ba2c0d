// Resolves names; walk.cpp walks over the trees.
#include "compiler/query/collector.hpp"

#include <algorithm>

#include "compiler/syntax/functions.hpp"

namespace robosync::compiler::query {
namespace {

SymbolKind kind_of(const VariableName& variable) {
  switch (variable.kind) {
    case vm::VariableKind::state:
      return SymbolKind::state;
    case vm::VariableKind::feeling:
      return SymbolKind::feeling;
    case vm::VariableKind::signal:
      return SymbolKind::signal;
    case vm::VariableKind::band:
      return SymbolKind::check;
    case vm::VariableKind::timer:
      return SymbolKind::timer;
    default:
      return SymbolKind::remember;
  }
}

// The spans of a STATE's or CHECK's labels in its declaration.
std::vector<Span> places_of_labels(const VariableName& variable) {
  std::vector<Span> places;
  if (const auto* const* state = std::get_if<const ast::State*>(&variable.declared))
    for (const ast::Name& label : (*state)->labels)
      places.push_back(label.span);
  if (const auto* const* check = std::get_if<const ast::Check*>(&variable.declared))
    for (const ast::Band& band : (*check)->bands)
      places.push_back(band.label.span);
  return places;
}

}  // namespace

Collector::Collector(const Project& project)
    : project_(project), names_(project.trees, project.robot, ignored_) {}

void Collector::collect() {
  collect_robot();
  collect_references();
  for (const ast::Tree* tree : project_.trees)
    for (const ast::Item& one : tree->items)
      item(one);
  collect_behaviors();
}

// ---- symbols

std::size_t Collector::intern(Symbol symbol) {
  const Span place = symbol.declared.value_or(Span{});
  // One place may declare several symbols: an actuator and the words that come with its device.
  Key key{place.file, place.begin,
          std::to_string(static_cast<int>(symbol.kind)) + fold_name(symbol.name)};
  const auto [known, added] = known_.emplace(std::move(key), symbols.size());
  if (added) symbols.push_back(std::move(symbol));
  return known->second;
}

void Collector::declare(SymbolKind kind, const ast::Name& name, std::string_view within) {
  if (name.text.empty()) return;
  const std::size_t symbol =
      intern({kind, std::string(name.text), name.span, true, 0, 0, std::string(within)});
  occurrences.push_back({name.span, symbol, true});
}

void Collector::refer(const ast::Name& name, Symbol symbol) {
  if (name.text.empty()) return;
  occurrences.push_back({name.span, intern(std::move(symbol)), false});
}

void Collector::collect_robot() {
  const auto add = [this](SymbolKind kind, const Spelled& name, std::size_t owner,
                          std::size_t place = 0) {
    occurrences.push_back(
        {name.span, intern({kind, name.text, name.span, true, owner, place}), true});
  };
  const Robot& robot = project_.robot;
  for (std::size_t s = 0; s < robot.sensors.size(); ++s) {
    add(SymbolKind::sensor, robot.sensors[s].name, s);
    for (std::size_t c = 0; c < robot.sensors[s].channels.size(); ++c)
      add(SymbolKind::channel, robot.sensors[s].channels[c].name, s, c);
  }
  for (std::size_t a = 0; a < robot.actuators.size(); ++a)
    add(SymbolKind::actuator, robot.actuators[a].name, a);
  for (std::size_t g = 0; g < robot.groups.size(); ++g)
    add(SymbolKind::group, robot.groups[g].name, g);
}

void Collector::refer_to(SymbolKind kind, const Spelled& name, std::size_t owner, Span place) {
  occurrences.push_back({place, intern({kind, name.text, name.span, true, owner}), false});
}

// Names of parts in entries of other parts.
void Collector::collect_references() {
  const Robot& robot = project_.robot;
  // Where each is named, with its kind and its place in the robot.
  std::vector<std::tuple<Span, SymbolKind, std::size_t>> places;
  for (const SensorConfig& sensor : robot.sensors)
    if (sensor.algorithm)
      places.emplace_back(sensor.algorithm->input_span, SymbolKind::sensor,
                          sensor.algorithm->input);
  for (const ActuatorConfig& actuator : robot.actuators)
    for (std::size_t i = 0; actuator.encoders && i < actuator.encoders->size(); ++i)
      places.emplace_back(actuator.encoder_spans.at(i), SymbolKind::sensor,
                          actuator.encoders->at(i));
  for (const GroupConfig& group : robot.groups)
    for (std::size_t i = 0; i < group.member_spans.size(); ++i)
      places.emplace_back(group.member_spans[i], SymbolKind::actuator, group.members[i]);
  for (const BehaviorConfig& behavior : robot.behaviors) {
    if (behavior.action)
      places.emplace_back(behavior.action_span, SymbolKind::actuator, *behavior.action);
    if (behavior.action_group)
      places.emplace_back(behavior.action_span, SymbolKind::group, *behavior.action_group);
  }
  for (const auto& [place, kind, owner] : places)
    refer_to(kind,
             kind == SymbolKind::sensor     ? robot.sensors[owner].name
             : kind == SymbolKind::actuator ? robot.actuators[owner].name
                                            : robot.groups[owner].name,
             owner, place);
}

// robot.json may describe a BEHAVIOR, too, and uses its name there.
void Collector::collect_behaviors() {
  for (const BehaviorConfig& config : project_.robot.behaviors) {
    const auto same = [&](const Symbol& symbol) {
      return symbol.kind == SymbolKind::behavior && same_name(symbol.name, config.name.text);
    };
    const auto found = std::ranges::find_if(symbols, same);
    if (found == symbols.end()) continue;
    occurrences.push_back(
        {config.name.span, static_cast<std::size_t>(found - symbols.begin()), false});
  }
}

// ---- looking up

bool Collector::parameter(const ast::Name& name) {
  if (parameters_ == nullptr) return false;
  for (const ast::Name& known : *parameters_) {
    if (!same_name(known.text, name.text)) continue;
    refer(name, {SymbolKind::parameter, std::string(known.text), known.span, true, 0, 0,
                 std::string(within_)});
    return true;
  }
  return false;
}

bool Collector::constant(const ast::Name& name) {
  const ConstantName* const found = names_.find_constant(name.text);
  if (found == nullptr) return false;
  refer(name, {SymbolKind::let, std::string(found->let->name.text), found->let->name.span});
  return true;
}

bool Collector::variable(const ast::Name& name) {
  const VariableName* const found = names_.find_variable(name.text);
  if (found == nullptr) return false;
  refer(name, {kind_of(*found), std::string(found->name.text), found->name.span});
  return true;
}

bool Collector::list(const ast::Name& name) {
  if (parameter(name)) return true;
  const ListName* const found = names_.find_list(name.text);
  if (found == nullptr) return false;
  refer(name, {SymbolKind::list, std::string(found->list->name.text), found->list->name.span});
  return true;
}

bool Collector::motion(const ast::Name& name) {
  const MotionName* const found = names_.find_motion(name.text);
  if (found == nullptr) return false;
  refer(name,
        {SymbolKind::motion, std::string(found->motion->name.text), found->motion->name.span});
  return true;
}

bool Collector::define(const ast::Name& name) {
  const DefineName* const found = names_.find_define(name.text);
  if (found == nullptr) return false;
  refer(name, {SymbolKind::define, std::string(found->define->name.text), found->span});
  return true;
}

bool Collector::target(const ast::Name& name) {
  const auto found = names_.find_target(name.text);
  if (!found) return false;
  if (found->group) {
    const Spelled& group = project_.robot.groups[*found->group].name;
    refer(name, {SymbolKind::group, group.text, group.span, true, *found->group});
  } else {
    const std::size_t place = found->actuators.front();
    const Spelled& actuator = project_.robot.actuators[place].name;
    refer(name, {SymbolKind::actuator, actuator.text, actuator.span, true, place});
  }
  return true;
}

bool Collector::verb(const ast::Name& name) {
  const std::vector<std::size_t>& able = names_.able_to(name.text);
  if (able.empty()) return false;
  const ActuatorConfig& actuator = project_.robot.actuators[able.front()];
  refer(name, {SymbolKind::verb, actuator.find_verb(name.text)->name, actuator.name.span, false,
               able.front()});
  return true;
}

bool Collector::word(const ast::Name& name) {
  for (std::size_t a = 0; a < project_.robot.actuators.size(); ++a) {
    const ActuatorConfig& actuator = project_.robot.actuators[a];
    const WordConfig* const found = actuator.find_word(name.text);
    if (found == nullptr) continue;
    refer(name, {SymbolKind::word, found->name, actuator.name.span, false, a});
    return true;
  }
  return false;
}

bool Collector::function(const ast::Name& name) {
  const FunctionName* const found = find_function(name.text);
  if (found == nullptr) return false;
  refer(name, {SymbolKind::function, std::string(found->name), std::nullopt, false});
  return true;
}

void Collector::value(const ast::Name& name) {
  if (parameter(name) || variable(name) || constant(name) || list(name) || target(name)) return;
  word(name);
}

// `touch LEVEL`, `touchLevel`, `touch`, or a name.
void Collector::leaf(const ast::Operand& node) {
  const auto sensor = names_.find_sensor(node.name.text);
  if (!sensor && !node.channel && parameter(node.name)) return;
  if (!sensor && !node.channel && (variable(node.name) || constant(node.name))) return;
  if (sensor) {
    const Spelled& known = project_.robot.sensors[*sensor].name;
    refer(node.name, {SymbolKind::sensor, known.text, known.span, true, *sensor});
  }
  const auto channel = names_.find_channel(node);
  if (!channel) {
    if (!sensor) value(node.name);
    return;
  }
  const Spelled& known = names_.channel(*channel).name;
  const bool alone = known.span.begin == names_.sensor(*channel).name.span.begin;
  const Symbol symbol{SymbolKind::channel, known.text,      known.span, !alone,
                      channel->sensor,     channel->channel};
  if (node.channel) refer(*node.channel, symbol);
  if (!sensor) refer(node.name, symbol);
}

// ---- labels

Collector::Labels Collector::labels_of(const ast::Operand& operand) {
  if (const VariableName* const found =
          operand.channel ? nullptr : names_.find_variable(operand.name.text))
    return {found->labels, places_of_labels(*found), found->name.span,
            std::string(found->name.text)};
  const auto channel = names_.find_channel(operand);
  if (!channel) return {};
  return {names_.channel(*channel).labels,
          {},
          names_.channel(*channel).name.span,
          names_.channel_name(*channel)};
}

bool Collector::label(const Labels& labels, const ast::Name& name) {
  const auto found = std::ranges::find_if(
      labels.texts, [&](const std::string& text) { return same_name(text, name.text); });
  if (found == labels.texts.end()) return false;
  const auto place = static_cast<std::size_t>(found - labels.texts.begin());
  const bool is_there = place < labels.places.size();
  refer(name, {SymbolKind::label, *found, is_there ? labels.places[place] : labels.owner_place,
               is_there, 0, 0, labels.owner});
  return true;
}

void Collector::label_of(const ast::Expr* value, const ast::Name& name) {
  const auto* operand = value == nullptr ? nullptr : std::get_if<ast::Operand>(&value->node);
  if (operand != nullptr) label(labels_of(*operand), name);
}

void Collector::leaf(const ast::Is& node) {
  if (!node.is_string) label_of(node.value.get(), node.label);
}

}  // namespace robosync::compiler::query
