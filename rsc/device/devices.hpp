// How the devices on a board's buses answer: in `rsc info`, in `rsc monitor` and after `rsc upload`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "link/messages.hpp"
#include "rsc/device/client.hpp"
#include "rsc/json.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// A sensor of the running program on a bus.
struct OnBus {
  std::string name;  // of the sensor
  // Not the device, which the image does not have: several, such as tmp105 and tmp421, can have one driver.
  std::string_view driver;
  unsigned bus = 0;
  unsigned address = 0;  // on SPI, its select pin
  bool spi = false;      // else I2C
  bool asked = false;    // the board has tried to read it
  bool silent = false;   // it does not answer
  bool held = false;     // the bus is held low: no device on it can answer
  unsigned failed = 0;   // transfers since the program started
};

// `said`: the report of the board that runs `image`.
[[nodiscard]] std::vector<OnBus> on_buses(const vm::Image& image, const link::Devices& said);
// The devices that do not answer, once the board has asked all of them or has had the time to.
[[nodiscard]] std::vector<OnBus> silent_after_start(Client& client, const vm::Image& image);

// "touch (max34451) at address 0x70 on i2c bus 0 answers", "knob (mcp3008) on spi bus 0, select pin 16, is read": nothing
// answers on SPI.
[[nodiscard]] std::string found_text(const OnBus& device);
// "touch at address 0x70 on i2c bus 0 does not answer (12 transfers failed): …", with what to check.
[[nodiscard]] std::string silent_text(const OnBus& device);
[[nodiscard]] Json devices_json(const std::vector<OnBus>& devices);

}  // namespace robosync::tool
