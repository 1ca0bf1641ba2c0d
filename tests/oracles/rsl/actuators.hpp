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
  Actuators(const compiler::ir::Program& program, const compiler::Robot& robot, Trace& trace);

  // False if too many wait already: the command is dropped. "What is out of the actuator's range is
  // moved to its end", and no speed is above the LIMIT.
  bool submit(std::size_t actuator, Order order);
  void start(std::size_t actuator, Millis now);  // if it is idle and has something to do
  void cancel(std::size_t actuator, Millis now);
  void halt(std::size_t actuator, Millis now);
  void release(std::size_t actuator);
  // Ends what is over at `now`, and begins what follows. True if something was done.
  bool advance(std::size_t actuator, Millis now);
  [[nodiscard]] bool works_for(std::size_t rule) const;

private:
  struct Limits {
    std::int64_t least = 0, most = 0, speed = 0;
    std::int64_t usual = 0;  // speed, where a command says none; 0: it takes as long as it is told
    bool goes = false;       // it has a way to go, and AT is the speed of that
    bool sweeps = false;     // without a target it goes over its range and back
  };
  // From a place to another. Where it is in between is worked out in whole milliseconds.
  struct Motion {
    std::int64_t from = 0, to = 0;
    Millis begin = 0;
    std::int64_t length = 0;  // in microseconds
    [[nodiscard]] std::int64_t at(Millis now) const;
  };
  struct Key {  // of a MOTION: when it is to be there
    Millis due = 0;
    std::int64_t to = 0;
  };
  struct Queue {
    std::deque<Order> orders;  // the first one is under way if busy
    bool busy = false;
    Motion motion;
    std::int64_t home = 0, speed = 0;  // of a gesture
    unsigned legs = 0;                 // still to come
    bool halted = false;               // what it was doing is neither done nor cancelled yet
    Millis ends = 0;
    std::deque<Key> keys;  // of the MOTION under way, those still to come …
    Millis motion_ends = 0;
  };
  Millis begin(std::size_t actuator, const Order& order, Millis now);
  void go(std::size_t actuator, std::int64_t to, std::int64_t length, Millis now);
  bool next_leg(std::size_t actuator, Millis now);
  void begin_motion(std::size_t actuator, const Order& order, Millis now);
  Millis follow_at_once(std::size_t actuator, std::int64_t to, Millis now);
  Millis go_to_next_key(std::size_t actuator, Millis now);
  void let_go(std::size_t actuator, vm::Release how, Millis now);
  // What is under way takes no place any more, and a STOP never does.
  static std::size_t waiting(const Queue& queue) {
    const bool first =
        queue.busy ||
        (!queue.orders.empty() && queue.orders.front().command->verb.action == vm::Action::stop);
    return queue.orders.size() - (first ? 1 : 0);
  }

  const compiler::ir::Program& program_;
  std::set<std::size_t> used_;  // actuators that the program commands or halts
  Trace& trace_;
  std::vector<vm::Release> on_release_, safe_;
  std::vector<Queue> queues_;
  std::vector<Limits> limits_;
};

}  // namespace robosync::oracle
