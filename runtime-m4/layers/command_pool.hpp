// Commands on their way to the actuators: one fixed pool of memory, with a bounded first-in first-out queue in it for each
// actuator.
#pragma once

#include <cstdint>

#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/messages.hpp"

namespace robosync::layers {

class CommandPool {
  struct Node {
    Command
        command;  // already inside its actuator's limits, so nothing is left to compute when its time comes
    Node* next;
  };

public:
  // The last `count - handed` commands are staged: their actuator does not see them before they are handed over.
  struct Queue {
    Node* first = nullptr;
    Node* last = nullptr;
    std::uint8_t count = 0;
    std::uint8_t handed = 0;
    bool begun = false;  // the first one has begun: it stays as it is until pop()

    bool has_staged() const { return count != handed; }
    void hand_over() { handed = count; }
  };

  // All places are free, and all queues are empty.
  void start(Memory& memory);

  // A new last entry of `queue`, staged, to be filled in; null if no place is left.
  [[nodiscard]] Command* push(Queue& queue);
  // Does a follow replace the last command of `queue`? That command is last().
  static bool renews(const Queue& queue) {
    return queue.count > (queue.begun ? 1 : 0) && last(queue).action() == vm::Action::follow;
  }
  static Command& last(const Queue& queue) { return queue.last->command; }
  // The first entry of `queue`, which must not be empty; valid until pop().
  static const Command& front(const Queue& queue) { return queue.first->command; }
  void pop(Queue& queue);           // the first one, which was handed over
  void drop_handed(Queue& queue);   // all that were handed over
  void drop_staged(Queue& queue);   // … that were not
  void drop_waiting(Queue& queue);  // all except one that has begun

private:
  void keep_first(Queue& queue, unsigned count);

  Node* free_ = nullptr;
};

}  // namespace robosync::layers
