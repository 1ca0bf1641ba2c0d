// Whose line it is. A host opens a session with hello, and what changes the robot names it; so what two hosts on one line send
// never mixes. Another hello closes it, but not in the midst of a transfer, unless that is what its host wants.
#pragma once

#include <cstdint>

#include "link/frame.hpp"
#include "link/wire.hpp"
#include "runtime-m4/kernel/time.hpp"

namespace robosync::update {

class LineSession {
public:
  void open(const link::Hello& host, bool in_transfer, kernel::Time now) {
    if (host.session != host_.session && in_transfer && host.take == 0) return;
    if (host.session != host_.session) since_ = now;
    host_ = host;
  }

  // Is the request of this session, or one that needs none?
  [[nodiscard]] bool admits(const link::Frame& frame) const {
    using link::MessageType;
    switch (frame.type) {
      case MessageType::data:
      case MessageType::pieces:
        return names(frame, static_cast<std::uint16_t>(host_.session));
      case MessageType::begin:
      case MessageType::activate:
      case MessageType::feed:
      case MessageType::resume:
      case MessageType::clear:
      case MessageType::roll_back:
        return names(frame, host_.session);
      default:
        return true;
    }
  }

  link::Busy busy(kernel::Time now) const {
    return {host_.host, static_cast<std::uint32_t>((now - since_) / 1000)};
  }

private:
  // A request that names its session does so first. A short one is left to who reads it.
  template <typename Number>
  bool names(const link::Frame& frame, Number session) const {
    Number named{};
    return !link::read_prefix(frame.payload, named) || (named == session && host_.session != 0);
  }

  link::Hello host_{};  // session 0: none yet
  kernel::Time since_ = 0;
};

}  // namespace robosync::update
