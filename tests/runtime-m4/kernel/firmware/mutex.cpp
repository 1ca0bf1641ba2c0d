// Mutexes on the board: the cases of mutex_cases.hpp with real preemption, a holder that faults,
// and a bus that they protect.
#include "runtime-m4/kernel/mutex.hpp"

#include <utility>

#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/mps2-an386/board.hpp"
#include "runtime-m4/layers/sampler.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"
#include "tests/runtime-m4/kernel/mutex_cases.hpp"

namespace {

using namespace robosync;

class BoardStage final : public mutex_cases::Stage {
public:
  BoardStage() : Stage(robosync_kernel) {}
  kernel::Thread& start(unsigned index, kernel::Category category, std::int16_t priority,
                        void (*entry)(void*)) override {
    return rig::start(index, priority, entry, category);
  }
  void run() override { rig::sleep_ms(10); }
};

template <unsigned kIndex>
void run_case() {
  BoardStage stage;
  const bool passed = mutex_cases::passes(mutex_cases::all()[kIndex], stage);
  if (!passed) rig::fail("mutex_cases.cpp", kIndex, mutex_cases::noted());
}

kernel::Mutex shared{rig::Category::behavior};

void holder_faults() {
  rig::start(0, 60, [](void*) {
    robosync_kernel.acquire(shared);
    asm volatile("udf #0");
  });
  CHECK(rig::faults() == 1);
  CHECK(!shared.held());
  const kernel::MutexGuard mine(robosync_kernel, shared);
  CHECK(shared.held());
}

// Two sensor threads on one bus: the higher one wakes while the lower one has it. Each reads a different register of the
// thermometer. These tests have a handler of their own for the bus's interrupts, so the reader does the bits.
struct Reader {
  std::uint8_t input;  // register
  vm::Value expected;  // its value after reset, high byte first on the bus
  unsigned good = 0;
  unsigned bad = 0;
};
std::array<Reader, 2> readers = {
    {{.input = 3, .expected = 0x0050}, {.input = 2, .expected = 0x004B}}};
guard::OutputGuard outputs{robosync_kernel, robosync_board};
layers::DriverSampler sampler{robosync_kernel, robosync_board, outputs};

void read_once(Reader& reader) {
  static constexpr std::uint16_t kThermometer = 0x48;
  const vm::Sensor sensor = {.name = 0,
                             .driver = vm::DriverId::i2c_register,
                             .bus = 0,
                             .address = kThermometer,
                             .period_ms = 1,
                             .first_channel = 0,
                             .channel_count = 1,
                             .first_input = 0,
                             .room = 0};
  vm::Channel channel{};
  channel.input = reader.input;
  channel.scale_num = channel.scale_den = 1;
  vm::Image image{};
  image.sensors = {&sensor, 1};
  image.channels = {&channel, 1};
  sampler.ask(image, 0);
  constexpr unsigned kMostBits = 1000;
  for (unsigned i = 0; i < kMostBits && sampler.awaits(); ++i) {
    const port::Alone alone;
    if (sampler.awaits()) boards::mps2::board.i2c(0).on_interrupt();
  }
  vm::Value value = 0;
  const bool right = sampler.sample(image, 0, value) && value == reader.expected;
  ++(right ? reader.good : reader.bad);
}

void one_bus() {
  const auto now_and_then = [](void*) {
    while (true) {
      rig::sleep_ms(2);
      read_once(readers[0]);
    }
  };
  const auto always = [](void*) {
    while (true)
      read_once(readers[1]);
  };
  rig::start(0, rig::kConductor - 1, now_and_then, rig::Category::sensor);
  rig::start(1, rig::kConductor - 2, always, rig::Category::sensor);
  rig::sleep_ms(200);
  for (const Reader& reader : readers) {
    CHECK(reader.good > 50);
    CHECK(reader.bad == 0);
  }
}

template <std::size_t... kIndices>
auto scenarios(std::index_sequence<kIndices...>) {
  return std::array<rig::Scenario, sizeof...(kIndices) + 2>{
      {{mutex_cases::all()[kIndices].name, run_case<kIndices>}...,
       {"mutex: free again when its holder faults", holder_faults},
       {"two sensor threads share one bus", one_bus}}};
}
const auto kScenarios = scenarios(std::make_index_sequence<mutex_cases::kCount>());

}  // namespace

std::span<const rig::Scenario> rig::mutex_scenarios() {
  return kScenarios;
}
