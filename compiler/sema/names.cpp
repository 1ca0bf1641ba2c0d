#include "compiler/sema/names.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/syntax/functions.hpp"
#include "compiler/syntax/walk.hpp"
#include "compiler/units/foreign_units.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {

// ---- lookup

namespace {

std::vector<std::string> channel_names(const SensorConfig& sensor) {
  std::vector<std::string> names;
  for (const ChannelConfig& channel : sensor.channels)
    names.push_back(channel.name.text);
  return names;
}

// Words of RSL where only a name is possible.
struct WordAsName {
  std::string_view word, help;
};
constexpr WordAsName kWordsAsNames[] = {
    {"START", "to act once at the beginning, write `AT START`"},
    {"RANDOM", "`RANDOM` takes two numbers: `RANDOM(1, 6)`"},
};

// `EVERY second DO`. One letter is more likely a name.
bool helps_with_unit(std::string_view word, Diagnostic& d) {
  const Unit* const known = find_unit(word);
  const std::string unit(known != nullptr ? known->spelling : unit_word(word));
  if (word.size() < 3 || unit.empty()) return false;
  d.helps("a unit follows a number: `1" + unit + "`");
  return true;
}

// A word of RSL, a verb or a function in the place of a sensor.
bool helps_with_other_word(const Names& names, const ast::Operand& operand, Diagnostic& d) {
  const std::string_view word = operand.name.text;
  if (!operand.channel) {
    const auto* const one = std::ranges::find_if(
        kWordsAsNames, [&](const WordAsName& known) { return same_name(known.word, word); });
    if (one != std::end(kWordsAsNames)) d.helps(std::string(one->help));
    return one != std::end(kWordsAsNames) || helps_with_unit(word, d);
  }
  const FunctionName* const function = find_function(word);
  if (names.is_verb(word))
    d.helps(operand.name.shown() + " is a verb: write each command on its own line");
  else if (function != nullptr)
    d.helps("write `" + std::string(function->name) + "(…)`: its number goes in brackets");
  else
    return false;
  return true;
}

vm::VariableKind remembered_as(const ast::Remember& variable) {
  return variable.kept ? vm::VariableKind::kept : vm::VariableKind::plain;
}

}  // namespace

bool Names::names_a_channel(std::string_view name) const {
  return sensors_.find(name).has_value() || channels_.find(name).has_value();
}

// The robot's names are looked up for every word of the program, so they are indexed.
void Names::index_robot() {
  for (const SensorConfig& sensor : robot_.sensors)
    for (const ChannelConfig& channel : sensor.channels)
      joined_.push_back(sensor.name.text + channel.name.text);
  for (std::size_t s = 0; s < robot_.sensors.size(); ++s) {
    own_channels_.push_back(index_of(robot_.sensors[s].channels));
    for (std::size_t c = 0; c < robot_.sensors[s].channels.size(); ++c) {
      channels_.add(joined_[channel_refs_.size()], channel_refs_.size());
      channel_refs_.push_back({s, c});
    }
  }
  for (const ActuatorConfig& actuator : robot_.actuators)
    for (const WordConfig& word : actuator.words)
      if (!word.text) words_.add(word.name, 0);
  for (std::size_t a = 0; a < robot_.actuators.size(); ++a)
    for (const VerbConfig& verb : robot_.actuators[a].verbs) {
      if (verbs_.add(verb.name, able_.size())) able_.emplace_back();
      std::vector<std::size_t>& able = able_[*verbs_.find(verb.name)];
      if (able.empty() || able.back() != a) able.push_back(a);
    }
}

