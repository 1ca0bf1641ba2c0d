// See line_lock.hpp. May assume Linux: locks on bytes of the device, owned by the open file (F_OFD_SETLK). Byte 0 is
// the line, byte 1 the request for it. They are released when the process ends, however it ends.
#include "rsc/device/line_lock.hpp"

#include <cerrno>
#include <chrono>
#include <thread>

#include <fcntl.h>

#include "rsc/failure.hpp"

namespace robosync::tool {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kWaitForOther{1000}, kBetweenTries{10};

enum Part : off_t { kLine = 0, kWanted = 1 };

struct flock lock_of(Part part, short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = part;
  lock.l_len = 1;
  return lock;
}

// A device that cannot be locked for another reason is used without a lock.
bool try_take(int file, Part part) {
  struct flock lock = lock_of(part, F_WRLCK);
  return fcntl(file, F_OFD_SETLK, &lock) == 0 || (errno != EAGAIN && errno != EACCES);
}

void let_go(int file, Part part) {
  struct flock lock = lock_of(part, F_UNLCK);
  fcntl(file, F_OFD_SETLK, &lock);
}

}  // namespace

LineLock::LineLock(int file, const std::string& port, Sharing sharing) : file_(file) {
  if (sharing == Sharing::at_once) {
    (void)try_take(file, kWanted);
    return;
  }
  const auto give_up = std::chrono::steady_clock::now() + kWaitForOther;
  for (const Part part : {kWanted, kLine})
    while (!try_take(file, part)) {
      if (std::chrono::steady_clock::now() >= give_up)
        throw Failure(Exit::outside, port + ": another rsc uses this line; end it first");
      std::this_thread::sleep_for(kBetweenTries);
    }
  let_go(file, kWanted);
}

bool LineLock::wanted() const {
  struct flock lock = lock_of(kWanted, F_WRLCK);
  return fcntl(file_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

// Requesting it here would take it away from the borrower.
bool LineLock::lend(const std::function<bool()>& waiting) const {
  let_go(file_, kLine);
  while (wanted() || !try_take(file_, kLine)) {
    if (!waiting()) return false;
    std::this_thread::sleep_for(kBetweenTries);
  }
  return true;
}

}  // namespace robosync::tool
