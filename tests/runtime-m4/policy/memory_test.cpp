// The memory that a program needs on a board, for random images: the layout meets the requirements of the MPU and
// of the closed parts, and no part is forgotten.
#include "runtime-m4/policy/memory.hpp"

#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using namespace robosync;
using namespace robosync::policy;

namespace {

constexpr BoardMemory kBoard = {
    .arena_begin = 0x2000'4000, .arena_bytes = 112 * 1024, .step_budget = 100'000};
constexpr std::uint32_t kSafety = 2;  // rules of the first behaviour, if it is SAFETY

// An image with only the relevant parts.
struct Drawn {
  vm::ImageHeader header{};
  std::vector<vm::Sensor> sensors;
  std::vector<vm::Channel> channels;
  std::vector<vm::Actuator> actuators;
  std::vector<vm::Variable> variables;
  std::vector<vm::Check> checks;
  std::vector<vm::Behavior> behaviors;
  std::vector<vm::Timer> timers;
  std::vector<vm::Rule> rules;
  std::vector<vm::Response> responses{1};
  std::vector<vm::Word> code;

  vm::Image image() const {
    vm::Image image;
    image.header = &header;
    image.sensors = sensors;
    image.channels = channels;
    image.actuators = actuators;
    image.variables = variables;
    image.checks = checks;
    image.behaviors = behaviors;
    image.timers = timers;
    image.rules = rules;
    image.responses = responses;
    image.code = code;
    return image;
  }
  Needs needs(const BoardMemory& board = kBoard) const { return needs_of(image(), board); }
};

unsigned below(unsigned end) {
  return *rc::gen::inRange(0U, end);
}

Drawn draw() {
  Drawn drawn;
  drawn.sensors.resize(below(33));
  for (vm::Sensor& sensor : drawn.sensors) {
    sensor.driver = below(2) == 0 ? vm::DriverId::virtual_sensor : vm::DriverId::i2c_register;
    sensor.period_ms = 20;
    sensor.channel_count = 1;
  }
  drawn.channels.resize(drawn.sensors.size());
  drawn.actuators.resize(below(33));
  drawn.variables.resize(below(33));
  for (vm::Variable& variable : drawn.variables)
    variable.fade = below(2);
  drawn.checks.resize(below(10));
  for (vm::Check& check : drawn.checks)
    check.window = static_cast<std::uint16_t>(1 + below(32));
  drawn.behaviors.resize(below(65));
  if (!drawn.behaviors.empty() && below(2) == 0) {
    drawn.behaviors[0].priority = vm::kSafetyPriority;
    drawn.behaviors[0].rule_count = kSafety;
    drawn.rules.resize(kSafety);
  }
  for (vm::Rule& rule : drawn.rules)
    rule = {.condition_start = 0,
            .condition_length = 0,
            .then_response = 0,
            .else_response = vm::kNoIndex,
            .line = 1,
            .kind = vm::RuleKind::safety,
            .modifiers = vm::kNoModifiers};
  for (vm::Behavior& behavior : drawn.behaviors)
    behavior.cells = static_cast<std::uint8_t>(below(60));
  drawn.rules.resize(drawn.rules.size() + below(1200));
  drawn.header.total_length = 64 + 4 * below(10'000);
  return drawn;
}

std::uint32_t sum_of_parts(const Needs& needs, Region region) {
  std::uint32_t bytes = 0;
  for (std::size_t p = 0; p < kParts.size(); ++p)
    if (kParts[p].region == region) bytes += bytes_of(static_cast<Part>(p), needs.counts);
  return bytes;
}

// Does the region cover the address? Interprets the two registers as the core does.
bool covers(const regions::Region& region, std::uint32_t address) {
  if ((region.size_and_eighths & 1) == 0) return false;
  const std::uint32_t size = 2U << (region.size_and_eighths >> 1 & 0x1F);
  if (address - region.base >= size) return false;
  const std::uint32_t eighth = (address - region.base) / (size / 8);
  return (region.size_and_eighths >> (8 + eighth) & 1) == 0;
}

void check_layout(const Needs& needs, const BoardMemory& board) {
  const std::uint32_t image_end = needs.open + needs.image;
  RC_ASSERT(needs.open == sum_of_parts(needs, Region::open));
  RC_ASSERT(needs.writable_begin >= image_end);
  RC_ASSERT(needs.writable >= sum_of_parts(needs, Region::writable));
  RC_ASSERT(needs.closed >= sum_of_parts(needs, Region::closed));
  RC_ASSERT(needs.closed % kStackUnit == 0);
  RC_ASSERT(needs.total >= needs.writable_begin + needs.writable + needs.closed);
  // A window covers exactly the writable memory.
  const std::uint32_t writable = board.arena_begin + needs.writable_begin;
  const regions::Window window = regions::finest_window(writable, needs.writable);
  RC_ASSERT(needs.writable == 0 || window.lower.size_and_eighths != 0);
  // The region over the open parts covers none of the closed ones, and nothing before the arena.
  const regions::Region open = regions::cover(board.arena_begin, board.arena_begin + image_end);
  RC_ASSERT(covers(open, board.arena_begin));
  RC_ASSERT(covers(open, board.arena_begin + image_end - 1));
  RC_ASSERT(!covers(open, board.arena_begin - 1));
  RC_ASSERT(!covers(open, board.arena_begin + needs.total - needs.closed));
}

// Wherever the stacks before it end, an MPU window for the memory that SAFETY's bytecode writes fits into its part.
void check_safety_window(const Counts& counts) {
  const regions::Fit fit = safety_window(counts);
  const std::uint32_t bytes = bytes_of(Part::safety_region, counts);
  for (std::uint32_t end = 0x2000'4000; end < 0x2000'5000; end += kStackUnit) {
    const std::uint32_t begin = aligned(end - bytes, fit.alignment);
    RC_ASSERT(begin + fit.bytes <= end);
    const regions::Window window = regions::finest_window(begin, fit.bytes);
    RC_ASSERT(covers(window.lower, begin));
    const std::uint32_t last = begin + fit.bytes - 1;
    RC_ASSERT(covers(window.lower, last) || covers(window.upper, last));
    for (const std::uint32_t outside : {begin - 1, last + 1})
      RC_ASSERT(!covers(window.lower, outside) && !covers(window.upper, outside));
  }
}

}  // namespace

TEST_CASE("what SAFETY's bytecode writes is one window of the MPU, and fits") {
  const bool holds = rc::check([] {
    Counts counts;
    counts[Count::safety_cells] = below(256);
    counts[Count::safety_timer_words] = below(600);
    counts[Count::safety_output] = vm::kMaxResponseOutput;
    counts[Count::safety_bytes] = safety_bytes(counts);
    const std::uint32_t needed =
        kSafetyStack + kSafetyMachine +
        4 * (counts[Count::safety_cells] + counts[Count::safety_timer_words] +
             counts[Count::safety_output]);
    RC_ASSERT(safety_window(counts).bytes >= needed);
    RC_ASSERT(bytes_of(Part::safety_region, counts) <= needed + needed / 2 + kStackUnit);
    check_safety_window(counts);
  });
  CHECK(holds);
}

TEST_CASE("a layout keeps apart what threads without privileges may use, and the rest") {
  const bool holds = rc::check([] {
    const Drawn drawn = draw();
    const Needs needs = drawn.needs();
    // Alignment wastes at most an eighth here and there.
    const std::uint32_t parts = sum_of_parts(needs, Region::open) + needs.image +
                                sum_of_parts(needs, Region::writable) +
                                sum_of_parts(needs, Region::closed);
    RC_ASSERT(needs.total <= parts + parts / 2 + 1024);
    if (needs.total > 128 * 1024 - 0x4000) return;  // does not fit, so there is no layout
    check_layout(needs, kBoard);
    const auto shares = shares_of(needs);
    std::uint32_t all = 0;
    for (const std::uint32_t share : shares)
      all += share;
    RC_ASSERT(all == needs.total);
  });
  CHECK(holds);
}

TEST_CASE("more of anything never needs less") {
  const bool holds = rc::check([] {
    const Drawn drawn = draw();
    Drawn more = drawn;
    switch (below(4)) {
      case 0:
        more.rules.resize(more.rules.size() + 1);
        break;
      case 1:
        more.actuators.resize(more.actuators.size() + 1);
        break;
      case 2:
        more.header.total_length += 4;
        break;
      default:
        more.behaviors.resize(more.behaviors.size() + 1);
    }
    const auto parts = [](const Needs& needs) {
      return sum_of_parts(needs, Region::open) + sum_of_parts(needs, Region::writable) +
             sum_of_parts(needs, Region::closed) + needs.image;
    };
    RC_ASSERT(parts(more.needs()) >= parts(drawn.needs()));
  });
  CHECK(holds);
}

TEST_CASE("what one more of each takes") {
  Drawn drawn;
  drawn.channels.resize(4);
  drawn.sensors.resize(4);
  for (vm::Sensor& sensor : drawn.sensors)
    sensor = {.name = 0,
              .driver = vm::DriverId::i2c_register,
              .bus = 0,
              .address = 0,
              .period_ms = 20,
              .first_channel = 0,
              .channel_count = 1,
              .first_input = 0,
              .room = 0};
  drawn.actuators.resize(10);
  drawn.behaviors.resize(4);
  drawn.rules.resize(100);
  const Counts counts = drawn.needs().counts;
  CHECK(counts[Count::sensor_threads] == 4);
  CHECK(counts[Count::feeds] == 0);
  CHECK(counts[Count::behavior_threads] == 4);
  CHECK(counts[Count::set_words] == 4);
  CHECK(counts[Count::commands] == 36);
  CHECK(counts.threads() == 21);
}

TEST_CASE("sensors that are fed share one thread, and have a place for each channel") {
  Drawn drawn;
  drawn.sensors.resize(2);
  for (vm::Sensor& sensor : drawn.sensors) {
    sensor.driver = vm::DriverId::virtual_sensor;
    sensor.channel_count = 30;
  }
  drawn.channels.resize(60);
  CHECK(drawn.needs().counts[Count::sensor_threads] == 1);
  CHECK(drawn.needs().counts[Count::feeds] == 60);
}
