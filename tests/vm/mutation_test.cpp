// Random damage to good images, with the checksum made right again: every image is either refused,
// or runs inside its bounds. The sanitizer build (ROBOSYNC_SANITIZE) turns a step outside into a
// failure; guards around the frame and the output do so in any build.
#include <algorithm>
#include <array>
#include <memory>
#include <random>

#include <catch2/catch.hpp>

#include "tests/support/share.hpp"
#include "tests/vm/companion.hpp"
#include "vm/disassembler.hpp"
#include "vm/interpreter.hpp"
#include "vm/output.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;

namespace {

constexpr Value kGuard = 0x13579BDF;

// A behaviour's frame in memory of exactly its size, between two guards.
class GuardedFrame {
public:
  GuardedFrame(const Behavior& behavior, std::mt19937& random)
      : cells_(behavior.cells), memory_(new Value[cells_ + 2]) {
    memory_[0] = memory_[cells_ + 1] = kGuard;
    const std::array<Value, 8> samples{kUnknown, 0, kTrue, kValueMax, kValueMin, 3000, 2999, 1};
    for (std::size_t i = 0; i < cells_; ++i)
      cells()[i] = i < behavior.input_count ? samples[random() % samples.size()] : 0;
    inputs_.assign(cells(), cells() + behavior.input_count);
  }
  Value* cells() { return memory_.get() + 1; }
  // Nothing was written around it, and no inputs but those in `written`, a bit each.
  void check(std::uint32_t written = 0) {
    REQUIRE((memory_[0] == kGuard && memory_[cells_ + 1] == kGuard));
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      if (i >= 32 || (written >> i & 1) == 0) REQUIRE(cells()[i] == inputs_[i]);
  }
  // The inputs are again what they were.
  void latch() { std::copy(inputs_.begin(), inputs_.end(), cells()); }

private:
  std::size_t cells_;
  std::unique_ptr<Value[]> memory_;
  std::vector<Value> inputs_;
};

// Everything the output refers to exists, and lies inside what the response declared.
void check_output(const Image& image, std::span<const Word> output, std::uint32_t declared) {
  Params params{};
  OutputReader reader(output, params);
  Output said;
  std::size_t used = 0;
  while (reader.next(said)) {
    used += 1 + 2 * static_cast<std::size_t>(std::popcount(said.given));
    if (said.kind == OutputKind::log || said.kind == OutputKind::alert) {
      REQUIRE(said.text < image.strings.size());
      continue;
    }
    const std::uint32_t targets = image.target_mask(said.target);
    const bool all = said.kind == OutputKind::halt && said.target == kAllActuators;
    REQUIRE((all || (targets != 0 && (targets & ~declared) == 0)));
    if (said.kind == OutputKind::halt) continue;
    REQUIRE(said.verb < image.verbs.size());
    REQUIRE((said.word == kNoWord || said.word < image.words.size()));
    REQUIRE((said.given & ~image.verbs[said.verb].params) == 0);
  }
  REQUIRE(used <= output.size());
}

// One behaviour's frame and the timer memory, each between guards; runs what a step may run.
class Runner {
public:
  Runner(const Image& image, const Behavior& behavior, std::mt19937& random)
      : image_(image), behavior_(behavior), random_(random), frame_(behavior, random) {
    std::size_t words = 0;
    for (const Timer& timer : image.timers)
      words += timer_words(timer);
    timers_.assign(words + 2, 0);
    timers_.front() = timers_.back() = static_cast<std::uint32_t>(kGuard);
    machine_.frame = frame_.cells();
    machine_.constants = image.constants.data();
    machine_.timers = image.timers.data();
    machine_.timer_memory = timers_.data() + 1;
    machine_.now = static_cast<std::uint32_t>(random());
  }

