// Each check of the verifier that looks at records: a good image made wrong in one place, and
// exactly that place refused.
#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"
#include "tests/vm/refusal_checks.hpp"
#include "vm/drivers.hpp"
#include "vm/verifier.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
namespace robot = robosync::vm::test::companion;

namespace {

constexpr std::uint16_t kNowhere = 9999;  // no string, no record

// Refuses what `wrong` makes of the record at `index` of `records`.
template <typename Record, typename Wrong>
void refused_record(std::vector<Record> ImageBuilder::*records, Section section, Refusal refusal,
                    std::uint16_t index, Wrong wrong) {
  check_refused([&](ImageBuilder& i) { wrong((i.*records)[index]); }, {refusal, section, index});
}

}  // namespace

TEST_CASE("sensors") {
  const auto refused = [](Refusal refusal, std::uint16_t index, auto wrong) {
    check_refused([&](ImageBuilder& i) { wrong(i.sensors); }, {refusal, Section::sensors, index});
  };
  refused(Refusal::no_driver, 0, [](auto& s) { s[0].driver = static_cast<DriverId>(200); });
  refused(Refusal::no_driver, 1, [](auto& s) { s[1].driver = DriverId::count_; });
  refused(Refusal::bad_value, 1, [](auto& s) { s[1].driver = DriverId::virtual_actuator; });
  refused(Refusal::bad_value, 0, [](auto& s) { s[0].room = 1; });
  refused(Refusal::bad_index, 0, [](auto& s) { s[0].first_channel = 1; });
  refused(Refusal::bad_index, 1, [](auto& s) { s[1].first_channel = 1; });  // overlaps the first
  refused(Refusal::bad_index, 1, [](auto& s) { s[0].channel_count = 1; });  // leaves a gap
  refused(Refusal::bad_index, 1, [](auto& s) { s[1].channel_count = 2; });  // one too many
  refused(Refusal::bad_index, 0, [](auto& s) { s[0].channel_count = 255; });
  // What is measured is measured again and again, at an address that there is.
  refused(Refusal::bad_value, 0, [](auto& s) { s[0].period_ms = 0; });
  refused(Refusal::bad_value, 0, [](auto& s) { s[0].address = 0x07; });
  refused(Refusal::bad_value, 0, [](auto& s) { s[0].address = 0x78; });
  refused(Refusal::bad_value, 0, [](auto& s) { s[0].address = 0xFFFF; });
  // A pin may be any here; the board knows its own. Two levels can be the active one.
  refused(Refusal::bad_value, 0, [](auto& s) {
    s[0].driver = DriverId::digital_input;
    s[0].period_ms = 0;
  });
  refused(Refusal::bad_value, 0, [](auto& s) {
    s[0].driver = DriverId::digital_input;
    s[0].bus = 2;
  });
  // What is measured by an echo has both pins for itself, and its time.
  const auto by_echo = [](Sensor& sensor, unsigned trigger, unsigned echo) {
    sensor.driver = DriverId::hc_sr04;
    sensor.bus = static_cast<std::uint8_t>(trigger);
    sensor.address = static_cast<std::uint16_t>(echo);
    sensor.period_ms = kMinEchoPeriodMs;
  };
  refused(Refusal::shared_pin, 0, [&](auto& s) { by_echo(s[0], 20, 20); });
  refused(Refusal::bad_value, 0, [&](auto& s) {
    by_echo(s[0], 20, 40);
    s[0].period_ms = kMinEchoPeriodMs - 1;
  });
  // What is told to measure has its time, too.
  const auto by_light = [](Sensor& sensor, std::uint16_t period_ms) {
    sensor.driver = DriverId::vl53l0x;
    sensor.address = 0x29;
    sensor.period_ms = period_ms;
  };
  refused(Refusal::bad_value, 0, [&](auto& s) { by_light(s[0], kMinRangingPeriodMs - 1); });
  {
    ImageBuilder image = robot::make();
    by_light(image.sensors[0], kMinRangingPeriodMs);
    check_accepted(image);
  }
  // A microphone has the board's rate, no place, and no second one or analog input beside it.
  const auto by_ear = [](Sensor& sensor) {
    sensor.driver = DriverId::microphone;
    sensor.bus = 0;
    sensor.address = 0;
    sensor.period_ms = kSoundPeriodMs;
  };
  {
    ImageBuilder image = robot::make();
    by_ear(image.sensors[0]);
    check_accepted(image);
  }
  for (const int period : {0, kSoundPeriodMs - 1, kSoundPeriodMs + 1})
    refused(Refusal::bad_value, 0, [&](auto& s) {
      by_ear(s[0]);
      s[0].period_ms = static_cast<std::uint16_t>(period);
    });
  refused(Refusal::bad_value, 0, [&](auto& s) {
    by_ear(s[0]);
    s[0].bus = 1;
  });
  refused(Refusal::bad_value, 0, [&](auto& s) {
    by_ear(s[0]);
    s[0].address = 1;
  });
  refused(Refusal::too_many, 1, [&](auto& s) {
    by_ear(s[0]);
    by_ear(s[1]);
  });
  for (const std::size_t ear : {0, 1})
    refused(Refusal::bad_value, static_cast<std::uint16_t>(ear), [&](auto& s) {
      by_ear(s[ear]);
      s[1 - ear].driver = DriverId::analog_input;
      s[1 - ear].bus = 0;
      s[1 - ear].address = 44;
      s[1 - ear].period_ms = 20;
    });
  for (const auto& [trigger, echo] : {std::pair{20, 41}, {21, 40}, {40, 21}, {21, 20}})
    refused(Refusal::shared_pin, 1, [&, trigger = trigger, echo = echo](auto& s) {
      by_echo(s[0], 20, 40);
      by_echo(s[1], static_cast<unsigned>(trigger), static_cast<unsigned>(echo));
    });
  refused(Refusal::shared_pin, 1, [&](auto& s) {
    s[0].driver = DriverId::digital_input;
    s[0].bus = 0;
    s[0].address = 40;
    by_echo(s[1], 20, 40);
  });
  // It may hear nothing: what SAFETY reads of it grows stale.
  check_refused(
      [&](ImageBuilder& image) {
        by_echo(image.sensors[0], 20, 40);
        image.channels[1].stale_ms = 0;
      },
      {Refusal::never_stale, Section::behaviors, 0});
  {
    ImageBuilder image = robot::make();
    by_echo(image.sensors[0], 20, 40);
    by_echo(image.sensors[1], 21, 41);
    check_accepted(image);
    const auto drives = [&](std::uint16_t pin) {
      ImageBuilder taken = image;
      taken.actuators[1].pin = pin;
      return taken;
    };
    check_refused(drives(20), {Refusal::shared_pin, Section::actuators, 1});
    check_refused(drives(41), {Refusal::shared_pin, Section::actuators, 1});
  }
  // What is measured as a voltage has its pin for itself, and nothing on a bus.
  const auto voltage = [](Sensor& sensor, unsigned pin) {
    sensor.driver = DriverId::analog_input;
    sensor.bus = 0;
    sensor.address = static_cast<std::uint16_t>(pin);
    sensor.period_ms = 20;
  };
  refused(Refusal::bad_value, 0, [&](auto& s) {
    voltage(s[0], 44);
    s[0].period_ms = 0;
  });
  refused(Refusal::bad_value, 0, [&](auto& s) {
    voltage(s[0], 44);
    s[0].bus = 1;
  });
  refused(Refusal::shared_pin, 1, [&](auto& s) {
    voltage(s[0], 44);
    voltage(s[1], 44);
  });
  refused(Refusal::shared_pin, 1, [&](auto& s) {
    by_echo(s[0], 20, 40);
    voltage(s[1], 20);
  });
  refused(Refusal::shared_pin, 1, [&](auto& s) {
    voltage(s[0], 20);
    by_echo(s[1], 20, 40);
  });
  check_refused(
      [&](ImageBuilder& image) {
        voltage(image.sensors[0], 44);
        image.channels[1].stale_ms = 0;
      },
      {Refusal::never_stale, Section::behaviors, 0});
  {
    ImageBuilder image = robot::make();
    voltage(image.sensors[0], 44);
    voltage(image.sensors[1], 0xFFFE);
    check_accepted(image);
    image.actuators[1].pin = 44;
    check_refused(image, {Refusal::shared_pin, Section::actuators, 1});
  }
  for (const int address : {0x00, 0xFFFE}) {
    ImageBuilder image = robot::make();
    image.sensors[0].driver = DriverId::digital_input;
    image.sensors[0].address = static_cast<std::uint16_t>(address);
    image.sensors[0].bus = 1;
    check_accepted(image);
  }
  for (const int address : {0x08, 0x77}) {
    ImageBuilder image = robot::make();
    image.sensors[0].address = static_cast<std::uint16_t>(address);
    check_accepted(image);
  }
}