std::optional<ChannelRef> Names::channel_of_sensor(std::size_t sensor,
                                                   const ast::Operand& operand) {
  const SensorConfig& config = robot_.sensors[sensor];
  if (!operand.channel) {
    if (config.channels.size() == 1) return ChannelRef{sensor, 0};
    diagnostics_.report(Code::E0501, config.name.shown() + " has several channels: say which")
        .label(operand.name.span)
        .helps("channels: " + list_names(channel_names(config)));
    return std::nullopt;
  }
  if (const auto channel = own_channels_[sensor].find(operand.channel->text))
    return ChannelRef{sensor, *channel};
  for (const ChannelConfig& channel : config.channels) {
    if (!find_label(channel.labels, operand.channel->text)) continue;
    const std::string shown =
        config.channels.size() == 1 ? config.name.text : config.name.text + " " + channel.name.text;
    const Span word = operand.channel->span;
    diagnostics_.report(Code::E0501, "`IS` is missing before " + operand.channel->shown())
        .label(word)
        .helps("write `" + shown + " IS " + std::string(operand.channel->text) + "`")
        .fix({word.file, operand.name.span.begin, word.end},
             shown + " IS " + std::string(operand.channel->text), Applicability::likely);
    return std::nullopt;
  }
  Diagnostic& d = diagnostics_
                      .report(Code::E0501, "the sensor " + config.name.shown() +
                                               " has no channel " + operand.channel->shown())
                      .label(operand.channel->span)
                      .label(config.name.span, "the sensor", false);
  if (!diagnostics_.may_search(config.channels.size())) return std::nullopt;
  const auto candidates = channel_names(config);
  did_you_mean(d, operand.channel->span, operand.channel->text, candidates);
  if (d.help.empty()) d.helps("channels: " + list_names(candidates));
  return std::nullopt;
}

std::optional<ChannelRef> Names::find_channel(const ast::Operand& operand) {
  if (operand.name.text.empty()) return std::nullopt;
  if (const auto sensor = sensors_.find(operand.name.text))
    return channel_of_sensor(*sensor, operand);
  if (const auto joined = operand.channel ? std::nullopt : channels_.find(operand.name.text))
    return channel_refs_[*joined];
  report_unknown(operand);
  return std::nullopt;
}

// compile() then drops the warning about the missing file.
bool Names::report_missing(const ast::Operand& operand) {
  for (const MissingModule& missing : robot_.missing) {
    if (!same_name(missing.name.text, operand.name.text)) continue;
    diagnostics_
        .report(Code::E0501, missing.name.shown() + " needs its module, the file " + missing.file)
        .label(operand.name.span)
        .label(missing.path, "this file does not exist", false)
        .helps(missing.help);
    return true;
  }
  return false;
}

// A name that is no sensor, but is something else, or shall be.
bool Names::report_known(const ast::Name& name) {
  if (find_variable(name.text) != nullptr || find_constant(name.text) != nullptr) {
    diagnostics_
        .report(Code::E0501,
                name.shown() + " is " + kind_of(name.text) + ", but a step of a TEST sets a sensor")
        .label(name.span)
        .helps("to check it, write `EXPECT THAT " + std::string(name.text) + " = …`");
    return true;
  }
  if (!set_.contains(fold_name(name.text))) return false;
  // The same message as for the SET: they become one.
  Diagnostic& d = diagnostics_.report(Code::E0501, no_variable(name)).label(name.span);
  if (diagnostics_.may_search(variables_.size()))
    did_you_mean(d, name.span, name.text, variable_names());
  if (d.help.empty())
    d.helps("declare it at the top: `REMEMBER " + std::string(name.text) + " = 0`");
  return true;
}

