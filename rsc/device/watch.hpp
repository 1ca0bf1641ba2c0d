// Watches what a board does as it happens (trace events, log lines, faults) and
// tells its viewers (viewer.hpp).
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rsc/device/viewer.hpp"

namespace robosync::tool {

// The board's trace is on while the object exists.
class Watch {
public:
  // `session` is null while the line is lost, and a new session when it is back.
  // `place`: where to look for it. `threads`: also ask for the threads once a
  // second.
  Watch(std::unique_ptr<Session>& session, Place place, std::vector<Viewer*> viewers,
        bool threads = false);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  // Tells the viewers which board it is, why it started, its last fault, which
  // devices do not answer, and what is tripped, halted and known now.
  void introduce();
  // Runs until the duration is over, the user interrupts (Ctrl-C), or a viewer is
  // done. Meanwhile it lends the line to another rsc that wants it, and looks for a
  // lost line. Throws Failure (outside) if the line is still lost at the end.
  void show(std::optional<std::chrono::milliseconds> duration);
  // For a caller with requests of its own in between: tells the viewers what has come, and what comes within `wait`.
  // Meanwhile the line is neither lent nor looked for. False: the user interrupts, or a viewer is done. Throws Failure
  // (outside) if the line is lost.
  [[nodiscard]] bool listen(std::chrono::milliseconds wait);
  // Tells the viewers what has come already, also from a line that is lost.
  void tell_the_rest();

private:
  using Clock = Transport::Clock;

  void begin();
  void learn_program();
  void learn_source();
  [[nodiscard]] const Program* uploaded(const link::ProgramHash& hash) const;
  void learn_threads();
  bool goes_on();
  bool step();
  void look_if_due();
  void tell(const Message& message);
  void tell_event(const Message& message);
  void tell_current();
  void tell_threads();
  void look(const link::Status& status);
  void remember(const link::Status& status);
  bool has_restarted(const link::Status& status) const;
  bool lend();
  void lose(const std::string& why);
  void find_again();
  void report_losses(const link::Status& status);
  void missed(const std::string& why);

  std::unique_ptr<Session>& session_;
  Place place_;
  std::vector<Viewer*> viewers_;
  bool threads_;
  std::vector<link::ThreadInfo> thread_list_;  // the latest list
  std::vector<std::byte> image_bytes_;
  vm::Image image_;
  TraceNames names_;
  // The board's last status, and when it came.
  link::Status last_{};
  std::chrono::system_clock::time_point last_at_;
  Clock::time_point last_at_steady_;
  bool has_line_ = true;  // not lent to another rsc
  std::string why_lost_;  // why the line is lost, while it is
  std::optional<Clock::time_point> until_;
  Clock::time_point next_look_, next_try_;
};

}  // namespace robosync::tool
