// May assume that the plan was made for this program.
#include "rsc/trace/recording.hpp"

#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/timing.hpp"
#include "rsc/trace/time_units.hpp"
#include "rsc/trace/trace_format.hpp"
#include "runtime-m4/sim/simulator.hpp"

namespace robosync::tool {
namespace {

using compiler::test_plan::ChannelName;
using compiler::test_plan::PlannedReading;

// Not the configuration's: a TEST must not depend on it.
constexpr std::uint32_t kTestSeed = 1;

// Nothing for a channel that the program does not read: the image does not have it.
std::optional<std::uint8_t> channel_of(const vm::Image& image, const ChannelName& name) {
  for (std::size_t i = 0; i < image.channels.size(); ++i) {
    const vm::Channel& channel = image.channels[i];
    if (image.string(channel.name) == name.channel &&
        image.string(image.sensors[channel.sensor].name) == name.sensor) {
      return static_cast<std::uint8_t>(i);
    }
  }
  return std::nullopt;
}

}  // namespace

Recording record(const Program& program, const compiler::test_plan::TestPlan& plan,
                 const compiler::test_plan::PlannedTest& test) {
  Recording recording{&program.image(), &program.origin(), &plan, &test, {}, {}, {}};
  const std::vector<std::byte> uploaded = without_source_lines(program);  // as on the board
  const sim::Simulator* robot = nullptr;
  const auto take = [&](const link::Event& event) {
    recording.events.push_back(event);
    if (names_thread(event) && recording.threads.empty()) recording.threads = robot->threads();
  };
  sim::Simulator simulator(uploaded, take, program.board(), test.seed.value_or(kTestSeed));
  robot = &simulator;
  if (const vm::Verdict verdict = simulator.verdict(); !verdict.ok()) {
    throw Failure(Exit::program,
                  fmt::format("the board would refuse the program: {}",
                              refusal_text(program.image(), verdict, program.board())));
  }
  for (const PlannedReading& reading : test.readings) {
    const auto channel = channel_of(program.image(), plan.channels.at(reading.channel));
    if (channel) simulator.feed(reading.at * kMicroseconds, *channel, reading.value);
  }
  simulator.run_until(test.end * kMicroseconds);
  for (const PlannedReading& reading : test.readings) {
    const auto channel = channel_of(program.image(), plan.channels.at(reading.channel));
    const bool sampled = !channel || simulator.is_sampled(reading.at * kMicroseconds, *channel);
    if (!sampled) recording.unseen.push_back(&reading);
  }
  return recording;
}

Playback::Playback(const Recording& recording)
    : recording_(recording), channels_(recording.image->channels.size(), vm::kUnknown) {
  for (const vm::Variable& variable : recording.image->variables)
    variables_.push_back(variable.initial);
}

const link::Event* Playback::next() {
  if (at_ == recording_.events.size()) return nullptr;
  const link::Event& event = recording_.events[at_++];
  now_us_ = std::max(now_us_, event.time_us);
  const vm::Value value = event.value_count > 0 ? event.values[0] : vm::kUnknown;
  if (event.kind == link::EventKind::input && event.subject < channels_.size()) {
    channels_[event.subject] = value;
  } else if (event.kind == link::EventKind::stale && event.subject < channels_.size()) {
    channels_[event.subject] = vm::kUnknown;
  } else if (event.kind == link::EventKind::set && event.subject < variables_.size()) {
    variables_[event.subject] = value;
  }
  return &event;
}

void Playback::advance(std::uint64_t until_us) {
  while (at_ < recording_.events.size() && recording_.events[at_].time_us <= until_us)
    next();
  now_us_ = std::max(now_us_, until_us);
}

std::uint64_t Playback::next_time() const {
  std::uint64_t time = at_ < recording_.events.size() ? recording_.events[at_].time_us : UINT64_MAX;
  for (const PlannedReading& reading : recording_.test->readings) {
    const std::uint64_t at = reading.at * kMicroseconds;
    if (at > now_us_) time = std::min(time, at);
  }
  return time;
}

vm::Value Playback::channel(compiler::ChannelRef channel) const {
  const auto place = channel_of(*recording_.image, recording_.plan->channels.at(channel));
  if (place) return channels_[*place];
  // The program does not read it, so the robot has no value: it is what the test fed.
  vm::Value value = vm::kUnknown;
  for (const PlannedReading& reading : recording_.test->readings) {
    if (reading.channel == channel && reading.at * kMicroseconds <= now_us_) value = reading.value;
  }
  return value;
}

vm::Value Playback::variable(std::size_t index) const {
  return index < variables_.size() ? variables_[index] : vm::kUnknown;
}

// Durations also count milliseconds.
vm::Value Playback::time() const {
  return static_cast<vm::Value>(now_us_ / kMicroseconds);
}

}  // namespace robosync::tool
