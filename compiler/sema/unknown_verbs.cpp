// Part of Commands: words in a verb's place that are not verbs of the robot.
#include <algorithm>
#include <string_view>

#include "compiler/config/devices.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/commands.hpp"
#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler {

namespace {

// Words of other languages for verbs that RSL has.
struct ForeignVerb {
  std::string_view spelling, meant, help;
};
constexpr ForeignVerb kForeignVerbs[] = {
    {"PRINT", "LOG", "LOG writes a line for you to read"},
    {"ECHO", "LOG", "LOG writes a line for you to read"},
    {"WRITE", "LOG", "LOG writes a line for you to read"},
    {"SLEEP", "WAIT", "WAIT makes a pause"},
    {"DELAY", "WAIT", "WAIT makes a pause"},
    {"PAUSE", "WAIT", "WAIT makes a pause"},
    {"HOLD", "WAIT", "WAIT makes a pause"},
    {"STAY", "WAIT", "WAIT makes a pause"},
    {"LIFT", "MOVE", "MOVE moves a joint: `MOVE arm TO 90deg`"},
    {"ROTATE", "TURN", "TURN turns a joint, wheels or the robot: `TURN head TO 20deg`"},
    {"SPEAK", "SAY", "SAY says a text: `SAY \"Hello\"`"},
    {"TALK", "SAY", "SAY says a text: `SAY \"Hello\"`"},
    {"TELL", "SAY", "SAY says a text: `SAY \"Hello\"`"},
    {"DISPLAY", "SHOW", "SHOW shows a picture: `SHOW face happy`"},
    {"FADE", "", "OVER makes a change slow: `LIGHT lamp red OVER 1s`"},
    {"FLASH", "BLINK", "BLINK turns a light on and off"},
    {"ADD", "", "RAISE increases a variable: `RAISE visits BY 1`"},
    {"INCREASE", "RAISE", "RAISE increases a variable: `RAISE visits BY 1`"},
    {"INCREMENT", "RAISE", "RAISE increases a variable: `RAISE visits BY 1`"},
    {"SUBTRACT", "", "LOWER decreases a variable: `LOWER visits BY 1`"},
    {"DECREASE", "LOWER", "LOWER decreases a variable: `LOWER visits BY 1`"},
    {"DECREMENT", "LOWER", "LOWER decreases a variable: `LOWER visits BY 1`"},
    {"BREAK", "", "a loop ends when its condition no longer holds: `REPEAT WHILE touch LEVEL > 3`"},
    {"CONTINUE", "", "to leave out the rest of a round, put it into an IF"},
    {"RETURN", "", "to leave out the rest of a response, put it into an IF"},
    {"EXIT", "", "to leave out the rest of a response, put it into an IF"},
};

// Keywords that may begin a line or continue the one before.
std::vector<std::string> keywords_of_lines() {
  constexpr unsigned kBegins = role::item | role::part | role::statement | role::after;
  std::vector<std::string> found;
  for (const Keyword& keyword : keywords())
    if ((keyword.roles & kBegins) != 0) found.emplace_back(keyword.spelling);
  return found;
}

}  // namespace

void doubt_keyword(Diagnostic& diagnostic) {
  for (Fix& fix : diagnostic.fixes) {
    const auto is_meant = [&](const Keyword& one) { return one.spelling == fix.replacement; };
    if (std::ranges::any_of(keywords(), is_meant)) fix.applicability = Applicability::likely;
  }
}

void suggest_perform(Diagnostic& diagnostic, const ast::Name& motion) {
  const std::string better = std::string(kPerform) + " " + std::string(motion.text);
  diagnostic.helps(motion.shown() + " is a MOTION: write `" + better + "`")
      .fix(motion.span, better, Applicability::likely);
}

// `voice SAY "Hello"`
bool Commands::begins_with_actuator(const ast::Command& command) {
  const ast::Name& name = command.verb;
  const auto target = names_.find_target(name.text);
  if (!target || target->actuators.empty()) return false;
  Diagnostic& d = diagnostics_
                      .report(Code::E0501, name.shown() +
                                               " is an actuator, not a verb: a command "
                                               "begins with a verb")
                      .label(name.span);
  const ast::Word* const first = first_word(command);
  if (first != nullptr && names_.is_verb(first->name.text)) {
    const std::string better = std::string(first->name.text) + " " + std::string(name.text);
    d.helps("write `" + better + "`")
        .fix({name.span.file, name.span.begin, first->name.span.end}, better,
             Applicability::likely);
    return true;
  }
  d.helps(name.shown() + " knows " +
          list_names(verb_names(robot_.actuators[target->actuators.front()])));
  return true;
}