void Names::report_unknown(const ast::Operand& operand) {
  if (report_missing(operand)) return;
  if (!operand.channel && report_known(operand.name)) return;
  const std::string what = operand.channel ? "sensor " : "sensor, LET or variable called ";
  Diagnostic& d = diagnostics_.report(Code::E0501, "there is no " + what + operand.name.shown())
                      .label(operand.name.span);
  if (helps_with_other_word(*this, operand, d)) return;
  if (!operand.channel && help_with_word(d, operand.name)) return;
  const std::size_t most = joined_.size() + constants_.size() + variables_.size();
  if (!diagnostics_.may_search(robot_.sensors.size() + (operand.channel ? 0 : most))) return;
  if (help_with_sensor(d, operand.name) || help_with_parts(d, operand)) return;
  std::vector<std::string> candidates;
  for (const SensorConfig& sensor : robot_.sensors) {
    candidates.push_back(sensor.name.text);
    if (!operand.channel)
      for (const ChannelConfig& channel : sensor.channels)
        candidates.push_back(sensor.name.text + channel.name.text);
  }
  if (!operand.channel)
    for (const auto& [folded, constant] : constants_)
      candidates.emplace_back(constant.let->name.text);
  if (!operand.channel)
    for (std::string& name : variable_names())
      candidates.push_back(std::move(name));
  did_you_mean(d, operand.name.span, operand.name.text, candidates);
  if (!d.help.empty()) return;
  candidates.clear();
  for (const SensorConfig& sensor : robot_.sensors)
    candidates.push_back(sensor.name.text);
  if (!candidates.empty()) d.helps("sensors: " + list_names(candidates));
}

ConstantName* Names::find_constant(std::string_view name) {
  const auto found = constants_.find(fold_name(name));
  return found == constants_.end() ? nullptr : &found->second;
}

DefineName* Names::find_define(std::string_view name) {
  const auto found = defines_.find(fold_name(name));
  return found == defines_.end() ? nullptr : &found->second;
}

const ListName* Names::find_list(std::string_view name) const {
  const auto found = lists_.find(fold_name(name));
  return found == lists_.end() ? nullptr : &found->second;
}

std::vector<std::string> Names::list_names_given() const {
  std::vector<std::string> names;
  for (const auto& [folded, list] : lists_)
    names.emplace_back(list.list->name.text);
  return names;
}

MotionName* Names::find_motion(std::string_view name) {
  const auto found = motions_.find(fold_name(name));
  return found == motions_.end() ? nullptr : &found->second;
}

VariableName* Names::find_variable(std::string_view name) {
  const std::string folded = fold_name(name);
  if (scope_ != nullptr) {
    const Places& places = private_[scope_];
    if (const auto found = places.find(folded); found != places.end())
      return &variables_[found->second];
  }
  const auto found = globals_.find(folded);
  return found == globals_.end() ? nullptr : &variables_[found->second];
}

const ast::Behavior* Names::set_scope(const ast::Behavior* behavior) {
  return std::exchange(scope_, behavior);
}

std::string Names::kind_of(std::string_view name) {
  constexpr std::array<std::string_view, static_cast<std::size_t>(vm::VariableKind::count_)>
      kKinds = {"a REMEMBER", "a STATE", "a FEELING", "a signal",
                "a CHECK",    "a TIMER", "a REMEMBER"};
  if (const VariableName* variable = find_variable(name))
    return std::string(kKinds[static_cast<std::size_t>(variable->kind)]);
  if (find_constant(name) != nullptr) return "a LET";
  if (find_define(name) != nullptr) return "a DEFINE";
  if (find_list(name) != nullptr) return "a LIST";
  if (names_a_channel(name)) return "a sensor";
  if (find_target(name)) return "an actuator";
  return claimed_.contains(fold_name(name)) ? "the name of a block" : "";
}

std::optional<std::size_t> Names::find_sensor(std::string_view name) const {
  return sensors_.find(name);
}

std::optional<Target> Names::find_target(std::string_view name) const {
  if (const auto actuator = actuators_.find(name))
    return Target{std::nullopt, {*actuator}, robot_.actuators[*actuator].name.text};
  const auto group = groups_.find(name);
  if (!group) return std::nullopt;
  const GroupConfig& config = robot_.groups[*group];
  return Target{group, config.members, config.name.text};
}

bool Names::is_verb(std::string_view name) const {
  return verbs_.find(name).has_value();
}

