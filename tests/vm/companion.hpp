// A small robot and a program for it that uses every kind of record, rule, timer and block.
//
// Tests change one thing in it and look what comes of that. The enumerators are the places of its
// records.
#pragma once

#include "tests/vm/image_builder.hpp"
#include "vm/drivers.hpp"

namespace robosync::vm::test::companion {

enum Channels : std::uint8_t { touch_level, touch_force, distance };
// As inputs they follow the channels.
enum Variables : std::uint8_t { visitors, mood, joy, called, nearness };
constexpr std::uint8_t input_of(Variables variable) {
  return static_cast<std::uint8_t>(3 + variable);
}
enum Actuators : std::uint8_t { left_arm, right_arm, speaker };
enum Groups : std::uint8_t { arms = kGroupBit };
enum Verbs : std::uint8_t { move_verb, play_verb };
enum Words : std::uint8_t { slowly, quickly, greeting, warning };
enum Behaviors : std::uint16_t { safety_behavior, greet, back_off };
enum Rules : std::uint16_t { pinch, pinch_resume, touched, hug, lively, watch_far, hello, retreat };
enum Responses : std::uint16_t { stop, gentle, aggressive, talk, blink, backward, dance };
enum Timers : std::uint8_t { firm_for, many_times, first_then, far_latch, became, moved };

constexpr unsigned kTo = static_cast<unsigned>(Param::to);
constexpr unsigned kOver = static_cast<unsigned>(Param::over);

inline void add_sensors(ImageBuilder& image) {
  const auto channel = [&](std::string_view name, std::uint8_t sensor, Dimension dimension) {
    Channel record{};
    record.name = image.name(name);
    record.sensor = sensor;
    record.dimension = dimension;
    record.stale_ms = 500;
    record.scale_den = 1;
    record.scale_num = 1000;
    record.max = 5000 * kScale;
    image.channels.push_back(record);
  };
  image.sensors.push_back({image.name("touch"), DriverId::max34451, 1, 0x21, 20, 0, 2, 0, 0});
  image.sensors.push_back({image.name("proximity"), DriverId::virtual_sensor, 0, 0, 0, 2, 1, 0, 0});
  channel("LEVEL", 0, Dimension::number);
  channel("FORCE", 0, Dimension::force);
  channel("DISTANCE", 1, Dimension::length);
}

inline void add_robot(ImageBuilder& image) {
  add_sensors(image);
  const auto actuator = [&](std::string_view name, DriverId driver, std::uint32_t verbs) {
    const auto pin = static_cast<std::uint16_t>(3 + image.actuators.size());
    const std::uint8_t line = drives_player(driver) ? 1 : 0;
    image.actuators.push_back({image.name(name), driver, line, pin, Release::rest, Release::coast,
                               verbs, -90 * kScale, 90 * kScale, kValueMax});
  };
  actuator("left_arm", DriverId::servo, 1 << move_verb);
  actuator("right_arm", DriverId::servo, 1 << move_verb);
  actuator("speaker", DriverId::player, 1 << play_verb);
  image.groups.push_back({image.name("arms"), 0, 1 << left_arm | 1 << right_arm});

  const auto bit = [](Param param) { return 1U << static_cast<unsigned>(param); };
  image.verbs.push_back(
      {image.name("MOVE"), Action::move,
       static_cast<std::uint8_t>(bit(Param::to) | bit(Param::at) | bit(Param::over))});
  image.verbs.push_back(
      {image.name("PLAY"), Action::play, static_cast<std::uint8_t>(bit(Param::item))});
  image.words.push_back({image.name("SLOWLY"), Param::at, 0, 20 * kScale});
  image.words.push_back({image.name("QUICKLY"), Param::at, 0, 90 * kScale});
  image.words.push_back({image.name("greeting.wav"), Param::item, 0, 1 * kScale});
  image.words.push_back({image.name("warning.wav"), Param::item, 0, 2 * kScale});
}

inline void add_memory(ImageBuilder& image) {
  const auto variable = [&](std::string_view name, VariableKind kind, Value max) -> Variable& {
    Variable record{};
    record.name = image.name(name);
    record.kind = kind;
    record.max = max;
    return image.variables.emplace_back(record);
  };
  variable("visitors", VariableKind::plain, kValueMax);
  variable("mood", VariableKind::state, 1 * kScale);
  Variable& feeling = variable("joy", VariableKind::feeling, 100 * kScale);
  feeling.dimension = Dimension::percent;
  feeling.initial = feeling.fades_to = 50 * kScale;
  feeling.fade = 0x7F000000;
  variable("called", VariableKind::signal, kValueMax);
  variable("nearness", VariableKind::band, 1 * kScale).initial = kUnknown;
  for (const Variables labelled : {mood, nearness}) {
    image.variables[labelled].first_label = image.add_labels({"calm", "wary"});
    image.variables[labelled].label_count = 2;
  }
  image.checks.push_back({nearness, distance, 0, 2, 5, 40});
  image.bands.push_back({kValueMin, 800 * kScale - 1, kValueMin, 900 * kScale - 1});
  image.bands.push_back({800 * kScale, kValueMax, 700 * kScale, kValueMax});
  image.modifiers.push_back({20 * kScale, 2 * kScale, 1, {}});
}

// SAFETY: FORCE > 3 halts everything, until it is down to 3. Frame: r0 FORCE, r1 mood | r2.
inline void add_safety(ImageBuilder& image, unsigned three) {
  using Op = Opcode;
  const std::uint16_t text = image.name("too much force");
  image.response(0b111,
                 {encode(Op::halt, arms), encode(Op::halt, kAllActuators),
                  encode_wide(Op::load, 2, image.constant(1 * kScale)), encode(Op::set, 1, 2),
                  encode(Op::arg, kTo, 0), encode_wide(Op::log, 0, text),
                  encode_wide(Op::alert, 0, text), encode(Op::end)});
  image.rule_of(RuleKind::safety, stop, {encode(Op::gt_k, 2, 0, three), encode(Op::ret, 2)}, 30);
  image.rule_of(
      RuleKind::resume, kNoIndex,
      {encode(Op::le_k, 2, 0, three),
       encode(Op::held, 2, 2, image.timer(TimerKind::held, 2 * kScale)), encode(Op::ret, 2)},
      31);
  image.behaviors.push_back({kSafetyPriority, kNoIndex, 0b111, 0, 2, 2, 0, 0, 3});
}

// Two arms, two sides; a WHILE that counts and talks; EVERY 1s TO 3s.
// Frame: r0 visitors, r1 mood, r2 LEVEL, r3 DISTANCE | r4, r5, r6 | r7 | r8 …
inline void add_greet(ImageBuilder& image, unsigned three) {
  using Op = Opcode;
  const std::uint16_t one = image.constant(1 * kScale);
  const std::uint16_t half = image.constant(500);
  const Word both = encode(Op::cmd, arms, move_verb, slowly);
  image.response(0b111, {both, encode(Op::cmd_end, speaker, play_verb, greeting)});
  image.response(0b111, {encode(Op::cmd, arms, move_verb, quickly),
                         encode(Op::cmd_end, speaker, play_verb, warning)});
  // REPEAT 3 TIMES … WAIT 0.5 … END; visitors + 1; IF watch … ELSE … END; WAIT UNTIL … WITHIN 1
  image.response(0b101, {encode_wide(Op::times, 4, three),
                         encode(Op::cmd, speaker, play_verb, greeting),
                         encode_wide(Op::load, 8, half),
                         encode(Op::wait, 8),
                         encode_wide(Op::again, 4, 4),
                         encode_wide(Op::load, 8, one),
                         encode(Op::add, 8, 0, 8),
                         encode(Op::set, 0, 8),
                         encode(Op::min_k, 0, 0, three),
                         encode_wide(Op::unless_known, 7, 4),
                         encode_wide(Op::unless, 7, 2),
                         encode(Op::cmd, left_arm, move_verb, slowly),
                         encode_wide(Op::jump, 0, 1),
                         encode(Op::cmd, left_arm, move_verb, quickly),
                         encode(Op::wait_done),
                         encode_wide(Op::load, 8, one),
                         encode(Op::deadline, 5, 8),
                         encode(Op::poll),
                         encode(Op::lt_k, 8, 2, three),
                         encode(Op::reached, 9, 5),
                         encode(Op::or_, 8, 8, 9),
                         encode_wide(Op::until, 8, 4),
                         encode(Op::shift, 1, 3),
                         encode(Op::end)});
  // PICK ONE
  image.response(0b100, {encode_wide(Op::load, 8, 0), encode_wide(Op::load, 9, one),
                         encode(Op::random, 6, 8, 9), encode(Op::lt_k, 8, 6, half),
                         encode_wide(Op::unless, 8, 2),
                         encode(Op::cmd, speaker, play_verb, greeting), encode_wide(Op::jump, 0, 1),
                         encode(Op::cmd, speaker, play_verb, warning), encode(Op::end)});

  image.rule(gentle, aggressive, {encode(Op::lt_k, 8, 2, three), encode(Op::ret, 8)}, 2);
  image.rules.back().modifiers = 0;
  image.rule_of(RuleKind::while_, talk,
                {encode(Op::lt_k, 8, 3, three), encode(Op::gt_k, 9, 2, three),
                 encode(Op::counted, 8, 8, image.timer(TimerKind::counted, 2 * kScale, 3)),
                 encode(Op::sequence, 9, 8, image.timer(TimerKind::sequence, 2 * kScale)),
                 encode(Op::or_, 8, 8, 9), encode(Op::ret, 8)},
                7);
  image.rule_of(RuleKind::every, blink,
                {encode_wide(Op::load, 8, one), encode_wide(Op::load, 9, three),
                 encode(Op::random, 8, 8, 9), encode(Op::ret_number, 8)},
                15);
  image.rule_of(RuleKind::watch, kNoIndex,
                {encode(Op::gt_k, 8, 3, three), encode(Op::ge_k, 9, 3, one),
                 encode(Op::latch, 8, 9, image.timer(TimerKind::latch, 0)), encode(Op::ret, 8)},
                8);
  image.behaviors.push_back({50, image.name("greet"), 0b111, 2, 4, 4, 2, 3, 10});
}

// Frame: r0 called, r1 FORCE, r2 LEVEL | r3 | r4 …
inline void add_back_off(ImageBuilder& image, unsigned three) {
  using Op = Opcode;
  const std::uint16_t seventy = image.constant(70 * kScale);
  const std::uint16_t half = image.constant(500);
  image.response(0b001, {encode_wide(Op::load, 4, seventy), encode(Op::mul, 5, 1, 4),
                         encode(Op::min_k, 5, 5, seventy), encode(Op::arg, kTo, 5),
                         encode_wide(Op::arg_k, kOver, half),
                         encode(Op::cmd, left_arm, move_verb, kNoWord), encode(Op::end)});
  // REPEAT FOREVER MOVE … THEN REPEAT FORCE TIMES … WAIT … END END
  image.response(
      0b010, {encode(Op::loop), encode(Op::cmd, right_arm, move_verb, slowly),
              encode(Op::wait_done), encode(Op::times_v, 3, 1), encode(Op::wait, 1),
              encode_wide(Op::again, 3, 2), encode(Op::lt_k, 4, 1, three),
              encode_wide(Op::around, 4, 7), encode(Op::cmd_end, right_arm, move_verb, quickly)});
  image.rule_of(RuleKind::start, dance, {}, 20);
  image.rule(backward, kNoIndex,
             {encode(Op::gt_k, 4, 1, half), encode(Op::le, 5, 1, 2), encode(Op::not_, 5, 5),
              encode(Op::and_, 4, 4, 5), encode(Op::rose, 4, 4, image.timer(TimerKind::rose, 0)),
              encode(Op::changed, 5, 0, image.timer(TimerKind::changed, 1 * kScale)),
              encode(Op::or_, 4, 4, 5), encode(Op::ret, 4)},
             22);
  image.behaviors.push_back({-1, kNoIndex, 0b011, 6, 3, 2, 6, 1, 6});
}

inline ImageBuilder make() {
  ImageBuilder image;
  add_robot(image);
  add_memory(image);
  const std::uint16_t zero = image.constant(0);
  const std::uint16_t three = image.constant(3 * kScale);
  static_cast<void>(zero);
  add_safety(image, three);
  add_greet(image, three);
  add_back_off(image, three);
  image.inputs = {touch_force, input_of(mood),   input_of(visitors), input_of(mood), touch_level,
                  distance,    input_of(called), touch_force,        touch_level};
  image.source_lines = {{0, 4}, {2, 7}, {4, 10}};
  return image;
}

}  // namespace robosync::vm::test::companion
