// Lays out records and code and fills in the header.
#include "compiler/codegen/emit.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include "compiler/codegen/records.hpp"
#include "compiler/codegen/rules.hpp"
#include "compiler/config/boards.hpp"
#include "vm/drivers.hpp"
#include "vm/identity.hpp"
#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

namespace robosync::compiler {
namespace {

class Emitter {
public:
  Emitter(EmitOptions options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics) {}

  Emitted emit(const ir::Program& program, const ir::Program& written, const Robot& robot) {
    const Tables tables(written, robot, diagnostics_);
    if (diagnostics_.has_errors()) return {};
    rules_ = make_rules(program, written, tables, strings_, diagnostics_);
    records_ = make_records(written, robot, tables, strings_);
    add_algorithms(robot, tables);
    if (records_.drive) add_drive(vm::values_of(*records_.drive));
    if (diagnostics_.has_errors() || !counts_fit()) return {};
    if (options_.source_lines) lines_ = rules_.pool.lines();
    lay_out();
    finish_header(robot);
    return {std::move(bytes_), std::move(rules_.pool), std::move(rules_.places)};
  }

private:
  void add_algorithms(const Robot& robot, const Tables& tables);
  void add_drive(const vm::DriveValues& values);
  bool counts_fit();
  void lay_out();
  vm::Image sections() const;
  void append(std::span<const std::byte> section);
  void finish_header(const Robot& robot);

  EmitOptions options_;
  Diagnostics& diagnostics_;
  Strings strings_;
  Records records_;
  RuleSections rules_;
  std::vector<vm::Value> constants_;
  std::vector<vm::SourceLine> lines_;
  vm::ImageHeader header_{};
  std::vector<std::byte> bytes_;
};

// The parameters of the algorithms follow the constants of the code.
void Emitter::add_algorithms(const Robot& robot, const Tables& tables) {
  constants_ = rules_.pool.constants();
  for (vm::Sensor& record : records_.sensors) {
    if (vm::is_served(record.driver)) continue;
    const std::size_t place = tables.sensor_of(record.first_channel);
    const auto& algorithm = robot.sensors[place].algorithm;
    if (!algorithm) continue;
    record.bus = algorithm->module;
    record.address = place_row(constants_, algorithm->config);
    record.room = algorithm->room;
    record.first_input = tables.input({algorithm->input, algorithm->first});
  }
}

void Emitter::add_drive(const vm::DriveValues& values) {
  const auto place = place_row(constants_, std::vector<vm::Value>(values.begin(), values.end()));
  for (vm::Actuator& record : records_.actuators)
    if (vm::drives_wheels(record.driver)) record.pin = place;
}

bool Emitter::counts_fit() {
  const auto fits = [&](std::size_t count, std::size_t limit, const char* what) {
    if (count > limit)
      diagnostics_
          .report(Code::E0407, "the program has " + std::to_string(count) + " " + what +
                                   "; the limit is " + std::to_string(limit))
          .label({});
    return count <= limit;
  };
  constexpr std::size_t kMost = vm::kNoIndex - 1;
  const auto chips = static_cast<std::size_t>(
      std::ranges::count_if(records_.sensors, vm::is_servo_chip, &vm::Sensor::driver));
  const auto displays = static_cast<std::size_t>(
      std::ranges::count_if(records_.sensors, vm::is_display, &vm::Sensor::driver));
  return fits(chips, vm::kMaxServoChips, "servo chips") &&
         fits(displays, vm::kMaxDisplays, "displays") &&
         fits(records_.checks.size(), UINT8_MAX, "CHECKs") &&
         fits(records_.bands.size(), UINT8_MAX, "bands") &&
         fits(records_.motions.size(), UINT8_MAX, "MOTIONs") &&
         fits(records_.tracks.size(), UINT8_MAX, "columns of MOTIONs") &&
         fits(records_.keys.size(), kMost, "values in MOTIONs") &&
         fits(rules_.behaviors.size(), vm::kMaxBehaviors, "behaviours") &&
         fits(rules_.modifiers.size(), vm::kNoModifiers, "different COOLDOWNs and WAITINGs") &&
         fits(rules_.timers.records().size(), UINT8_MAX, "time words") &&
         fits(rules_.rules.size(), kMost, "rules") &&
         fits(rules_.responses.size(), kMost, "responses") &&
         fits(rules_.inputs.size(), kMost, "inputs") &&
         fits(constants_.size(), kMost, "different numbers") &&
         fits(rules_.pool.code().size(), kMost, "commands and conditions") &&
         fits(strings_.labels().size(), kMost, "labels") &&
         fits(strings_.text().size(), kMost, "bytes of names and texts");
}

vm::Image Emitter::sections() const {
  vm::Image image;
  image.sensors = records_.sensors;
  image.channels = records_.channels;
  image.actuators = records_.actuators;
  image.groups = records_.groups;
  image.verbs = records_.verbs;
  image.words = records_.words;
  image.variables = records_.variables;
  image.checks = records_.checks;
  image.bands = records_.bands;
  image.behaviors = rules_.behaviors;
  image.modifiers = rules_.modifiers;
  image.adaptations = records_.adaptations;
  image.traits = records_.traits;
  image.motions = records_.motions;
  image.tracks = records_.tracks;
  image.keys = records_.keys;
  image.timers = rules_.timers.records();
  image.rules = rules_.rules;
  image.responses = rules_.responses;
  image.inputs = rules_.inputs;
  image.constants = constants_;
  image.code = rules_.pool.code();
  image.labels = strings_.labels();
  image.strings = strings_.text();
  image.source_lines = lines_;
  return image;
}

void Emitter::append(std::span<const std::byte> section) {
  bytes_.insert(bytes_.end(), section.begin(), section.end());
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
}

void Emitter::lay_out() {
  const vm::Image all = sections();
  bytes_.assign(sizeof header_, std::byte{0});
#define IMAGE_SECTION(records, Record, Count, check, name)  \
  header_.records = static_cast<Count>(all.records.size()); \
  append(std::as_bytes(all.records));
#include "vm/sections.def"
#undef IMAGE_SECTION
}

void Emitter::finish_header(const Robot& robot) {
  header_.magic = vm::kMagic;
  header_.total_length = static_cast<std::uint32_t>(bytes_.size());
  header_.format_major = vm::kFormatMajor;
  header_.opcode_set = vm::opcode_set_id();
  header_.seed = options_.seed != 0 ? options_.seed : robot.seed;
  header_.safety_start_ms = robot.safety_start_ms;
  header_.board = board_id(board_for(robot.board).name);
  std::memcpy(bytes_.data(), &header_, sizeof header_);
  vm::Image view;
  if (vm::view_image(bytes_, view)) header_.step_cost = vm::step_cost(view);
  std::memcpy(bytes_.data(), &header_, sizeof header_);
  vm::seal(bytes_);
}

}  // namespace

Emitted emit(const ir::Program& program, const ir::Program& written, const Robot& robot,
             EmitOptions options, Diagnostics& diagnostics) {
  return Emitter(options, diagnostics).emit(program, written, robot);
}

}  // namespace robosync::compiler
