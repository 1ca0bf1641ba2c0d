// The robot on the host: the same kernel, layers and VM as the firmware, in virtual time.
// This is the engine behind `rsc run`. Deterministic: same image, same feeds, same events.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "link/events.hpp"
#include "link/messages.hpp"
#include "runtime-m4/policy/memory.hpp"
#include "vm/verifier.hpp"

namespace robosync::sim {

class Simulator {
public:
  using Sink = std::function<void(const link::Event&)>;

  // Verifies and activates `image` on a board with `memory`, or else on the board that the preset
  // names; the program's clock is at 0. `seed` replaces the image's seed of the random numbers;
  // 0: as the image says, or 1.
  Simulator(std::span<const std::byte> image, Sink sink, const policy::BoardMemory& memory,
            std::uint32_t seed = 0);
  Simulator(std::span<const std::byte> image, Sink sink);
  ~Simulator();

  vm::Verdict verdict() const;  // why the image was refused, or ok

  // From program time `at_us` on, the sensor behind `channel` measures `value` (thousandths); with
  // kUnknown it fails to measure. On the host every sensor can be fed, whatever its driver: one
  // that samples finds the value at its next period. Feeds may come in any number and order. Of two
  // for the same channel and tick the last one counts; a feed for a time that has passed is one for
  // now. The sink may feed, too: the next step has what it feeds for now.
  void feed(std::uint64_t at_us, std::uint8_t channel, vm::Value value);

  // False for a feed of a sampled channel that no sample has measured so far.
  bool is_sampled(std::uint64_t at_us, std::uint8_t channel) const;

  // Runs the robot until program time `until_us`, inclusive.
  void run_until(std::uint64_t until_us);

  link::Status status() const;
  std::vector<link::ThreadInfo> threads() const;  // by rank, as events name them

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace robosync::sim
