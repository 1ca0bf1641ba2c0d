#include "compiler/query/completion.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "compiler/query/describe.hpp"
#include "compiler/query/expected.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/syntax/functions.hpp"
#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler::query {
namespace {

using Set = std::initializer_list<SymbolKind>;
using K = SymbolKind;

class Completer {
public:
  Completer(const Project& project, const Symbols& symbols, const Expected& expected)
      : project_(project), symbols_(symbols), expected_(expected) {}

  std::vector<Candidate> run() {
    if (expected_.in_string) {
      texts();
      return std::move(result_);
    }
    if (expected_.takes(Kinds::NAME)) names();
    keywords();
    return std::move(result_);
  }

private:
  // ---- what comes before the cursor
  [[nodiscard]] TokenKind back(std::size_t places) const { return expected_.back(places); }
  [[nodiscard]] std::string_view text(const Token& token) const {
    return project_.sources.file(token.span.file).text(token.span);
  }
  [[nodiscard]] std::string_view word_back(std::size_t places) const {
    const Tokens& before = expected_.before;
    return places <= before.size() ? text(before[before.size() - places]) : std::string_view();
  }
  // The first token of the statement at the cursor.
  [[nodiscard]] std::size_t statement() const {
    const Tokens& before = expected_.before;
    std::size_t first = before.size();
    while (first > 0 && before[first - 1].kind != Kinds::NEWLINE &&
           (roles_of(before[first - 1].kind) & role::begins) == 0)
      --first;
    const auto is = [&](std::size_t at, TokenKind kind) {
      return at < before.size() && before[at].kind == kind;
    };
    if (is(first, Kinds::EXPECT)) ++first;
    if (is(first, Kinds::NO)) ++first;
    if (is(first, Kinds::QUANTITY) && is(first + 1, Kinds::TIMES)) first += 2;
    return first;
  }
  [[nodiscard]] bool in_brackets(std::size_t from) const {
    int open = 0;
    for (std::size_t at = from; at < expected_.before.size(); ++at) {
      if (expected_.before[at].kind == Kinds::OPEN) ++open;
      if (expected_.before[at].kind == Kinds::CLOSE) --open;
    }
    return open > 0;
  }

  // ---- adding
  void add(const Symbol& symbol) {
    if (!symbol.within.empty() && symbol.kind != K::label && !same_name(symbol.within, scope()))
      return;
    Description about = describe(symbol, project_);
    std::string detail = about.code.empty() ? about.kind : about.code;
    add({symbol.name, symbol.kind, std::move(detail), std::move(about.text), false});
  }
  void add(Candidate candidate) {
    const auto same = [&](const Candidate& known) { return known.text == candidate.text; };
    if (std::ranges::none_of(result_, same)) result_.push_back(std::move(candidate));
  }
  void declared(Set kinds) {
    for (const Symbol& symbol : symbols_.all())
      if (std::ranges::find(kinds, symbol.kind) != kinds.end()) add(symbol);
  }
  // The BEHAVIOR or DEFINE around the cursor.
  [[nodiscard]] std::string_view scope() const {
    const Tokens& before = expected_.before;
    const bool has =
        before.size() > 1 && is_one_of(before[0].kind, {Kinds::BEHAVIOR, Kinds::DEFINE});
    return has ? text(before[1]) : std::string_view();
  }

  void operands() {
    declared({K::sensor, K::let, K::remember, K::state, K::timer, K::feeling, K::check,
              K::parameter, K::list});
    for (const FunctionName& function : kFunctions)
      add({std::string(function.name), K::function, "a function of numbers", {}, false});
  }

  void channels(std::string_view name) {
    const auto& sensors = project_.robot.sensors;
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      if (!same_name(sensors[s].name.text, name)) continue;
      for (std::size_t c = 0; c < sensors[s].channels.size(); ++c) {
        const Symbol symbol{K::channel, sensors[s].channels[c].name.text, {}, true, s, c};
        Description about = describe(symbol, project_);
        add({symbol.name, K::channel, first_sentence(about.text), about.text, false});
      }
    }
  }
  static std::string first_sentence(const std::string& text) {
    return text.substr(0, text.find('\n'));
  }

