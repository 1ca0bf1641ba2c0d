// The compiled program (.rsb): its layout in memory and on the wire.
//
// Little-endian; every record is a plain struct that is read in place. Sections follow the header
// without gaps in the order of sections.def (each padded to 4 bytes), so offsets are derived, never
// stored, and sections cannot overlap. An image is data from outside: do not trust it before verify()
// has accepted it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "vm/value.hpp"

namespace robosync::vm {

using Word = std::uint32_t;  // one instruction: op | a << 8 | b << 16 | c << 24

inline constexpr std::uint32_t kMagic = 0x31425352;  // "RSB1"
inline constexpr std::uint8_t kFormatMajor = 3;      // a board runs only images of its own major

inline constexpr std::uint16_t kNoIndex = 0xFFFF;    // "none" in any u16 index
inline constexpr std::uint8_t kNoWord = 0xFF;        // CMD without a word
inline constexpr std::uint8_t kGroupBit = 0x80;      // target operand: a group, not an actuator
inline constexpr std::uint8_t kAllActuators = 0xFF;  // target operand of halt: every actuator
inline constexpr std::uint8_t kNoModifiers = 0xFF;   // Rule::modifiers: none
inline constexpr std::int16_t kSafetyPriority =
    100;                                            // of the behaviour that holds the SAFETY rules
inline constexpr std::uint8_t kSafetyBehavior = 0;  // its index, if there are any
inline constexpr unsigned kFadeTickMs = 100;        // how often a fading variable moves
inline constexpr unsigned kMaxWindow = 32;          // samples of a median
inline constexpr unsigned kMaxEdges = 16;           // n TIMES WITHIN
inline constexpr unsigned kMaxWritable = 32;        // input cells a behaviour can set: a bit each
inline constexpr unsigned kMaxBlocks = 16;          // blocks open at once in a response
inline constexpr unsigned kMinKeyGapMs = 20;        // between two keys of a MOTION
inline constexpr unsigned kMinAdaptationMs = 100;   // shortest window of adaptive priorities
inline constexpr int kMaxPriority = 99;             // highest that a program can give a behaviour
inline constexpr int kMinPriority = -100;           // lowest of a behaviour without a number

// Limits of the format. A board may have smaller ones (Limits in verifier.hpp).
inline constexpr unsigned kMaxBehaviors = 64;
inline constexpr unsigned kMaxActuators = 32;  // one bit each in an actuator mask
inline constexpr unsigned kMaxVerbs = 32;      // one bit each in Actuator::verbs
inline constexpr unsigned kMaxWords = 255;
inline constexpr unsigned kMaxInputs = 255;         // channels and variables
inline constexpr unsigned kMaxCells = 255;          // frame cells of a behaviour
inline constexpr unsigned kMaxKept = 16;            // KEPT variables: stored as one small record
inline constexpr unsigned kMaxRobotName = 15;       // bytes
inline constexpr unsigned kMaxResponseOutput = 64;  // output words of a response in one step
inline constexpr unsigned kMaxQueued = 8;           // commands that wait for one actuator
// … and for all the actuators of an image.
constexpr unsigned max_queued(unsigned actuators) {
  const unsigned each = kMaxQueued * actuators;
  const unsigned together = 16 + 2 * actuators;
  return each < together ? each : together;
}

enum class Dimension : std::uint8_t {
#define DIMENSION(name, unit, doc) name,
#include "vm/dimensions.def"
#undef DIMENSION
};

enum class Param : std::uint8_t {
#define PARAM(name, spelling, doc) name,
#include "vm/params.def"
#undef PARAM
  count_
};
// Values of parameters, by Param.
using Params = std::array<Value, static_cast<std::size_t>(Param::count_)>;

// These parameters carry the values for the {} places of a text that a command says: verbs that play or say do not use them
// otherwise.
inline constexpr std::array kTextParams = {Param::by, Param::times, Param::direction};

enum class DriverId : std::uint8_t {
#define SENSOR_DRIVER(name, sample, doc) name,
#define ACTUATOR_DRIVER(name, ...) name,
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
  count_
};

// What a verb makes its driver do. The image's verb table joins a name to one of these.
// perform: a MOTION, unknown to drivers; the control layer turns it into moves.
// follow: goes TO a place like move, and replaces the previous follow.
enum class Action : std::uint8_t { move, play, set, stop, perform, follow, count_ };

// What an actuator does when its response is interrupted, and when safety halts it.
enum class Release : std::uint8_t { hold, rest, coast, count_ };

// Sensor::bus of a sensor on a pin: the level there that reads as 1.
enum class ActiveLevel : std::uint8_t { low, high, count_ };

// Sensor::first_input of a spi_register: what its registers hold, high byte first unless it ends in `le`.
enum class SpiFormat : std::uint8_t { uint16, int16, uint16le, int16le, uint8, int8, count_ };

// Actuator::bus of a virtual_motion; its pin is its usual speed, in whole units per second (0: a
// command takes as long as it says).
enum class VirtualMotion : std::uint8_t {
  goes,    // TO and BY are distances, AT and the limit their speed
  sweeps,  // like goes; without a target it sweeps over its range and back
};

// Actuator::bus of a virtual_output: the output of the real one, which gives the time of a command.
enum class VirtualOutput : std::uint8_t {
  level,    // OVER and then FOR
  picture,  // like level; BLINK: its TIMES, or OVER
  tones,    // FOR, else the melody
};

enum class RuleKind : std::uint8_t {
  when,       // edge: the condition becomes true
  when_else,  // edge: the chosen side changes; the first known value chooses a side
  while_,     // level: as long as the condition is true
  every,      // the condition's code computes the time to the next trigger, each time anew
  start,      // once, in the first step; no condition
  watch,      // no response: the truth of its condition is kept in the frame, for responses
  safety,     // level, latched; evaluated by the safety monitor
  resume,     // follows its safety rule: the condition that releases it. No response
  count_
};

// Kinds of variables. All are inputs like channels, numbered after them.
enum class VariableKind : std::uint8_t {
  plain,    // REMEMBER
  state,    // STATE: its value is the index of a label, in thousandths
  feeling,  // FEELING
  signal,   // counts the SIGNALs
  band,     // of a CHECK: the index of a band's label, in thousandths; only the check sets it
  timer,    // TIMER: program time of its last RESTART
  kept,     // REMEMBER … KEPT: plain, and outlasts a power loss where it can be stored
  count_
};

// The memory of a time word. Its state is words of the program's timer memory.
enum class TimerKind : std::uint8_t {
#define TIMER(name, words, counts, doc) name,
#include "vm/timers.def"
#undef TIMER
  count_
};

using ProgramHash = std::array<std::uint8_t, 8>;

struct ImageHeader {
  std::uint32_t magic;         // kMagic
  std::uint32_t crc32;         // CRC-32 (IEEE) of everything after this field
  std::uint32_t total_length;  // bytes, including the header; a multiple of 4
  std::uint8_t format_major;
  std::uint8_t board;        // the board it is for, a number computed from its name; 0: none
  std::uint16_t opcode_set;  // opcode_set_id() of the compiler's opcodes.def
  ProgramHash program_hash;  // the image's name (identity.hpp)
  std::uint32_t seed;        // for RANDOM and PICK ONE; 0: the runtime chooses one
  std::uint32_t step_cost;   // worst-case M4 instructions of VM code in one step
  // Records in each section; those of `inputs` and `labels` are numbers, of `strings` bytes, of `code`
  // instruction words. Without source_lines (--strip), traces and faults have no line numbers.
#define IMAGE_SECTION(records, Record, Count, check, name) Count records;
#include "vm/sections.def"
#undef IMAGE_SECTION
  // The longest time that a robot waits for the readings of SAFETY rules before program time begins.
  std::uint16_t safety_start_ms;
};
static_assert(sizeof(ImageHeader) == 68);

enum class TraitKind : std::uint8_t {
  name,  // `value`: the name of the robot that the image is for, in the strings; without it, any with that board
  acceleration,  // `value`: the limit of an actuator, in whole units per second squared
  pulse_at_min,  // `value`: a servo's pulse at the lower end of its range, in microseconds
  pulse_at_max,  // … at the upper end
  count_
};

// What few robots have, so that the others pay nothing for it: in the order of the kinds, and of the actuators in each.
struct Trait {
  std::uint16_t value;
  std::uint8_t actuator;  // that has it; 0 for the name
  TraitKind kind;
};
static_assert(sizeof(Trait) == 4);

// The pulses at the ends of a servo's range, in microseconds. With the longer one first, it turns the other way. Those of an image
// without traits for them, which are also the limits for any servo.
struct ServoPulses {
  std::uint16_t at_min = 500;
  std::uint16_t at_max = 2500;
  bool operator==(const ServoPulses&) const = default;
};
inline constexpr ServoPulses kServoPulses;
constexpr ServoPulses pulses_of(std::span<const Trait> traits, std::size_t actuator) {
  ServoPulses pulses;
  for (const Trait& trait : traits) {
    if (trait.actuator != actuator) continue;
    if (trait.kind == TraitKind::pulse_at_min) pulses.at_min = trait.value;
    if (trait.kind == TraitKind::pulse_at_max) pulses.at_max = trait.value;
  }
  return pulses;
}

// For an algorithm, `bus` is the number of its module in the firmware, `address` the index of its
// parameters in the constants, and `first_input` the first channel that it reads, which belongs to an
// earlier sensor. Channel::input of its channels is the number of the module's output. `room` is how much memory its module has
// besides the first kilobyte, in kilobytes. For a servo chip, which has no channels, `first_input` is the board's pin at the chip's
// enable input. For a spi_register, it is the SpiFormat.
struct Sensor {
  std::uint16_t name;  // offset in the strings
  DriverId driver;
  std::uint8_t bus;
  std::uint16_t address;    // I2C address or pin; on SPI, the select pin
  std::uint16_t period_ms;  // between two samples; 0: only fed
  std::uint8_t first_channel;
  std::uint8_t channel_count;
  std::uint8_t first_input;  // for an algorithm, a servo chip or a spi_register; else 0
  std::uint8_t room;         // for an algorithm; else 0
};
static_assert(sizeof(Sensor) == 12);

struct Channel {
  std::uint16_t name;
  std::uint8_t sensor;
  std::uint8_t input;  // number of the device's input or register
  Dimension dimension;
  std::uint8_t label_count;  // for a channel whose values are words: value n is label n
  std::uint16_t stale_ms;    // a reading older than this is unknown; 0: never stale
  std::uint16_t scale_den;   // value = raw * scale_num / scale_den + offset, thousandths
  std::uint16_t first_label;
  std::int32_t scale_num;
  Value offset;
  Value min, max;  // readings are clamped to this range
  Value change;    // published only if it differs by at least this; 0: any difference
};
static_assert(sizeof(Channel) == 32);

struct Actuator {
  std::uint16_t name;
  DriverId driver;
  std::uint8_t bus;
  std::uint16_t pin;
  Release on_release;
  Release safe;
  std::uint32_t verbs;  // bit v: verb v of the verb table may command it
  Value min, max;       // range of TO, canonical units
  Value speed_limit;    // upper limit of AT; kValueMax: none
};
static_assert(sizeof(Actuator) == 24);

struct Group {
  std::uint16_t name;
  std::uint16_t reserved;
  std::uint32_t members;  // actuator mask
};
static_assert(sizeof(Group) == 8);

struct Verb {
  std::uint16_t name;
  Action action;
  std::uint8_t params;  // bit p: takes parameter p
};
static_assert(sizeof(Verb) == 4);

struct WordEntry {  // SLOWLY, "greeting.wav", BACKWARD: a name that sets one parameter
  std::uint16_t name;
  Param param;
  std::uint8_t reserved;
  Value value;
};
static_assert(sizeof(WordEntry) == 8);

// Its number as an input is the number of channels + its index in the section.
struct Variable {
  std::uint16_t name;
  VariableKind kind;
  Dimension dimension;
  std::uint16_t first_label;  // of state and band
  std::uint8_t label_count;   // 0 for the other kinds
  std::uint8_t reserved;
  Value initial;   // kUnknown for band
  Value min, max;  // values that are set are clamped to this range
  Value fades_to;  // only if fade != 0
  std::uint32_t
      fade;  // fraction of the distance to fades_to left after kFadeTickMs, times 2^31; 0: no fading
};
static_assert(sizeof(Variable) == 28);

// A CHECK: stores the band of an input's value in a variable, before the rules read either.
struct Check {
  std::uint8_t variable;  // index in the section of variables; of kind band
  std::uint8_t input;     // channel, or variable that is no band
  std::uint8_t first_band;
  std::uint8_t band_count;
  std::uint16_t window;     // samples whose median is classified (SMOOTH); 1: the value itself
  std::uint16_t sample_ms;  // between two samples of the window
};
static_assert(sizeof(Check) == 8);

// The first band whose range low … high contains the value is chosen. The previous band is kept while
// the value is in that band's wider range stay_low … stay_high (MARGIN; none if stay_low > stay_high).
// All ends are inclusive.
struct Band {
  Value low, high;
  Value stay_low, stay_high;
};
static_assert(sizeof(Band) == 16);

struct Timer {
  TimerKind kind;
  std::uint8_t count;   // counted: rising edges; else 0
  std::uint16_t state;  // its first word in the timer memory, where the timers follow each other
  Value duration;       // in thousandths of a second; changed: the least difference, 0: any
};
static_assert(sizeof(Timer) == 8);

struct Modifiers {
  Value cooldown;  // in thousandths of a second; 0: none
  Value waiting;
  std::uint8_t restarting;  // 1: a trigger starts the running response again
  std::array<std::uint8_t, 3> reserved;
};
static_assert(sizeof(Modifiers) == 12);

// A behaviour's frame: its inputs in cells 0 … input_count-1 (latched at the start of each step), its
// locals (numbers that outlast a step), the truths of its watch rules in their order, then its
// registers. With kSafetyPriority it is no behaviour but holds the SAFETY rules.
struct Behavior {
  std::int16_t priority;  // 1–99 as written; rules outside a BEHAVIOR get 0, -1, -2 … in file order
  std::uint16_t name;       // kNoIndex: a rule outside a BEHAVIOR
  std::uint32_t actuators;  // union over its responses
  std::uint16_t first_input;
  std::uint8_t input_count;
  std::uint8_t rule_count;
  std::uint16_t first_rule;
  std::uint8_t locals;
  std::uint8_t cells;  // frame cells, inputs included
};
static_assert(sizeof(Behavior) == 16);

struct Rule {
  std::uint16_t condition_start;  // word index in the code section; 0 for start
  std::uint16_t condition_length;
  std::uint16_t then_response;  // index of a response; kNoIndex of watch and resume
  std::uint16_t else_response;  // kNoIndex without ELSE
  std::uint16_t line;           // of the rule in the source, for traces
  RuleKind kind;
  std::uint8_t modifiers;  // index, or kNoModifiers
};
static_assert(sizeof(Rule) == 12);

struct Response {
  std::uint16_t start;   // word index in the code section
  std::uint16_t length;  // words
  std::uint32_t
      actuators;  // every actuator that it can command; recomputed and compared by the verifier
};
static_assert(sizeof(Response) == 8);

struct SourceLine {  // the first instruction word that comes from `line`
  std::uint16_t word;
  std::uint16_t line;
};
static_assert(sizeof(SourceLine) == 4);

// How priorities adapt: a behaviour that was triggered F times in a window is raised by alpha × F /
// window_ms in the next one, up to the cap. This affects threads only, never the ownership of actuators.
struct Adaptation {
  std::uint16_t alpha;      // thousandths of a priority times a second, for each trigger
  std::uint16_t window_ms;  // windows follow each other from activation on
  std::uint8_t cap;         // 1–99
  std::array<std::uint8_t, 3> reserved;
};
static_assert(sizeof(Adaptation) == 8);

// A MOTION: a table of key frames. Its tracks follow each other, one for each of its actuators. The
// command that performs it has the motion's index, in thousandths, as its parameter `item`.
struct Motion {
  std::uint16_t name;
  std::uint8_t first_track;
  std::uint8_t track_count;
  Value length;  // time of its last row, thousandths of a second
};
static_assert(sizeof(Motion) == 8);

struct Track {  // its keys follow each other
  std::uint8_t actuator;
  std::uint8_t key_count;
  std::uint16_t first_key;
};
static_assert(sizeof(Track) == 4);

struct Key {
  Value time;  // since the motion began, thousandths of a second; keys >= kMinKeyGapMs apart
  Value to;    // position of the actuator then, thousandths of its canonical unit
};
static_assert(sizeof(Key) == 8);

// Read-only view of an image's sections. `bytes` must be 4-aligned and outlive the view.
struct Image {
  const ImageHeader* header = nullptr;
#define IMAGE_SECTION(records, Record, Count, check, name) std::span<const Record> records;
#include "vm/sections.def"
#undef IMAGE_SECTION

