// One thread: all available input is read before anything is answered, so that a request can be cancelled, and a text that is
// being typed is only checked in its latest version.
#include "rsc/lsp/stdio.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>

#include <poll.h>
#include <unistd.h>

#include "rsc/lsp/framing.hpp"
#include "rsc/lsp/server.hpp"

namespace robosync::tool::lsp {
namespace {

constexpr std::size_t kBlock = std::size_t{64} * 1024;
// The most messages that wait before reading stops, so that an editor cannot fill the memory.
constexpr std::size_t kMostWaiting = 1000;

// False if the editor has closed its end.
bool write_all(int out, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(out, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

class Line {
public:
  Line(int in, int out)
      : in_(in), server_([this, out](const std::string& message) {
          heard_ = heard_ && write_all(out, framed(message));
        }) {}

  int serve() {
    while (open_ && heard_ && !server_.exit_code()) {
      const bool waits = !has_work_ && !server_.is_dirty();
      if (server_.waiting() < kMostWaiting && has_come(waits)) {
        read_some();
      } else if (has_work_) {
        has_work_ = server_.step();
      } else if (server_.is_dirty()) {
        server_.idle();
      }
    }
    while (!server_.exit_code() && server_.step()) {
      // Messages that came before the line was closed are answered.
    }
    if (heard_ && !server_.exit_code() && server_.is_dirty()) server_.idle();
    return server_.exit_code().value_or(broken_ ? 1 : server_.exit_code_at_end());
  }

private:
  bool has_come(bool waits) {
    pollfd line{in_, POLLIN, 0};
    const int count = poll(&line, 1, waits ? -1 : 0);
    return count > 0;
  }

  void read_some() {
    const ssize_t count = read(in_, block_.data(), block_.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
    if (count <= 0) {
      open_ = false;
      return;
    }
    frames_.feed(std::string_view(block_.data(), static_cast<std::size_t>(count)));
    while (take(frames_.next())) {
    }
    has_work_ = true;
  }

  bool take(const Frame& frame) {
    switch (frame.what) {
      case Frame::What::incomplete:
        return false;
      case Frame::What::message:
        server_.receive(frame.body);
        return true;
      case Frame::What::too_large:
        server_.complain(error::invalid_request, "a message has at most 64 MiB");
        return true;
      case Frame::What::broken:
        break;
    }
    server_.complain(error::parse_error,
                     "a message begins with `Content-Length: ` and the number of its bytes");
    open_ = false;
    broken_ = true;
    return false;
  }

  int in_;
  Server server_;
  FrameReader frames_;
  std::array<char, kBlock> block_{};
  bool open_ = true;   // more may come
  bool heard_ = true;  // the editor takes what is sent: it may do so when nothing more comes
  bool broken_ = false;
  bool has_work_ = false;
};

}  // namespace

int serve(int in, int out) {
  (void)std::signal(SIGPIPE, SIG_IGN);  // write() reports it as well
  return Line(in, out).serve();
}

}  // namespace robosync::tool::lsp
