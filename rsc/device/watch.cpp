// The board's data is not trusted. Promises that losses are reported, and that the board's
// trace is off afterwards.
#include "rsc/device/watch.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/interruptible.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {
namespace {

using link::MessageType;
using std::chrono::milliseconds;

constexpr milliseconds kLook{1000};       // for checks of losses and threads
constexpr milliseconds kListen{50};       // before the viewers have their turn
constexpr std::size_t kMostAtOnce = 100;  // messages, before the caller of listen() has its turn
constexpr milliseconds kTryAgain{500};
constexpr milliseconds kTolerance{3000};  // of a board's clock against this computer's

}  // namespace

Watch::Watch(std::unique_ptr<Session>& session, Place place, std::vector<Viewer*> viewers,
             bool threads)
    : session_(session),
      place_(std::move(place)),
      viewers_(std::move(viewers)),
      threads_(threads),
      next_look_(Clock::now() + kLook) {
  begin();
}

Watch::~Watch() {
  if (!has_line_ || !session_) return;
  try {
    session_->client.set_trace(false);
  } catch (const Failure&) {
    // The line is lost; the next hello stops the trace.
  }
}

void Watch::begin() {
  learn_program();
  if (threads_) thread_list_ = session_->client.threads();
  remember(session_->client.set_trace(true));
}

void Watch::learn_program() {
  image_bytes_ = session_->client.running_image([this](const link::ProgramHash& hash) {
    const Program* const program = uploaded(hash);
    return program == nullptr ? std::vector<std::byte>() : without_source_lines(*program);
  });
  const bool good = vm::verify(image_bytes_, vm::Limits{}, image_).ok();
  names_ = {good ? &image_ : nullptr, {}, nullptr};
  if (good) learn_source();
  learn_threads();
  for (Viewer* const viewer : viewers_)
    viewer->program(names_, image_bytes_);
}

// The board does not know units; the viewer that uploaded the program may know its
// configuration.
void Watch::learn_source() {
  if (const Program* const program = uploaded(image_.header->program_hash))
    names_.origin = &program->origin();
}

const Program* Watch::uploaded(const link::ProgramHash& hash) const {
  for (const Viewer* const viewer : viewers_)
    if (const Program* const program = viewer->uploaded(hash)) return program;
  return nullptr;
}

void Watch::learn_threads() {
  names_.threads = session_->client.threads();
}

void Watch::introduce() {
  Past past(session_->client);
  std::vector<OnBus> silent;
  if (names_.image != nullptr) silent = on_buses(image_, session_->client.devices());
  std::erase_if(silent, [](const OnBus& device) { return !device.silent; });
  past.owner.pairing = session_->board.pairing;
  if (past.owner.pairing == link::Pairing::paired) past.owner = session_->client.authority();
  for (Viewer* const viewer : viewers_)
    viewer->board(session_->board, past, silent);
  tell_current();
}

bool Watch::goes_on() {
  bool wanted = true;
  for (Viewer* const viewer : viewers_)
    wanted = viewer->work(has_line_ ? session_.get() : nullptr) && wanted;
  return wanted && !Interruptible::interrupted() && (!until_ || Clock::now() < *until_);
}

void Watch::show(std::optional<milliseconds> duration) {
  const Interruptible interruptible;
  until_.reset();
  if (duration) until_ = Clock::now() + *duration;
  while (goes_on()) {
    if (!session_)
      find_again();
    else if (!step())
      return;
  }
  if (!session_) throw Failure(Exit::outside, why_lost_);
  look(session_->client.status());
}

// False if the line was lent until the end.
bool Watch::step() {
  try {
    if (session_->transport->wanted() && !lend()) return false;
    look_if_due();
    auto wait = kListen;
    if (until_) {
      const auto left = std::chrono::ceil<milliseconds>(*until_ - Clock::now());
      wait = std::clamp(left, milliseconds(0), wait);
    }
    if (const auto message = session_->client.next_unasked(wait)) tell(*message);
  } catch (const Failure& failure) {
    if (failure.exit() != Exit::outside) throw;
    lose(failure.what());
  }
  return true;
}

void Watch::look_if_due() {
  const auto now = Clock::now();
  if (now < next_look_) return;
  look(session_->client.set_trace(true));
  if (threads_) tell_threads();
  next_look_ = now + kLook;
}

bool Watch::listen(milliseconds wait) {
  look_if_due();
  for (std::size_t i = 0; i < kMostAtOnce; ++i) {
    const auto message = session_->client.next_unasked(i == 0 ? wait : milliseconds(0));
    if (!message) break;
    tell(*message);
  }
  return goes_on();
}

void Watch::tell_the_rest() {
  if (!session_) return;
  try {
    while (const auto message = session_->client.pending_unasked())
      tell(*message);
  } catch (const Failure&) {
    // What a number means is asked over the same line.
  }
  (void)goes_on();
}