  // The labels of the operand that ends this many tokens back.
  void labels(std::size_t places) {
    const bool is_channel = back(places + 1) == Kinds::NAME;
    const std::string_view name = word_back(is_channel ? places + 1 : places);
    const std::string_view channel = word_back(places);
    for (const Symbol& symbol : symbols_.all())
      if (symbol.kind == K::label && same_name(symbol.within, name)) add(symbol);
    for (const SensorConfig& sensor : project_.robot.sensors)
      for (const ChannelConfig& one : sensor.channels) {
        const bool meant =
            is_channel ? same_name(sensor.name.text, name) && same_name(one.name.text, channel)
                       : same_name(sensor.name.text + one.name.text, name) ||
                             (sensor.channels.size() == 1 && same_name(sensor.name.text, name));
        for (const std::string& label : one.labels)
          if (meant) add({label, K::label, "a word of " + sensor.name.text, {}, false});
      }
  }

  // ---- commands
  void verbs() {
    for (const ActuatorConfig& actuator : project_.robot.actuators)
      for (const VerbConfig& verb : actuator.verbs)
        add({verb.name, K::verb, "a verb", describe_verb(actuator, verb), false});
    declared({K::define});
    for (const char* const word : {"PERFORM", "FOLLOW", "RESTART"})
      add({word, K::verb, "a command", {}, false});
  }

  // The actuators that may be meant: the one that is already named, or else all that know the verb.
  [[nodiscard]] std::vector<const ActuatorConfig*> meant(std::size_t first, bool& named) const {
    const std::string_view verb = text(expected_.before[first]);
    std::vector<const ActuatorConfig*> able, told;
    for (const ActuatorConfig& actuator : project_.robot.actuators) {
      if (actuator.find_verb(verb) == nullptr) continue;
      able.push_back(&actuator);
      for (std::size_t at = first + 1; at < expected_.before.size(); ++at)
        if (is_named(actuator, text(expected_.before[at]))) told.push_back(&actuator);
    }
    named = !told.empty();
    return named ? told : able;
  }
  [[nodiscard]] bool is_named(const ActuatorConfig& actuator, std::string_view name) const {
    if (same_name(actuator.name.text, name)) return true;
    for (const GroupConfig& group : project_.robot.groups)
      if (same_name(group.name.text, name))
        return std::ranges::any_of(group.members, [&](std::size_t member) {
          return &project_.robot.actuators[member] == &actuator;
        });
    return false;
  }

  void in_command(std::size_t first) {
    const std::string_view verb = text(expected_.before[first]);
    if (ascii::same(verb, "PERFORM")) return declared({K::motion});
    if (ascii::same(verb, "RESTART")) return declared({K::timer});
    if (ascii::same(verb, "FOLLOW")) return targets();
    bool named = false;
    const auto actuators = meant(first, named);
    if (!named) add_able(actuators);
    for (const ActuatorConfig* actuator : actuators)
      for (const WordConfig& word : actuator->words)
        if (!word.text && actuator->find_verb(verb)->goes_with(word))
          add({word.name, K::word, "a word", describe_word(*actuator, word), false});
    declared({K::parameter});
  }
  void add_able(const std::vector<const ActuatorConfig*>& able) {
    for (const Symbol& symbol : symbols_.all()) {
      const auto knows = [&](const ActuatorConfig* actuator) {
        return is_named(*actuator, symbol.name);
      };
      const bool target = symbol.kind == K::actuator || symbol.kind == K::group;
      if (target && std::ranges::any_of(able, knows)) add(symbol);
    }
  }
  void targets() { declared({K::actuator, K::group, K::parameter}); }

  // The sounds that fit the command.
  void texts() {
    const std::size_t first = statement();
    if (first >= expected_.before.size() || expected_.before[first].kind != Kinds::NAME) return;
    bool named = false;
    for (const ActuatorConfig* actuator : meant(first, named))
      for (const WordConfig& word : actuator->words)
        if (word.text) add({word.name, K::word, "a text that the device knows", {}, true});
  }

