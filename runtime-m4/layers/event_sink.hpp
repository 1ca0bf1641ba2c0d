// Where trace events go: the link's ring on the board, the caller of the simulator on the host.
#pragma once

#include "link/events.hpp"

namespace robosync {

class EventSink {
public:
  virtual void emit(const link::Event& event) = 0;  // never blocks

protected:
  ~EventSink() = default;
};

}  // namespace robosync
