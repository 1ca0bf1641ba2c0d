// What the link says of a thread: the board's, and the one of the robot in virtual time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "link/messages.hpp"
#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::layers {

[[nodiscard]] inline link::Name padded(std::string_view text) {
  link::Name name{};
  std::copy_n(text.begin(), std::min(text.size(), name.size() - 1), name.begin());
  return name;
}

[[nodiscard]] inline link::ThreadInfo thread_info(const kernel::Kernel& kernel,
                                                  const kernel::Thread& thread, std::size_t index) {
  return {static_cast<std::uint8_t>(index),
          static_cast<std::uint8_t>(kernel.threads().size()),
          static_cast<std::uint8_t>(thread.category()),
          thread.rank(),
          thread.priority().now,
          thread.priority().base,
          static_cast<std::uint16_t>(thread.stack().size()),
          static_cast<std::uint16_t>(thread.stack_used()),
          static_cast<std::uint8_t>(kernel.state(thread)),
          thread.missed(),
          thread.activations(),
          kernel.run_time(thread),
          kernel.clock(),
          padded(thread.name())};
}

}  // namespace robosync::layers
