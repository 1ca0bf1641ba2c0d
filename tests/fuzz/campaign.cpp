#include "tests/fuzz/campaign.hpp"

#include <algorithm>

#include "runtime-m4/algorithms/judge.hpp"
#include "runtime-m4/policy/memory.hpp"
#include "runtime-m4/policy/pins.hpp"
#include "vm/disassembler.hpp"

namespace robosync::fuzz {
namespace {

using vm::Refusal;
using vm::Section;

constexpr std::size_t kPool = 512;
constexpr std::size_t kLongest = 1400;  // of what is kept: short images are quick
constexpr int kRepairs = 8;

std::uint32_t all_of(std::size_t actuators) {
  return actuators >= 32 ? UINT32_MAX : (std::uint32_t{1} << actuators) - 1;
}

}  // namespace

Campaign::Campaign(const Seeds& seeds, std::uint64_t seed, std::function<void(const char*)> failed)
    : random_(seed),
      seeds_(seeds),
      pool_(seeds.carved),
      mutator_(random_, seeds.whole),
      engine_(std::move(failed)) {}

void Campaign::choose() {
  const std::uint32_t draw = random_.below(64);
  if (draw == 0) return draft_.assign(seeds_.whole[random_.below(seeds_.whole.size())]);
  if (draw < 16) return draft_.assign(seeds_.carved[random_.below(seeds_.carved.size())]);
  draft_.assign(pool_[random_.below(pool_.size())]);
}

std::uint32_t Campaign::mask_of(std::size_t response) {
  const auto& record = draft_.view().responses[response];
  std::uint32_t mask = 0;
  for (std::size_t w = record.start; w < std::size_t{record.start} + record.length; ++w) {
    const Word word = draft_.word(w);
    if (!is_opcode(word) || kind_of(word, 0) != Operand::target) continue;
    const std::uint8_t target = vm::operand_a(word);
    const bool all = info_of(word).effect == vm::Effect::halt && target == vm::kAllActuators;
    mask |= all ? all_of(draft_.view().actuators.size()) : draft_.view().target_mask(target);
  }
  return mask;
}

// Where only a declaration is not what the code does: declares that. False: it cannot be done.
bool Campaign::repair(const vm::Verdict& verdict) {
  if (!draft_.sound()) return false;
  if (verdict.refusal == Refusal::cost_differs) {
    draft_.header().step_cost = vm::step_cost(draft_.view());
  } else if (verdict.refusal == Refusal::mask_differs) {
    if (verdict.section == Section::responses) {
      draft_.as<vm::Response>(Section::responses, verdict.index).actuators = mask_of(verdict.index);
    } else {
      auto& behavior = draft_.as<vm::Behavior>(Section::behaviors, verdict.index);
      std::uint32_t mask = 0;
      for (std::size_t r = 0; r < behavior.rule_count; ++r) {
        const vm::Rule& rule = draft_.view().rules[behavior.first_rule + r];
        for (const std::uint16_t index : {rule.then_response, rule.else_response})
          if (index != vm::kNoIndex) mask |= draft_.view().responses[index].actuators;
      }
      behavior.actuators = mask;
    }
  } else {
    return false;
  }
  draft_.put_crc();
  return true;
}

// In memory of exactly its size.
vm::Verdict Campaign::verify(bool tight) {
  const auto bytes = draft_.bytes();
  const std::byte* const copy = image_slot_.copy(bytes.data(), bytes.size());
  return vm::verify({copy, bytes.size()}, limits(tight), accepted_);
}

Entry Campaign::step() {
  choose();
  if (draft_.sound()) mutator_.mutate(draft_);
  Entry entry{};
  entry.seed = random_.next();
  entry.tight = random_.one_in(16) ? 1 : 0;
  vm::Verdict verdict = verify(entry.tight != 0);
  const bool repairs = random_.below(16) != 0;
  for (int i = 0; repairs && i < kRepairs && !verdict.ok() && repair(verdict); ++i)
    verdict = verify(entry.tight != 0);
  entry.size = static_cast<std::uint32_t>(draft_.bytes().size());
  entry.verdict = verdict_word(verdict);
  ++totals_.images;
  totals_.length += entry.size;
  ++totals_.verdicts[static_cast<std::size_t>(verdict.refusal)];
  if (verdict.ok()) run(entry);
  return entry;
}

void Campaign::run(Entry& entry) {
  const Facts facts = exercise(accepted_, entry.seed, engine_);
  entry.hash = facts.hash;
  const std::uint32_t declared = accepted_.header->step_cost;
  if (facts.worst > declared) engine_.fail("a step costs more than declared");
  totals_.runs += facts.runs;
  totals_.pauses += facts.pauses;
  totals_.exact += facts.worst == declared ? 1 : 0;
  if (declared > 0)
    totals_.worst_ratio = std::max(totals_.worst_ratio, double{1} * facts.worst / declared);
  std::bitset<kOpcodeCount> seen;
  for (const Word word : accepted_.code)
    if (is_opcode(word)) seen.set(word & 0xFF);
  for (std::size_t i = 0; i < kOpcodeCount; ++i)
    totals_.opcodes[i] += seen[i] ? 1 : 0;
  if (random_.one_in(64)) read_names();
  lay_out();
  keep();
}

// What it needs of a board's memory leaves nothing out, keeps apart what must be, and is refused by a
// board that has less.
void Campaign::lay_out() {
  policy::BoardMemory board{.arena_begin = 0x2000'0000U + 0x4000U * random_.below(8),
                            .arena_bytes = 0x400U << random_.below(12),
                            .step_budget = 0};
  const policy::Needs needs = policy::needs_of(accepted_, board);
  std::uint64_t parts = needs.image;
  for (std::size_t p = 0; p < policy::kParts.size(); ++p)
    parts += std::uint64_t{policy::kParts[p].bytes} *
             policy::count_of(static_cast<policy::Part>(p), needs.counts);
  const std::uint32_t written = needs.writable_begin + needs.writable;
  if (needs.total < parts || needs.image < accepted_.header->total_length ||
      needs.open + needs.image > needs.writable_begin || written + needs.closed > needs.total)
    engine_.fail("it needs more memory than is counted");
  if (!needs.fit(board)) ++totals_.verdicts[static_cast<std::size_t>(Refusal::no_room)];
  wire();
}

// A board drawn for it may not have its pins, analog ones too, or its bus, or may reserve its address; what it drives there is inside the limits.
void Campaign::wire() {
  const auto first = static_cast<std::uint16_t>(random_.below(16));
  const policy::PinLimit outputs[] = {{first, 40, 500, 2500, 0}};
  const policy::PinRange inputs[] = {{first, 40}};
  policy::I2cPlace reserved{0, 0};
  if (first % 4 == 0 && !accepted_.sensors.empty()) {
    const vm::Sensor& sensor = accepted_.sensors.front();
    reserved = {sensor.bus, static_cast<std::uint8_t>(sensor.address)};
  }
  const policy::BoardPins board{.outputs = outputs,
                                .inputs = inputs,
                                .analog = inputs,
                                .enables = inputs,
                                .i2c_buses = static_cast<std::uint8_t>(random_.below(3)),
                                .reserved = {&reserved, 1},
                                .spi_buses = static_cast<std::uint8_t>(first % 2),
                                .selects = inputs};
  const vm::Verdict verdict = policy::judge(accepted_, board);
  if (!verdict.ok()) ++totals_.verdicts[static_cast<std::size_t>(verdict.refusal)];
  compute();
}

// The firmware may not have its modules; nor may they be able to work with an algorithm that is drawn for it.
void Campaign::compute() {
  std::vector<vm::Sensor> sensors(accepted_.sensors.begin(), accepted_.sensors.end());
  if (!sensors.empty() && sensors.back().first_channel > 0) {
    vm::Sensor& last = sensors.back();
    last.driver = vm::DriverId::algorithm;
    last.bus = static_cast<std::uint8_t>(random_.below(3));
    last.first_input = static_cast<std::uint8_t>(random_.below(last.first_channel));
    const auto constants = static_cast<std::uint32_t>(accepted_.constants.size());
    last.address = static_cast<std::uint16_t>(random_.below(constants + 2));
    if (random_.one_in(4)) sensors.front().driver = vm::DriverId::algorithm;
  }
  vm::Image image = accepted_;
  image.sensors = sensors;
  const vm::Verdict verdict = algorithms::judge(image);
  if (!verdict.ok()) ++totals_.verdicts[static_cast<std::size_t>(verdict.refusal)];
}

// What a person is shown of an accepted image is inside of it, too.
void Campaign::read_names() {
  std::size_t length = 0;
  const auto read = [&](const auto& records) {
    for (const auto& record : records)
      length += accepted_.string(record.name).size();
  };
  read(accepted_.sensors);
  read(accepted_.channels);
  read(accepted_.actuators);
  read(accepted_.groups);
  read(accepted_.verbs);
  read(accepted_.words);
  read(accepted_.variables);
  read(accepted_.behaviors);
  std::array<char, 60> line{};
  for (const Word word : accepted_.code)
    length += vm::disassemble(accepted_, word, line);
  if (length > std::size_t{1} << 30) engine_.fail("names without end");
}

void Campaign::keep() {
  const auto bytes = draft_.bytes();
  if (bytes.size() > kLongest || !random_.one_in(8)) return;
  Seed kept(bytes.begin(), bytes.end());
  if (pool_.size() < kPool)
    pool_.push_back(std::move(kept));
  else
    pool_[random_.below(pool_.size())] = std::move(kept);
}

}  // namespace robosync::fuzz
