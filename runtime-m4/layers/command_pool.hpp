// Commands on their way to the actuators: fixed memory for all, and a bounded first-in first-out
// queue for each actuator in it.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/messages.hpp"

namespace robosync::layers {

class CommandPool {
public:
  struct Queue {
    std::uint8_t first = kNone;
    std::uint8_t last = kNone;
    std::uint8_t count = 0;
    bool begun = false;  // the first one: it stays as it is until pop()
  };

  // All its places are free, and no queue has any.
  void start(Memory& memory);

  // False when the queue has policy::kMaxQueued commands or no place is left.
  [[nodiscard]] bool push(Queue& queue, const Command& command);
  // Does a follow take the place of the last command of `queue`? … and it takes it.
  bool renews(const Queue& queue) const {
    return queue.count > (queue.begun ? 1 : 0) &&
           nodes_[queue.last].command.action() == vm::Action::follow;
  }
  [[gnu::noinline]] void renew(const Queue& queue, const Command& follow);
  // The first of `queue`, which is not empty; good until pop().
  const Command& front(const Queue& queue) const { return nodes_[queue.first].command; }
  void pop(Queue& queue);
  void clear(Queue& queue);
  void drop_waiting(Queue& queue);  // all but what is begun
  // Moves all of `from` behind `queue`; together they are not longer than policy::kMaxQueued.
  void append(Queue& queue, Queue& from);

private:
  static constexpr std::uint8_t kNone = 0xFF;
  static void copy(const Command& from, Command& to);
  struct Node {
    Command command;
    std::uint8_t next = kNone;
  };

  std::span<Node> nodes_;
  std::uint8_t free_ = kNone;
};

}  // namespace robosync::layers
