// The interrupts of the board that the firmware uses.
#include "runtime-m4/boards/common/vectors.hpp"

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"

extern "C" void Usart1_Handler();

namespace {

using namespace robosync::boards;

constexpr std::size_t kInterrupts = 82;
constexpr std::array kUsed{Interrupt{l475::usart1::kInterrupt, Usart1_Handler}};

}  // namespace

extern "C" {
[[gnu::section(".vectors.0"), gnu::used]] alignas(kVectorAlignment<kInterrupts>) extern const
    Vectors<kInterrupts> robosync_vectors = vectors<kInterrupts>(kUsed, true);
[[gnu::section(".vectors.1"), gnu::used]] alignas(kVectorAlignment<kInterrupts>) extern const
    Vectors<kInterrupts> robosync_unprivileged_vectors = vectors<kInterrupts>(kUsed, false);
}
