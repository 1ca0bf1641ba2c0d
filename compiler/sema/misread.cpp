// Part of Commands: arguments that are each a word, a text or a number, but together mean something else. Reported once
// for all of them, before each is rejected on its own.
#include <algorithm>
#include <cstdlib>
#include <optional>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/commands.hpp"
#include "compiler/units/foreign_units.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {

namespace {

// Words of other languages, and of people, for RSL's prepositions.
struct ForeignPreposition {
  std::string_view spelling, meant;
};
constexpr ForeignPreposition kForeignPrepositions[] = {
    {"IN", "OVER"},
    {"DURING", "OVER"},
    {"SPEED", "AT"},
};

bool is_text(const ast::Argument& argument) {
  return argument.preposition == ast::Preposition::none &&
         std::holds_alternative<ast::Text>(argument.value);
}

// This word and those that follow it: `hello there`.
std::string words_from(const ast::Command& command, const ast::Word& first) {
  std::string words(first.name.text);
  bool follows = false;
  for (const ast::Argument& argument : command.arguments) {
    const auto* const word = std::get_if<ast::Word>(&argument.value);
    if (follows && (word == nullptr || argument.preposition != ast::Preposition::none)) break;
    if (follows) words += " " + std::string(word->name.text);
    follows = follows || word == &first;
  }
  return words;
}

Span both(const ast::Argument& first, const ast::Argument& second) {
  return {first.span.file, first.span.begin, second.span.end};
}

}  // namespace

// True if the argument and the next one are not meant as two arguments; reports it.
bool Commands::is_misread(const ast::Command& command, std::size_t place) {
  if (is_second_command(command, place) || lacks_brackets(command, place) ||
      is_word_of_program(command, place))
    return true;
  const std::size_t next = place + 1;
  const std::size_t first_part = command.arguments.size() - command.parts;
  if (next >= command.arguments.size() || is_chosen(place) || is_chosen(next)) return false;
  if (lacks_list(command, place)) return true;
  return next < first_part &&
         (is_foreign_preposition(command, place) || is_reading(command, place) ||
          lacks_comma(command, place) || is_unit_apart(command, place));
}

// `SHOW eyes mood`, where `mood` is a STATE: the words of a command are the actuator's.
bool Commands::is_word_of_program(const ast::Command& command, std::size_t place) {
  const ast::Word* const word = is_chosen(place) ? nullptr : plain_word(command.arguments[place]);
  if (word == nullptr || is_known_word(word->name.text) ||
      expressions_.find_binding(word->name.text) != nullptr)
    return false;
  const VariableName* const variable = names_.find_variable(word->name.text);
  const std::vector<std::size_t>& able = names_.able_to(command.verb.text);
  if (able.empty() || variable == nullptr || variable->taken || variable->labels.empty())
    return false;
  const ast::Word* const first = place == 0 ? nullptr : plain_word(command.arguments.front());
  const auto named = first == nullptr ? std::nullopt : names_.find_target(first->name.text);
  const bool is_named = named && !named->actuators.empty();
  const ActuatorConfig& actuator =
      robot_.actuators[is_named ? named->actuators.front() : able.front()];
  const VerbConfig* const verb = actuator.find_verb(command.verb.text);
  if (verb == nullptr || verb->texts == Texts::any) return false;
  const std::vector<std::string> known = actuator.words_of(*verb);
  if (known.empty()) return false;
  const auto both_have = [&](const std::string& label) {
    return std::ranges::any_of(known, [&](const auto& one) { return same_name(one, label); });
  };
  const auto shared = std::ranges::find_if(variable->labels, both_have);
  const std::string asked = shared == variable->labels.end() ? variable->labels.front() : *shared;
  const std::string given = shared == variable->labels.end() ? known.front() : *shared;
  diagnostics_
      .report(Code::E0306, "`" + verb->name + "` takes a word of " + actuator.name.shown() +
                               ", but " + word->name.shown() + " is " +
                               names_.kind_of(word->name.text))
      .label(word->name.span)
      .helps("write an IF for each word: `IF " + std::string(word->name.text) + " IS " + asked +
             " DO " + verb->name + " " +
             (first == nullptr ? "" : std::string(first->name.text) + " ") + given + " END`");
  return true;
}

