// Where trace events go: the link's ring on the board, the caller of the simulator on the host.
#pragma once

#include "link/events.hpp"

namespace robosync {

class EventSink {
public:
  // No event is made for a sink that does not listen, so tracing costs next to nothing until somebody
  // reads it.
  [[gnu::always_inline]] bool listening() const {
    return __atomic_load_n(&listening_, __ATOMIC_RELAXED);
  }

  virtual void emit(const link::Event& event) = 0;  // never blocks

protected:
  explicit EventSink(bool listening) : listening_(listening) {}
  ~EventSink() = default;
  void set_listening(bool on) { __atomic_store_n(&listening_, on, __ATOMIC_RELAXED); }

private:
  bool listening_;  // not std::atomic: when it saves flash, the compiler calls its load()
};

}  // namespace robosync
