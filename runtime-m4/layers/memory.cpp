// See memory.hpp.
#include "runtime-m4/layers/memory.hpp"

#include <cstring>
#include <utility>

namespace robosync::layers {

namespace {

using policy::Part;

// The part that exists before any program.
constexpr std::uint32_t kShared = policy::bytes_of(Part::shared, {});

}  // namespace

void Memory::lay_out(const policy::Needs& needs) {
  needs_ = needs;
  open_ = at(kShared, 0).data();
  writable_ = at(needs.writable_begin, 0).data();
  closed_ = arena_.data() + arena_.size();
}

void Memory::clear() {
  policy::Needs none;
  none.open = none.writable_begin = none.total = kShared;
  lay_out(none);
}

std::span<std::byte> Memory::take_raw(Part part, std::size_t element) {
  std::size_t bytes = element * policy::count_of(part, needs_.counts);
  bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
  if (policy::info_of(part).region == policy::Region::closed) return {closed_ -= bytes, bytes};
  std::byte*& next = policy::info_of(part).region == policy::Region::open ? open_ : writable_;
  return {std::exchange(next, next + bytes), bytes};
}

std::byte* Memory::take_zeroed(Part part, std::size_t element) {
  const std::span<std::byte> taken = take_raw(part, element);
  std::memset(taken.data(), 0, taken.size());
  return taken.data();
}

std::span<std::byte> Memory::take_area(Part part) {
  const std::span<std::byte> taken =
      take_raw(part, policy::info_of(part).bytes * port::kArenaScale);
  std::memset(taken.data(), 0, taken.size());
  return taken;
}

// In the board's bytes.
std::span<std::byte> Memory::room() {
  const std::uint32_t begin = needs_.writable_begin + needs_.writable;
  return at(begin, board_.arena_bytes - needs_.closed - begin);
}

}  // namespace robosync::layers
