// See safety_region.hpp.
#include "runtime-m4/layers/safety_region.hpp"

#include <new>

#include "runtime-m4/policy/memory.hpp"

namespace robosync::layers {

using policy::Count;

static_assert(port::kArenaScale != 1 || sizeof(SafetyRegion::Work) <= policy::kSafetyMachine);

namespace {

// Takes `count` elements from the front of `left`.
template <class T>
std::span<T> take_front(std::span<std::byte>& left, std::uint32_t count) {
  auto* const first = reinterpret_cast<T*>(left.data());
  left = left.subspan(count * sizeof(T));
  return {first, count};
}

}  // namespace

// The stack is at the bottom: a stack overflow leaves the window.
SafetyRegion SafetyRegion::take(Memory& memory) {
  const std::span<std::byte> bytes = memory.take_area(policy::Part::safety_region);
  if (bytes.empty()) return {};
  const policy::Counts& counts = memory.needs().counts;
  const policy::regions::Fit fit = policy::safety_window(counts);
  const std::size_t begin = -reinterpret_cast<std::uintptr_t>(bytes.data()) & (fit.alignment - 1);
  SafetyRegion region;
  region.window = bytes.subspan(begin, fit.bytes * port::kArenaScale);
  std::span<std::byte> left = region.window.subspan(policy::kSafetyStack);
  region.stack_top = left.data();
  region.work = new (take_front<Work>(left, 1).data()) Work();
  region.output = take_front<vm::Word>(left, counts[Count::safety_output]);
  region.timer_words = take_front<std::uint32_t>(left, counts[Count::safety_timer_words]);
  region.cells = take_front<std::uint32_t>(left, counts[Count::safety_cells]);
  return region;
}

std::span<const vm::Word> SafetyRegion::put_out(std::span<const vm::Word> output,
                                                const vm::Word* end) {
  const auto bytes =
      reinterpret_cast<std::uintptr_t>(end) - reinterpret_cast<std::uintptr_t>(output.data());
  return output.first(bytes <= output.size_bytes() ? bytes / sizeof(vm::Word) : 0);
}

}  // namespace robosync::layers
