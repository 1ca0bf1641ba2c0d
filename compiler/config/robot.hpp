// The robot, as robot.json and the device descriptors describe it. Sema resolves names against it, and codegen writes it into the
// image. Values are thousandths of the canonical unit (vm/value.hpp) throughout.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/config/names.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/units/units.hpp"
#include "vm/drive.hpp"
#include "vm/image.hpp"

namespace robosync::compiler {

constexpr std::size_t kMaxLabels = 255;  // of a channel
// A channel without "stale_after" is stale when it is silent for so many periods.
constexpr int kStalePeriods = 5;

struct ChannelConfig {
  Spelled name;
  const Unit* unit = nullptr;  // never null once read; the unit of numbers without one
  Span unit_span;              // where robot.json gives the unit, or else the channel or sensor
  std::uint8_t input = 0;
  vm::Value min = vm::kValueMin;
  vm::Value max = vm::kValueMax;
  vm::Value change = 0;
  vm::Value offset = 0;
  Scale scale;                  // one raw count
  std::uint16_t period_ms = 0;  // 0: only when fed
  std::uint16_t stale_ms = 0;   // 0: never stale
  bool stale_by_rate = false;   // stale_ms follows from the rate: "stale_after" is not given
  // For a channel whose values are words: value n is label n. Its range is then 0 … labels - 1.
  std::vector<std::string> labels;
  bool truth = false;  // its two labels mean false and true: it may be a condition on its own
  // The words that the program compares it with become labels, after these, when the program is analysed.
  bool learns_words = false;

  void add_label(std::string label);  // the range grows with it
};

// Makes a sensor an algorithm: its channels are the outputs of a module.
struct AlgorithmConfig {
  std::uint8_t module = 0;  // its number (algorithm_modules.hpp)
  std::size_t input = 0;    // the sensor that it reads: an index in Robot::sensors
  std::size_t first = 0;    // the first channel of it that it reads …
  std::size_t inputs = 0;   // … and how many
  std::vector<vm::Value>
      config;  // its parameters, all of them, and what it was taught: how many constants, and these
  std::uint8_t room = 0;  // vm::Sensor::room
  Span input_span{};      // where robot.json names its input
};

// Makes a fed sensor the outputs of a module that runs on a companion computer.
struct CompanionConfig {
  std::string module;
  std::uint16_t period_ms = 0;    // how often it sends its results
  std::vector<vm::Value> config;  // its parameters, all of them
};

struct SensorConfig {
  Spelled name;
  std::string device;       // its descriptor in stdlib/devices/
  bool is_unknown = false;  // there is no such descriptor, which has been reported
  std::string part;         // of the board; empty: it is none
  vm::DriverId driver{};
  std::uint8_t bus = 0;
  std::uint16_t address = 0;    // or pin
  std::uint16_t period_ms = 0;  // of its fastest channel
  std::uint8_t format = 0;      // vm::SpiFormat of a spi_register; else 0
  std::vector<ChannelConfig> channels;
  std::optional<AlgorithmConfig> algorithm;
  std::optional<CompanionConfig> companion;
  std::string
      words_file;  // the file with the words that the algorithm was taught; empty: it is not taught
  std::string taught_by;  // … and the program of a companion computer that teaches them
};

// The channel of an encoder that says how far its wheel has come; nullopt: it has none.
[[nodiscard]] std::optional<std::size_t> distance_of(const SensorConfig& encoder);

enum class Texts : std::uint8_t {
  none,    // the verb takes no string
  listed,  // one of the actuator's sounds
  any      // any text
};

struct WordConfig {  // SLOWLY, or a sound
  std::string name;
  vm::Param param{};
  vm::Value value = 0;
  bool text = false;                  // written in quotes
  std::optional<vm::Value> duration;  // of a sound, if not the player's default
  std::vector<std::string> verbs{};   // that it belongs to; empty: all that take its parameter
};

struct VerbConfig {
  std::string name;
  vm::Action action{};
  std::uint8_t takes = 0;  // bit p: takes vm::Param p
  Texts texts = Texts::none;
  const Unit* by_unit = nullptr;  // of BY, if it is not the actuator's own

  [[nodiscard]] bool has(vm::Param param) const {
    return (takes >> static_cast<unsigned>(param) & 1u) != 0;
  }
  [[nodiscard]] bool goes_with(const WordConfig& word) const;
  // As in the image: the parameters it takes, and those that carry the values of a text.
  [[nodiscard]] std::uint8_t carries() const {
    std::uint8_t params = takes;
    for (const vm::Param param : vm::kTextParams)
      if (texts == Texts::any)
        params |= static_cast<std::uint8_t>(1u << static_cast<unsigned>(param));
    return params;
  }
};

// A chip that generates pulses for servos, identified by its address.
struct ServoChip {
  std::uint8_t bus = 0;
  std::uint16_t address = 0;
  std::uint8_t enable = 0;  // the board's pin at its OE input

