// Which host owns the line. A host opens a session with hello, and each request that changes the robot names the session, so
// requests of two hosts on one line never mix. A hello of another host takes over, but during a transfer only if it says so.
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

  // Does the request belong to this session, or need none?
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
  // The session's number comes first in a request. If the payload is too short for it, its reader rejects it.
  template <typename Number>
  bool names(const link::Frame& frame, Number session) const {
    Number named{};
    return !link::read_prefix(frame.payload, named) || (named == session && host_.session != 0);
  }

  link::Hello host_{};  // session 0: none yet
  kernel::Time since_ = 0;
};

}  // namespace robosync::update
