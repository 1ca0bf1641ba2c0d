// See link_share.hpp.
#include "runtime-m4/layers/link_share.hpp"

#include "runtime-m4/policy/link_share.hpp"

namespace robosync::layers {

void LinkShare::start(std::uint32_t step_cost) {
  constexpr auto kTickUs = static_cast<std::uint32_t>(kernel::kTick);
  patience_ = (policy::link_patience_us(step_cost) + kTickUs - 1) / kTickUs;
  since_ = {.activations = UINT32_MAX};
  pause_ = 0;
}

LinkShare::Look LinkShare::look(const kernel::Kernel& kernel) const {
  return {.tick = kernel.tick(),
          .clock = kernel.clock(),
          .activations = link_->activations(),
          .run_time = kernel.run_time(*link_)};
}

bool LinkShare::is_due(const Look& look) {
  if (had_time(look)) since_ = look;
  return look.tick - since_.tick >= patience_ && has_budget(look);
}

void LinkShare::took(const Look& begin, const Look& end) {
  turn_ = begin;
  pause_ = policy::kLinkParts * (end.clock - begin.clock);
}

bool LinkShare::had_time(const Look& look) const {
  return look.activations != since_.activations ||
         look.run_time - since_.run_time > (look.clock - since_.clock) / policy::kLinkParts;
}

// The clock wraps after minutes; no pause is as long as this.
constexpr std::uint32_t kLongTicks = 1000;

bool LinkShare::has_budget(const Look& look) const {
  return look.clock - turn_.clock >= pause_ || look.tick - turn_.tick >= kLongTicks;
}

}  // namespace robosync::layers
