#include "tests/timing/script.hpp"

#include <map>

#include "link/events.hpp"
#include "rsc/failure.hpp"
#include "rsc/trace/scenario.hpp"
#include "runtime-m4/sim/simulator.hpp"
#include "tests/timing/firmware/block.hpp"

namespace robosync::timing {
namespace {

using link::EventKind;

constexpr std::uint64_t kDefaultDurationUs = 10'000'000;
constexpr std::uint64_t kMicroseconds = 1000;  // in a millisecond

struct Step {
  std::uint32_t now = 0;
  std::map<std::uint32_t, std::uint32_t> inputs, runs;  // by number
};

class Steps {
public:
  explicit Steps(const vm::Image& image) : image_(image) {}

  void take(const link::Event& event) {
    Step& step = steps_[event.step];
    step.now = static_cast<std::uint32_t>(event.time_us / kMicroseconds);
    const auto value = static_cast<std::uint32_t>(event.values[0]);
    switch (event.kind) {
      case EventKind::input:
        step.inputs[event.subject] = value;
        break;
      case EventKind::stale:
        step.inputs[event.subject] = static_cast<std::uint32_t>(vm::kUnknown);
        break;
      case EventKind::set:
        step.inputs[static_cast<std::uint32_t>(image_.channels.size()) + event.subject] = value;
        break;
      case EventKind::win:
        step.runs[event.subject] = value;  // the side: Run has the same numbers
        break;
      case EventKind::trip:
        step.runs[event.subject] = static_cast<std::uint32_t>(Run::then);
        break;
      case EventKind::go_on:
        step.runs[event.subject] = static_cast<std::uint32_t>(Run::on);
        break;
      default:
        break;
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> words() const {
    std::vector<std::uint32_t> words;
    const auto count = [](const auto& map) { return static_cast<std::uint32_t>(map.size()); };
    for (const auto& [number, step] : steps_) {
      words.insert(words.end(), {step.now, count(step.inputs)});
      for (const auto& [input, value] : step.inputs)
        words.insert(words.end(), {input, value});
      words.push_back(count(step.runs));
      for (const auto& [rule, run] : step.runs)
        words.push_back(rule | run << kRunShift);
    }
    return words;
  }

private:
  const vm::Image& image_;
  std::map<std::uint32_t, Step> steps_;
};

}  // namespace

std::vector<std::uint32_t> script_of(const tool::Program& program, const std::string& scenario) {
  const tool::Scenario stimuli = tool::read_scenario(scenario, program);
  Steps steps(program.image());
  sim::Simulator simulator(program.bytes(), [&](const link::Event& event) { steps.take(event); });
  if (!simulator.verdict().ok())
    throw tool::Failure(tool::Exit::program, scenario + ": the board would refuse the program");
  for (const tool::Stimulus& stimulus : stimuli.stimuli)
    simulator.feed(stimulus.at_us, stimulus.channel, stimulus.value);
  simulator.run_until(stimuli.duration_us.value_or(kDefaultDurationUs));
  return steps.words();
}

}  // namespace robosync::timing
