// SIGINT (Ctrl-C) and SIGTERM end the current wait or run instead of the program, which then cleans up.
#pragma once

#include <csignal>

namespace robosync::tool {

// Takes effect while the object exists. One at a time.
class Interruptible {
public:
  Interruptible() {
    flag() = 0;
    struct sigaction action {};
    action.sa_handler = [](int signal) { flag() = signal; };
    sigaction(SIGINT, &action, &before_int_);
    sigaction(SIGTERM, &action, &before_term_);
  }
  ~Interruptible() { restore(); }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  static bool interrupted() { return flag() != 0; }

  // If a signal came, the program ends by it now, as its parent expects of one that was interrupted.
  void pass_on() const {
    restore();
    if (interrupted()) std::raise(flag());
  }

private:
  void restore() const {
    sigaction(SIGINT, &before_int_, nullptr);
    sigaction(SIGTERM, &before_term_, nullptr);
  }
  static volatile std::sig_atomic_t& flag() {
    static constinit volatile std::sig_atomic_t interrupted = 0;
    return interrupted;
  }

  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
};

}  // namespace robosync::tool
