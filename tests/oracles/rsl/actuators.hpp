// Actuators: each does its commands one after the other, and says when it is done.
#pragma once

#include <deque>
#include <functional>
#include <set>
#include <vector>

#include "tests/oracles/rsl/trace.hpp"

namespace robosync::oracle {

class Actuators {
public:
  Actuators(const compiler::Program& program, const compiler::Robot& robot, Trace& trace);

  // False if too many wait already: the command is dropped. "What is out of the actuator's range is
  // moved to its end", and no speed is above the LIMIT.
  bool submit(std::size_t actuator, Order order);
  void start(std::size_t actuator, Millis now);  // if it is idle and has something to do
  void cancel(std::size_t actuator);
  void halt(std::size_t actuator);
  void release(std::size_t actuator);
  // Ends what is over at `now`, and begins what follows. True if something was done.
  bool advance(std::size_t actuator, Millis now);
  [[nodiscard]] bool works_for(std::size_t rule) const;

private:
  struct Limits {
    std::int64_t least = 0, most = 0, speed = 0;
  };
  struct Queue {
    std::deque<Order> orders;  // the first one is under way if busy
    bool busy = false;
    bool halted = false;  // what it was doing is neither done nor cancelled yet
    Millis ends = 0;
  };
  Trace& trace_;
  std::vector<Queue> queues_;
  std::vector<Limits> limits_;
};

}  // namespace robosync::oracle
