// See past.hpp. The board's data is not trusted.
#include "rsc/device/past.hpp"

#include <fmt/format.h>

#include "rsc/device/session.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {
namespace {

Json registers(const link::Fault& fault) {
  Json list = Json::array();
  for (const std::uint32_t value : fault.r)
    list.push_back(fmt::format("{:08x}", value));
  return list;
}

}  // namespace

std::string_view reset_reason(const link::Status& status) {
  switch (status.reset_reason) {
    case link::ResetReason::power:
      return "power";
    case link::ResetReason::watchdog:
      return "watchdog";
    case link::ResetReason::software:
      return "software";
  }
  return "?";
}

std::string past_text(const link::Status& status) {
  return fmt::format("{:.3f} s (reset: {}), {} activations, {} faults",
                     static_cast<double>(status.uptime_us) / 1e6, reset_reason(status),
                     status.activations, status.faults);
}

std::string fault_text(const link::Fault& fault) {
  return fmt::format(
      "thread {} stopped: cause {:08x} address {:08x} pc {:08x} lr {:08x} sp {:08x} xpsr {:08x} "
      "r0-r12 {:08x}",
      text_of(fault.thread), fault.cause, fault.address, fault.pc, fault.lr, fault.sp, fault.xpsr,
      fmt::join(fault.r, " "));
}

Json fault_json(const link::Fault& fault) {
  return {{"thread", text_of(fault.thread)},
          {"cause", fault.cause},
          {"address", fault.address},
          {"pc", fault.pc},
          {"lr", fault.lr},
          {"sp", fault.sp},
          {"xpsr", fault.xpsr},
          {"r", registers(fault)}};
}

Json last_fault_json(const Past& past) {
  return past.has_fault() ? fault_json(past.fault) : Json(nullptr);
}

}  // namespace robosync::tool
