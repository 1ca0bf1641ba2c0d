// SIGINT (Ctrl-C) and SIGTERM end the current wait instead of the program, which then cleans up and exits normally.
#pragma once

#include <csignal>

namespace robosync::tool {

// Takes effect while the object exists. One at a time.
class Interruptible {
public:
  Interruptible() {
    flag() = 0;
    struct sigaction action {};
    action.sa_handler = [](int) { flag() = 1; };
    sigaction(SIGINT, &action, &before_int_);
    sigaction(SIGTERM, &action, &before_term_);
  }
  ~Interruptible() {
    sigaction(SIGINT, &before_int_, nullptr);
    sigaction(SIGTERM, &before_term_, nullptr);
  }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  static bool interrupted() { return flag() != 0; }

private:
  static volatile std::sig_atomic_t& flag() {
    static constinit volatile std::sig_atomic_t interrupted = 0;
    return interrupted;
  }

  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
};

}  // namespace robosync::tool