TEST_CASE("an algorithm reads what was measured before it, every so often") {
  const auto algorithm = [](std::uint8_t first_input, std::uint16_t period_ms) {
    return [=](ImageBuilder& image) {
      image.sensors[1].driver = DriverId::algorithm;
      image.sensors[1].first_input = first_input;
      image.sensors[1].period_ms = period_ms;
    };
  };
  ImageBuilder good = robot::make();
  algorithm(1, 20)(good);
  check_accepted(good);
  check_refused(algorithm(2, 20), {Refusal::bad_index, Section::sensors, 1});  // itself
  check_refused(algorithm(200, 20), {Refusal::bad_index, Section::sensors, 1});
  check_refused(algorithm(0, 0), {Refusal::bad_value, Section::sensors, 1});
  // What SAFETY reads of it grows stale, as what it is made of does.
  const auto safety_reads = [&](std::uint16_t stale_ms) {
    ImageBuilder image = robot::make();
    algorithm(1, 20)(image);
    image.inputs[image.behaviors[kSafetyBehavior].first_input] = 2;
    image.channels[2].stale_ms = stale_ms;
    return image;
  };
  check_refused(safety_reads(0), {Refusal::never_stale, Section::behaviors, 0});
  check_accepted(safety_reads(100));
  // Others read nothing.
  for (const std::uint16_t index : {std::uint16_t{0}, std::uint16_t{1}})
    check_refused([&](ImageBuilder& i) { i.sensors[index].first_input = 1; },
                  {Refusal::bad_value, Section::sensors, index});
}

