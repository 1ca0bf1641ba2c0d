// A conversation with a board: the open port, the client on it, and the board's introduction.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include "rsc/device/client.hpp"
#include "rsc/device/transport.hpp"

namespace robosync::tool {

struct Session {
  // Opens the port and says hello. Throws Failure (outside) when there is no port, or no answer
  // before the timeout.
  explicit Session(const std::string& port,
                   std::chrono::milliseconds timeout = std::chrono::milliseconds(2000))
      : transport(open_port(port)), client(*transport, timeout), board(client.hello()) {}

  std::unique_ptr<Transport> transport;
  Client client;
  link::HelloReply board;
};

// A NUL-padded name from the wire.
[[nodiscard]] inline std::string text_of(const link::Name& name) {
  return {name.begin(), std::find(name.begin(), name.end(), '\0')};
}

}  // namespace robosync::tool
