// May assume nothing of what the board sends. Promises that each line is written out at once, that
// losses are said, and that the board's trace is off again afterwards.
#include "rsc/device/watch.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <iostream>
#include <span>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "link/events.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/device/past.hpp"
#include "rsc/device/threads.hpp"
#include "rsc/failure.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {
namespace {

using link::MessageType;
using std::chrono::milliseconds;
using Json = nlohmann::ordered_json;

constexpr milliseconds kLookForLosses{1000};  // and at the threads

volatile std::sig_atomic_t interrupted = 0;

// SIGINT ends the watch instead of the program, so that the board is told to stop its trace.
class Interruptible {
public:
  Interruptible() {
    interrupted = 0;
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };
    sigaction(SIGINT, &action, &before_int_);
    sigaction(SIGTERM, &action, &before_term_);
  }
  ~Interruptible() {
    sigaction(SIGINT, &before_int_, nullptr);
    sigaction(SIGTERM, &before_term_, nullptr);
  }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

private:
  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
};

}  // namespace

Watch::Watch(Session& session, Format format, bool threads)
    : session_(session), format_(format), threads_(threads) {
  learn_names();
  if (threads_) thread_list_ = session_.client.threads();
  lost_ = session_.client.set_trace(true).lost_events;
}

Watch::~Watch() {
  if (!has_line_) return;
  try {
    session_.client.set_trace(false);
  } catch (const Failure&) {
    // The line is gone; the next hello stops the trace.
  }
}

void Watch::learn_names() {
  image_bytes_ = session_.client.running_image();
  const bool good = vm::verify(image_bytes_, vm::Limits{}, image_).ok();
  names_ = {good ? &image_ : nullptr, {}};
  learn_threads();
}

void Watch::learn_threads() {
  names_.threads.clear();
  for (const link::ThreadInfo& thread : session_.client.threads())
    names_.threads.push_back(text_of(thread.name));
}

void Watch::introduce() {
  const Past past(session_.client);
  uptime_us_ = past.status.uptime_us;
  std::vector<OnBus> silent;
  if (names_.image != nullptr) silent = on_buses(image_, session_.client.devices());
  std::erase_if(silent, [](const OnBus& device) { return !device.silent; });
  link::Authority owner{};
  owner.pairing = session_.board.pairing;
  if (owner.pairing == link::Pairing::paired) owner = session_.client.authority();
  if (format_ == Format::json) {
    const Json line{{"event", "board"},
                    {"name", text_of(session_.board.board)},
                    {"uptime_us", past.status.uptime_us},
                    {"reset_reason", reset_reason(past.status)},
                    {"faults", past.status.faults},
                    {"last_fault", last_fault_json(past)},
                    {"owner", owner_json(owner)},
                    {"silent", devices_json(silent)}};
    std::cout << line.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
  } else {
    std::cout << fmt::format("        board  {}, up {}{}\n", text_of(session_.board.board),
                             past_text(past.status),
                             past.has_fault() ? "; last fault: " + fault_text(past.fault) : "");
    std::cout << "        owner  " << owner_text(owner) << '\n';
    for (const OnBus& device : silent)
      std::cout << "       silent  " << silent_text(device) << '\n';
  }
  std::cout.flush();
}

void Watch::show(std::optional<milliseconds> duration) {
  const Interruptible interruptible;
  const auto start = session_.client.now();
  const auto goes_on = [&] {
    return interrupted == 0 && (!duration || session_.client.now() - start < *duration);
  };
  auto next_look = start + kLookForLosses;
  while (goes_on()) {
    if (session_.transport->wanted() && !lend(goes_on)) return;
    const auto now = session_.client.now();
    if (now >= next_look) {
      look(session_.client.set_trace(true));
      if (threads_) show_threads();
      next_look = now + kLookForLosses;
    }
    auto wait = milliseconds(100);
    if (duration) {
      const auto left = std::chrono::ceil<milliseconds>(start + *duration - now);
      wait = std::clamp(left, milliseconds(0), wait);
    }
    if (const auto message = session_.client.next_unasked(wait)) show(*message);
  }
  report_losses(session_.client.status());
}

