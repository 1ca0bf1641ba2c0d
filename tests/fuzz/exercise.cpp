#include "tests/fuzz/exercise.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "runtime-m4/policy/memory.hpp"
#include "tests/support/operands.hpp"
#include "vm/output.hpp"
#include "vm/timers.hpp"

namespace robosync::fuzz {
namespace {

using vm::Image;
using vm::Machine;
using vm::Value;
using vm::Word;

constexpr int kSteps = 2;     // of every rule
constexpr int kMostRuns = 5;  // of a response: from its start, and from pauses
// Room for more than the verifier promises, so that the interpreter's own limit hides nothing.
constexpr std::size_t kOutputRoom = vm::kMaxResponseOutput + 8;

constexpr std::array<Value, 12> kEdges = {vm::kUnknown,  0,    vm::kTrue, vm::kValueMax,
                                          vm::kValueMin, 1,    1000,      2999,
                                          3000,          -500, 5000,      vm::kValueMax - 1};

class Exercise {
public:
  Exercise(const Image& image, const vm::Behavior& behavior, Random& random, Engine& engine,
           Facts& facts)
      : image_(image), behavior_(behavior), random_(random), engine_(engine), facts_(facts) {
    frame_ = engine.frame(behavior.cells);
    for (const vm::Timer& timer : image.timers)
      timer_words_ += vm::timer_words(timer);
    timer_memory_ = engine.timer_memory(timer_words_);
    const bool garbage = random.one_in(4);  // any content is harmless
    for (std::size_t i = 0; i < timer_words_; ++i)
      timer_memory_[i] = garbage ? random.next() : 0;
    for (std::size_t i = 0; i < behavior.cells; ++i)
      frame_[i] = value();
    machine_.frame = frame_;
    machine_.timer_memory = timer_memory_;
    machine_.now = random.next();
    machine_.random = random.next() | 1;
  }

  void go() {
    std::size_t watch = std::size_t{behavior_.input_count} + behavior_.locals;
    const std::size_t watches_begin = watch;
    for (std::size_t r = 0; r < behavior_.rule_count; ++r)
      watch += rule_at(r).kind == vm::RuleKind::watch ? 1 : 0;
    watches_end_ = watch;
    watch = watches_begin;
    for (std::size_t r = 0; r < behavior_.rule_count; ++r) {
      const vm::Rule& rule = rule_at(r);
      std::uint32_t condition = 0;
      std::uint32_t response = 0;
      for (int step = 0; step < kSteps; ++step) {
        latch();
        condition = std::max(condition, evaluate(rule));
        if (rule.kind == vm::RuleKind::watch) frame_[watch] = result_;
        response = std::max(response, respond(rule, rule.then_response));
        response = std::max(response, respond(rule, rule.else_response));
      }
      watch += rule.kind == vm::RuleKind::watch ? 1 : 0;
      facts_.worst += condition + response;
    }
    for (std::size_t i = 0; i < timer_words_; ++i)
      note(timer_memory_[i]);
  }

private:
  [[nodiscard]] const vm::Rule& rule_at(std::size_t r) const {
    return image_.rules[behavior_.first_rule + r];
  }
  void note(std::uint32_t word) { facts_.hash = (facts_.hash ^ word) * 16777619U; }
  void require(bool holds, const char* what) {
    if (!holds) engine_.fail(what);
  }

  // An edge, a constant of the program or its neighbour, or anything.
  Value value() {
    const std::uint32_t draw = random_.below(8);
    if (draw < 4) return kEdges[random_.below(kEdges.size())];
    if (draw < 7 && !image_.constants.empty()) {
      const Value constant = image_.constants[random_.below(image_.constants.size())];
      return std::clamp(constant, vm::kValueMin + 1, vm::kValueMax - 1) +
             (static_cast<Value>(random_.below(3)) - 1);
    }
    return static_cast<Value>(random_.next());
  }
  // A step begins: some inputs and watched truths are others, and it is later.
  void latch() {
    for (std::size_t i = 0; i < behavior_.input_count; ++i) {
      if (!random_.one_in(3)) latched_[i] = value();
      frame_[i] = latched_[i];
    }
    constexpr std::array<Value, 3> kTruths = {vm::kTrue, vm::kFalse, vm::kUnknown};
    for (std::size_t i = std::size_t{behavior_.input_count} + behavior_.locals; i < watches_end_;
         ++i)
      frame_[i] = kTruths[random_.below(kTruths.size())];
    machine_.now += random_.below(random_.one_in(8) ? UINT32_MAX : 1000);
    machine_.left_ms = static_cast<std::uint8_t>(random_.one_in(2) ? 0 : random_.below(UINT8_MAX));
  }

  std::uint32_t evaluate(const vm::Rule& rule) {
    if (rule.condition_length == 0) return 0;
    machine_.wake = Machine::kNever;
    machine_.event = false;
    std::uint32_t cost = 0;
    result_ = engine_.evaluate(
        machine_, {&behavior_, rule.condition_start, rule.condition_length, true, false}, cost);
    ++facts_.runs;
    const bool truth = result_ == vm::kTrue || result_ == vm::kFalse || result_ == vm::kUnknown;
    require(truth || rule.kind == vm::RuleKind::every, "a condition is no truth value");
    note(static_cast<std::uint32_t>(result_));
    note(machine_.event ? machine_.wake + 1 : machine_.wake);
    check_inputs(0);
    return cost;
  }

