// A byte line to the board: a serial device, a pseudo terminal, or a socket of an emulator.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace robosync::tool {

// How long a line may take no bytes before it counts as gone.
inline constexpr int kWriteTimeoutMs = 5000;

class Transport {
public:
  using Clock = std::chrono::steady_clock;

  virtual ~Transport() = default;

  // Waits at most `timeout` for bytes. Returns how many came; 0 after the timeout, or earlier when
  // a signal came in. Throws Failure (outside) when the line is gone.
  virtual std::size_t read(std::span<std::byte> bytes, std::chrono::milliseconds timeout) = 0;
  // Writes all. Throws Failure (outside) when the line is gone or takes nothing for so long.
  virtual void write(std::span<const std::byte> bytes) = 0;
  virtual std::string name() const = 0;  // as the user wrote it
  // What timeouts are measured with.
  virtual Clock::time_point now() const { return Clock::now(); }
};

// One rsc at a time uses a serial line or a pty: two would each take bytes that are for the other.
enum class Sharing {
  alone,  // waits half a second for another one that is about to end; then throws Failure (outside)
  with_others  // for what must not wait: the reply may go to the other one
};

// `port`: a serial device (115,200 baud, 8N1), a pty, unix:PATH or tcp:HOST:PORT. Throws Failure:
// outside when it cannot be opened (and says why), usage when it is not such a name.
[[nodiscard]] std::unique_ptr<Transport> open_port(const std::string& port,
                                                   Sharing sharing = Sharing::alone);

}  // namespace robosync::tool
