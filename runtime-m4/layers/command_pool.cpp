// See command_pool.hpp. Linked lists; no list is longer than the pool.
#include "runtime-m4/layers/command_pool.hpp"

#include <algorithm>
#include <utility>

namespace robosync::layers {

void CommandPool::start(Memory& memory) {
  free_ = nullptr;
  for (Node& node : memory.take_zero<policy::Part::commands, Node>())
    node.next = std::exchange(free_, &node);
}

Command* CommandPool::push(Queue& queue) {
  Node* const taken = free_;
  if (taken == nullptr || queue.count >= vm::kMaxQueued) return nullptr;
  free_ = taken->next;
  (queue.count == 0 ? queue.first : queue.last->next) = taken;
  queue.last = taken;
  ++queue.count;
  return &taken->command;
}

void CommandPool::pop(Queue& queue) {
  Node* const freed = queue.first;
  queue.first = std::exchange(freed->next, std::exchange(free_, freed));
  queue.begun = false;
  --queue.handed;
  --queue.count;
}

void CommandPool::drop_handed(Queue& queue) {
  while (queue.handed > 0)
    pop(queue);
}

void CommandPool::drop_staged(Queue& queue) {
  keep_first(queue, queue.handed);
}

void CommandPool::drop_waiting(Queue& queue) {
  keep_first(queue, queue.begun ? 1 : 0);
}

void CommandPool::keep_first(Queue& queue, unsigned count) {
  Node* last = nullptr;
  Node* next = queue.first;
  for (unsigned i = 0; i < queue.count; ++i) {
    Node& node = *next;
    next = node.next;
    if (i < count) {
      last = &node;
    } else {
      node.next = std::exchange(free_, &node);
    }
  }
  queue.last = last;
  queue.count = static_cast<std::uint8_t>(std::min<unsigned>(queue.count, count));
  queue.handed = std::min(queue.handed, queue.count);
}

}  // namespace robosync::layers