  // From its start, and then some times on from where it paused. The cost of its costliest run.
  std::uint32_t respond(const vm::Rule& rule, std::uint16_t index) {
    if (index == vm::kNoIndex) return 0;
    const vm::Response& response = image_.responses[index];
    const CodeObject object{&behavior_, response.start, response.length, false,
                            rule.kind == vm::RuleKind::safety};
    std::uint32_t worst = 0;
    std::size_t from = 0;
    for (int runs = 0; runs < kMostRuns; ++runs) {
      Word* const output = engine_.output(kOutputRoom);
      machine_.output = output;
      machine_.output_end = output + kOutputRoom;
      machine_.wake = Machine::kNever;
      machine_.assigned = machine_.shifted = 0;
      const Run run = engine_.respond(machine_, object, from);
      ++facts_.runs;
      worst = std::max(worst, run.cost);
      check_run(run, {output, machine_.output}, response);
      std::copy_n(latched_.begin(), behavior_.input_count, frame_);
      if (run.pause == vm::Pause::ended) break;
      ++facts_.pauses;
      from = run.next;
      latch();
    }
    return worst;
  }

  void check_run(const Run& run, std::span<const Word> output, const vm::Response& response) {
    require(output.size() <= vm::kMaxResponseOutput, "too much output");
    require(run.pause == vm::Pause::ended || run.next < response.length, "pauses outside");
    check_output(output, response.actuators);
    const std::uint32_t owned = owned_by(response);
    require((machine_.written() & ~owned) == 0, "wrote what it does not set");
    check_written();
    check_inputs(owned);
    for (const Word word : output)
      note(word);
    for (std::size_t i = 0; i < behavior_.cells; ++i)
      note(static_cast<std::uint32_t>(frame_[i]));
    note(static_cast<std::uint32_t>(run.pause));
    note(static_cast<std::uint32_t>(run.next));
    note(run.wake);
    note(machine_.random);
    note(machine_.shifted);
    note(machine_.assigned);
  }

  // Everything the output refers to exists, and lies inside what the response declared.
  void check_output(std::span<const Word> output, std::uint32_t declared) {
    vm::Params params{};
    vm::OutputReader reader(output, params);
    vm::Output said;
    std::size_t used = 0;
    while (reader.next(said)) {
      used += 1 + 2 * static_cast<std::size_t>(std::popcount(said.given));
      if (said.kind == vm::OutputKind::log || said.kind == vm::OutputKind::alert) {
        require(said.text < image_.strings.size(), "a text that is none");
        continue;
      }
      const std::uint32_t targets = image_.target_mask(said.target);
      const bool halts = said.kind == vm::OutputKind::halt;
      const bool all = halts && said.target == vm::kAllActuators;
      require(all || targets != 0, "no such target");
      require((targets & ~declared) == 0, "an actuator that is not declared");
      if (halts) continue;
      require(said.verb < image_.verbs.size(), "no such verb");
      require(said.word == vm::kNoWord || said.word < image_.words.size(), "no such word");
      require((said.given & ~image_.verbs[said.verb].params) == 0, "not the verb's parameter");
      for (std::uint32_t left = targets; left != 0; left &= left - 1)
        require(
            (image_.actuators[static_cast<std::size_t>(std::countr_zero(left))].verbs >> said.verb &
             1) != 0,
            "not the actuator's verb");
    }
    // A parameter that is given twice is put out twice, and read once.
    require(used <= output.size() && (output.empty() || used > 0), "output that is none");
  }

  // The inputs that it sets, a bit each. To set one to an unknown does nothing, but then the
  // response owns it all the same, and may change it in place.
  [[nodiscard]] std::uint32_t owned_by(const vm::Response& response) const {
    std::uint32_t owned = 0;
    for (const Word word : image_.code.subspan(response.start, response.length))
      if (kind_of(word, 0) == Operand::variable) owned |= std::uint32_t{1} << operand(word, 0) % 32;
    return owned;
  }
  // What was written are variables of the behaviour that are no bands.
  void check_written() {
    for (std::uint32_t left = machine_.written(); left != 0; left &= left - 1) {
      const auto cell = static_cast<std::size_t>(std::countr_zero(left));
      require(cell < behavior_.input_count, "wrote an input that is none");
      const std::size_t input = image_.inputs[behavior_.first_input + cell];
      const std::size_t channels = image_.channels.size();
      require(
          input >= channels && image_.variables[input - channels].kind != vm::VariableKind::band,
          "wrote an input that is no variable");
    }
  }
  void check_inputs(std::uint32_t owned) {
    for (std::size_t i = 0; i < behavior_.input_count; ++i)
      if (i >= 32 || (owned >> i & 1) == 0)
        require(frame_[i] == latched_[i], "changed an input that it does not set");
  }

  const Image& image_;
  const vm::Behavior& behavior_;
  Random& random_;
  Engine& engine_;
  Facts& facts_;
  Machine machine_;
  Value* frame_ = nullptr;
  std::uint32_t* timer_memory_ = nullptr;
  std::size_t timer_words_ = 0;
  std::size_t watches_end_ = 0;
  Value result_ = 0;
  std::array<Value, 256> latched_{};
};

}  // namespace

// Of a board like ours. Host and board must count the same.
std::uint32_t memory_needed(const Image& image) {
  return policy::needs_of(image, {.arena_begin = 0x2000'4000, .arena_bytes = 0, .step_budget = 0})
      .total;
}

Facts exercise(const Image& image, std::uint64_t seed, Engine& engine) {
  Random random(seed);
  Facts facts;
  engine.begin(image);
  for (const vm::Behavior& behavior : image.behaviors)
    Exercise(image, behavior, random, engine, facts).go();
  facts.hash = (facts.hash ^ memory_needed(image)) * 16777619U;
  return facts;
}

}  // namespace robosync::fuzz