bool Names::is_word(std::string_view name) const {
  return words_.find(name).has_value();
}

const std::vector<std::size_t>& Names::able_to(std::string_view verb) const {
  static const std::vector<std::size_t> nobody;
  const auto found = verbs_.find(verb);
  return found ? able_[*found] : nobody;
}

std::optional<std::size_t> Names::find_label(const std::vector<std::string>& labels,
                                             std::string_view label) {
  NameIndex& index = labels_[&labels];
  if (index.empty())
    for (std::size_t i = 0; i < labels.size(); ++i)
      index.add(labels[i], i);
  return index.find(label);
}

std::size_t Names::learn_label(ChannelRef ref, std::string_view label) {
  const std::vector<std::string>& labels = channel(ref).labels;
  std::size_t place = labels.size();
  for (const ir::LearnedWord& word : learned_)
    if (word.channel == ref) ++place;
  labels_[&labels].add(label, place);
  learned_.push_back({ref, std::string(label)});
  return place;
}

std::string Names::channel_name(ChannelRef ref) const {
  return sensor(ref).name.text + " " + channel(ref).name.text;
}

std::vector<std::string> Names::target_names() const {
  std::vector<std::string> names;
  for (const ActuatorConfig& actuator : robot_.actuators)
    names.push_back(actuator.name.text);
  for (const GroupConfig& group : robot_.groups)
    names.push_back(group.name.text);
  return names;
}

namespace {

// Empty: none is that device, or more than one.
template <typename Config>
const Config* only_one_that_is(std::string_view device, const std::vector<Config>& all) {
  const auto is_it = [&](const Config& one) {
    return same_name(one.device, device) || same_name(one.part, device);
  };
  const auto found = std::ranges::find_if(all, is_it);
  if (found == all.end() || std::any_of(found + 1, all.end(), is_it)) return nullptr;
  return &*found;
}

template <typename Config>
bool help_with_name(Diagnostic& d, const ast::Name& device, const std::vector<Config>& all) {
  const Config* const meant = only_one_that_is(device.text, all);
  if (meant == nullptr) return false;
  d.helps("this robot calls it `" + meant->name.text + "`")
      .fix(device.span, meant->name.text, Applicability::likely);
  return true;
}

}  // namespace

bool Names::help_with_sensor(Diagnostic& diagnostic, const ast::Name& device) const {
  return help_with_name(diagnostic, device, robot_.sensors);
}

bool Names::help_with_actuator(Diagnostic& diagnostic, const ast::Name& device) const {
  return help_with_name(diagnostic, device, robot_.actuators);
}

void Names::doubt_group(Diagnostic& diagnostic, std::string_view word) const {
  const auto is_in = [&](std::string_view name) {
    return fold_name(name).find(fold_name(word)) != std::string::npos;
  };
  for (Fix& fix : diagnostic.fixes) {
    const auto group = groups_.find(fix.replacement);
    if (!group) continue;
    const auto& members = robot_.groups[*group].members;
    const bool is_member = std::ranges::any_of(
        members, [&](std::size_t member) { return is_in(robot_.actuators[member].name.text); });
    const bool is_singular = fold_name(fix.replacement) == fold_name(word) + "s";
    if (is_member || is_singular) fix.applicability = Applicability::likely;
  }
}

std::vector<std::string> Names::verb_names() const {
  std::vector<std::string> names;
  std::set<std::string_view> seen;
  for (const ActuatorConfig& actuator : robot_.actuators)
    for (const VerbConfig& verb : actuator.verbs)
      if (seen.insert(verb.name).second) names.push_back(verb.name);
  return names;
}

std::vector<std::string> Names::motion_names() const {
  std::vector<std::string> names;
  for (const auto& [folded, motion] : motions_)
    names.emplace_back(motion.motion->name.text);
  return names;
}

