// See algorithms.hpp. May rely on the verifier and on algorithms::judge() for the image.
#include "runtime-m4/layers/algorithms.hpp"

#include <algorithm>
#include <new>

#include "runtime-m4/algorithms/judge.hpp"
#include "runtime-m4/kernel/calls.hpp"

namespace robosync::layers {

using link::EventKind;

// --- start ---

bool AlgorithmLayer::start(const LoadedProgram& program, Memory& memory, ProgramThreads& threads) {
  program_ = &program;
  server_ = nullptr;
  begun_ = false;
  units_ = memory.take<policy::Part::algorithm_units, Unit>();
  if (units_.empty()) return true;
  return start_units(memory.board(), threads) && start_server(threads);
}

bool AlgorithmLayer::start_units(const policy::BoardMemory& board, ProgramThreads& threads) {
  const vm::Image& image = program_->image;
  const auto nothing = [](std::size_t, std::uint32_t, std::uint32_t) {};
  const std::uint32_t lowest = policy::place_algorithms(image, board, nothing);
  auto unit = units_.begin();
  bool good = true;
  policy::place_algorithms(image, board, [&](std::size_t s, std::uint32_t at, std::uint32_t bytes) {
    unit->sensor = static_cast<std::uint8_t>(s);
    good = good && start_unit(*unit++, threads.algorithm_stack(at - lowest, bytes), threads);
  });
  return good;
}

bool AlgorithmLayer::start_server(ProgramThreads& threads) {
  kernel::ThreadSpec spec;
  spec.name = "algorithms";
  spec.category = kernel::Category::sensor;
  spec.entry = [](void* self) { static_cast<AlgorithmLayer*>(self)->run(); };
  spec.argument = this;
  server_ = threads.start(spec, policy::kAlgorithms);
  sensors_.tell_of_samples(server_);
  return server_ != nullptr;
}

// The kernel paints the stack, but not the data below it.
bool AlgorithmLayer::start_unit(Unit& unit, std::span<std::byte> stack, ProgramThreads& threads) {
  static_assert(port::kArenaScale != 1 ||
                sizeof(Data) + ROBOSYNC_MOST_BYTES + policy::kModuleStack <=
                    policy::kAlgorithmStack);
  static_assert(ROBOSYNC_ROOM == policy::kAlgorithmStack);
  kernel::ThreadSpec spec;
  spec.name = name_of(program_->image, wiring_of(unit).name, "algorithm");
  spec.category = kernel::Category::algorithm;
  spec.privileged = false;
  spec.stack = stack;
  spec.data_bytes =
      static_cast<std::uint16_t>(sizeof(Data) + algorithms::most_bytes(wiring_of(unit)));
  std::ranges::fill(stack.first(spec.data_bytes), std::byte{0});
  unit.data = new (stack.data()) Data;
  fill(unit, *unit.data);
  spec.entry = [](void* data) { run_module(*static_cast<Data*>(data)); };
  spec.argument = unit.data;
  unit.thread = threads.start(spec, unit.sensor);
  return unit.thread != nullptr;
}

void AlgorithmLayer::fill(Unit& unit, Data& data) const {
  const vm::Sensor& wiring = wiring_of(unit);
  const robosync_module& module = algorithms::module_of(wiring);
  const std::int32_t* const config = algorithms::config_of(program_->image, wiring);
  data.kernel = &kernel_;
  data.module = &module;
  data.period_ms = wiring.period_ms;
  data.begins = 1;
  std::ranges::fill(data.outputs, ROBOSYNC_UNKNOWN);
  std::copy_n(config, module.parameters, data.config);
  unit.budget = (2 * module.cost(config) + kInterrupts) / port::kCyclesPerCount;
}

// --- the module's thread: unprivileged ---

void AlgorithmLayer::run_module(Data& data) {
  const robosync_module& module = *data.module;
  std::byte* const state = data.memory();
  std::byte* const scratch = state + algorithms::scratch_at(module, data.config);
  const robosync_block block = {data.inputs, data.outputs, data.config};
  while (true) {
    kernel::calls::wait(*data.kernel, kReleased);
    if (data.begins != 0) module.init(state, data.config, data.period_ms);
    data.begins = 0;
    data.changed = module.process(state, scratch, &block);
    if (data.changed == ROBOSYNC_FAILED) return;
  }
}

// --- the thread that serves them ---

void AlgorithmLayer::run() {
  while (true) {
    const kernel::Events why = kernel_.wait(kBegin | SensorLayer::kSampled, next_due());
    if ((why & kBegin) != 0) note_begin();
    sensors_.deliver_due();
    const kernel::Time now = kernel_.now();
    for (Unit& unit : units_) {
      if (is_due(unit, now)) serve(unit, now);
      sensors_.note_turn(sensors_.channels_of(unit.sensor));
    }
  }
}

// Forgets what was measured before program time, which SAFETY begins with: how much that was must not matter.
void AlgorithmLayer::note_begin() {
  begun_ = true;
  for (Unit& unit : units_) {
    unit.due = trace_.activated_at();
    unit.seen = kernel::kForever;
    unit.data->begins = 1;
  }
}

// An algorithm whose input is fed runs at its period; one whose input is sampled runs after each sample.
bool AlgorithmLayer::is_timed(const Unit& unit) const {
  const vm::Image& image = program_->image;
  return policy::is_fed(image.sensors[policy::input_of(image, wiring_of(unit))]);
}

kernel::Time AlgorithmLayer::next_due() const {
  kernel::Time next = kernel::kForever;
  for (const Unit& unit : units_)
    if (begun_ && is_timed(unit)) next = std::min(next, unit.due);
  return next;
}

// Periods that have passed are skipped, never made up for.
bool AlgorithmLayer::is_due(Unit& unit, kernel::Time now) {
  if (!is_timed(unit))
    return mailboxes_.sampled_at(wiring_of(unit).first_input) != unit.seen ||
           (!unit.released && !latch_inputs(unit, now));
  if (!begun_) return sensors_.awaits(sensors_.channels_of(unit.sensor));
  if (now < unit.due) return false;
  const kernel::Duration period = kernel::milliseconds(wiring_of(unit).period_ms);
  const kernel::Time missed = (now - unit.due) / period;
  if (missed != 0) kernel_.current().note_miss();
  unit.due += (missed + 1) * period;
  return true;
}

// A module that is still not done has been lowered: it may take its time, and this sample is lost.
void AlgorithmLayer::serve(Unit& unit, kernel::Time now) {
  if (kernel_.state(*unit.thread) == kernel::Thread::State::stopped) return;
  if (unit.released) collect(unit);
  if (unit.released || !latch(unit, now)) return;
  release(unit);
  collect(unit);
}

bool AlgorithmLayer::latch(Unit& unit, kernel::Time now) {
  const auto lock = kernel_.lock();
  unit.seen = mailboxes_.sampled_at(wiring_of(unit).first_input);
  return latch_inputs(unit, now);
}

// False if an input is unknown: then the module starts over.
bool AlgorithmLayer::latch_inputs(Unit& unit, kernel::Time now) {
  const vm::Sensor& wiring = wiring_of(unit);
  Data& data = *unit.data;
  const auto lock = kernel_.lock();
  for (unsigned i = 0; i < algorithms::module_of(wiring).inputs; ++i) {
    const unsigned channel = wiring.first_input + i;
    data.inputs[i] = mailboxes_.fresh_value(channel, program_->image.channels[channel], now);
    if (data.inputs[i] == vm::kUnknown) {
      data.begins = 1;
      return false;
    }
  }
  return true;
}

// The module may have written anything to where it wants to look.
void AlgorithmLayer::show_constants(const Unit& unit) {
  const std::span<const vm::Value> constants =
      algorithms::constants_of(program_->image, wiring_of(unit));
  robosync_show(reinterpret_cast<robosync_taught*>(unit.data->memory()), constants.data(),
                static_cast<std::uint32_t>(constants.size()));
}

void AlgorithmLayer::release(Unit& unit) {
  if (algorithms::module_of(wiring_of(unit)).learns != 0) show_constants(unit);
  {
    const auto lock = kernel_.lock();
    unit.run_time = kernel_.run_time(*unit.thread);
    unit.released = true;
    unit.told = false;
  }
  kernel_.signal(*unit.thread, kReleased);
}

bool AlgorithmLayer::is_done(const Unit& unit) const {
  return kernel_.state(*unit.thread) == kernel::Thread::State::blocked;
}

void AlgorithmLayer::collect(Unit& unit) {
  if (!is_done(unit)) return;
  if (!unit.told && is_over(unit, 1)) punish(unit);
  unit.released = false;
  if (kernel_.state(*unit.thread) == kernel::Thread::State::stopped) return;
  const vm::Sensor& wiring = wiring_of(unit);
  ChannelMask news = 0;
  for (unsigned i = 0; i < wiring.channel_count; ++i) {
    const auto channel = static_cast<std::uint8_t>(wiring.first_channel + i);
    const vm::Value value = unit.data->outputs[program_->image.channels[channel].input];
    if (value != vm::kUnknown) news |= sensors_.publish(channel, value, unit.seen);
  }
  sensors_.announce(news);
}

// --- budgets ---

bool AlgorithmLayer::is_over(const Unit& unit, std::uint32_t times) const {
  const auto lock = kernel_.lock();
  return unit.released && kernel_.run_time(*unit.thread) - unit.run_time > times * unit.budget;
}

// A ready module is running, or would be. One that is over twice in one release runs on and on.
void AlgorithmLayer::look_at_budgets() {
  for (Unit& unit : units_) {
    if (kernel_.state(*unit.thread) != kernel::Thread::State::ready) continue;
    if (is_over(unit, unit.told ? 2 : 1)) punish(unit);
  }
}

void AlgorithmLayer::punish(Unit& unit) {
  {
    const auto lock = kernel_.lock();
    if (unit.conduct == Conduct::good) {
      unit.conduct = Conduct::over;
      unit.told = true;
      return kernel_.signal(step_thread_, lower_);
    }
  }
  port::stop_overrun(kernel_, *unit.thread);
}

void AlgorithmLayer::lower_those_over(ProgramThreads& threads) {
  const std::int8_t idle = policy::idle_priority(program_->image);
  for (Unit& unit : units_) {
    if (unit.conduct != Conduct::over) continue;
    unit.conduct = Conduct::lowered;
    trace_.emit(EventKind::lowered, trace_.now(), unit.sensor);
    threads.keep_at(*unit.thread, {idle, idle});
  }
}

void AlgorithmLayer::retire(unsigned sensor) {
  const vm::Sensor& wiring = program_->image.sensors[sensor];
  for (unsigned i = 0; i < wiring.channel_count; ++i)
    mailboxes_.forget(wiring.first_channel + i);
}

}  // namespace robosync::layers