// `SAY "Hello" MOVE head LEFT`
bool Commands::is_second_command(const ast::Command& command, std::size_t place) {
  const ast::Word* const word = is_chosen(place) ? nullptr : plain_word(command.arguments[place]);
  if (word == nullptr || !names_.is_verb(word->name.text) || is_known_word(word->name.text))
    return false;
  const Span before = place == 0 ? command.verb.span : command.arguments[place - 1].span;
  diagnostics_.report(Code::E0505, word->name.shown() + " begins a second command on this line")
      .label(word->name.span)
      .helps("each command goes on a line of its own")
      .fix({before.file, before.end, word->name.span.begin}, "\n", Applicability::likely);
  return true;
}

// `MOVE left arm UP`
bool Commands::is_torn_name(const ast::Command& command) {
  for (std::size_t i = 1; i < command.arguments.size(); ++i) {
    const ast::Word* const front = plain_word(command.arguments[i - 1]);
    const ast::Word* const back = plain_word(command.arguments[i]);
    if (front == nullptr || back == nullptr) continue;
    const auto target =
        names_.find_target(std::string(front->name.text) + "_" + std::string(back->name.text));
    if (!target) continue;
    const Span name{front->name.span.file, front->name.span.begin, back->name.span.end};
    diagnostics_.report(Code::E0501, "the name of an actuator is one word")
        .label(name)
        .helps("did you mean `" + target->name + "`?")
        .fix(name, target->name, Applicability::likely);
    return true;
  }
  return false;
}

// `TO person DIRECTION`: reports it, because the second word would be read as one of the actuator's.
bool Commands::lacks_brackets(const ast::Command& command, std::size_t place) {
  const ast::Argument& first = command.arguments[place];
  const auto* const word = std::get_if<ast::Word>(&first.value);
  const ast::Word* const second =
      place + 1 < command.arguments.size() ? plain_word(command.arguments[place + 1]) : nullptr;
  if (first.preposition == ast::Preposition::none || word == nullptr || second == nullptr)
    return false;
  const auto sensor = names_.find_sensor(word->name.text);
  if (!sensor ||
      std::ranges::none_of(robot_.sensors[*sensor].channels, [&](const ChannelConfig& channel) {
        return same_name(channel.name.text, second->name.text);
      }))
    return false;
  Span both = word->name.span;
  both.end = second->name.span.end;
  const std::string better =
      "(" + std::string(word->name.text) + " " + std::string(second->name.text) + ")";
  diagnostics_.report(Code::E0505, "a value of two words needs brackets here")
      .label(both)
      .helps("write `" + better + "`")
      .fix(both, better);
  return true;
}

// `MOVE head TO 30deg IN 2s`
bool Commands::is_foreign_preposition(const ast::Command& command, std::size_t place) {
  const ast::Word* const word = plain_word(command.arguments[place]);
  const ast::Argument& next = command.arguments[place + 1];
  if (word == nullptr || is_known_word(word->name.text) ||
      next.preposition != ast::Preposition::none ||
      !std::holds_alternative<ast::Amount>(next.value))
    return false;
  for (const ForeignPreposition& one : kForeignPrepositions) {
    if (!same_name(one.spelling, word->name.text)) continue;
    const std::string meant(one.meant);
    diagnostics_.report(Code::E0505, word->name.shown() + " is written `" + meant + "` in RSL")
        .label(word->name.span)
        .fix(word->name.span, meant, Applicability::likely);
    return true;
  }
  return false;
}