std::vector<std::string> Names::define_names() const {
  std::vector<std::string> names;
  for (const auto& [folded, define] : defines_)
    names.emplace_back(define.define->name.text);
  return names;
}

std::vector<std::string> Names::variable_names() const {
  std::vector<std::string> names;
  for (const auto& [folded, place] : globals_)
    names.emplace_back(variables_[place].name.text);
  if (const auto own = private_.find(scope_); own != private_.end())
    for (const auto& [folded, place] : own->second)
      names.emplace_back(variables_[place].name.text);
  return names;
}

// ---- collecting the names of a program and its modules

Names::Names(const Trees& trees, const Robot& robot, Diagnostics& diagnostics)
    : robot_(robot),
      diagnostics_(diagnostics),
      sensors_(index_of(robot.sensors)),
      actuators_(index_of(robot.actuators)),
      groups_(index_of(robot.groups)) {
  index_robot();
  for (const ast::Tree* tree : trees) {
    in_module_ = tree != trees.front();
    collect(*tree);
  }
  // A signal is declared by its use, so explicit declarations come first.
  for (const ast::Tree* tree : trees) {
    in_module_ = tree != trees.front();
    collect_signals(*tree);
  }
  for (const auto& [behavior, places] : private_)
    for (const auto& [folded, place] : places)
      if (const auto first = claimed_.find(folded); first != claimed_.end())
        report_twice(variables_[place].name, first->second);
}

void Names::collect(const ast::Tree& tree) {
  for (const ast::Item& item : tree.items)
    std::visit([this](const auto& node) { add(node); }, item.node);
}

void Names::report_twice(const ast::Name& name, Span first) {
  Diagnostic& d = diagnostics_.report(Code::E0101, "the name " + name.shown() + " is given twice");
  const bool yours = name.span.file == kProgramFile;
  if (yours == (first.file == kProgramFile)) {
    d.label(name.span).label(first, "first given here", false);
    if (name.span.file != first.file)
      d.helps("use only one of the two modules, or rename it in a copy of one");
    return;
  }
  d.label(yours ? name.span : first)
      .label(yours ? first : name.span, "a module that you use has this name too", false)
      .helps("choose another name for yours");
}

// True if the name is new. An empty name was missing and has been reported.
bool Names::claim(const ast::Name& name) {
  if (name.text.empty()) return false;
  const auto [first, added] = claimed_.emplace(fold_name(name.text), name.span);
  if (!added) report_twice(name, first->second);
  return added;
}

// Like claim(), for a name that is used in the same places as a sensor's.
bool Names::claim_operand(const ast::Name& name) {
  if (!claim(name)) return false;
  if (names_a_channel(name.text))
    diagnostics_.report(Code::E0101, name.shown() + " is already a sensor of the robot")
        .label(name.span);
  return true;
}

void Names::add(const ast::Let& let) {
  if (claim_operand(let.name))
    constants_.emplace(fold_name(let.name.text), ConstantName{&let, in_module_});
}

void Names::add(const ast::Define& define) {
  check_parameters(define);
  if (!claim(define.name)) return;
  if (is_verb(define.name.text))
    diagnostics_.report(Code::E0101, define.name.shown() + " is already a verb of the robot")
        .label(define.name.span);
  defines_.emplace(fold_name(define.name.text), DefineName{&define, define.name.span, in_module_});
}

void Names::add(const ast::Motion& motion) {
  if (claim(motion.name))
    motions_.emplace(fold_name(motion.name.text), MotionName{&motion, in_module_});
}

void Names::check_parameters(const ast::Define& define) {
  std::map<std::string, Span> seen;
  for (const ast::Name& parameter : define.parameters) {
    const auto [first, added] = seen.emplace(fold_name(parameter.text), parameter.span);
    if (!added) report_twice(parameter, first->second);
  }
}

