// See spread.hpp.
#include "tests/runtime-m4/layers/spread.hpp"

namespace robosync::test {
namespace {

constexpr unsigned kChannelsOfSensor = 8;
constexpr unsigned kHighestPriority = 90;

std::string sensor_of(unsigned channel) {
  return "s" + std::to_string(channel / kChannelsOfSensor);
}

}  // namespace

std::string Spread::rsl() const {
  std::string text_of_all;
  for (unsigned b = 0; b < behaviors; ++b) {
    text_of_all += "BEHAVIOR b" + std::to_string(b) + " PRIORITY " +
                   std::to_string(kHighestPriority - b) + "\n";
    for (unsigned r = rules * b / behaviors; r < rules * (b + 1) / behaviors; ++r)
      text_of_all += "  WHEN " + sensor_of(channel_of(r)) + " C" + std::to_string(channel_of(r)) +
                     " = " + std::to_string(value_of(r)) + " DO\n    LOG \"" + std::to_string(r) +
                     text + "\"\n  END\n";
    text_of_all += "END\n";
  }
  return text_of_all;
}

std::string Spread::json() const {
  std::string sensors;
  for (unsigned c = 0; c < channels; ++c) {
    if (c % kChannelsOfSensor == 0)
      sensors += (c == 0 ? "" : "}},") + std::string(R"({"name": ")") + sensor_of(c) +
                 R"(", "type": "VIRTUAL", "channels": {)";
    else
      sensors += ",";
    sensors += "\"C" + std::to_string(c) + R"(": {"range": [0, 1000]})";
  }
  return R"({"sensors": [)" + sensors +
         R"(}}], "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}]})";
}

}  // namespace robosync::test