// `SAY touch LEVEL`
bool Commands::is_reading(const ast::Command& command, std::size_t place) {
  const ast::Word* const sensor = plain_word(command.arguments[place]);
  const ast::Word* const channel = plain_word(command.arguments[place + 1]);
  if (sensor == nullptr || channel == nullptr || is_known_word(channel->name.text)) return false;
  const auto found = names_.find_sensor(sensor->name.text);
  if (!found || std::ranges::none_of(robot_.sensors[*found].channels, [&](const auto& one) {
        return same_name(one.name.text, channel->name.text);
      }))
    return false;
  const std::string reading =
      std::string(sensor->name.text) + " " + std::string(channel->name.text);
  Diagnostic& d = diagnostics_
                      .report(Code::E0505, "this is a number, but nothing tells " +
                                               command.verb.shown() + " what to do with it")
                      .label(both(command.arguments[place], command.arguments[place + 1]));
  if (same_name(command.verb.text, "SAY"))
    d.helps("write the words, a comma and the number: `SAY \"…\", " + reading + "`");
  else
    d.helps("write TO, BY, AT, OVER or FOR and brackets, such as `TO (" + reading + ")`");
  return true;
}

// `SAY "You have" points`
bool Commands::lacks_comma(const ast::Command& command, std::size_t place) {
  const ast::Argument& next = command.arguments[place + 1];
  if (!is_text(command.arguments[place])) return false;
  const ast::Word* const word = plain_word(next);
  const bool number = word != nullptr && !is_known_word(word->name.text) &&
                      !names_.find_target(word->name.text) && names_a_number(word->name);
  const bool more = is_text(next) && same_name(command.verb.text, "SAY");
  if (!more && !number) return false;
  const Span gap{next.span.file, command.arguments[place].span.end, next.span.begin};
  diagnostics_.report(Code::E0505, "a comma is missing between the parts of a text")
      .label(next.span, "this is another part")
      .helps("separate the parts with commas: `\"You have\", points, \"points\"`")
      .fix(gap, ", ", Applicability::likely);
  return true;
}

// `SAY ANY "one", "two"`, `SAY ITEM 3 jokes`
bool Commands::lacks_list(const ast::Command& command, std::size_t place) {
  const ast::Word* const word = plain_word(command.arguments[place]);
  if (word == nullptr || is_known_word(word->name.text)) return false;
  const ast::Argument& next = command.arguments[place + 1];
  const bool chooses = same_name(word->name.text, "ANY") || same_name(word->name.text, "NEXT");
  if (chooses && is_text(next)) {
    diagnostics_.report(Code::E0505, word->name.shown() + " chooses from a LIST")
        .label(next.span, "this is a text")
        .helps("give the texts a name at the top, `LIST words: \"one\", \"two\"`, and write `" +
               std::string(word->name.text) + " words`");
    return true;
  }
  if (!same_name(word->name.text, "ITEM") || !std::holds_alternative<ast::Amount>(next.value))
    return false;
  diagnostics_.report(Code::E0505, "`OF` is missing after the number of the ITEM")
      .label(both(command.arguments[place], next))
      .helps("write `ITEM 3 OF` and the LIST");
  return true;
}

// Does an actuator that has this verb take a change and a position?
bool Commands::can_go_to(std::string_view verb) const {
  return std::ranges::any_of(names_.able_to(verb), [&](std::size_t actuator) {
    const VerbConfig* const known = robot_.actuators[actuator].find_verb(verb);
    return known->has(vm::Param::to) && known->has(vm::Param::by);
  });
}

// `30 degrees`
bool Commands::is_unit_apart(const ast::Command& command, std::size_t place) {
  const auto* const amount = std::get_if<ast::Amount>(&command.arguments[place].value);
  const ast::Argument& next = command.arguments[place + 1];
  const ast::Word* const word = plain_word(next);
  if (amount == nullptr || amount->times || amount->value == nullptr || word == nullptr)
    return false;
  const auto* const number = std::get_if<ast::Quantity>(&amount->value->node);
  const bool bare = number != nullptr && number->unit.empty();
  const Unit* const unit = find_unit(word->name.text);
  if (!bare || unit == nullptr || is_known_word(word->name.text)) return false;
  const Span all{next.span.file, amount->value->span.begin, next.span.end};
  const std::string better = std::string(number->digits) + std::string(unit->spelling);
  const bool relative = command.arguments[place].preposition == ast::Preposition::none &&
                        can_go_to(command.verb.text);
  Diagnostic& d = diagnostics_.report(Code::E0505, "a unit follows its number without a space");
  d.label(all)
      .helps("write `" + better + "`")
      .fix(all, better, relative ? Applicability::likely : Applicability::certain);
  if (relative)
    d.helps("alone, it is how far from where it is now (`BY`); for a position, write `TO " +
            better + "`");
  return true;
}