// Closes the port, so that a cable can be plugged in again.
void Watch::lose(const std::string& why) {
  why_lost_ = why;
  session_.reset();
  next_try_ = Clock::now() + kTryAgain;
  missed(why + "; looking for it again");
}

void Watch::find_again() {
  std::this_thread::sleep_for(kListen);
  if (Clock::now() < next_try_) return;
  try {
    session_ = open_session(place_);
    begin();
    missed("the line is back; what happened meanwhile is not shown");
    introduce();
  } catch (const Failure& failure) {
    if (failure.exit() != Exit::outside) throw;
    why_lost_ = failure.what();
    session_.reset();
  }
  next_try_ = Clock::now() + kTryAgain;
}

void Watch::tell(const Message& message) {
  if (message.type == MessageType::event) {
    tell_event(message);
    return;
  }
  if (message.type == MessageType::fault) {
    link::Fault fault{};
    if (!link::read_payload(message.payload, fault)) return;
    for (Viewer* const viewer : viewers_)
      viewer->fault(fault);
    return;
  }
  const std::string text(reinterpret_cast<const char*>(message.payload.data()),
                         message.payload.size());
  for (Viewer* const viewer : viewers_)
    viewer->log(text);
}

void Watch::tell_event(const Message& message) {
  link::Event event;
  if (!link::decode_event(message.payload, event)) return;
  // Another program runs: numbers have other meanings from here on.
  if (event.kind == link::EventKind::activated) learn_program();
  // Events name threads by rank, and ranks have changed. They are fetched when an event next
  // names a thread.
  if (event.kind == link::EventKind::priority || event.kind == link::EventKind::lowered)
    names_.threads.clear();
  if (names_thread(event) && names_.threads.empty()) learn_threads();
  for (Viewer* const viewer : viewers_)
    viewer->event(event, names_);
}

// The trace is on already, so nothing that happens after the answer is missed.
void Watch::tell_current() {
  const Current current = current_of(session_->client, names_.image);
  for (Viewer* const viewer : viewers_)
    viewer->current(current, names_);
}

void Watch::tell_threads() {
  const std::vector<link::ThreadInfo> now = session_->client.threads();
  for (Viewer* const viewer : viewers_)
    viewer->threads(now, thread_list_);
  thread_list_ = now;
}

void Watch::remember(const link::Status& status) {
  last_ = status;
  last_at_ = std::chrono::system_clock::now();
  last_at_steady_ = Clock::now();
}

// When this computer has slept, a board that restarted meanwhile may have been up for longer than at the last look. But then it
// has not been up for all of the time that passed by the wall clock. A board in an emulator sleeps with this computer, and the
// wall clock may be set: so the board may also have gone on as the steady clock did.
bool Watch::has_restarted(const link::Status& status) const {
  if (status.uptime_us < last_.uptime_us || status.activations < last_.activations ||
      status.lost_events < last_.lost_events)
    return true;
  const std::chrono::duration<double> by_wall = std::chrono::system_clock::now() - last_at_;
  const std::chrono::duration<double> by_steady = Clock::now() - last_at_steady_;
  const std::chrono::duration<double> went_on =
      std::chrono::microseconds(status.uptime_us - last_.uptime_us);
  const auto tolerance = kTolerance + by_wall / 50;  // an emulator may be slow
  return went_on + tolerance < by_wall && abs(went_on - by_steady) > tolerance;
}

// A restarted board has its trace off, so every status request switches it on again.
void Watch::look(const link::Status& status) {
  if (has_restarted(status)) {
    missed("the board has restarted");
    learn_program();
    introduce();
  } else {
    report_losses(status);
  }
  remember(status);
  for (Viewer* const viewer : viewers_)
    viewer->status(status);
}

// Pending messages are passed on first: their numbers belong to the program that has run so
// far. The other rsc's hello switches the trace off anyway.
bool Watch::lend() {
  session_->client.set_trace(false);
  while (const auto message = session_->client.next_unasked(milliseconds(0)))
    tell(*message);
  const auto lent = Clock::now();
  has_line_ = false;
  has_line_ = session_->transport->lend([this] { return goes_on(); });
  if (!has_line_) return false;
  const link::Status status = session_->client.set_trace(true);
  const std::vector<std::byte> before = image_bytes_;
  learn_program();
  missed(
      fmt::format("another rsc has used the line for {:.1f} s{}; what happened "
                  "meanwhile is not shown",
                  std::chrono::duration<double>(Clock::now() - lent).count(),
                  image_bytes_ == before ? "" : ", and another program runs"));
  tell_current();
  look(status);
  return true;
}

void Watch::report_losses(const link::Status& status) {
  if (status.lost_events <= last_.lost_events) return;
  const std::uint32_t now_lost = status.lost_events - last_.lost_events;
  missed(fmt::format("{} events did not fit on the line and are not shown", now_lost));
}

void Watch::missed(const std::string& why) {
  for (Viewer* const viewer : viewers_)
    viewer->missed(why);
}

}  // namespace robosync::tool