TEST_CASE("a driver that the firmware does not have is named by its record") {
  Limits limits;
  limits.drivers = ~(std::uint64_t{1} << static_cast<unsigned>(DriverId::max34451));
  check_refused(robot::make(), {Refusal::no_driver, Section::sensors, 0}, limits);
  limits.drivers = ~(std::uint64_t{1} << static_cast<unsigned>(DriverId::player));
  check_refused(robot::make(), {Refusal::no_driver, Section::actuators, 2}, limits);
}

TEST_CASE("channels") {
  const auto refused = [](Refusal refusal, std::uint16_t index, auto wrong) {
    check_refused([&](ImageBuilder& i) { wrong(i.channels); }, {refusal, Section::channels, index});
  };
  refused(Refusal::bad_index, 0, [](auto& c) { c[0].sensor = 1; });
  refused(Refusal::bad_index, 2, [](auto& c) { c[2].sensor = 0; });
  refused(Refusal::bad_index, 2, [](auto& c) { c[2].sensor = 2; });
  refused(Refusal::bad_value, 1, [](auto& c) { c[1].dimension = static_cast<Dimension>(16); });
  refused(Refusal::bad_index, 1, [](auto& c) { c[1].label_count = 5; });
  refused(Refusal::bad_index, 1, [](auto& c) {
    c[1].label_count = 1;
    c[1].first_label = 4;
  });
  refused(Refusal::bad_index, 1, [](auto& c) { c[1].first_label = kNowhere; });
  refused(Refusal::bad_value, 1, [](auto& c) { c[1].scale_den = 0; });
  refused(Refusal::bad_value, 1, [](auto& c) { c[1].offset = kUnknown; });
  refused(Refusal::bad_value, 1, [](auto& c) { c[1].min = kUnknown; });
  refused(Refusal::bad_value, 1, [](auto& c) { c[1].max = c[1].min - 1; });
  refused(Refusal::bad_value, 1, [](auto& c) { c[1].change = -1; });
  check_refused([](ImageBuilder& i) { i.channels[1].stale_ms = 0; },
                {Refusal::never_stale, Section::behaviors, 0});
  {
    ImageBuilder image = robot::make();
    image.channels[0].stale_ms = 0;  // SAFETY does not read it
    image.channels[2].stale_ms = 0;  // it is fed
    check_accepted(image);
  }
  // A channel that no sensor owns.
  check_refused([](ImageBuilder& i) { i.channels.push_back(i.channels[2]); },
                {Refusal::bad_index, Section::channels, 3});
}

TEST_CASE("a channel's sensor exists, whatever stands behind the last sensor") {
  // Behind the sensors stand the channels; here the first one reads like a sensor of channels 0
  // to 2.
  check_refused(
      [](ImageBuilder& i) {
        i.channels[0].scale_den = 3 << 8;
        i.channels[2].sensor = 2;
      },
      {Refusal::bad_index, Section::channels, 2});
}