  // The NUL-terminated string at `offset`; empty if kNoIndex or out of range.
  std::string_view string(std::uint16_t offset) const;
  // The name of the robot that it is for; empty: any.
  [[nodiscard]] std::string_view robot_name() const {
    const bool has_name = !traits.empty() && traits.front().kind == TraitKind::name;
    return has_name ? string(traits.front().value) : std::string_view();
  }
  // In whole units per second squared; 0: no limit.
  [[nodiscard]] constexpr std::uint16_t acceleration_of(std::size_t actuator) const {
    for (const Trait& trait : traits)
      if (trait.kind == TraitKind::acceleration && trait.actuator == actuator) return trait.value;
    return 0;
  }
  // Are there SAFETY rules? If so, kSafetyBehavior holds them.
  [[nodiscard]] bool has_safety() const {
    return !behaviors.empty() && behaviors[kSafetyBehavior].priority == kSafetyPriority;
  }
  // The mask of the actuators that the target operand of a CMD names.
  [[gnu::always_inline]] std::uint32_t target_mask(std::uint8_t target) const {
    if ((target & kGroupBit) != 0) {
      const std::size_t group = target & ~unsigned{kGroupBit};
      return group < groups.size() ? groups[group].members : 0;
    }
    return target < actuators.size() && target < kMaxActuators ? std::uint32_t{1} << target : 0;
  }
};

// Sections in the order of the image; also names the place in a verifier's refusal.
enum class Section : std::uint8_t {
  header,
#define IMAGE_SECTION(records, Record, Count, check, name) records,
#include "vm/sections.def"
#undef IMAGE_SECTION
  count_
};

// Lays the sections out over `bytes`. False if they do not fill exactly total_length ==
// bytes.size().
[[nodiscard]] bool view_image(std::span<const std::byte> bytes, Image& image);

// CRC-32 (IEEE 802.3) of `bytes`, continuing from `seed` (0 to begin).
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t seed = 0);

// The name in an image's header, which the link and the store use. identity.hpp checks whether it matches the bytes.
// Zeros if the header is incomplete; such an image is refused as too short, whatever its name.
[[nodiscard]] ProgramHash stated_name(std::span<const std::byte> image);

}  // namespace robosync::vm