  void step() {
    const auto rules = image_.rules.subspan(behavior_.first_rule, behavior_.rule_count);
    std::uint8_t watch = behavior_.input_count + behavior_.locals;
    for (const Rule& rule : rules) {
      machine_.now += static_cast<std::uint32_t>(random_() % 1000);
      if (rule.condition_length > 0) {
        const Value value = evaluate(machine_, image_.code.data() + rule.condition_start);
        const bool truth = value == kTrue || value == kFalse || value == kUnknown;
        REQUIRE((truth || rule.kind == RuleKind::every));
        if (rule.kind == RuleKind::watch) frame_.cells()[watch++] = value;
      }
      run(rule.then_response);
      run(rule.else_response);
    }
    frame_.check();
    REQUIRE(timers_.front() == static_cast<std::uint32_t>(kGuard));
    REQUIRE(timers_.back() == static_cast<std::uint32_t>(kGuard));
  }

private:
  // From its start, and then a few times on from where it paused. Loops without end would hang
  // here.
  void run(std::uint16_t index) {
    if (index == kNoIndex) return;
    const Response& response = image_.responses[index];
    const Word* place = image_.code.data() + response.start;
    for (int part = 0; part < 4 && place != nullptr; ++part) {
      // Room for more than the verifier promises, so that the interpreter's own limit hides
      // nothing.
      std::array<Word, kMaxResponseOutput + 8> output{};
      machine_.output = output.data();
      machine_.output_end = output.data() + output.size();
      machine_.wake = Machine::kNever;
      machine_.assigned = machine_.shifted = 0;
      const Progress progress = respond(machine_, place);
      const auto length = static_cast<std::size_t>(machine_.output - output.data());
      REQUIRE(length <= kMaxResponseOutput);
      check_output(image_, {output.data(), length}, response.actuators);
      check_written(image_.code.subspan(response.start, response.length));
      frame_.latch();
      machine_.now += static_cast<std::uint32_t>(random_() % 1000);
      place = progress.next;
      const Word* const first = image_.code.data() + response.start;
      REQUIRE((place == nullptr || (place >= first && place < first + response.length)));
      REQUIRE((place == nullptr) == (progress.pause == Pause::ended));
    }
  }
  // Only variables, and of these only those that the code sets or shifts. A SET to an unknown does
  // nothing, but gives the variable to the response all the same.
  void check_written(std::span<const Word> code) {
    std::uint32_t owned = 0;
    for (const Word word : code)
      if (opcode_of(word) == Opcode::set || opcode_of(word) == Opcode::shift)
        owned |= 1U << (operand_a(word) & 31U);
    REQUIRE((machine_.written() & ~owned) == 0);
    for (std::uint32_t left = machine_.written(); left != 0; left &= left - 1) {
      const auto cell = static_cast<std::size_t>(std::countr_zero(left));
      REQUIRE(cell < behavior_.input_count);
      REQUIRE(image_.inputs[behavior_.first_input + cell] >= image_.channels.size());
    }
    REQUIRE((machine_.assigned & ~machine_.written()) == 0);
    frame_.check(owned);
  }