TEST_CASE("the ends of what is allowed are allowed") {
  ImageBuilder image = robot::make();
  image.behaviors[robot::greet].priority = 99;
  image.behaviors[robot::back_off].priority = kMinPriority;
  image.channels[1].max = image.channels[1].min;
  image.actuators[2].max = image.actuators[2].min = kValueMin;
  image.actuators[2].speed_limit = 0;
  image.variables[robot::visitors].initial = kValueMax;
  image.variables[robot::visitors].min = kValueMax;
  image.variables[robot::joy].fade = 0x7FFFFFFF;
  image.variables[robot::joy].fades_to = image.variables[robot::joy].max;
  image.checks[0].window = kMaxWindow;
  image.bands[0] = {0, 0, 0, 0};
  image.timers[robot::firm_for].duration = kValueMax;
  image.timers.back().duration = 0;
  check_accepted(image);
}

TEST_CASE("actuators") {
  const auto refused = [](Refusal refusal, std::uint16_t index, auto wrong) {
    check_refused([&](ImageBuilder& i) { wrong(i.actuators); },
                  {refusal, Section::actuators, index});
  };
  refused(Refusal::no_driver, 2, [](auto& a) { a[2].driver = DriverId::count_; });
  refused(Refusal::bad_value, 2, [](auto& a) { a[2].driver = DriverId::i2c_register; });
  refused(Refusal::bad_value, 2, [](auto& a) { a[2].on_release = Release::count_; });
  refused(Refusal::bad_value, 2, [](auto& a) { a[2].safe = Release::count_; });
  refused(Refusal::bad_value, 2, [](auto& a) { a[2].min = a[2].max + 1; });
  refused(Refusal::bad_value, 2, [](auto& a) { a[2].min = kUnknown; });
  refused(Refusal::bad_value, 2, [](auto& a) { a[2].speed_limit = -1; });
  refused(Refusal::bad_value, 2, [](auto& a) { a[2].speed_limit = kUnknown; });
  refused(Refusal::bad_index, 0, [](auto& a) { a[0].verbs |= 1 << 2; });
  refused(Refusal::shared_pin, 1, [](auto& a) { a[1].pin = a[0].pin; });
  refused(Refusal::drives_on, 0, [](auto& a) {
    a[0].driver = DriverId::pwm;
    a[0].safe = Release::hold;
  });
  // What has two pins has both for itself.
  const auto two = [](Actuator& actuator, std::uint16_t first, unsigned second) {
    actuator.driver = DriverId::motor;
    actuator.pin = first;
    actuator.bus = static_cast<std::uint8_t>(second);
    actuator.safe = Release::coast;
  };
  refused(Refusal::shared_pin, 1, [&](auto& a) { two(a[1], 20, 20); });
  refused(Refusal::shared_pin, 1, [&](auto& a) { two(a[1], 20, a[0].pin); });
  refused(Refusal::shared_pin, 1, [&](auto& a) { two(a[1], a[0].pin, 20); });
  refused(Refusal::shared_pin, 1, [&](auto& a) { two(a[0], 20, a[1].pin); });
  refused(Refusal::shared_pin, 1, [&](auto& a) {
    two(a[0], 20, 21);
    two(a[1], 22, 21);
  });
  refused(Refusal::drives_on, 1, [&](auto& a) {
    two(a[1], 20, 21);
    a[1].safe = Release::hold;
  });
  check_refused(
      [&](ImageBuilder& i) {
        i.sensors[0].driver = DriverId::digital_input;
        i.sensors[0].bus = 0;
        i.sensors[0].address = 21;
        two(i.actuators[1], 20, 21);
      },
      {Refusal::shared_pin, Section::actuators, 1});
  // Nor may a pin be driven that is read.
  check_refused(
      [](ImageBuilder& i) {
        i.sensors[0].driver = DriverId::digital_input;
        i.sensors[0].bus = 0;
        i.sensors[0].address = i.actuators[1].pin;
      },
      {Refusal::shared_pin, Section::actuators, 1});
  ImageBuilder image = robot::make();
  image.actuators[0].pin = image.sensors[0].address;  // on I2C that is no pin
  image.actuators[2].pin = image.actuators[0].pin;    // a player has none
  image.actuators[0].safe = Release::hold;            // a servo may
  image.actuators[1].driver = DriverId::pwm;
  image.actuators[1].on_release = Release::hold;
  check_accepted(image);
  two(image.actuators[1], 20, 21);
  check_accepted(image);
}

