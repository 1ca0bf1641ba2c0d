// Lays out records and code, fills in the header, and has the verifier check the result.
#include "compiler/codegen/image_writer.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include "compiler/codegen/dearest_rules.hpp"
#include "compiler/codegen/records.hpp"
#include "compiler/codegen/rules.hpp"
#include "compiler/optimize/optimize.hpp"
#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMaxTimers = 256;  // an operand of one byte

// The last bytes of the hash; never 0, which a generator of random numbers could not leave.
std::uint32_t seed_of(const ProgramHash& hash) {
  std::uint32_t seed = 0;
  for (std::size_t i = hash.size() - sizeof seed; i < hash.size(); ++i)
    seed = seed << 8 | hash[i];
  return seed == 0 ? 1 : seed;
}

class ImageWriter {
public:
  ImageWriter(ImageOptions options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics) {}

  std::vector<std::byte> write(const Program& program, const Robot& robot,
                               const ProgramHash& hash) {
    const Tables tables(program, diagnostics_);
    if (diagnostics_.errors() > 0) return {};
    // Devices and variables stay: what the robot measures and shows is the program's business.
    rules_ = make_rules(options_.optimize ? optimize(program, robot) : program, program, tables,
                        strings_, diagnostics_);
    records_ = make_records(program, robot, tables, strings_);
    if (diagnostics_.errors() > 0 || !counts_fit()) return {};
    lay_out();
    finish_header(hash);
    if (!verified()) return {};
    return std::move(bytes_);
  }

private:
  bool counts_fit();
  void lay_out();
  template <typename Record>
  std::uint16_t section(const std::vector<Record>& records);
  void finish_header(const ProgramHash& hash);
  bool verified();
  bool too_costly(Span span);
  // False, to be returned.
  bool too_large(const std::string& what, Span span = {}) {
    diagnostics_.report(Code::E0407, what).label(span);
    return false;
  }

  ImageOptions options_;
  Diagnostics& diagnostics_;
  Strings strings_;
  Records records_;
  RuleSections rules_;
  vm::ImageHeader header_{};
  std::vector<std::byte> bytes_;
};

bool ImageWriter::counts_fit() {
  const auto fits = [&](std::size_t count, std::size_t limit, const char* what) {
    return count <= limit || too_large("the program has too many " + std::string(what));
  };
  constexpr std::size_t kMost = vm::kNoIndex - 1;
  return fits(records_.checks.size(), UINT8_MAX, "CHECKs") &&
         fits(records_.bands.size(), UINT8_MAX, "bands") &&
         fits(rules_.behaviors.size(), vm::kMaxBehaviors, "behaviours") &&
         fits(rules_.modifiers.size(), vm::kNoModifiers, "different COOLDOWNs and WAITINGs") &&
         fits(rules_.timers.records().size(), kMaxTimers, "time words") &&
         fits(rules_.rules.size(), kMost, "rules") &&
         fits(rules_.responses.size(), kMost, "responses") &&
         fits(rules_.inputs.size(), kMost, "inputs") &&
         fits(rules_.pool.constants().size(), kMost, "different numbers") &&
         fits(rules_.pool.code().size(), kMost, "commands and conditions") &&
         fits(strings_.labels().size(), kMost, "labels") &&
         fits(strings_.text().size(), kMost, "names and texts");
}

template <typename Record>
std::uint16_t ImageWriter::section(const std::vector<Record>& records) {
  const auto raw = std::as_bytes(std::span(records));
  bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  return static_cast<std::uint16_t>(records.size());
}

void ImageWriter::lay_out() {
  const auto count8 = [](std::uint16_t count) { return static_cast<std::uint8_t>(count); };
  bytes_.assign(sizeof header_, std::byte{0});
  header_.sensors = count8(section(records_.sensors));
  header_.channels = count8(section(records_.channels));
  header_.actuators = count8(section(records_.actuators));
  header_.groups = count8(section(records_.groups));
  header_.verbs = count8(section(records_.verbs));
  header_.words = count8(section(records_.words));
  header_.variables = count8(section(records_.variables));
  header_.checks = count8(section(records_.checks));
  header_.bands = count8(section(records_.bands));
  header_.behaviors = count8(section(rules_.behaviors));
  header_.modifiers = count8(section(rules_.modifiers));
  header_.adaptations = count8(section(records_.adaptations));
  header_.timers = section(rules_.timers.records());
  header_.rules = section(rules_.rules);
  header_.responses = section(rules_.responses);
  header_.inputs = section(rules_.inputs);
  header_.constants = section(rules_.pool.constants());
  header_.code = section(rules_.pool.code());
  header_.labels = section(strings_.labels());
  header_.string_bytes = section(std::vector<char>(strings_.text().begin(), strings_.text().end()));
  if (options_.source_lines) header_.source_lines = section(rules_.pool.lines());
}