// `CALL wave`
bool Commands::calls_define(const ast::Command& command) {
  const ast::Word* const first = first_word(command);
  if (first == nullptr || names_.find_define(first->name.text) == nullptr) return false;
  const Span verb = command.verb.span;
  diagnostics_
      .report(Code::E0501,
              "there is no verb " + command.verb.shown() + ": a DEFINE is run by its name alone")
      .label(verb)
      .helps("write `" + std::string(first->name.text) + "`")
      .fix({verb.file, verb.begin, first->name.span.begin}, "", Applicability::likely);
  return true;
}

// `PRINT "here"`, `RESET idle`
bool Commands::is_foreign(const ast::Command& command) {
  const ast::Word* const first = first_word(command);
  const VariableName* const reset = first != nullptr && same_name("RESET", command.verb.text)
                                        ? names_.find_variable(first->name.text)
                                        : nullptr;
  if (reset != nullptr) {
    const bool timer = reset->kind == vm::VariableKind::timer;
    Diagnostic& d = diagnostics_
                        .report(Code::E0501, "there is no verb " + command.verb.shown() + ": " +
                                                 (timer ? "RESTART sets a TIMER back to 0"
                                                        : "SET changes a variable"))
                        .label(command.verb.span);
    if (timer) d.fix(command.verb.span, "RESTART", Applicability::likely);
    return true;
  }
  for (const ForeignVerb& foreign : kForeignVerbs) {
    const bool may_be_define = command.arguments.empty() && !foreign.meant.empty();
    if (may_be_define || !same_name(foreign.spelling, command.verb.text)) continue;
    Diagnostic& d = diagnostics_.report(Code::E0501, "there is no verb " + command.verb.shown())
                        .label(command.verb.span)
                        .helps(std::string(foreign.help));
    if (!foreign.meant.empty())
      d.fix(command.verb.span, std::string(foreign.meant), Applicability::likely);
    return true;
  }
  return false;
}

// `EXPECT go WITHIN 1s`, `go 3 TIMES`, `go left_arm`
void Commands::report_run_define(const ast::Command& command, Diagnostic& diagnostic) const {
  const std::string name(command.verb.text);
  if (command.arguments.empty()) {
    diagnostic.message = "a TEST expects a command, but " + command.verb.shown() + " is a DEFINE";
    diagnostic.helps("write a command that it gives");
    return;
  }
  const ast::Argument& first = command.arguments.front();
  const auto* const amount = std::get_if<ast::Amount>(&first.value);
  if (amount != nullptr && amount->times) {
    diagnostic.message = "a DEFINE takes no `TIMES`";
    diagnostic.helps("write `REPEAT 3 TIMES`, `" + name + "` and `END`, each on its own line");
  } else if (first.preposition == ast::Preposition::for_) {
    diagnostic.message = "a DEFINE takes no `FOR`";
    diagnostic.helps("say in the DEFINE how long its commands last");
  } else {
    diagnostic.helps(command.verb.shown() +
                     " is a DEFINE: write its values after WITH, separated by commas");
  }
}

void Commands::report_unknown_verb(const ast::Command& command) {
  const ast::Name& verb = command.verb;
  const bool is_ours =
      names_.find_motion(verb.text) != nullptr || names_.find_define(verb.text) != nullptr;
  if (begins_with_actuator(command) || calls_define(command) || (!is_ours && is_foreign(command)))
    return;
  const std::string what = command.arguments.empty() ? "DEFINE or verb " : "verb ";
  Diagnostic& d =
      diagnostics_.report(Code::E0501, "there is no " + what + verb.shown()).label(verb.span);
  if (names_.find_motion(verb.text) != nullptr) return suggest_perform(d, verb);
  if (command.arguments.empty()) d.unknown = verb.text;
  d.in_verb_place = true;
  if (names_.find_define(verb.text) != nullptr) {
    report_run_define(command, d);
    return;
  }
  if (!diagnostics_.may_search(robot_.actuators.size() + names_.defines().size())) return;
  auto candidates = names_.verb_names();
  const auto defines = names_.define_names();
  candidates.insert(candidates.end(), defines.begin(), defines.end());
  const auto verbs = candidates;
  const auto keywords = keywords_of_lines();
  candidates.insert(candidates.end(), keywords.begin(), keywords.end());
  for (const std::string_view word : {kPerform, kFollow, kRestart})
    candidates.emplace_back(word);
  std::erase_if(candidates, [&](const auto& one) { return same_name(one, verb.text); });
  if (did_you_mean(d, verb.span, verb.text, candidates)) return doubt_keyword(d);
  // The verb may belong to a device that this robot lacks: usually `USE` brought in a file that needs it.
  const auto devices = devices_with(verb.text);
  if (devices.empty() && !verbs.empty()) d.helps("verbs: " + list_names(verbs));
  if (devices.empty()) return;
  d.message = "no actuator of this robot knows the verb " + verb.shown();
  d.helps("add one to robot.json, with the device " + list_names(devices, "or"));
}

}  // namespace robosync::compiler