  bool operator==(const ServoChip&) const = default;
};

// A panel or strip of lights, encoded as in the image (vm::is_panel()).
struct PanelConfig {
  std::uint8_t lay = 0;
  vm::Value color = 0;  // of a light that is on; the brightest white of a strip
};

struct ActuatorConfig {
  Spelled name;
  std::string device;  // its descriptor in stdlib/devices/
  std::string part;    // of the board; empty: it is none
  vm::DriverId driver{};
  std::uint8_t bus = 0;
  std::uint16_t pin = 0;  // or the channel of its chip, or the address of its display
  std::optional<ServoChip> chip;
  std::optional<PanelConfig> panel;
  std::optional<vm::DriveParameters> drive;
  std::optional<std::array<std::size_t, 2>> encoders;  // of the drive's wheels: in Robot::sensors
  std::array<Span, 2> encoder_spans{};                 // where robot.json names them
  vm::Release on_release = vm::Release::hold;
  vm::Release safe = vm::Release::hold;
  const Unit* to_unit = nullptr;  // of TO and BY; null: it has no position
  const Unit* at_unit = nullptr;  // of AT; null: it has no speed
  vm::Value min = vm::kValueMin;  // range of TO
  vm::Value max = vm::kValueMax;
  vm::Value lowest = vm::kValueMin;  // that robot.json may give as the range
  vm::Value highest = vm::kValueMax;
  Span range_span;
  vm::ServoPulses pulses;  // of a servo, at the ends of the range
  vm::Value speed_limit = vm::kValueMax;
  Span limit_span;
  std::uint16_t acceleration = 0;  // its limit, as in the image; 0: none
  Span acceleration_span;
  std::uint16_t usual_speed =
      0;                // of a virtual one, in whole units a second; 0: the command says how long
  bool sweeps = false;  // … without a target, across its range and back
  vm::Value word_length = 0;  // of a spoken word, in thousandths of a second; 0: it does not speak
  std::vector<VerbConfig> verbs;
  std::vector<WordConfig> words;

  // TO is not a place, but a number that it shows.
  [[nodiscard]] bool shows_numbers() const;
  // A servo, a motor, wheels: a command can move a part of the robot.
  [[nodiscard]] bool moves() const;
  // It goes TO a place at a speed of its own, which can have a limit of acceleration.
  [[nodiscard]] bool moves_at_a_speed() const;
  [[nodiscard]] const VerbConfig* find_verb(std::string_view verb) const;
  [[nodiscard]] const WordConfig* find_word(std::string_view word) const;         // not a text
  [[nodiscard]] const WordConfig* find_text(std::string_view text) const;         // exact
  [[nodiscard]] std::vector<std::string> words_of(const VerbConfig& verb) const;  // no texts
};

struct GroupConfig {
  Spelled name;
  std::vector<std::size_t> members;  // indexes in Robot::actuators
  std::vector<Span> member_spans{};  // where robot.json names them
};

struct BehaviorConfig {
  Spelled name;
  std::optional<int> priority;
  Span priority_span;
  std::optional<std::size_t> action;  // index in Robot::actuators, or …
  std::optional<std::size_t> action_group;
  Span action_span;
};

// How priorities adapt (vm::Adaptation is the form in the image).
struct SchedulerConfig {
  std::uint16_t alpha = 2000;  // thousandths; 0: they do not adapt
  std::uint16_t window_ms = 10'000;
  std::uint8_t cap = 95;
};

inline constexpr std::int64_t kMaxSeed = 2'147'483'647;

// How long a program waits at its start for the first readings that SAFETY rules need.
inline constexpr std::uint16_t kSafetyStartMs = 100;

// An algorithm whose module file does not exist.
struct MissingModule {
  Spelled name;
  std::string file;
  Span path;
  std::string help;  // how to get it
};

enum class LintLevel : std::uint8_t { allow, warn, deny };

struct Robot {
  std::string name;  // the robot's own; empty: not given
  std::vector<SensorConfig> sensors;
  std::vector<ActuatorConfig> actuators;
  std::vector<GroupConfig> groups;
  std::vector<BehaviorConfig> behaviors;
  std::optional<SchedulerConfig> scheduler;
  std::uint16_t safety_start_ms = kSafetyStartMs;
  std::uint32_t seed = 0;            // of the random numbers; 0: not given
  std::optional<std::size_t> board;  // index in board_names(); nullopt: not given
  std::map<Code, LintLevel> lints;
  std::vector<MissingModule> missing;
  bool complete = true;  // false: it has a mistake, which has been reported
};

// ---- the units that the program's author uses, by the names in the image

struct ActuatorUnits {
  const Unit* to = nullptr;                 // of TO and BY; null: it has no position
  const Unit* at = nullptr;                 // of AT; null: it has no speed
  std::map<std::string, const Unit*> by{};  // of BY, for verbs with their own unit
};

// Values that are not listed are shown in their canonical unit.
struct WrittenUnits {
  std::map<std::string, const Unit*> channels;  // "sensor.CHANNEL"
  std::map<std::string, const Unit*> variables;
  std::map<std::string, ActuatorUnits> actuators;
};

// The units that robot.json gives.
[[nodiscard]] WrittenUnits units_of(const Robot& robot);

}  // namespace robosync::compiler
