// Part of Names: what a name that stands for nothing may be meant for.
#include <string>

#include "compiler/sema/names.hpp"
#include "compiler/syntax/number_words.hpp"

namespace robosync::compiler {

// `MOVE arm TO SLOWLY`
bool Names::help_with_word(Diagnostic& d, const ast::Name& name) const {
  for (const ActuatorConfig& actuator : robot_.actuators)
    for (const WordConfig& word : actuator.words) {
      if (word.text || !same_name(word.name, name.text)) continue;
      d.helps(name.shown() + " is a word of " + actuator.name.shown() + ", not a number");
      return true;
    }
  return false;
}

// `three` for 3, `red button` for `red_button`, `LEVEL` for `touch LEVEL`
bool Names::help_with_parts(Diagnostic& d, const ast::Operand& operand) const {
  const ast::Name& name = operand.name;
  const Span all{name.span.file, name.span.begin,
                 operand.channel ? operand.channel->span.end : name.span.end};
  const auto write = [&](const std::string& better, const std::string& why) {
    d.helps(why + "`" + better + "`").fix(all, better, Applicability::likely);
    return true;
  };
  const unsigned number = operand.channel ? 0 : number_in_words(name.text);
  if (number > 0) return write(std::to_string(number), "a number is written in digits: ");
  for (const SensorConfig& sensor : robot_.sensors) {
    if (operand.channel &&
        same_name(sensor.name.text, std::string(name.text).append(operand.channel->text)))
      return write(sensor.name.text, "the name of the sensor is ");
    for (const ChannelConfig& channel : sensor.channels)
      if (!operand.channel && same_name(channel.name.text, name.text))
        return write(sensor.name.text + " " + channel.name.text,
                     "the name of its sensor goes before it: ");
  }
  return false;
}

}  // namespace robosync::compiler
