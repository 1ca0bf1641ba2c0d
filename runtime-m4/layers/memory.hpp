// The arena: the board's memory for programs. It is laid out for each program by what that program
// needs (policy/memory.hpp) and then handed out part by part. No part is freed on its own.
//
// The sizes of the parts on the Cortex-M4 decide the layout: there the arena matches those numbers
// byte for byte. The host's parts are larger, so its arena is too (port::kArenaScale), in the same
// order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <type_traits>

#include "runtime-m4/kernel/thread.hpp"
#include "runtime-m4/policy/memory.hpp"

namespace robosync::layers {

class Memory {
public:
  // `arena` has board.arena_bytes times port::kArenaScale bytes and is aligned to kArenaAlignment.
  Memory(std::span<std::byte> arena, const policy::BoardMemory& board)
      : arena_(arena), board_(board) {
    clear();
  }
  static constexpr std::size_t kArenaAlignment = policy::kStackUnit;
  // Of every part. The host needs a larger one.
  static constexpr std::size_t kAlignment = port::kArenaScale == 1 ? policy::kPartUnit : 16;

  const policy::BoardMemory& board() const { return board_; }
  // The needs of the program that it is laid out for.
  const policy::Needs& needs() const { return needs_; }

  // Forgets all parts except the one that is taken before there is any program.
  void lay_out(const policy::Needs& needs);
  // … for no program.
  void clear();

  // Takes a part, once, with all elements newly constructed. On the board `T` must match memory.def.
  template <policy::Part kPart, class T>
  std::span<T> take();
  // … of a type whose new state is all zero.
  template <policy::Part kPart, class T>
  std::span<T> take_zero();
  // … as raw bytes.
  std::span<std::byte> take_bytes(policy::Part part) {
    return take_raw(part, policy::info_of(part).bytes);
  }

  // … all zero, and on the host scaled up like the arena, for a part that has a layout of its own.
  std::span<std::byte> take_area(policy::Part part);

  // Where the program's image is stored.
  std::span<std::byte> image() { return at(needs_.open, needs_.image); }
  // Where the next image may be received: the room that the program leaves.
  std::span<std::byte> room();
  // What the behaviours' threads may access.
  port::Areas areas() {
    return {.readable = {arena_.data(), at(needs_.open, needs_.image).data() + needs_.image},
            .writable = at(needs_.writable_begin, needs_.writable * port::kArenaScale)};
  }

private:
  std::span<std::byte> at(std::uint32_t place, std::size_t bytes) {
    return arena_.subspan(std::size_t{place} * port::kArenaScale, bytes);
  }
  std::span<std::byte> take_raw(policy::Part part, std::size_t element);
  std::byte* take_zeroed(policy::Part part, std::size_t element);

  std::span<std::byte> arena_;
  const policy::BoardMemory& board_;
  policy::Needs needs_;
  std::byte* open_ = nullptr;  // first free byte …
  std::byte* writable_ = nullptr;
  std::byte* closed_ = nullptr;  // … and the one past the last
};

template <policy::Part kPart, class T>
std::span<T> Memory::take_zero() {
  if constexpr (port::kArenaScale == 1)
    static_assert(sizeof(T) == policy::info_of(kPart).bytes, "see policy/memory.def");
  static_assert(sizeof(T) <= policy::info_of(kPart).bytes * port::kArenaScale);
  static_assert(alignof(T) <= kAlignment);
  auto* const taken = reinterpret_cast<T*>(take_zeroed(kPart, sizeof(T)));
  return {taken, policy::count_of(kPart, needs_.counts)};
}

template <policy::Part kPart, class T>
std::span<T> Memory::take() {
  const std::span<T> taken = take_zero<kPart, T>();
  if constexpr (!std::is_trivially_default_constructible_v<T>)
    for (T& one : taken)
      new (&one) T();
  return taken;
}

}  // namespace robosync::layers
