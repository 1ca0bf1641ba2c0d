// See link_share.hpp.
#include "runtime-m4/layers/link_share.hpp"

#include "runtime-m4/policy/link_share.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {
namespace {

constexpr unsigned kLongEnough = policy::kLinkPeriodMs / policy::kSafetyPeriodMs;

}  // namespace

bool LinkShare::is_due(const kernel::Kernel& kernel) {
  if (link_ == nullptr || kernel.state(*link_) != kernel::Thread::State::ready) return false;
  return is_due(Look{.activations = link_->activations(),
                     .run_time = kernel.run_time(*link_),
                     .clock = kernel.clock()});
}

bool LinkShare::is_due(const Look& look) {
  without_ = had_nothing(look) ? without_ + 1 : 0;
  last_ = look;
  if (without_ < kLongEnough) return false;
  without_ = 0;
  return true;
}

// Who has waited in between has been activated since.
bool LinkShare::had_nothing(const Look& look) const {
  if (look.activations != last_.activations) return false;
  return look.run_time - last_.run_time < (look.clock - last_.clock) / policy::kLinkParts;
}

}  // namespace robosync::layers
