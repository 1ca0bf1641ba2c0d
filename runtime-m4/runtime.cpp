// See runtime.hpp.
#include "runtime-m4/runtime.hpp"

#include <algorithm>

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync {

using link::EventKind;

// A part gets references to others that may not be constructed yet, since the members stand in the
// order of what is closed: no constructor may use what it is given, only keep it.
Runtime::Runtime(kernel::Kernel& kernel, boards::Board& board, EventSink& events,
                 layers::Workspace& workspace)
    : kernel_(kernel),
      board_(board),
      monitor_(kernel, board, *this),
      safety_rules_(kernel,
                    {.trace = trace_,
                     .mailboxes = mailboxes_,
                     .frames = frames_,
                     .variables = variables_,
                     .control = control_,
                     .alarm = alarm_,
                     .processing = processing_},
                    step_thread_, layers::kHalted),
      threads_(kernel),
      mailboxes_(kernel),
      sensors_(kernel, trace_, mailboxes_, alarm_, step_thread_, layers::kNews),
      control_(kernel, board, trace_, step_thread_,
               {.idle = layers::kIdle, .cancelled = layers::kCancelled, .halted = layers::kHalted}),
      variables_(kernel),
      drivers_(kernel, board),
      alarm_(kernel, monitor_.thread(), safety::Monitor::kNews),
      trace_(kernel, events),
      frames_(workspace),
      triggers_(workspace),
      behaviors_(kernel, {.trace = trace_,
                          .workspace = workspace,
                          .frames = frames_,
                          .triggers = triggers_,
                          .arbiter = arbiter_,
                          .variables = variables_,
                          .control = control_}),
      processing_(kernel, trace_, step_thread_,
                  {.mailboxes = mailboxes_,
                   .sensors = sensors_,
                   .variables = variables_,
                   .triggers = triggers_,
                   .arbiter = arbiter_,
                   .behaviors = behaviors_,
                   .control = control_,
                   .threads = threads_,
                   .alarm = alarm_}) {}

static_assert(Runtime::layout().may_be_readable <= Runtime::layout().readable);

bool Runtime::start() {
  return monitor_.start();
}

const vm::Limits& Runtime::limits() {
  static constexpr vm::Limits kLimits{.image_bytes = layers::kSlotBytes,
                                      .step_cost = layers::kStepBudget,
                                      .frame_cells = layers::kMaxFrameCells,
                                      .behaviors = layers::kMaxBehaviors,
                                      .sensors = layers::kMaxSensors,
                                      .actuators = layers::kMaxActuators,
                                      .drivers = drivers::kPresent};
  return kLimits;
}

vm::Verdict Runtime::activate(std::span<const std::byte> bytes) {
  vm::Image image;
  vm::Verdict verdict = vm::verify(bytes, limits(), image);
  if (verdict.ok()) verdict = layers::fits(image);
  if (!verdict.ok()) return verdict;

  faults_ += threads_.stopped();
  running_ = false;
  threads_.dismiss();
  control_.release_all();
  halted_ = false;
  program_.load(image);
  if (!start_program()) {
    threads_.dismiss();
    return {vm::Refusal::too_many, vm::Section::header, 0};
  }
  ++activations_;
  return {};
}

// The threads wait until all of them are there.
bool Runtime::start_program() {
  mailboxes_.reset();
  frames_.start(program_);
  kernel_.grant(areas());
  const auto seed = static_cast<std::int32_t>(program_.image.header->seed);
  trace_.emit(EventKind::activated, {}, 0, 0, seed);
  if (!control_.start(program_, threads_) || !behaviors_.start(program_, threads_) ||
      !processing_.start(program_) || !sensors_.start(program_, *sampler_, threads_))
    return false;
  processing_.rank();
  safety_rules_.start(program_);
  go();
  return true;
}

// To the behaviours' threads. What lies between the object and the image is theirs to read as well,
// so on the board nothing does.
port::Areas Runtime::areas() {
  const auto bytes = [](const void* of) { return static_cast<const std::byte*>(of); };
  const vm::ImageHeader* const image = program_.image.header;
  // Addresses compare as numbers on all our machines, those of different objects as well.
  const std::byte* const begin = std::min(bytes(&program_), bytes(image));
  const std::byte* const end = std::max(bytes(this + 1), bytes(image) + image->total_length);
  return {.readable = {begin, static_cast<std::size_t>(end - begin)},
          .writable = frames_.writable(program_)};
}

// The program's clock begins at a tick that none of its threads can have missed.
void Runtime::go() {
  const auto lock = kernel_.lock();
  trace_.restart(kernel_.now() + (port::kTimeFlows ? kernel::kTick : 0));
  running_ = true;
  kernel_.signal(monitor_.thread(), safety::Monitor::kProgram);
  processing_.go();
  sensors_.go();
}

link::FeedResult Runtime::feed(const link::Feed& feed) {
  if (!running_) return {link::FeedError::no_program, 0};
  return sensors_.feed(feed);
}

void Runtime::fill_status(link::Status& status) const {
  status.uptime_us = kernel_.now();
  status.program_us = running_ ? trace_.program_time() : 0;
  status.steps = running_ ? processing_.steps() : 0;
  status.safety_checks = monitor_.checks();
  status.safety_late_us = monitor_.worst_lateness();
  status.activations = activations_;
  status.faults = static_cast<std::uint8_t>(std::min(faults_ + threads_.stopped(), 255U));
  status.reset_reason = board_.reset_reason();
}

void Runtime::hold_to_budgets(bool alive) {
  if (alive) return budget_.forget();
  kernel::Thread* const over = budget_.look(kernel_);
  if (over != nullptr) port::stop_overrun(kernel_, *over);
}

// The first time it is reported, as a missed deadline of the step thread.
void Runtime::halt(kernel::Duration stuck_for) {
  control_.halt_for_good();
  if (halted_) return;
  halted_ = true;
  const auto late = static_cast<std::int32_t>(stuck_for);
  step_thread_.note_miss();
  trace_.emit(EventKind::deadline, trace_.now(), step_thread_.rank(), 0, late);
}

kernel::Time Runtime::look_at_rules() {
  return running_ ? safety_rules_.look() : kernel::kForever;
}

}  // namespace robosync
