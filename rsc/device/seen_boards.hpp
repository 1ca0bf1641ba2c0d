// Finds the boards on this computer's serial ports and drives.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rsc/device/serial_transport.hpp"

namespace robosync::tool {

// What the board on a port reports about itself; nothing if no RoboSync firmware answers.
struct Answer {
  std::string board, firmware;
};
using Ask = std::function<std::optional<Answer>(const std::string& port)>;
[[nodiscard]] std::optional<Answer> ask_board(const std::string& port);

struct SeenPort {
  SerialPort port;
  std::vector<std::string> may_be;  // known boards whose serial port has this USB id
  std::optional<Answer> answer;
};

// Only ports that may be a board are asked: another device might take the request for a command.
[[nodiscard]] std::vector<SeenPort> look_at_ports(const std::vector<SerialPort>& ports,
                                                  const Ask& ask);

struct SeenDrive {
  std::filesystem::path place;
  std::string board;
};
[[nodiscard]] std::vector<SeenDrive> look_at_drives();

}  // namespace robosync::tool
