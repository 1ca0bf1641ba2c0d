// Commands on their way to the actuators, each as its driver takes it: fixed memory for all, and a bounded first-in
// first-out queue for each actuator in it.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/layers/memory.hpp"

namespace robosync::layers {

// For one actuator, inside its limits: so nothing is left to be done when its time comes.
struct QueuedOrder {
  drivers::Order order;
  std::uint8_t verb;  // as of Command
  std::uint8_t word;
  std::uint8_t given;
  // No parameter is kUnknown: else nobody can say what it means, and it is not carried out.
  bool complete;
};

class CommandPool {
public:
  // Aligned, so that one is copied as a word.
  struct alignas(std::uint32_t) Queue {
    std::uint8_t first = kNone;
    std::uint8_t last = kNone;
    std::uint8_t count = 0;
    bool begun = false;  // the first one: it stays as it is until pop()
  };

  // All its places are free, and no queue has any.
  void start(Memory& memory);

  // A new last one of `queue`, to be filled in; null when no place is left.
  [[nodiscard]] QueuedOrder* push(Queue& queue);
  // Does a follow take the place of the last command of `queue`? Then it is last().
  bool renews(const Queue& queue) const {
    return queue.count > (queue.begun ? 1 : 0) &&
           nodes_[queue.last].command.order.action == vm::Action::follow;
  }
  QueuedOrder& last(const Queue& queue) const { return nodes_[queue.last].command; }
  // The first of `queue`, which is not empty; good until pop().
  const QueuedOrder& front(const Queue& queue) const { return nodes_[queue.first].command; }
  void pop(Queue& queue);
  void clear(Queue& queue);
  void drop_waiting(Queue& queue);  // all but what is begun
  // Moves all of `from` behind `queue`; together they are not longer than policy::kMaxQueued.
  void append(Queue& queue, Queue& from);

private:
  static constexpr std::uint8_t kNone = 0xFF;
  struct Node {
    QueuedOrder command;
    std::uint8_t next = kNone;
  };

  std::span<Node> nodes_;
  std::uint8_t free_ = kNone;
};

}  // namespace robosync::layers
