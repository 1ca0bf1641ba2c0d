// See reset.hpp.
#include "runtime-m4/boards/common/reset.hpp"

#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::boards {

namespace {

// Survives a reset. Valid only if `magic` is right; it is cleared once it has been read.
struct Record {
  std::uint32_t magic;
  ResetReason reason;
  bool has_fault;
  link::Fault fault;
};
constexpr std::uint32_t kMagic = 0x52425354;
[[gnu::section(".noinit")]] Record record;

// The record as it was when the firmware started.
class Start {
public:
  Start() {
    if (record.magic == kMagic) {
      reason_ = record.reason;
      has_fault_ = record.has_fault;
      fault_ = record.fault;
    }
    record = {};
  }
  ResetReason reason() const { return reason_; }
  const link::Fault* fault() const { return has_fault_ ? &fault_ : nullptr; }

private:
  ResetReason reason_ = ResetReason::power;
  bool has_fault_ = false;
  link::Fault fault_{};
};
Start start;

}  // namespace

ResetReason last_reset() {
  return start.reason();
}

const link::Fault* last_fault() {
  return start.fault();
}

void keep_watchdog_reset() {
  record = {kMagic, ResetReason::watchdog, false, {}};
}

void reset_after(const link::Fault& fault) {
  switch_outputs_off();
  record = {kMagic, ResetReason::software, true, fault};
  port::core::reset();
}

}  // namespace robosync::boards
