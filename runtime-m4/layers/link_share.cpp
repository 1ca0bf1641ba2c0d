// See link_share.hpp.
#include "runtime-m4/layers/link_share.hpp"

#include "runtime-m4/policy/link_share.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {
namespace {

constexpr unsigned kLongEnough = policy::kLinkPeriodMs / policy::kSafetyPeriodMs;

}  // namespace

bool LinkShare::is_due(const kernel::Kernel& kernel) {
  Look look;
  look.ready = link_ != nullptr && kernel.state(*link_) == kernel::Thread::State::ready;
  if (look.ready) {  // else nobody asks for the rest
    look.activations = link_->activations();
    look.run_time = kernel.run_time(*link_);
    look.clock = kernel.clock();
  }
  return is_due(look);
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
