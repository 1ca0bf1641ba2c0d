// rsc bridge --mqtt HOST:PORT --port P [--name ROBOT] [--duration TIME] [--key FILE]
#include "rsc/bridge/bridge.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "rsc/device/watch.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

void add_bridge(Options& options) {
  struct BridgeOptions {
    std::string port, key, mqtt, name;
    std::optional<std::chrono::milliseconds> duration;
  };
  auto asked = std::make_shared<BridgeOptions>();
  options.option("--mqtt", "HOST:PORT", asked->mqtt, "the broker", Options::Need::required);
  add_port_option(options, asked->port);
  add_key_option(options, asked->key);
  options.option("--name", "ROBOT", asked->name,
                 "its name there: topics begin with robosync/ROBOT; else its own name "
                 "(robot.json), else robot");
  add_duration_option(options, "--duration", asked->duration, "how long; else until Ctrl-C");
  options.runs([asked] {
    const Mqtt::Place broker = parse_broker(asked->mqtt);
    const Place place{asked->port, asked->key};
    auto session = open_session(place);
    std::string name = asked->name;
    if (name.empty()) name = text_of(session->board.robot);
    if (name.empty()) name = "robot";
    Bridge bridge(broker, name);
    Watch watch(session, place, {&bridge});
    watch.introduce();
    watch.show(asked->duration);
  });
}

}  // namespace robosync::tool