// `TO 30,5deg`: the comma touches the numbers on both sides.
bool Commands::has_decimal_comma(const ast::Argument& part, const ast::Argument& next) {
  const auto number_of = [](const ast::Argument& one) -> const ast::Quantity* {
    const auto* const amount = std::get_if<ast::Amount>(&one.value);
    return amount == nullptr ? nullptr : std::get_if<ast::Quantity>(&amount->value->node);
  };
  const ast::Quantity* const whole = number_of(part);
  const ast::Quantity* const decimals = number_of(next);
  if (whole == nullptr || !whole->unit.empty() || decimals == nullptr ||
      part.preposition == ast::Preposition::none || next.preposition != ast::Preposition::none ||
      next.span.begin != part.span.end + 1)
    return false;
  Span all = std::get<ast::Amount>(part.value).value->span;
  all.end = next.span.end;
  report_decimal_comma(diagnostics_, all, whole->digits,
                       std::string(decimals->digits) + std::string(decimals->unit));
  return true;
}

// `PLAY button happy`: a sensor in place of the actuator.
bool Commands::is_sensor_meant(const Recipient& to, const ast::Word& word, const Names& names) {
  if (!names.find_sensor(word.name.text)) return false;
  const bool says = to.verb.texts == Texts::any && to.command.arguments.size() == 1;
  Diagnostic& d =
      to.diagnostics
          .report(Code::E0501,
                  word.name.shown() + " is a sensor, " +
                      (says ? "not a text" : "but `" + to.verb.name + "` needs an actuator"))
          .label(word.name.span);
  if (says)
    d.helps("write the words, a comma and what it measures: `" + to.verb.name + " \"…\", " +
            std::string(word.name.text) + " …`");
  else if (plain_word(to.command.arguments.front()) == &word)
    d.helps("write `" + to.verb.name + " " + to.actuator.name.text + "`")
        .fix(word.name.span, to.actuator.name.text, Applicability::likely);
  return true;
}

// ---- a word or a text that the actuator does not take

// Does a number or a value in brackets follow, as after TO, BY, AT, OVER and FOR?
static bool may_be_preposition(const ast::Command& command, const ast::Word& word) {
  const auto& arguments = command.arguments;
  const auto next = std::ranges::find_if(
      arguments, [&](const ast::Argument& one) { return one.span.begin > word.name.span.begin; });
  const auto* const amount =
      next == arguments.end() ? nullptr : std::get_if<ast::Amount>(&next->value);
  return amount != nullptr && !amount->times && next->preposition == ast::Preposition::none;
}

// `SHOW lights happy`
static bool stands_for_actuator(const ActuatorConfig& actuator, const ast::Command& command,
                                const ast::Word& word) {
  const auto& arguments = command.arguments;
  const ast::Word* const next = arguments.size() > 1 ? plain_word(arguments[1]) : nullptr;
  return next != nullptr && plain_word(arguments.front()) == &word &&
         actuator.find_word(next->name.text) != nullptr;
}

// What may be meant: a word of the actuator, a target, or a word of RSL that may come later in a line of commands. Not the word
// itself, which is one of these in the wrong place.
static std::vector<std::string> meant_instead(std::vector<std::string> words,
                                              const std::vector<std::string>& targets,
                                              const ast::Word& word) {
  words.insert(words.end(), targets.begin(), targets.end());
  for (const char* const keyword :
       {"TO", "BY", "OVER", "AT", "FOR", "MARGIN", "TIMES", "WITH", "ELSE", "END"})
    words.emplace_back(keyword);
  std::erase_if(words, [&](const auto& one) { return same_name(one, word.name.text); });
  return words;
}

