// See command_pool.hpp. Linked lists of indices; no list is longer than the pool.
#include "runtime-m4/layers/command_pool.hpp"

#include <utility>

namespace robosync::layers {

void CommandPool::start(Memory& memory) {
  nodes_ = memory.take_zero<policy::Part::commands, Node>();
  free_ = kNone;
  for (std::size_t i = nodes_.size(); i > 0; --i) {
    nodes_[i - 1].next = free_;
    free_ = static_cast<std::uint8_t>(i - 1);
  }
}

QueuedOrder* CommandPool::push(Queue& queue) {
  if (free_ == kNone) return nullptr;
  const std::uint8_t taken = free_;
  Node& node = nodes_[taken];
  free_ = node.next;
  if (queue.count == 0) {
    queue.first = taken;
  } else {
    nodes_[queue.last].next = taken;
  }
  queue.last = taken;
  ++queue.count;
  return &node.command;
}

void CommandPool::pop(Queue& queue) {
  const std::uint8_t freed = queue.first;
  queue.first = std::exchange(nodes_[freed].next, free_);
  free_ = freed;
  queue.begun = false;
  if (--queue.count == 0) queue = {};
}

void CommandPool::append(Queue& queue, Queue& from) {
  if (queue.count == 0) {
    queue = std::exchange(from, {});
    return;
  }
  if (from.count == 0) return;
  nodes_[queue.last].next = from.first;
  queue.last = from.last;
  queue.count = static_cast<std::uint8_t>(queue.count + from.count);
  from = {};
}

void CommandPool::clear(Queue& queue) {
  while (queue.count > 0)
    pop(queue);
}

void CommandPool::drop_waiting(Queue& queue) {
  if (!queue.begun) return clear(queue);
  while (queue.count > 1) {
    Node& front = nodes_[queue.first];
    const std::uint8_t freed = front.next;
    front.next = std::exchange(nodes_[freed].next, free_);
    free_ = freed;
    --queue.count;
  }
  queue.last = queue.first;
}

}  // namespace robosync::layers
