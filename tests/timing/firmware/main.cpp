// Runs every program of a block (block.hpp), first the steps of its script, then random ones, with
// markers around each entry into the VM. tests/timing/timing.py counts between them.
#include <cstring>
#include <span>

#include "bench/firmware/mark.hpp"
#include "tests/timing/firmware/robot.hpp"
#include "tests/timing/firmware/stimuli.hpp"
#include "vm/verifier.hpp"

namespace robosync::timing {
namespace {

Robot robot;

[[gnu::noinline]] void mark_program() {
  BENCH_MARK(program);
}

// Reads the block word by word.
class Reader {
public:
  std::uint32_t word() {
    std::uint32_t word = 0;
    std::memcpy(&word, at_, sizeof word);
    at_ += sizeof word;
    return word;
  }
  std::span<const std::byte> bytes(std::size_t count) {
    const std::span<const std::byte> bytes(at_, count);
    at_ += count;
    return bytes;
  }
  [[nodiscard]] const std::byte* at() const { return at_; }

private:
  const std::byte* at_ = reinterpret_cast<const std::byte*>(kBlockAddress);
};

// The rules that ran come in the order of the rules, as they ran.
void replay(Reader& reader, const vm::Image& image) {
  const std::uint32_t words = reader.word();
  const std::byte* const end = reader.at() + words * sizeof(std::uint32_t);
  while (reader.at() < end) {
    const std::uint32_t now = reader.word();
    for (std::uint32_t left = reader.word(); left > 0; --left) {
      const std::uint32_t input = reader.word();
      robot.set_input(input, static_cast<vm::Value>(reader.word()));
    }
    robot.evaluate(now);
    std::size_t rule = 0;
    for (std::uint32_t left = reader.word(); left > 0; --left) {
      const std::uint32_t action = reader.word();
      for (; rule < (action & 0xFFFFU); ++rule)
        robot.skip(rule);
      const auto run = static_cast<Run>(action >> kRunShift);
      robot.has(rule, run) ? robot.respond(rule, run) : robot.skip(rule);
      ++rule;
    }
    for (; rule < image.rules.size(); ++rule)
      robot.skip(rule);
  }
}

bool run_program(Reader& reader, std::uint32_t bytes, std::uint32_t steps, std::uint32_t seed) {
  vm::Image image;
  if (!vm::verify(reader.bytes(bytes), vm::Limits{}, image).ok()) return false;
  if (image.rules.size() > Robot::kMostRules) return false;
  mark_program();
  robot.start(image);
  replay(reader, image);
  robot.start(image);
  Stimuli stimuli(seed);
  for (std::uint32_t i = 0; i < steps; ++i)
    stimuli.step(robot, image);
  return true;
}

bool run_all() {
  Reader reader;
  const std::uint32_t steps = reader.word();
  std::uint32_t seed = 0;
  while (const std::uint32_t bytes = reader.word())
    if (!run_program(reader, bytes, steps, seed += 2)) return false;
  return true;
}

}  // namespace
}  // namespace robosync::timing

int main() {
  robosync::bench::leave(robosync::timing::run_all());
}
