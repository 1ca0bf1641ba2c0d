// May assume POSIX. Promises that no call waits longer than it was told, and that every failure
// names the port.
#include "rsc/device/file_transport.hpp"

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

#include "rsc/device/line_lock.hpp"
#include "rsc/failure.hpp"
#include "rsc/tcp_port.hpp"

namespace robosync::tool {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& why) {
  throw Failure(Exit::outside, fmt::format("{}: {}", what, why));
}
[[noreturn]] void fail(const std::string& what, int error) {
  fail(what, std::strerror(error));
}

class Descriptor {
public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  operator int() const { return number_; }

private:
  int number_;
};

constexpr int kConnectTimeoutMs = 2000;

// Returns as poll(): 0 after the timeout, negative on error.
int wait_for(int file, short events, int timeout_ms) {
  pollfd entry{file, events, 0};
  return poll(&entry, 1, timeout_ms);
}

// Connects a non-blocking socket; 0, or the error. A peer that listens but does not accept makes it time out.
int connect_to(int file, const sockaddr* address, socklen_t length) {
  for (int waited_ms = 0; connect(file, address, length) != 0; ++waited_ms) {
    if (errno == EINPROGRESS) {
      if (wait_for(file, POLLOUT, kConnectTimeoutMs) <= 0) return ETIMEDOUT;
      int error = 0;
      socklen_t size = sizeof error;
      getsockopt(file, SOL_SOCKET, SO_ERROR, &error, &size);
      return error;
    }
    if (errno != EAGAIN && errno != EINTR) return errno;
    if (waited_ms == kConnectTimeoutMs) return ETIMEDOUT;
    poll(nullptr, 0, 1);
  }
  return 0;
}

class FileTransport final : public Transport {
public:
  enum class Kind { device, socket };

  FileTransport(std::string name, Descriptor file, Kind kind, std::optional<LineLock> lock = {})
      : name_(std::move(name)), file_(std::move(file)), kind_(kind), lock_(lock) {
    fcntl(file_, F_SETFL, O_NONBLOCK);
  }

  std::size_t read(std::span<std::byte> bytes, std::chrono::milliseconds timeout) override {
    if (!ready(POLLIN, static_cast<int>(timeout.count()))) return 0;
    const ssize_t count = ::read(file_, bytes.data(), bytes.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return 0;
    fail(name_, count == 0 ? "the other end closed the line" : std::strerror(errno));
  }

  void write(std::span<const std::byte> bytes) override {
    while (!bytes.empty()) {
      const ssize_t count = write_some(bytes);
      if (count >= 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(count));
      } else if (errno == EAGAIN) {
        if (!ready(POLLOUT, kWriteTimeoutMs)) fail(name_, "the line takes no bytes");
      } else if (errno != EINTR) {
        fail(name_, errno);
      }
    }
  }

  std::string name() const override { return name_; }
  bool wanted() const override { return lock_ && lock_->wanted(); }
  bool lend(const std::function<bool()>& waiting) override {
    return !lock_ || lock_->lend(waiting);
  }

private:
  bool ready(short events, int timeout_ms) {
    const int count = wait_for(file_, events, timeout_ms);
    if (count < 0 && errno != EINTR) fail(name_, errno);
    return count > 0;
  }

  // A closed line is an error and must not end the program.
  ssize_t write_some(std::span<const std::byte> bytes) {
    return kind_ == Kind::socket ? send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                                 : ::write(file_, bytes.data(), bytes.size());
  }

  std::string name_;
  Descriptor file_;
  Kind kind_;
  std::optional<LineLock> lock_;
};

}  // namespace

std::unique_ptr<Transport> open_pty(const std::string& path, Sharing sharing) {
  Descriptor file(open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (file < 0) fail(path, errno);
  const LineLock lock(file, path, sharing);
  termios settings{};
  if (tcgetattr(file, &settings) != 0) fail(path, errno);
  cfmakeraw(&settings);
  if (tcsetattr(file, TCSANOW, &settings) != 0) fail(path, errno);
  return std::make_unique<FileTransport>(path, std::move(file), FileTransport::Kind::device, lock);
}

std::unique_ptr<Transport> open_unix_socket(const std::string& path) {
  const std::string name = "unix:" + path;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    throw Failure(Exit::usage, name + ": give the path of a socket, at most 107 characters long");
  }
  path.copy(address.sun_path, path.size());
  Descriptor file(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (file < 0) fail(name, errno);
  const int error = connect_to(file, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  if (error == ETIMEDOUT) fail(name, "it takes no more connections: is another rsc using it?");
  if (error != 0) {
    fail(name, fmt::format("{}; is the robot running? (`scripts/robot --socket {}`)",
                           std::strerror(error), path));
  }
  return std::make_unique<FileTransport>(name, std::move(file), FileTransport::Kind::socket);
}

std::unique_ptr<Transport> open_tcp_socket(const std::string& host_and_port) {
  const std::string name = "tcp:" + host_and_port;
  const std::size_t colon = host_and_port.rfind(':');
  if (colon == std::string::npos || colon == 0 || !tcp_port(host_and_port.substr(colon + 1)))
    throw Failure(Exit::usage, name + ": give host and port, as in tcp:localhost:5555");
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host_and_port.substr(0, colon).c_str(),
                                host_and_port.substr(colon + 1).c_str(), &hints, &found);
  if (error != 0) fail(name, gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  int why = ECONNREFUSED;
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    Descriptor file(
        socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, at->ai_protocol));
    why = file < 0 ? errno : connect_to(file, at->ai_addr, at->ai_addrlen);
    if (why == 0) {
      const int on = 1;  // frames are small, and each waits for its reply
      setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      return std::make_unique<FileTransport>(name, std::move(file), FileTransport::Kind::socket);
    }
  }
  fail(name, why);
}

}  // namespace robosync::tool