// `MOVE leg TO 10deg`, where only `arm` can MOVE: the first word, if no word names an actuator.
bool Commands::is_in_place_of_actuator(const ast::Command& command, const ast::Word& word) const {
  return plain_word(command.arguments.front()) == &word &&
         std::ranges::none_of(command.arguments, [&](const ast::Argument& argument) {
           const ast::Word* const name = plain_word(argument);
           return name != nullptr && names_.find_target(name->name.text).has_value();
         });
}

// A word that is near the name of an actuator, or where the verb takes only words that are none of it.
void Commands::call_it_actuator(const Recipient& to, const ast::Word& word, Diagnostic& d) const {
  const bool near_one = !d.fixes.empty() && names_.find_target(d.fixes.front().replacement);
  const bool says_nothing = to.verb.texts == Texts::none && !to.verb.has(vm::Param::item);
  if (!near_one && !(d.help.empty() && says_nothing)) return;
  d.message = "there is no actuator " + word.name.shown();
  if (!near_one) d.helps("actuators: " + list_names(names_.target_names()));
}

void Commands::report_unknown_word(const Recipient& to, const ast::Word& word) const {
  if (is_sensor_meant(to, word, names_)) return;
  Diagnostic& d = to.diagnostics
                      .report(Code::E0501, to.actuator.name.shown() + " does not know the word " +
                                               word.name.shown())
                      .label(word.name.span);
  const std::size_t targets_known = robot_.actuators.size() + robot_.groups.size();
  if (!diagnostics_.may_search(to.actuator.words.size() + targets_known)) return;
  if (plain_word(to.command.arguments.front()) == &word &&
      names_.help_with_actuator(d, word.name)) {
    d.message = "there is no actuator " + word.name.shown();
    return;
  }
  std::vector<std::string> words;
  for (const WordConfig& known : to.actuator.words)
    if (!known.text) words.push_back(known.name);
  if (did_you_mean(d, word.name.span, word.name.text,
                   meant_instead(words, names_.target_names(), word)) &&
      !may_be_preposition(to.command, word))
    doubt_keyword(d);
  names_.doubt_group(d, word.name.text);
  if (d.help.empty() && stands_for_actuator(to.actuator, to.command, word)) {
    d.message = "there is no actuator " + word.name.shown();
    d.helps("write `" + to.verb.name + " " + to.actuator.name.text + "`")
        .fix(word.name.span, to.actuator.name.text, Applicability::likely);
  }
  if (is_in_place_of_actuator(to.command, word)) call_it_actuator(to, word, d);
  if (d.help.empty() && !words.empty()) d.helps("it knows " + list_names(words));
  if (names_.find_list(word.name.text) != nullptr)
    d.helps("it is a LIST; choose one of its texts: `ANY " + std::string(word.name.text) + "`");
  if (d.help.empty() && to.verb.texts == Texts::listed)
    help_with_files(to, d);
  else if (d.help.empty() && to.verb.texts == Texts::any)
    d.helps("put words to say or play in quotes: `\"" + words_from(to.command, word) + "\"`");
}

// `SHOW face "happy"`, `SHOW face ANY names`
void Commands::report_no_text(const Recipient& to, const Given& given) const {
  Diagnostic& d = to.diagnostics.report(Code::E0505, "`" + to.verb.name + "` takes no text")
                      .label(given.argument->span);
  if (chosen_ != nullptr)
    d.helps(
        "a LIST holds texts: for one of several words, write `PICK ONE` with an `OPTION` for each");
  else if (const WordConfig* const word = to.actuator.find_word(*given.text))
    d.helps("write the word without quotes: `" + word->name + "`")
        .fix(given.text_span, word->name, Applicability::likely);
}

}  // namespace robosync::compiler
