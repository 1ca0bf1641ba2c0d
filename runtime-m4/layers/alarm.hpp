// Wakes the safety thread when an input that a safety rule reads changes.
#pragma once

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/messages.hpp"

namespace robosync::layers {

class Alarm {
public:
  Alarm(kernel::Kernel& kernel, kernel::Thread& safety_thread, kernel::Events news)
      : kernel_(kernel), thread_(safety_thread), news_(news) {}

  void watch(InputMask inputs) { inputs_ = inputs; }
  // The safety thread outranks every caller: it has done its work when this returns, or when a caller that holds the kernel's lock
  // lets go of it.
  [[gnu::always_inline]] void ring(InputMask changed) {
    if ((changed & inputs_) != 0) kernel_.signal(thread_, news_);
  }

private:
  kernel::Kernel& kernel_;
  kernel::Thread& thread_;
  kernel::Events news_;
  InputMask inputs_ = 0;
};

}  // namespace robosync::layers