  const Image& image_;
  const Behavior& behavior_;
  std::mt19937& random_;
  GuardedFrame frame_;
  std::vector<std::uint32_t> timers_;
  Machine machine_;
};

void run_all(const Image& image, std::mt19937& random) {
  for (const Behavior& behavior : image.behaviors) {
    Runner runner(image, behavior, random);
    for (int step = 0; step < 3; ++step)
      runner.step();
  }
}

void read_names(const Image& image) {
  std::size_t length = 0;
  const auto read = [&](const auto& records) {
    for (const auto& record : records)
      length += image.string(record.name).size();
  };
  read(image.sensors);
  read(image.channels);
  read(image.actuators);
  read(image.groups);
  read(image.verbs);
  read(image.words);
  read(image.variables);
  read(image.behaviors);
  REQUIRE(length <= image.strings.size() * 2000);
}

void disassemble_all(const Image& image) {
  std::array<char, 60> line{};
  for (const Word word : image.code)
    REQUIRE(disassemble(image, word, line) < line.size());
}

// One to four changes: a bit, a byte, a small number, or a word from elsewhere in the image.
Bytes mutate(Bytes bytes, std::mt19937& random) {
  for (auto changes = 1 + random() % 4; changes > 0; --changes) {
    // The first fields of the header would only be refused as the wrong format again and again.
    const std::size_t place = 16 + random() % (bytes.size() - 16);
    switch (random() % 4) {
      case 0:
        bytes[place] ^= std::byte{1} << random() % 8;
        break;
      case 1:
        bytes[place] = static_cast<std::byte>(random());
        break;
      case 2:
        bytes[place] = static_cast<std::byte>(random() % 64);
        break;
      default:
        for (std::size_t i = 0, from = random() % (bytes.size() / 4); i < 4; ++i)
          bytes[place / 4 * 4 + i] = bytes[from * 4 + i];
    }
  }
  return bytes;
}

// The declared cost and masks, made to fit the damaged code: otherwise nearly every change of code
// would be refused for them, and never run.
void repair_declarations(Bytes& bytes) {
  Image image;
  if (!view_image(bytes, image)) return;
  const auto put = [&](const auto& field, std::uint32_t value) {
    const auto* const place = reinterpret_cast<const std::byte*>(&field);
    std::memcpy(bytes.data() + (place - bytes.data()), &value, sizeof value);
  };
  for (const Response& response : image.responses) {
    std::uint32_t mask = 0;
    if (std::size_t{response.start} + response.length > image.code.size()) continue;
    for (const Word word : image.code.subspan(response.start, response.length)) {
      const Opcode op = opcode_of(word);
      const bool targets = op == Opcode::cmd || op == Opcode::cmd_end || op == Opcode::halt;
      if (targets) mask |= image.target_mask(operand_a(word));
      if (op == Opcode::halt && operand_a(word) == kAllActuators)
        mask = (1U << image.actuators.size()) - 1;
    }
    put(response.actuators, mask);
  }
  for (const Behavior& behavior : image.behaviors) {
    std::uint32_t mask = 0;
    for (std::size_t r = behavior.first_rule; r < behavior.first_rule + behavior.rule_count; ++r) {
      if (r >= image.rules.size()) break;
      for (const std::uint16_t index : {image.rules[r].then_response, image.rules[r].else_response})
        if (index < image.responses.size()) mask |= image.responses[index].actuators;
    }
    put(behavior.actuators, mask);
  }
  put(image.header->step_cost, step_cost(image));
}

}  // namespace

TEST_CASE("damaged images are refused or run inside their bounds") {
  const auto mutants = robosync::test::share_of<std::size_t>(200000);
  std::mt19937 random(1);
  const Bytes good = companion::make().build();
  std::size_t run = 0;
  std::array<std::size_t, 64> refusals{};
  for (std::size_t i = 0; i < mutants; ++i) {
    Bytes bytes = mutate(good, random);
    if (i % 2 == 0) repair_declarations(bytes);
    repair_crc(bytes);
    Image image;
    const Verdict verdict = verify(bytes, {}, image);
    ++refusals[static_cast<std::size_t>(verdict.refusal)];
    if (!verdict.ok()) continue;
    ++run;
    run_all(image, random);
    read_names(image);
    disassemble_all(image);
  }
  // The loop is worth something only if both outcomes are common and refusals are of many kinds.
  CHECK(run > mutants / 20);
  CHECK(run < mutants - mutants / 20);
  CHECK(std::count_if(refusals.begin(), refusals.end(), [](auto n) { return n > 0; }) >= 20);
}

TEST_CASE("noise is refused, and read in bounds") {
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes(4 * (random() % 200));
    for (std::byte& byte : bytes)
      byte = static_cast<std::byte>(random());
    Image image;
    CHECK_FALSE(verify(bytes, {}, image).ok());
  }
}
