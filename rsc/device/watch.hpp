// Shows what a board does as it happens: trace events, log lines, faults.
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "rsc/console.hpp"
#include "rsc/device/session.hpp"
#include "rsc/trace/trace_format.hpp"

namespace robosync::tool {

// Switches the board's trace on while it lives.
class Watch {
public:
  Watch(Session& session, Format format, bool threads = false);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  // One line: which board it is, why it has started, and its last fault. Then one for each device that does not answer.
  void introduce();
  // Writes to stdout, one line each (and with `threads` the list of them once a second), until the
  // duration is over or the user interrupts (Ctrl-C). Meanwhile another rsc gets the line when it wants it.
  void show(std::optional<std::chrono::milliseconds> duration);

private:
  void learn_names();
  void learn_threads();
  void show(const Message& message);
  void show_event(const Message& message);
  void show_fault(const Message& message);
  void show_threads();
  void look(const link::Status& status);
  bool lend(const std::function<bool()>& waiting);
  void report_losses(const link::Status& status);

  Session& session_;
  Format format_;
  bool threads_;
  std::vector<link::ThreadInfo> thread_list_;  // as it was last shown
  std::vector<std::byte> image_bytes_;
  vm::Image image_;
  TraceNames names_;
  std::uint32_t lost_ = 0;
  std::uint64_t uptime_us_ = 0;  // of the board, when it was looked at last
  bool has_line_ = true;         // it is not lent to another rsc
};

}  // namespace robosync::tool