TEST_CASE("groups, verbs, words") {
  check_refused([](auto& i) { i.groups[0].members = 0; }, {Refusal::bad_value, Section::groups, 0});
  check_refused([](auto& i) { i.groups[0].reserved = 1; },
                {Refusal::bad_value, Section::groups, 0});
  check_refused([](auto& i) { i.groups[0].members |= 1 << 3; },
                {Refusal::bad_index, Section::groups, 0});
  check_refused([](auto& i) { i.verbs[1].action = Action::count_; },
                {Refusal::bad_value, Section::verbs, 1});
  check_refused([](auto& i) { i.words[2].param = Param::count_; },
                {Refusal::bad_value, Section::words, 2});
  check_refused([](auto& i) { i.words[2].reserved = 1; }, {Refusal::bad_value, Section::words, 2});
  check_refused([](auto& i) { i.words[2].value = kUnknown; },
                {Refusal::bad_value, Section::words, 2});
}

TEST_CASE("variables") {
  const auto refused = [](Refusal refusal, std::uint16_t index, auto wrong) {
    refused_record(&ImageBuilder::variables, Section::variables, refusal, index, wrong);
  };
  for (std::uint16_t index = 0; index < 5; ++index) {
    refused(Refusal::bad_value, index, [](auto& v) { v.dimension = static_cast<Dimension>(16); });
    refused(Refusal::bad_value, index, [](auto& v) { v.reserved = 1; });
    refused(Refusal::bad_value, index, [](auto& v) { v.min = kUnknown; });
    refused(Refusal::bad_value, index, [](auto& v) { v.max = v.min - 1; });
    refused(Refusal::bad_index, index, [](auto& v) { v.first_label = kNowhere; });
  }
  refused(Refusal::bad_value, robot::visitors, [](auto& v) { v.kind = VariableKind::count_; });
  refused(Refusal::bad_value, robot::visitors, [](auto& v) { v.initial = kUnknown; });
  refused(Refusal::bad_value, robot::visitors, [](auto& v) { v.initial = v.min - 1; });
  refused(Refusal::bad_value, robot::joy, [](auto& v) { v.initial = v.max + 1; });
  refused(Refusal::bad_value, robot::nearness, [](auto& v) { v.initial = 0; });
  // Labels: of states and bands, and only of these.
  refused(Refusal::bad_value, robot::visitors, [](auto& v) { v.label_count = 1; });
  refused(Refusal::bad_value, robot::called, [](auto& v) { v.label_count = 1; });
  refused(Refusal::bad_value, robot::mood, [](auto& v) { v.label_count = 0; });
  refused(Refusal::bad_index, robot::mood, [](auto& v) { v.label_count = 5; });
  refused(Refusal::bad_index, robot::nearness, [](auto& v) { v.first_label = 3; });
  // A state never leaves its labels.
  refused(Refusal::bad_value, robot::mood, [](auto& v) { v.min = -1; });
  refused(Refusal::bad_value, robot::mood, [](auto& v) { v.max = v.label_count * kScale; });
  // Only feelings fade, never away from their range, and never without end.
  refused(Refusal::bad_value, robot::visitors, [](auto& v) { v.fade = 1; });
  refused(Refusal::bad_value, robot::joy, [](auto& v) { v.fade = 0x80000000; });
  refused(Refusal::bad_value, robot::joy, [](auto& v) { v.fades_to = v.max + 1; });
  refused(Refusal::bad_value, robot::joy, [](auto& v) { v.fades_to = kUnknown; });
}

