// Commands on their way to the actuators, in the form that the driver takes: one fixed pool of memory, with a bounded
// first-in first-out queue in it for each actuator.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/layers/memory.hpp"

namespace robosync::layers {

// For one actuator and already inside its limits, so nothing is left to compute when its time comes.
struct QueuedOrder {
  drivers::Order order;
  std::uint8_t verb;  // as in Command
  std::uint8_t word;
  std::uint8_t given;
  // No parameter is kUnknown; otherwise the meaning is unclear, and the order is not carried out.
  bool complete;
};

class CommandPool {
public:
  // Aligned, so that it is copied as one word.
  struct alignas(std::uint32_t) Queue {
    std::uint8_t first = kNone;
    std::uint8_t last = kNone;
    std::uint8_t count = 0;
    bool begun = false;  // the first one has begun: it stays as it is until pop()
  };

  // All places are free, and all queues are empty.
  void start(Memory& memory);

  // A new last entry of `queue`, to be filled in; null if no place is left.
  [[nodiscard]] QueuedOrder* push(Queue& queue);
  // Does a follow replace the last command of `queue`? That command is last().
  bool renews(const Queue& queue) const {
    return queue.count > (queue.begun ? 1 : 0) &&
           nodes_[queue.last].command.order.action == vm::Action::follow;
  }
  QueuedOrder& last(const Queue& queue) const { return nodes_[queue.last].command; }
  // The first entry of `queue`, which must not be empty; valid until pop().
  const QueuedOrder& front(const Queue& queue) const { return nodes_[queue.first].command; }
  void pop(Queue& queue);
  void clear(Queue& queue);
  void drop_waiting(Queue& queue);  // all except one that has begun
  // Moves all of `from` to the end of `queue`; together they are at most vm::kMaxQueued.
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