void Names::add(const ast::Behavior& behavior) {
  claim(behavior.name);
  Places& places = private_[&behavior];
  for (const ast::Remember& variable : behavior.variables) {
    if (variable.name.text.empty()) continue;
    const auto same = places.find(fold_name(variable.name.text));
    if (same != places.end()) {
      report_twice(variable.name, variables_[same->second].name.span);
      continue;
    }
    if (names_a_channel(variable.name.text))
      diagnostics_.report(Code::E0101, variable.name.shown() + " is already a sensor of the robot")
          .label(variable.name.span);
    VariableName named{variable.name, 0, &variable, remembered_as(variable), {}};
    add_variable(std::move(named), places);
  }
}

void Names::add_variable(VariableName variable, Places& places) {
  variable.index = variables_.size();
  variable.in_module = in_module_;
  variable.taken = !std::holds_alternative<std::monostate>(variable.declared) &&
                   names_a_channel(variable.name.text);
  places.emplace(fold_name(variable.name.text), variable.index);
  variables_.push_back(std::move(variable));
}

void Names::add(const ast::Remember& variable) {
  if (claim_operand(variable.name))
    add_variable({variable.name, 0, &variable, remembered_as(variable), {}}, globals_);
}

void Names::add(const ast::State& state) {
  if (!claim_operand(state.name)) return;
  VariableName variable{state.name, 0, &state, vm::VariableKind::state, {}};
  for (const ast::Name& label : state.labels)
    variable.labels.emplace_back(label.text);
  add_variable(std::move(variable), globals_);
}

void Names::add(const ast::Timer& timer) {
  if (claim_operand(timer.name))
    add_variable({timer.name, 0, &timer, vm::VariableKind::timer, {}}, globals_);
}

void Names::add(const ast::List& list) {
  if (!claim_operand(list.name)) return;
  ListName named{&list, {}, in_module_};
  named.numbers = !std::holds_alternative<ast::Text>(list.items.front().value);
  for (const ast::Argument& item : list.items) {
    const auto* text = std::get_if<ast::Text>(&item.value);
    if (!named.numbers) named.texts.emplace_back(text != nullptr ? text->text : std::string_view());
    if (named.numbers != (text == nullptr))
      diagnostics_.report(Code::E0306, "a LIST holds texts or numbers, not both")
          .label(item.span)
          .label(list.items.front().span, named.numbers ? "a number" : "a text", false);
  }
  lists_.emplace(fold_name(list.name.text), std::move(named));
}

void Names::add(const ast::Feeling& feeling) {
  if (claim_operand(feeling.name))
    add_variable({feeling.name, 0, &feeling, vm::VariableKind::feeling, {}}, globals_);
}

// `CHECK proximity OF DISTANCE`: the two words of a channel, split apart.
bool Names::tears_channel(const ast::Check& check) const {
  const auto* const operand =
      check.operand ? std::get_if<ast::Operand>(&check.operand->node) : nullptr;
  const auto sensor = find_sensor(check.name.text);
  return sensor && operand != nullptr && !operand->channel &&
         std::ranges::any_of(robot_.sensors[*sensor].channels, [&](const ChannelConfig& channel) {
           return same_name(channel.name.text, operand->name.text);
         });
}

void Names::add(const ast::Check& check) {
  if (tears_channel(check)) {
    const std::string sensor(check.name.text);
    const std::string channel(std::get<ast::Operand>(check.operand->node).name.text);
    diagnostics_
        .report(Code::E0101,
                "a CHECK needs a name of its own, but " + check.name.shown() + " is a sensor")
        .label(check.name.span)
        .helps("write `CHECK " + sensor + "_words OF " + sensor + " " + channel + "`");
    return;
  }
  if (!claim_operand(check.name)) return;
  VariableName variable{check.name, 0, &check, vm::VariableKind::band, {}};
  for (const ast::Band& band : check.bands)
    variable.labels.emplace_back(band.label.text);
  add_variable(std::move(variable), globals_);
}

