// See served.hpp.
#include "runtime-m4/drivers/served.hpp"

#include "runtime-m4/policy/rules.hpp"

namespace robosync::drivers {
namespace {

bool transfer(const ServedBus& at, bool ahead, std::span<const std::byte> out,
              std::span<std::byte> in) {
  const kernel::MutexGuard mine(at.kernel, at.buses);
  if (ahead) at.board.ask_buses(true);
  const bool done = at.board.i2c_transfer(at.bus, at.address, out, in);
  if (ahead) at.board.ask_buses(false);
  return done;
}

// Until the requested transfer is done, or late.
void await(const ServedBus& at) {
  const unsigned most = at.board.buses_ask_ahead() + policy::kBusTicks;
  for (unsigned i = 0; i < most && (i == 0 || at.board.buses_busy()); ++i)
    at.kernel.sleep_until(at.kernel.now() + kernel::kTick);
}

}  // namespace

[[gnu::noinline]] bool exchange(const ServedBus& at, std::span<const std::byte> out,
                                std::span<std::byte> in, unsigned tries) {
  const bool ahead = at.board.buses_ask_ahead() != 0;
  for (; tries != 0; --tries) {
    if (ahead) {
      static_cast<void>(transfer(at, true, out, in));
      await(at);
    }
    if (transfer(at, false, out, in)) return true;
  }
  return false;
}

}  // namespace robosync::drivers
