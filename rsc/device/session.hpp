// A conversation with a board: the open port, the client on it, and the board's introduction.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "rsc/device/client.hpp"
#include "rsc/device/transport.hpp"
#include "rsc/names.hpp"

namespace robosync::tool {

enum class Greeting {
  now,   // waits for the board's answer
  later  // only sends hello, so that more can be sent without waiting; then greet()
};

struct Session {
  // Opens the port and says hello. Throws Failure (outside) if there is no port, or no answer
  // before the timeout. `take`: see Client.
  explicit Session(const std::string& port,
                   std::chrono::milliseconds timeout = std::chrono::milliseconds(2000),
                   Greeting greeting = Greeting::now, bool take = false)
      : transport(open_port(port)), client(*transport, timeout, take) {
    asked_ = client.send_hello();
    if (greeting == Greeting::now) greet();
  }

  [[nodiscard]] bool greeted() const { return !asked_; }
  // Waits for the answer, once.
  void greet() {
    if (asked_) board = client.hello_answer(*std::exchange(asked_, std::nullopt));
  }

  std::unique_ptr<Transport> transport;
  Client client;
  link::HelloReply board{};

private:
  std::optional<std::uint8_t> asked_;
};

// The port of a robot, and the key that signs orders to it (empty: the default).
struct Place {
  std::string port, key;
};
// Throws what Session() throws.
[[nodiscard]] inline std::unique_ptr<Session> open_session(const Place& place) {
  auto session = std::make_unique<Session>(place.port);
  session->client.use_key(place.key);
  return session;
}

}  // namespace robosync::tool
