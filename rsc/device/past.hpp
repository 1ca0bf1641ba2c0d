// Why a board started, and which fault it remembers, for `rsc info` and the first line of `rsc monitor`.
#pragma once

#include <string>
#include <string_view>

#include "link/messages.hpp"
#include "rsc/device/client.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

struct Past {
  explicit Past(Client& client) : status(client.status()), fault(client.last_fault()) {}

  bool has_fault() const { return fault.thread.front() != '\0'; }

  link::Status status;
  link::Authority owner{};  // who may give it orders, once asked for
  link::Fault fault;        // the last one that the board has kept, possibly from before it started
};

[[nodiscard]] std::string_view reset_reason(const link::Status& status);
// "12.345 s (reset: watchdog), 1 activations, 0 faults"
[[nodiscard]] std::string past_text(const link::Status& status);
// Which thread faulted, why and where, with all its registers.
[[nodiscard]] std::string fault_text(const link::Fault& fault);
[[nodiscard]] Json fault_json(const link::Fault& fault);
// null if there was none
[[nodiscard]] Json last_fault_json(const Past& past);

}  // namespace robosync::tool