TEST_CASE("checks and bands") {
  const auto refused = [](Refusal refusal, auto wrong) {
    refused_record(&ImageBuilder::checks, Section::checks, refusal, 0, wrong);
  };
  refused(Refusal::bad_index, [](auto& c) { c.variable = 5; });
  refused(Refusal::bad_index, [](auto& c) { c.input = 8; });
  refused(Refusal::bad_index, [](auto& c) { c.first_band = 1; });
  refused(Refusal::bad_index, [](auto& c) { c.band_count = 3; });
  refused(Refusal::bad_value, [](auto& c) { c.band_count = 1; });  // labels for two
  refused(Refusal::bad_value, [](auto& c) { c.variable = robot::mood; });
  refused(Refusal::bad_value, [](auto& c) { c.input = robot::input_of(robot::nearness); });
  refused(Refusal::bad_value, [](auto& c) { c.window = 0; });
  refused(Refusal::bad_value, [](auto& c) { c.window = kMaxWindow + 1; });
  refused(Refusal::bad_value, [](auto& c) { c.sample_ms = 0; });
  ImageBuilder image = robot::make();
  image.checks[0].input = robot::input_of(robot::joy);
  image.checks[0].window = 1;
  image.checks[0].sample_ms = 0;
  check_accepted(image);

  const auto band_refused = [](auto wrong) {
    refused_record(&ImageBuilder::bands, Section::bands, Refusal::bad_value, 0, wrong);
  };
  band_refused([](auto& b) { b.low = b.high + 1; });
  band_refused([](auto& b) { b.stay_low = b.low + 1; });
  band_refused([](auto& b) { b.stay_high = b.high - 1; });
  band_refused([](auto& b) { b.stay_low = kUnknown; });
  band_refused([](auto& b) { b.low = kUnknown; });
  band_refused([](auto& b) {  // no band to stay in, and none to enter
    b.stay_low = 1;
    b.stay_high = 0;
    b.low = b.high + 1;
  });
  image.bands[1].stay_low = 1;  // of a check without MARGIN: left at once
  image.bands[1].stay_high = 0;
  check_accepted(image);
}

TEST_CASE("modifiers and timers") {
  const auto modifiers_refused = [](auto wrong) {
    refused_record(&ImageBuilder::modifiers, Section::modifiers, Refusal::bad_value, 0, wrong);
  };
  modifiers_refused([](auto& m) { m.cooldown = -1; });
  modifiers_refused([](auto& m) { m.waiting = kUnknown; });
  modifiers_refused([](auto& m) { m.restarting = 2; });
  modifiers_refused([](auto& m) { m.reserved[2] = 1; });

  const auto refused = [](std::uint16_t index, auto wrong) {
    refused_record(&ImageBuilder::timers, Section::timers, Refusal::bad_value, index, wrong);
  };
  refused(robot::firm_for, [](auto& t) { t.kind = TimerKind::count_; });
  refused(robot::firm_for, [](auto& t) { t.duration = -1; });
  refused(robot::firm_for, [](auto& t) { t.duration = kUnknown; });
  refused(robot::firm_for, [](auto& t) { t.count = 1; });
  refused(robot::many_times, [](auto& t) { t.count = 0; });
  refused(robot::many_times, [](auto& t) { t.count = kMaxEdges + 1; });
  // They follow each other in the memory, each in as many words as it needs.
  refused(robot::firm_for, [](auto& t) { t.state = 1; });
  refused(robot::many_times, [](auto& t) { t.state = 0; });
  refused(robot::first_then, [](auto& t) { t.state = 4; });
  refused(robot::far_latch, [](auto& t) { t.state = 6; });
  refused(robot::became, [](auto& t) { t.state = 0xFFFF; });
}

TEST_CASE("behaviours") {
  const auto refused = [](Refusal refusal, std::uint16_t index, auto wrong) {
    check_refused([&](ImageBuilder& i) { wrong(i.behaviors); },
                  {refusal, Section::behaviors, index});
  };
  refused(Refusal::same_priority, 2, [](auto& b) { b[2].priority = b[1].priority; });
  refused(Refusal::same_priority, 1, [](auto& b) { b[1].priority = kSafetyPriority; });
  refused(Refusal::bad_value, 2, [](auto& b) { b[2].priority = 51; });
  refused(Refusal::bad_value, 0, [](auto& b) { b[0].priority = kSafetyPriority + 1; });
  refused(Refusal::bad_value, 2, [](auto& b) { b[2].priority = kMinPriority - 1; });
  refused(Refusal::bad_index, 0, [](auto& b) { b[0].first_rule = 1; });
  refused(Refusal::bad_index, 1, [](auto& b) { b[1].first_rule = 0; });
  refused(Refusal::bad_index, 1, [](auto& b) { b[1].first_rule = 3; });
  refused(Refusal::bad_index, 2, [](auto& b) { b[2].rule_count = 3; });
  refused(Refusal::bad_index, 1, [](auto& b) { b[1].rule_count = 0; });
  refused(Refusal::bad_index, 2, [](auto& b) { b[2].first_input = 7; });
  refused(Refusal::bad_index, 1, [](auto& b) { b[1].first_input = kNowhere; });
  refused(Refusal::bad_index, 0, [](auto& b) { b[0].input_count = 10; });
  // Fewer cells than four inputs, three locals and one watch.
  refused(Refusal::bad_value, 1, [](auto& b) { b[1].cells = 7; });
  refused(Refusal::bad_value, 1, [](auto& b) { b[1].locals = 255; });
  refused(Refusal::mask_differs, 1, [](auto& b) { b[1].actuators |= 1 << 4; });
  refused(Refusal::mask_differs, 0, [](auto& b) { b[0].actuators &= ~1U; });
  refused(Refusal::mask_differs, 2, [](auto& b) { b[2].actuators = 0; });
  // A rule that no behaviour has.
  check_refused([](ImageBuilder& i) { i.behaviors[2].rule_count = 1; },
                {Refusal::bad_index, Section::rules, 7});
}