void ImageWriter::finish_header(const ProgramHash& hash) {
  header_.magic = vm::kMagic;
  header_.total_length = static_cast<std::uint32_t>(bytes_.size());
  header_.format_major = vm::kFormatMajor;
  header_.format_minor = vm::kFormatMinor;
  header_.opcode_set = vm::opcode_set_id();
  header_.program_hash = hash;
  header_.seed = seed_of(hash);
  std::memcpy(bytes_.data(), &header_, sizeof header_);
  vm::Image view;
  if (vm::view_image(bytes_, view)) header_.step_cost = vm::step_cost(view);
  std::memcpy(bytes_.data(), &header_, sizeof header_);
  constexpr std::size_t kCrcEnd = offsetof(vm::ImageHeader, crc32) + sizeof header_.crc32;
  header_.crc32 = vm::crc32(std::span(bytes_).subspan(kCrcEnd));
  std::memcpy(bytes_.data(), &header_, sizeof header_);
}

// Shows what makes the step dear. One object alone may be too dear to be counted: that is `span`.
bool ImageWriter::too_costly(Span span) {
  Diagnostic& report = diagnostics_.report(
      Code::E0407, "one step of the program could take too long on the robot: at most " +
                       std::to_string(vm::Limits{}.step_cost) + " instructions may run in it");
  report.helps(std::string(kMendOfCostlyStep));
  vm::Image image;
  const bool whole = vm::view_image(bytes_, image);
  bool primary = true;
  for (const DearRule& dear : whole ? dearest_rules(image) : std::vector<DearRule>{}) {
    const vm::Rule& rule = rules_.rules[dear.rule];
    const bool in_else = dear.cost.else_response > dear.cost.then_response;
    const std::uint16_t response = in_else ? rule.else_response : rule.then_response;
    const bool in_response = dear.cost.dearer_response() > dear.cost.condition;
    const std::size_t word = in_response ? rules_.responses[response].start : rule.condition_start;
    report.label(rules_.pool.span_of(word),
                 "its rule takes up to " + std::to_string(dear.cost.step()) + " instructions",
                 primary);
    primary = false;
  }
  if (primary) report.label(span);
  return false;
}

bool ImageWriter::verified() {
  vm::Image image;
  const vm::Verdict verdict = vm::verify(bytes_, vm::Limits{}, image);
  if (verdict.ok()) return true;
  const bool in_code = verdict.section == vm::Section::code;
  const Span span = in_code ? rules_.pool.span_of(verdict.index) : Span{};
  switch (verdict.refusal) {
    case vm::Refusal::too_large:
      return too_large("the program is larger than 64 KiB", span);
    case vm::Refusal::too_costly:
      return too_costly(span);
    case vm::Refusal::too_many:
      return too_large("the program needs more memory than a robot has", span);
    case vm::Refusal::too_much_output:
      return too_large("there are more commands here than a robot takes in one step", span);
    case vm::Refusal::too_deep:
      return too_large("blocks are nested too deeply here for the robot", span);
    default:
      break;
  }
  diagnostics_
      .report(Code::E0499, "rsc made an image that the robot refuses: " +
                               std::string(vm::describe(verdict.refusal)) + " (" +
                               std::string(vm::describe(verdict.section)) + " " +
                               std::to_string(verdict.index) + ")")
      .label(span)
      .helps("please report this, with the program and its robot.json");
  return false;
}

}  // namespace

std::vector<std::byte> write_image(const Program& program, const Robot& robot,
                                   const ProgramHash& hash, ImageOptions options,
                                   Diagnostics& diagnostics) {
  if (options.optimize) {
    Diagnostics trial;
    std::vector<std::byte> image = ImageWriter(options, trial).write(program, robot, hash);
    const bool fits = std::none_of(trial.all().begin(), trial.all().end(),
                                   [](const Diagnostic& one) { return one.code == Code::E0407; });
    if (fits) {
      for (const Diagnostic& one : trial.all())
        diagnostics.report(one.code, one.message) = one;
      return image;
    }
    options.optimize = false;
  }
  return ImageWriter(options, diagnostics).write(program, robot, hash);
}

}  // namespace robosync::compiler
