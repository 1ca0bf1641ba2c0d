// Which addresses on a board's I2C buses answer, and what may be there: `rsc info --scan`.
#pragma once

#include <string>
#include <vector>

#include "rsc/device/client.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

struct FoundPart {
  unsigned bus = 0;
  unsigned address = 0;
  std::string known;                // the program's sensor there, or what the board uses it for
  std::vector<std::string> may_be;  // devices that can have this address; empty if it is known
};

struct Scan {
  std::vector<FoundPart> answers;
  std::vector<unsigned> held;  // buses of which a line is held low, so that nothing answers
  unsigned buses = 0;
};

// Asks the board for each address, one at a time. `board`: its name; an unknown board has no buses. `devices`: those of the running
// program.
[[nodiscard]] Scan scan_buses(Client& client, const std::string& board,
                              const std::vector<OnBus>& devices);
[[nodiscard]] std::string scan_text(const Scan& scan);
[[nodiscard]] Json scan_json(const Scan& scan);

}  // namespace robosync::tool
