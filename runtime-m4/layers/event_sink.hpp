// Where trace events go: the link's ring on the board, the caller of the simulator on the host.
#pragma once

#include <atomic>

#include "link/events.hpp"

namespace robosync {

class EventSink {
public:
  // Nobody makes an event for a sink that does not listen: so tracing costs next to nothing until
  // somebody wants to see it.
  [[gnu::always_inline]] bool listening() const {
    return listening_.load(std::memory_order_relaxed);
  }

  virtual void emit(const link::Event& event) = 0;  // never blocks

protected:
  explicit EventSink(bool listening) : listening_(listening) {}
  ~EventSink() = default;
  void set_listening(bool on) { listening_.store(on, std::memory_order_relaxed); }

private:
  std::atomic<bool> listening_;
};

}  // namespace robosync
