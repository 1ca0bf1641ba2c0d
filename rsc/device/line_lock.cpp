// See line_lock.hpp. May assume POSIX.
#include "rsc/device/line_lock.hpp"

#include <cerrno>
#include <chrono>
#include <thread>

#include <sys/file.h>

#include "rsc/failure.hpp"

namespace robosync::tool {
namespace {

constexpr std::chrono::milliseconds kWaitForOther{500}, kBetweenTries{10};

}  // namespace

// What cannot be locked for another reason is used without.
void lock_line(int file, const std::string& port) {
  for (auto waited = kBetweenTries; flock(file, LOCK_EX | LOCK_NB) != 0; waited += kBetweenTries) {
    if (errno != EWOULDBLOCK && errno != EINTR) return;
    if (waited > kWaitForOther)
      throw Failure(
          Exit::outside,
          port + ": another rsc uses this line; end it first (`rsc monitor` ends with Ctrl-C)");
    std::this_thread::sleep_for(kBetweenTries);
  }
}

}  // namespace robosync::tool
