// Watches what a board does as it happens: trace events, log lines, faults. It
// tells those who view it (viewer.hpp).
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rsc/device/viewer.hpp"

namespace robosync::tool {

// Switches the board's trace on while it lives.
class Watch {
public:
  // `session` becomes another one when the line is lost, and null until it is
  // found again. `place`: where. `threads`: once a second they are asked for,
  // too.
  Watch(std::unique_ptr<Session>& session, Place place, std::vector<Viewer*> viewers,
        bool threads = false);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  // Which board it is, why it has started, its last fault, and the devices that
  // do not answer.
  void introduce();
  // Until the duration is over, the user interrupts (Ctrl-C), or a viewer has
  // seen enough. Meanwhile another rsc gets the line when it wants it, and a
  // line that is lost is looked for again. Throws Failure (outside) when it is
  // lost in the end.
  void show(std::optional<std::chrono::milliseconds> duration);

private:
  using Clock = Transport::Clock;

  void begin();
  void learn_program();
  void learn_source();
  void learn_threads();
  bool goes_on();
  bool step();
  void tell(const Message& message);
  void tell_event(const Message& message);
  void tell_threads();
  void look(const link::Status& status);
  bool lend();
  void lose(const std::string& why);
  void find_again();
  void report_losses(const link::Status& status);
  void missed(const std::string& why);

  std::unique_ptr<Session>& session_;
  Place place_;
  std::vector<Viewer*> viewers_;
  bool threads_;
  std::vector<link::ThreadInfo> thread_list_;  // as it was last told
  std::vector<std::byte> image_bytes_;
  vm::Image image_;
  TraceNames names_;
  std::uint32_t lost_ = 0;
  std::uint64_t uptime_us_ = 0;  // of the board, when it was looked at last
  bool has_line_ = true;         // it is not lent to another rsc
  std::string why_lost_;         // the line, while it is
  std::optional<Clock::time_point> until_;
  Clock::time_point next_look_, next_try_;
};

}  // namespace robosync::tool
