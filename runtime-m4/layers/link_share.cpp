// See link_share.hpp.
#include "runtime-m4/layers/link_share.hpp"

#include "runtime-m4/policy/link_share.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {
namespace {

constexpr unsigned kLongEnough = policy::kLinkPeriodMs / policy::kSafetyPeriodMs;

}  // namespace

bool LinkShare::is_due(const kernel::Kernel& kernel) {
  if (link_ == nullptr || kernel.state(*link_) != kernel::Thread::State::ready) {
    without_ = 0;  // as mostly; then nobody asks for the rest
    last_.ready = false;
    return false;
  }
  return is_due(Look{.ready = true,
                     .activations = link_->activations(),
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

bool LinkShare::had_nothing(const Look& look) const {
  if (!look.ready || !last_.ready || look.activations != last_.activations) return false;
  return look.run_time - last_.run_time < (look.clock - last_.clock) / policy::kLinkParts;
}

}  // namespace robosync::layers