TEST_CASE("a rule has what its kind has, and nothing else") {
  const auto refused = [](Refusal refusal, std::uint16_t index, auto wrong) {
    refused_record(&ImageBuilder::rules, Section::rules, refusal, index, wrong);
  };
  for (std::uint16_t index = 0; index < 8; ++index) {
    CAPTURE(index);
    refused(Refusal::bad_value, index, [](Rule& r) { r.kind = RuleKind::count_; });
    refused(Refusal::bad_index, index, [](Rule& r) { r.modifiers = 1; });
    refused(Refusal::bad_index, index, [](Rule& r) { r.condition_start = 0xFFFF; });
    refused(Refusal::bad_index, index,
            [](Rule& r) { r.then_response = r.then_response == kNoIndex ? 0 : kNoIndex; });
    refused(Refusal::bad_index, index,
            [](Rule& r) { r.else_response = r.else_response == kNoIndex ? 0 : kNoIndex; });
    refused(Refusal::bad_index, index,
            [](Rule& r) { r.condition_length = r.condition_length == 0 ? 1 : 0; });
    const bool modified = index == robot::touched || index == robot::hug ||
                          index == robot::lively || index == robot::retreat;
    if (!modified) refused(Refusal::bad_index, index, [](Rule& r) { r.modifiers = 0; });
  }
  refused(Refusal::bad_index, robot::hug, [](Rule& r) { r.then_response = 7; });
  refused(Refusal::bad_index, robot::touched, [](Rule& r) { r.else_response = 7; });
  check_refused(
      [](ImageBuilder& i) {
        Rule& rule = i.rules[robot::hug];
        rule.condition_start =
            static_cast<std::uint16_t>(i.code.size() - rule.condition_length + 1U);
      },
      {Refusal::bad_index, Section::rules, robot::hug});
}

TEST_CASE("SAFETY rules are the first behaviour's, which has no others") {
  const auto refused = [](std::uint16_t index, auto wrong) {
    refused_record(&ImageBuilder::rules, Section::rules, Refusal::bad_value, index, wrong);
  };
  refused(robot::pinch, [](Rule& r) { r.kind = RuleKind::when; });
  refused(robot::pinch_resume, [](Rule& r) { r.kind = RuleKind::watch; });
  refused(robot::hug, [](Rule& r) { r.kind = RuleKind::safety; });
  refused(robot::watch_far, [](Rule& r) { r.kind = RuleKind::resume; });
  // Without its priority it is an ordinary behaviour, with rules that are not for it.
  check_refused([](ImageBuilder& i) { i.behaviors[0].priority = 99; },
                {Refusal::bad_value, Section::rules, robot::pinch});
  // What lets a safety rule go follows it: not another, and not nothing.
  check_refused(
      [](ImageBuilder& i) {
        i.rules.insert(i.rules.begin() + 1, i.rules[robot::pinch_resume]);
        i.behaviors[0].rule_count = 3;
        i.behaviors[1].first_rule = 3;
        i.behaviors[2].first_rule = 7;
      },
      {Refusal::bad_value, Section::rules, 2});
  check_refused([](ImageBuilder& i) { std::swap(i.rules[0], i.rules[1]); },
                {Refusal::bad_value, Section::rules, 0});
}

TEST_CASE("responses") {
  const auto refused = [](std::uint16_t index, auto wrong) {
    refused_record(&ImageBuilder::responses, Section::responses, Refusal::bad_index, index, wrong);
  };
  refused(2, [](Response& r) { r.length = 0; });
  refused(2, [](Response& r) { r.start = 0xFFFF; });
  refused(0, [](Response& r) { r.length = 0xFFFF; });
}