  // ---- names, by the tokens in front of them
  void names() {
    const std::size_t first = statement();
    if (gives_a_name()) return;
    if (expected_.takes(Kinds::SET) || back(1) == Kinds::EXPECT || after_expect(first))
      return verbs();
    if (by_keyword()) return;
    const Tokens& before = expected_.before;
    const bool command = first < before.size() && before[first].kind == Kinds::NAME;
    if (command && !in_brackets(first) && !expected_.takes(Kinds::PLUS)) {
      if (is_define(text(before[first]))) return operands();
      return in_command(first);
    }
    if (back(1) == Kinds::NAME) return channels(word_back(1));
    operands();
    // SET mood TO …, and = in a TEST.
    if (back(1) == Kinds::TO && back(3) == Kinds::SET) labels(2);
    if (back(1) == Kinds::EQUAL) labels(2);
  }
  [[nodiscard]] bool after_expect(std::size_t first) const {
    return first == expected_.before.size() && first > 0 &&
           is_one_of(back(1), {Kinds::EXPECT, Kinds::NO, Kinds::TIMES});
  }
  [[nodiscard]] bool is_define(std::string_view name) const {
    return std::ranges::any_of(symbols_.all(), [&](const Symbol& symbol) {
      return symbol.kind == K::define && same_name(symbol.name, name);
    });
  }
  // A name that is being declared here cannot be completed.
  [[nodiscard]] bool gives_a_name() const {
    const Tokens& before = expected_.before;
    if (is_one_of(back(1), {Kinds::LET, Kinds::REMEMBER, Kinds::STATE, Kinds::TIMER, Kinds::FEELING,
                            Kinds::CHECK, Kinds::DEFINE, Kinds::MOTION, Kinds::BEHAVIOR,
                            Kinds::SAFETY, Kinds::LIST}))
      return true;
    if (before.empty()) return false;
    const bool head = std::ranges::none_of(
        before, [](const Token& token) { return token.kind == Kinds::NEWLINE; });
    if (before[0].kind == Kinds::STATE || (before[0].kind == Kinds::DEFINE && head)) return true;
    return before[0].kind == Kinds::CHECK && expected_.takes(Kinds::MARGIN) &&
           back(1) == Kinds::NEWLINE;
  }
  // Completes by the keyword in front; false: the keyword does not determine it.
  bool by_keyword() {
    switch (back(1)) {
      case Kinds::USE:
        modules();
        return true;
      case Kinds::SET:
        declared({K::remember, K::state, K::feeling, K::parameter});
        return true;
      case Kinds::RAISE:
      case Kinds::LOWER:
        declared({K::feeling, K::remember, K::parameter});
        return true;
      case Kinds::SIGNAL:
        declared({K::signal, K::parameter});
        return true;
      case Kinds::STOP:
      case Kinds::LIMIT:
        targets();
        return true;
      case Kinds::IS:
      case Kinds::BECOMES:
        labels(2);
        return true;
      case Kinds::NOT:
        if (back(2) == Kinds::IS) labels(3);
        return back(2) == Kinds::IS;
      case Kinds::OF:
      case Kinds::COMMA:
        return by_item();
      default:
        return back(2) == Kinds::LIMIT && limits();
    }
  }
  // After OF, and after a comma: the kind of things that the line lists.
  bool by_item() {
    const TokenKind item = expected_.before[0].kind;
    if (item == Kinds::MOTION) targets();
    if (back(1) == Kinds::COMMA) return item == Kinds::MOTION;
    if (item == Kinds::CHECK) operands();
    if (item != Kinds::MOTION && item != Kinds::CHECK) declared({K::list, K::parameter});
    return true;
  }
  bool limits() {
    channels(word_back(1));
    add({"SPEED", K::channel, "how fast an actuator may move", {}, false});
    return true;
  }
  void modules() {
    for (const LibraryModule& module : project_.library)
      add({std::string(module.name), K::module, "a module of the library",
           comment_above_all(module.text), false});
  }
  // The comment at the start of a text.
  static std::string comment_above_all(std::string_view text) {
    std::string result;
    while (!text.empty() && (text[0] == '%' || text[0] == '#')) {
      std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(text.size(), line.size() + 1));
      line.remove_prefix(std::min(line.find_first_not_of("%# "), line.size()));
      result += (result.empty() ? "" : "\n") + std::string(line);
    }
    return result;
  }

  void keywords() {
    const bool in_behavior =
        !expected_.before.empty() && expected_.before[0].kind == Kinds::BEHAVIOR;
    for (const Keyword& keyword : compiler::keywords()) {
      if (!expected_.takes(keyword.kind) || keyword.spelling == "BEHAVIOUR") continue;
      const bool item = (keyword.roles & role::item) != 0 && (keyword.roles & role::statement) == 0;
      if (in_behavior && item) continue;
      add({std::string(keyword.spelling), std::nullopt, {}, {}, false});
    }
  }

  const Project& project_;
  const Symbols& symbols_;
  const Expected& expected_;
  std::vector<Candidate> result_;
};

}  // namespace

Completion complete(const Project& project, const Symbols& symbols, FileId file,
                    std::uint32_t offset) {
  const Expected expected = expected_at(project.sources, file, offset);
  Completion result{expected.typed, {}};
  if (!expected.in_comment) result.candidates = Completer(project, symbols, expected).run();
  return result;
}

}  // namespace robosync::compiler::query
