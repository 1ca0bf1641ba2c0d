// Why a board has started, and which fault it remembers: in `rsc info`, and in the first line of `rsc monitor`.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "link/messages.hpp"
#include "rsc/device/client.hpp"

namespace robosync::tool {

struct Past {
  explicit Past(Client& client) : status(client.status()), fault(client.last_fault()) {}

  bool has_fault() const { return fault.thread.front() != '\0'; }

  link::Status status;
  link::Authority owner{};  // who gives it orders, once somebody has asked
  link::Fault fault;        // the last one that the board has kept, also from before it started
};

[[nodiscard]] std::string_view reset_reason(const link::Status& status);
// "12.345 s (reset: watchdog), 1 activations, 0 faults"
[[nodiscard]] std::string past_text(const link::Status& status);
// Which thread, why and where; every register of it.
[[nodiscard]] std::string fault_text(const link::Fault& fault);
[[nodiscard]] nlohmann::ordered_json fault_json(const link::Fault& fault);
// null when there was none
[[nodiscard]] nlohmann::ordered_json last_fault_json(const Past& past);

}  // namespace robosync::tool
