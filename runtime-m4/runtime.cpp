// See runtime.hpp.
#include "runtime-m4/runtime.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <new>

#include "runtime-m4/algorithms/judge.hpp"
#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/layers/carried.hpp"

namespace robosync {

using link::EventKind;

Runtime::Runtime(kernel::Kernel& kernel, boards::Board& board, EventSink& events,
                 std::span<std::byte> arena, const policy::BoardMemory& memory)
    : kernel_(kernel),
      board_(board),
      memory_(arena, memory),
      limits_{.image_bytes = std::min<std::uint32_t>(vm::Limits{}.image_bytes, memory.arena_bytes),
              .step_cost = memory.step_budget,
              .drivers = drivers::kPresent},
      monitor_(kernel, board, *this),
      budget_(memory.step_budget),
      threads_(kernel),
      mailboxes_(kernel),
      sensors_(kernel, trace_, mailboxes_, alarm_, step_thread_, layers::kNews),
      algorithms_(kernel, trace_, mailboxes_, sensors_, step_thread_, layers::kStopped),
      outputs_(kernel, board),
      control_(kernel, outputs_, trace_, step_thread_,
               {.idle = layers::kIdle, .cancelled = layers::kCancelled, .halted = layers::kHalted}),
      variables_(kernel),
      drivers_(kernel, board, outputs_),
      alarm_(kernel, monitor_.thread(), safety::Monitor::kNews),
      trace_(kernel, events),
      shared_(share(arena)),
      safety_rules_(kernel,
                    {.trace = trace_,
                     .mailboxes = mailboxes_,
                     .frames = shared_.frames,
                     .variables = variables_,
                     .control = control_,
                     .outputs = outputs_,
                     .alarm = alarm_,
                     .processing = shared_.processing},
                    step_thread_, layers::kHalted) {}

// A part gets references to parts that are not constructed yet: a constructor may only store its
// references, not use them.
Runtime::Shared& Runtime::share(std::span<std::byte> arena) {
  static_assert(sizeof(Shared) / port::kArenaScale <= policy::info_of(policy::Part::shared).bytes,
                "see policy/memory.def");
  auto& shared = *reinterpret_cast<Shared*>(arena.data());
  return *new (&shared)
      Shared{.program = {},
             .workspace = {},
             .frames = layers::Frames(shared.workspace),
             .triggers = layers::Triggers(shared.workspace),
             .arbiter = {},
             .behaviors = layers::BehaviorLayer(kernel_, {.trace = trace_,
                                                          .workspace = shared.workspace,
                                                          .frames = shared.frames,
                                                          .triggers = shared.triggers,
                                                          .arbiter = shared.arbiter,
                                                          .variables = variables_,
                                                          .control = control_}),
             .processing = layers::ProcessingLayer(kernel_, trace_, step_thread_,
                                                   {.mailboxes = mailboxes_,
                                                    .sensors = sensors_,
                                                    .variables = variables_,
                                                    .triggers = shared.triggers,
                                                    .arbiter = shared.arbiter,
                                                    .behaviors = shared.behaviors,
                                                    .control = control_,
                                                    .threads = threads_,
                                                    .alarm = alarm_,
                                                    .algorithms = algorithms_})};
}

bool Runtime::start() {
  return monitor_.start();
}

// Computes everything from the verified image, so that no image can claim to need less. Not inlined,
// like load() and start_program(), so that their stack frames do not add up.
vm::Verdict Runtime::check(std::span<const std::byte> bytes) {
  vm::Image image;
  const vm::Verdict verdict = vm::verify(bytes, limits_, image);
  if (!verdict.ok()) return verdict;
  const vm::Verdict wired = policy::judge(image, board_.pins());
  if (!wired.ok()) return wired;
  const vm::Verdict modules = algorithms::judge(image);
  if (!modules.ok()) return modules;
  policy::count_needs(image, memory_.board(), next_);
  return policy::judge(next_, memory_.board());
}

vm::Verdict Runtime::activate(std::span<const std::byte> bytes, bool named) {
  const vm::Verdict verdict = check(bytes);
  if (!verdict.ok()) return verdict;
  if (!named) return {vm::Refusal::wrong_name, vm::Section::header, 0};
  if (!change_to(bytes)) {
    clear();
    return {vm::Refusal::too_many, vm::Section::header, 0};
  }
  ++activations_;
  return {};
}

bool Runtime::change_to(std::span<const std::byte> bytes) {
  layers::Carried carried;
  if (carries_ && running_) take_values(carried);
  end_program();
  return load(bytes) && start_program(carried);
}

void Runtime::take_values(layers::Carried& carried) const {
  const vm::Image& image = shared_.program.image;
  std::array<vm::Value, policy::kMaxVariables> values;
  {
    const auto lock = kernel_.lock();
    std::copy_n(shared_.processing.snapshot().values() + image.channels.size(),
                image.variables.size(), values.begin());
  }
  carried.take(image, values);
}

// The image may be anywhere in the room, even where the new program's parts go, so it is moved first.
bool Runtime::load(std::span<const std::byte> bytes) {
  memory_.lay_out(next_);
  const std::span<std::byte> place = memory_.image().first(bytes.size());
  std::memmove(place.data(), bytes.data(), bytes.size());
  vm::Image image;
  if (!vm::view_image(place, image)) return false;
  shared_.workspace.start(memory_);
  shared_.program.load(image, memory_);
  return true;
}

// The count of the processor's clock at which a program arrives is unpredictable: the line, its bytes
// and their oscillators are not synchronous with it. The generators spread the few bits that differ
// (layers/frames.cpp).
std::uint32_t Runtime::choose_seed(std::uint32_t of_image) const {
  if (given_seed_ != 0) return given_seed_;
  if (of_image != 0) return of_image;
  if (simulated()) return 1;
  const std::uint32_t seed = (kernel_.clock() ^ kernel_.tick() << 16U) & INT32_MAX;
  return seed != 0 ? seed : 1;
}

void Runtime::end_program() {
  faults_ += threads_.stopped();
  {
    const auto lock = kernel_.lock();
    running_ = begun_ = false;
  }
  threads_.dismiss();
  control_.release_all();
  halted_ = false;
}

void Runtime::clear() {
  end_program();
  control_.switch_off();
  memory_.clear();
}

// The threads wait until all of them have been added.
bool Runtime::start_program(const layers::Carried& carried) {
  const layers::LoadedProgram& program = shared_.program;
  threads_.take_stacks(memory_);
  const auto safety = layers::SafetyRegion::take(memory_);
  threads_.take_members(memory_);
  mailboxes_.start(memory_);
  const std::uint32_t seed = choose_seed(program.image.header->seed);
  shared_.frames.start(seed, safety);
  shared_.triggers.start(program.image, memory_);
  shared_.arbiter.start(program.behavior_of, memory_);
  safety_rules_.start(program, safety, memory_);
  kernel_.grant(memory_.areas());
  trace_.emit(EventKind::activated, {}, 0, 0, static_cast<std::int32_t>(seed));
  if (!control_.start(program, memory_, threads_) ||
      !shared_.behaviors.start(program, memory_, threads_) ||
      !shared_.processing.start(program, {kept_, carried}, memory_) ||
      !sensors_.start(program, *sampler_, simulated(), memory_, threads_) ||
      !algorithms_.start(program, memory_, threads_))
    return false;
  shared_.processing.rank();
  go();
  return true;
}

// With SAFETY rules, nothing moves until their readings are known: program time begins when they are,
// at the latest at the time that is set here (look_at_rules()).
void Runtime::go() {
  const auto lock = kernel_.lock();
  const vm::Image& image = shared_.program.image;
  const bool waits = image.has_safety() && !simulated();
  const kernel::Duration at_most =
      waits ? kernel::milliseconds(image.header->safety_start_ms) : kernel::Duration{0};
  trace_.restart(kernel_.now() + at_most + (port::kTimeFlows ? kernel::kTick : 0));
  begun_ = false;
  running_ = true;
  kernel_.signal(monitor_.thread(), safety::Monitor::kProgram | safety::Monitor::kNews);
  sensors_.go();
  if (!image.has_safety()) begin();
}

// Begins program time, at a tick that none of the program's threads can have missed.
void Runtime::begin() {
  const auto lock = kernel_.lock();
  const kernel::Time meant = trace_.activated_at();
  const kernel::Time zero = kernel_.now() + (port::kTimeFlows ? kernel::kTick : 0);
  if (zero != meant) {
    trace_.restart(zero);
    kernel_.signal(monitor_.thread(), safety::Monitor::kProgram);
  }
  begun_ = true;
  shared_.processing.go();
  sensors_.begin(meant);
  algorithms_.begin();
}

// The safety thread does it, which outranks all other threads: so it takes effect immediately.
void Runtime::say(bool stopped) {
  stopped_ = stopped;
  kernel_.signal(monitor_.thread(), safety::Monitor::kPerson);
}

void Runtime::obey() {
  stopped_ ? control_.stop() : control_.resume();
}

link::FeedResult Runtime::feed(const link::Feed& feed) {
  if (!running_.load(std::memory_order_relaxed)) return {link::FeedError::no_program, 0};
  return sensors_.feed(feed);
}

link::FeedResult Runtime::enqueue(const link::Feed& feed) {
  if (!running_) return {link::FeedError::no_program, 0};
  return sensors_.enqueue(feed);
}

void Runtime::fill_status(link::Status& status) const {
  status.uptime_us = kernel_.now();
  status.program_us = running_ ? trace_.program_time() : 0;
  status.steps = running_ ? shared_.processing.steps() : 0;
  status.safety_checks = monitor_.checks();
  status.safety_late_us = monitor_.worst_lateness();
  status.activations = activations_;
  status.faults = static_cast<std::uint8_t>(std::min(faults_ + threads_.stopped(), 255U));
  status.reset_reason = board_.reset_reason();
}

link::Probed Runtime::probe(const link::Probe& at) {
  const bool possible = at.address >= vm::kFirstAddress && at.address <= vm::kLastAddress;
  const bool answers = possible && drivers_.probe(at.bus, at.address);
  const bool held = at.bus < 8 && (board_.buses().held >> at.bus & 1) != 0;
  return {at.bus, at.address, answers ? std::uint8_t{1} : std::uint8_t{0},
          held ? std::uint8_t{1} : std::uint8_t{0}};
}

void Runtime::fill_devices(link::Devices& devices) const {
  const boards::BusState buses = board_.buses();
  devices.bus_clears = buses.clears;
  devices.held = buses.held;
  if (running_) sensors_.fill_devices(devices);
}

void Runtime::fill_state(link::State& state, std::uint32_t first) const {
  state.stopped = stopped_ ? 1 : 0;
  if (!running_) return;
  const vm::Image& image = shared_.program.image;
  const std::size_t inputs = image.channels.size() + image.variables.size();
  state.program_us = trace_.program_time();
  // The safety thread and the step thread write these, and may preempt this one: under the lock all are of one moment.
  const auto lock = kernel_.lock();
  safety_rules_.fill_tripped_now(state.tripped);
  state.halted = control_.halted();
  for (std::size_t i = first; i < inputs && state.count < state.values.size(); ++i)
    state.values[state.count++] = shared_.processing.snapshot().value(static_cast<std::uint8_t>(i));
}

std::size_t Runtime::fill_kept(std::span<layers::KeptNumber, vm::kMaxKept> kept) const {
  if (!running_) return 0;
  const vm::Image& image = shared_.program.image;
  std::size_t count = 0;
  {
    const auto lock = kernel_.lock();
    for (std::size_t v = 0; v < image.variables.size() && count < kept.size(); ++v)
      if (image.variables[v].kind == vm::VariableKind::kept)
        kept[count++].value = shared_.processing.snapshot().value(
            static_cast<std::uint8_t>(image.channels.size() + v));
  }
  count = 0;
  for (const vm::Variable& variable : image.variables)
    if (variable.kind == vm::VariableKind::kept && count < kept.size())
      kept[count++].key = layers::kept_key(image, variable);
  return count;
}

void Runtime::hold_to_budgets(bool alive) {
  if (running_) algorithms_.hold_to_budgets();
  if (alive) return budget_.forget();
  kernel::Thread* over = shared_.behaviors.blocked_at_work(step_thread_);
  if (over == nullptr) over = budget_.look(kernel_);
  if (over != nullptr) port::stop_overrun(kernel_, *over);
}

// Reports the first halt, as a missed deadline of the step thread.
void Runtime::halt(kernel::Duration stuck_for) {
  control_.halt_for_good();
  if (halted_) return;
  halted_ = true;
  const auto late = static_cast<std::int32_t>(stuck_for);
  step_thread_.note_miss();
  trace_.emit(EventKind::deadline, trace_.now(), step_thread_.rank(), 0, late);
}

// A reading that is unknown when program time begins trips its rule before the first step: no thread of
// the program has run since.
kernel::Time Runtime::look_at_rules() {
  if (begun_ && !sensors_.are_fed()) [[likely]]
    return safety_rules_.look();
  return look_at_feeds();
}

// Delivers fed readings first, and decides whether program time begins.
kernel::Time Runtime::look_at_feeds() {
  if (!begun_ && !running_) return kernel::kForever;
  const kernel::Time now = kernel_.now();
  sensors_.deliver_due();
  if (!begun_ && !sensors_.knows_enough()) {
    if (simulated()) return kernel::kForever;
    if (now < trace_.activated_at()) return trace_.activated_at();
  }
  if (!begun_) begin();
  return safety_rules_.look();
}

}  // namespace robosync
