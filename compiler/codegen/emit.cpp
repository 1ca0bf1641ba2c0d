// Lays out records and code, fills in the header, and has the verifier check the result.
#include "compiler/codegen/emit.hpp"

#include <cstring>
#include <span>

#include "compiler/codegen/records.hpp"
#include "compiler/codegen/rules.hpp"
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

class Emitter {
public:
  Emitter(EmitOptions options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics) {}

  Emitted emit(const Program& program, const Program& written, const Robot& robot,
               const ProgramHash& hash) {
    const Tables tables(written, diagnostics_);
    if (diagnostics_.errors() > 0) return {};
    rules_ = make_rules(program, written, tables, strings_, diagnostics_);
    records_ = make_records(written, robot, tables, strings_);
    if (diagnostics_.errors() > 0 || !counts_fit()) return {};
    lay_out();
    finish_header(hash);
    return {std::move(bytes_), std::move(rules_.pool)};
  }

private:
  bool counts_fit();
  void lay_out();
  template <typename Record>
  std::uint16_t section(const std::vector<Record>& records);
  void finish_header(const ProgramHash& hash);

  EmitOptions options_;
  Diagnostics& diagnostics_;
  Strings strings_;
  Records records_;
  RuleSections rules_;
  vm::ImageHeader header_{};
  std::vector<std::byte> bytes_;
};

bool Emitter::counts_fit() {
  const auto fits = [&](std::size_t count, std::size_t limit, const char* what) {
    if (count > limit)
      diagnostics_.report(Code::E0407, "the program has too many " + std::string(what)).label({});
    return count <= limit;
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
std::uint16_t Emitter::section(const std::vector<Record>& records) {
  const auto raw = std::as_bytes(std::span(records));
  bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  return static_cast<std::uint16_t>(records.size());
}

void Emitter::lay_out() {
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

void Emitter::finish_header(const ProgramHash& hash) {
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

}  // namespace

Emitted emit(const Program& program, const Program& written, const Robot& robot,
             const ProgramHash& hash, EmitOptions options, Diagnostics& diagnostics) {
  return Emitter(options, diagnostics).emit(program, written, robot, hash);
}

}  // namespace robosync::compiler