void Watch::show(const Message& message) {
  const std::string text(reinterpret_cast<const char*>(message.payload.data()),
                         message.payload.size());
  switch (message.type) {
    case MessageType::event:
      show_event(message);
      break;
    case MessageType::fault:
      show_fault(message);
      break;
    default:
      if (format_ == Format::json) {
        const Json line{{"event", "log"}, {"text", text}};
        std::cout << line.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
      } else {
        std::cout << "          log  " << text << '\n';
      }
  }
  std::cout.flush();
  if (!std::cout) throw Failure(Exit::outside, "could not write to stdout");
}

void Watch::show_event(const Message& message) {
  link::Event event;
  if (!link::decode_event(message.payload, event)) return;
  // Another program runs: numbers mean something else from here on.
  if (event.kind == link::EventKind::activated) learn_names();
  // Ranks, which is how events name threads, are others. Asked for only when one is named.
  if (event.kind == link::EventKind::priority || event.kind == link::EventKind::lowered)
    names_.threads.clear();
  const bool names_thread =
      event.kind == link::EventKind::fault || event.kind == link::EventKind::deadline;
  if (names_thread && names_.threads.empty()) learn_threads();
  std::cout << (format_ == Format::json ? trace_json(event, names_) : trace_line(event, names_))
            << '\n';
}

void Watch::show_fault(const Message& message) {
  link::Fault fault{};
  if (!link::read_payload(message.payload, fault)) return;
  if (format_ == Format::json) {
    Json line;
    line["event"] = "fault";
    line.update(fault_json(fault));
    std::cout << line.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
    return;
  }
  std::cout << "        fault  " << fault_text(fault) << '\n';
}

void Watch::show_threads() {
  const std::vector<link::ThreadInfo> now = session_.client.threads();
  if (format_ == Format::json) {
    const Json line{{"event", "threads"}, {"threads", threads_json(now, thread_list_)}};
    std::cout << line.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
  } else {
    std::cout << '\n' << threads_table(now, thread_list_) << '\n';
  }
  std::cout.flush();
  thread_list_ = now;
}

// A board that has started again has forgotten that somebody listens, so it is told each time.
void Watch::look(const link::Status& status) {
  if (status.uptime_us < uptime_us_) {
    std::cerr << "rsc: the board has started again\n";
    lost_ = 0;
    learn_names();
    introduce();
  } else {
    report_losses(status);
  }
  uptime_us_ = status.uptime_us;
}

// What has come is shown first: its numbers are those of the program that has run so far. The other one's hello switches
// the trace off anyway.
bool Watch::lend(const std::function<bool()>& waiting) {
  session_.client.set_trace(false);
  while (const auto message = session_.client.next_unasked(milliseconds(0)))
    show(*message);
  const auto lent = session_.client.now();
  has_line_ = session_.transport->lend(waiting);
  if (!has_line_) return false;
  const link::Status status = session_.client.set_trace(true);
  const std::vector<std::byte> before = image_bytes_;
  learn_names();
  std::cerr << fmt::format(
      "rsc: another rsc has used the line for {:.1f} s{}; what happened meanwhile is not shown\n",
      std::chrono::duration<double>(session_.client.now() - lent).count(),
      image_bytes_ == before ? "" : ", and another program runs");
  look(status);
  return true;
}

void Watch::report_losses(const link::Status& status) {
  const std::uint32_t now_lost = status.lost_events - lost_;
  lost_ = status.lost_events;
  if (now_lost == 0) return;
  std::cerr << fmt::format("rsc: {} events did not fit on the line and are not shown\n", now_lost);
}

}  // namespace robosync::tool