TEST_CASE("adaptation: none or one, in its ranges") {
  const auto with = [](auto change) {
    ImageBuilder image = robot::make();
    image.adaptations = {{.alpha = 2000, .window_ms = 10'000, .cap = 95, .reserved = {}}};
    change(image.adaptations);
    return image;
  };
  check_accepted(with([](auto&) {}));
  check_accepted(with([](auto& a) { a[0] = {1, kMinAdaptationMs, 1, {}}; }));
  check_accepted(with([](auto& a) { a[0] = {0xFFFF, 0xFFFF, kMaxPriority, {}}; }));
  const auto refused = [&](auto wrong) {
    check_refused([&](auto& image) { image = with([&](auto& a) { wrong(a[0]); }); },
                  {Refusal::bad_value, Section::adaptations, 0});
  };
  refused([](auto& a) { a.alpha = 0; });
  refused([](auto& a) { a.window_ms = kMinAdaptationMs - 1; });
  refused([](auto& a) { a.cap = 0; });
  refused([](auto& a) { a.cap = kMaxPriority + 1; });
  refused([](auto& a) { a.reserved[2] = 1; });
  check_refused([&](auto& image) { image = with([](auto& a) { a.push_back(a[0]); }); },
                {Refusal::bad_value, Section::header, 0});
}

TEST_CASE("motions: their tracks and keys follow each other, and keys come in time's order") {
  const auto with = [](auto change) {
    ImageBuilder image = robot::make();
    const std::uint16_t name = image.name("wave");
    image.motions = {{name, 0, 2, 600}, {name, 2, 1, kMinKeyGapMs}};
    image.tracks = {{0, 3, 0}, {1, 1, 3}, {1, 1, 4}};
    image.keys = {{0, 0}, {20, -5000}, {600, 5000}, {600, 0}, {0, 1}};
    change(image);
    return image;
  };
  check_accepted(with([](auto&) {}));
  const auto refused = [&](auto wrong, Refusal refusal, Section section, std::uint16_t record) {
    check_refused([&](auto& image) { image = with(wrong); }, {refusal, section, record});
  };
  constexpr auto kIndex = Refusal::bad_index;
  constexpr auto kValue = Refusal::bad_value;
  refused([](auto& i) { i.motions[0].name = 0xFFFE; }, Refusal::bad_string, Section::motions, 0);
  refused([](auto& i) { i.motions[1].first_track = 1; }, kIndex, Section::motions, 1);
  refused([](auto& i) { i.motions[1].track_count = 2; }, kIndex, Section::motions, 1);
  refused(
      [](auto& i) {
        i.motions[0].track_count = 0;
        i.motions[1].first_track = 0;
      },
      kValue, Section::motions, 0);
  refused([](auto& i) { i.motions[1].length = kMinKeyGapMs - 1; }, kValue, Section::motions, 1);
  refused([](auto& i) { i.motions.pop_back(); }, kIndex, Section::tracks, 2);
  refused([](auto& i) { i.tracks[1].actuator = 200; }, kIndex, Section::tracks, 1);
  refused([](auto& i) { i.tracks[1].first_key = 2; }, kIndex, Section::tracks, 1);
  refused([](auto& i) { i.tracks[2].key_count = 2; }, kIndex, Section::tracks, 2);
  refused([](auto& i) { i.tracks[2].key_count = 0; }, kValue, Section::tracks, 2);
  refused([](auto& i) { i.keys[1].time = 19; }, kValue, Section::tracks, 0);
  refused([](auto& i) { i.keys[2].time = 20; }, kValue, Section::tracks, 0);
  refused([](auto& i) { i.keys[0].time = kUnknown; }, kValue, Section::keys, 0);
  refused([](auto& i) { i.keys[3].to = kUnknown; }, kValue, Section::keys, 3);
  refused([](auto& i) { i.keys[4].time = -1; }, kValue, Section::keys, 4);
  refused([](auto& i) { i.keys.push_back({0, 0}); }, kIndex, Section::keys, 5);
}

TEST_CASE("inputs, constants, source lines") {
  check_refused([](auto& i) { i.inputs[2] = 8; }, {Refusal::bad_index, Section::inputs, 2});
  check_refused([](auto& i) { i.constants[1] = kUnknown; },
                {Refusal::bad_value, Section::constants, 1});
  check_refused([](auto& i) { i.source_lines[2].word = static_cast<std::uint16_t>(i.code.size()); },
                {Refusal::bad_index, Section::source_lines, 2});
  check_refused([](auto& i) { std::swap(i.source_lines[1], i.source_lines[2]); },
                {Refusal::bad_value, Section::source_lines, 2});
}