// ---- signals

void Names::collect_signals(const ast::Tree& tree) {
  const auto add = [this](const ast::Block& block) { add_signals(block); };
  for (const ast::Item& item : tree.items) {
    if (const auto* define = std::get_if<ast::Define>(&item.node)) add(define->body);
    if (const auto* safety = std::get_if<ast::Safety>(&item.node)) add(safety->body);
    if (const auto* rule = std::get_if<ast::Rule>(&item.node)) for_each_block(*rule, add);
    if (const auto* behavior = std::get_if<ast::Behavior>(&item.node))
      for (const ast::Rule& rule : behavior->rules)
        for_each_block(rule, add);
  }
}

void Names::add_signals(const ast::Block& block) {
  for_each_statement(block, [this](const ast::Stmt& stmt) {
    if (const auto* signal = std::get_if<ast::Signal>(&stmt.node)) add_signal(signal->name);
    add_set(stmt);
    add_turns(stmt);
  });
}

void Names::add_set(const ast::Stmt& stmt) {
  if (const auto* set = std::get_if<ast::Set>(&stmt.node)) set_.insert(fold_name(set->name.text));
  if (const auto* raise = std::get_if<ast::Raise>(&stmt.node))
    set_.insert(fold_name(raise->name.text));
}

bool Names::is_set(const VariableName& variable) const {
  return set_.contains(fold_name(variable.name.text));
}

void Names::add_signal(const ast::Name& name) {
  const auto known = globals_.find(fold_name(name.text));
  const bool again =
      known != globals_.end() && variables_[known->second].kind == vm::VariableKind::signal;
  if (!again && claim_operand(name))
    add_variable({name, 0, {}, vm::VariableKind::signal, {}}, globals_);
}

// ---- the variables of ANY and NEXT

void Names::add_turns(const ast::Stmt& stmt) {
  if (lists_.empty()) return;
  const auto look = [this](const ast::Argument& argument) {
    const auto* amount = std::get_if<ast::Amount>(&argument.value);
    if (amount == nullptr || amount->value == nullptr) return;
    const auto* operand = std::get_if<ast::Operand>(&amount->value->node);
    if (operand != nullptr && operand->channel) add_turn(operand->name, *operand->channel);
  };
  if (const auto* log = std::get_if<ast::Log>(&stmt.node))
    for (const ast::Argument& argument : log->arguments)
      look(argument);
  if (const auto* call = std::get_if<ast::Call>(&stmt.node))
    for (const ast::Argument& argument : call->arguments)
      look(argument);
  const auto* command = std::get_if<ast::Command>(&stmt.node);
  for (std::size_t i = 0; command != nullptr && i < command->arguments.size(); ++i) {
    look(command->arguments[i]);
    if (i == 0) continue;
    const auto* how = std::get_if<ast::Word>(&command->arguments[i - 1].value);
    const auto* list = std::get_if<ast::Word>(&command->arguments[i].value);
    if (how != nullptr && list != nullptr) add_turn(how->name, list->name);
  }
}

void Names::add_turn(const ast::Name& how, const ast::Name& list) {
  const auto found = lists_.find(fold_name(list.text));
  const std::string folded = fold_name(how.text);
  if (found == lists_.end() || (folded != "any" && folded != "next")) return;
  ListName& named = found->second;
  std::optional<std::size_t>& place = folded == "any" ? named.any : named.next;
  if (place || named.numbers || named.count() < 2) return;
  place = variables_.size();
  made_names_.push_front((folded == "any" ? "ANY " : "NEXT ") + std::string(named.list->name.text));
  VariableName variable{{made_names_.front(), list.span}, *place, {}, vm::VariableKind::plain, {}};
  variable.unit = &canonical_unit(vm::Dimension::number);
  variable.in_module = in_module_;
  variables_.push_back(std::move(variable));
}

}  // namespace robosync::compiler
