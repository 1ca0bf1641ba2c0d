// See simulator.hpp. Feeds wait in maps, ordered by tick. Those for fed channels move on to the
// runtime's own queue, as many as it holds at a time; the sampler looks up those for sampled
// channels.
#include "runtime-m4/sim/simulator.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/thread_info.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/sim/arena.hpp"
#include "runtime-m4/sim/host_board.hpp"

namespace robosync::sim {
namespace {

// Feeds by channel: what each one measures from which time on. An encoder of a drive that is not fed is turned by its wheel.
class HeldValues final : public layers::Sampler {
public:
  HeldValues(const kernel::Kernel& kernel, layers::Sampler& drivers)
      : kernel_(kernel), drivers_(drivers) {}

  void hold(std::uint8_t channel, kernel::Time from, vm::Value value) {
    values_[channel][from] = {value, false};
  }

  bool sample(const vm::Image& image, std::uint8_t channel, vm::Value& value) override {
    auto& history = values_[channel];
    if (history.empty() && vm::counts_edges(image.sensors[image.channels[channel].sensor].driver))
      return drivers_.sample(image, channel, value);
    const auto after = history.upper_bound(kernel_.now());
    if (after == history.begin()) return false;
    Held& held = std::prev(after)->second;
    held.sampled = true;
    value = held.value;
    return value != vm::kUnknown;
  }

  bool is_sampled(std::uint8_t channel, kernel::Time from) const {
    const auto history = values_.find(channel);
    if (history == values_.end()) return true;  // never held
    const auto held = history->second.find(from);
    return held == history->second.end() || held->second.sampled;
  }

private:
  struct Held {
    vm::Value value = vm::kUnknown;
    bool sampled = false;
  };

  const kernel::Kernel& kernel_;
  layers::Sampler& drivers_;
  std::map<std::uint8_t, std::map<kernel::Time, Held>> values_;
};

class Forwarder final : public EventSink {
public:
  explicit Forwarder(Simulator::Sink sink)
      : EventSink(static_cast<bool>(sink)), sink_(std::move(sink)) {}
  void emit(const link::Event& event) override { sink_(event); }

private:
  Simulator::Sink sink_;
};

constexpr std::uint64_t next_tick(std::uint64_t time_us) {
  return (time_us / kernel::kTick + (time_us % kernel::kTick != 0 ? 1 : 0)) * kernel::kTick;
}

}  // namespace

struct Simulator::Impl {
  Impl(Sink sink, const policy::BoardMemory& memory)
      : events(std::move(sink)),
        arena(memory),
        runtime(kernel, board, events, arena.bytes(), arena.board()),
        held(kernel, runtime.drivers()) {
    runtime.measure_with(held);
  }

  void load(std::span<const std::byte> bytes) {
    std::vector<std::uint32_t> image((bytes.size() + 3) / 4);  // aligned as the VM needs it
    if (!bytes.empty()) std::memcpy(image.data(), bytes.data(), bytes.size());
    runtime.start();
    verdict = runtime.activate(std::as_bytes(std::span(image)).first(bytes.size()));
  }

  bool is_fed(std::uint8_t channel) const;
  void feed(std::uint64_t tick, std::uint8_t channel, vm::Value value);
  std::uint64_t hand_over(std::uint64_t until_us);

  kernel::Kernel kernel;
  HostBoard board;
  Forwarder events;
  Arena arena;
  Runtime runtime;
  HeldValues held;
  vm::Verdict verdict;
  // Feeds not yet handed over: tick, then channel.
  std::map<std::uint64_t, std::map<std::uint8_t, vm::Value>> waiting;
  std::optional<std::uint64_t> running_until;  // while the robot runs
};

bool Simulator::Impl::is_fed(std::uint8_t channel) const {
  const vm::Image& program = runtime.image();
  return policy::is_fed(program.sensors[program.channels[channel].sensor]);
}

// A feed of the sink is for the run that is on.
void Simulator::Impl::feed(std::uint64_t tick, std::uint8_t channel, vm::Value value) {
  const bool is_for_this_run = running_until && tick <= *running_until;
  if (!is_for_this_run ||
      runtime.enqueue({.channel = channel, .at_us = tick, .value = value}).error !=
          link::FeedError::none)
    waiting[tick][channel] = value;
}

// Hands over whole ticks, as many as fit into the runtime's queue. Returns the time to run until
// before it can take more. One tick always fits: there is a place for each channel.
std::uint64_t Simulator::Impl::hand_over(std::uint64_t until_us) {
  std::size_t places = runtime.needs().counts[policy::Count::feeds];
  std::uint64_t handed = until_us;
  while (!waiting.empty() && waiting.begin()->first <= until_us) {
    const auto& [tick, feeds] = *waiting.begin();
    if (feeds.size() > places) return handed;
    places -= feeds.size();
    handed = tick;
    for (const auto& [channel, value] : feeds)
      runtime.enqueue({.channel = channel, .at_us = tick, .value = value});
    waiting.erase(waiting.begin());
  }
  return until_us;
}

Simulator::Simulator(std::span<const std::byte> image, Sink sink, const policy::BoardMemory& memory,
                     std::uint32_t seed)
    : impl_(std::make_unique<Impl>(std::move(sink), memory)) {
  impl_->runtime.draw_from(seed);
  impl_->load(image);
}

Simulator::Simulator(std::span<const std::byte> image, Sink sink)
    : Simulator(image, std::move(sink), boards::kMemory) {}

Simulator::~Simulator() = default;

vm::Verdict Simulator::verdict() const {
  return impl_->verdict;
}

void Simulator::feed(std::uint64_t at_us, std::uint8_t channel, vm::Value value) {
  if (!impl_->runtime.running() || channel >= impl_->runtime.image().channels.size()) return;
  const std::uint64_t tick = next_tick(std::max(at_us, impl_->kernel.now()));
  if (impl_->is_fed(channel)) {
    impl_->feed(tick, channel, value);
  } else {
    impl_->held.hold(channel, tick, value);
  }
}

bool Simulator::is_sampled(std::uint64_t at_us, std::uint8_t channel) const {
  return impl_->held.is_sampled(channel, next_tick(at_us));
}

void Simulator::run_until(std::uint64_t until_us) {
  std::uint64_t reached = 0;
  do {
    reached = impl_->hand_over(until_us);
    impl_->running_until = reached;
    impl_->kernel.machine().run_until(reached);
    impl_->running_until.reset();
  } while (reached < until_us);
}

link::Status Simulator::status() const {
  link::Status status{};
  impl_->runtime.fill_status(status);
  return status;
}

std::vector<link::ThreadInfo> Simulator::threads() const {
  std::vector<link::ThreadInfo> threads;
  for (const kernel::Thread* const thread : impl_->kernel.threads())
    threads.push_back(layers::thread_info(impl_->kernel, *thread, threads.size()));
  return threads;
}

}  // namespace robosync::sim
