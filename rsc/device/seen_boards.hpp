// Which boards are at the serial ports and drives of this computer.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rsc/device/serial_transport.hpp"

namespace robosync::tool {

// What a port's board says of itself; nothing when nobody answers as RoboSync does.
struct Answer {
  std::string board, firmware;
};
using Ask = std::function<std::optional<Answer>(const std::string& port)>;
[[nodiscard]] std::optional<Answer> ask_board(const std::string& port);

struct SeenPort {
  SerialPort port;
  std::vector<std::string> may_be;  // the known boards whose serial line looks like that
  std::optional<Answer> answer;
};

// Only ports that may be a board are asked: what is at another one might take the question for an order.
[[nodiscard]] std::vector<SeenPort> look_at_ports(const std::vector<SerialPort>& ports,
                                                  const Ask& ask);

struct SeenDrive {
  std::filesystem::path place;
  std::string board;
};
[[nodiscard]] std::vector<SeenDrive> look_at_drives();

}  // namespace robosync::tool
