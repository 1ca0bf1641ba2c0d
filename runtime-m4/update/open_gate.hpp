// Replaces order_gate.hpp in firmware that cannot verify signatures (ROBOSYNC_AUTHENTICATION is off): any host on the line gives
// the robot orders.
#pragma once

#include <cstddef>
#include <span>

#include "link/frame.hpp"
#include "link/messages.hpp"
#include "runtime-m4/boards/store.hpp"
#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::update {

class OpenGate {
public:
  OpenGate(kernel::Kernel& /*kernel*/, boards::Store* /*store*/) {}
  void open(bool /*switched_on*/) {}
  [[nodiscard]] bool takes(link::Frame& frame) {
    signed_ = frame.type == link::MessageType::signed_order;
    return !signed_;
  }
  [[nodiscard]] bool grants(std::span<const std::byte> /*image*/, const link::Activate& /*how*/) {
    return true;
  }
  void outdate() {}
  void pair(const link::Pair& /*owner*/) { signed_ = false; }
  void unpair() {}
  link::Pairing pairing() const { return link::Pairing::impossible; }
  void fill(link::Authority& answer) const {
    answer.denial = signed_ ? link::Denial::no_owner : link::Denial::no_store;
  }
  bool busy() const { return false; }
  bool work() { return false; }
  kernel::Time due() const { return kernel::kForever; }

private:
  bool signed_ = false;  // the last request was
};

}  // namespace robosync::update
