// A byte line to the board: a serial device, a pseudo terminal, or a socket of an emulator.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace robosync::tool {

// How long a line may accept no bytes before it counts as lost.
inline constexpr int kWriteTimeoutMs = 2000;

class Transport {
public:
  using Clock = std::chrono::steady_clock;

  virtual ~Transport() = default;

  // Waits at most `timeout` for bytes. Returns how many came; 0 after the timeout, or earlier
  // after a signal. Throws Failure (outside) if the line is lost.
  virtual std::size_t read(std::span<std::byte> bytes, std::chrono::milliseconds timeout) = 0;
  // Writes all bytes. Throws Failure (outside) if the line is lost or accepts nothing for that
  // long.
  virtual void write(std::span<const std::byte> bytes) = 0;
  virtual std::string name() const = 0;  // as the user wrote it
  // For lines that every rsc can open (line_lock.hpp); other lines have nothing to lend.
  virtual bool wanted() const { return false; }
  [[nodiscard]] virtual bool lend(const std::function<bool()>& /*waiting*/) { return true; }
  // The clock for timeouts.
  virtual Clock::time_point now() const { return Clock::now(); }
};

// How a serial line or a pty is shared with other rsc processes (line_lock.hpp).
enum class Sharing {
  in_turn,  // waits for it
  at_once   // starts while it waits: the first reply may go to the other process
};

// The same name for all names of one device or socket, as far as its file shows.
[[nodiscard]] std::string real_name_of(const std::string& port);

// `port`: a serial device (115,200 baud, 8N1), a pty, unix:PATH or tcp:HOST:PORT. Throws Failure:
// outside if it cannot be opened (with the reason), usage if it is not such a name.
[[nodiscard]] std::unique_ptr<Transport> open_port(const std::string& port,
                                                   Sharing sharing = Sharing::in_turn);

}  // namespace robosync::tool
