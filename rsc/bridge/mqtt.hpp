// A connection to an MQTT broker through libmosquitto, which is loaded only when needed: other verbs
// do not require it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace robosync::tool {

struct MqttMessage {
  std::string topic, payload;
  bool retained = false;  // published before this connection
};

// Its own thread talks to the broker and reconnects when the connection is lost. It then publishes
// again what was published with `retain`, because the broker may have lost it.
class Mqtt {
public:
  // `last_words`: what the broker publishes (retained) if this program dies. Throws Failure
  // (outside) if libmosquitto is not installed, or there is no broker.
  struct Place {
    std::string host;
    int port = 1883;
  };
  Mqtt(const Place& broker, const std::string& filter, const MqttMessage& last_words);
  ~Mqtt();
  Mqtt(const Mqtt&) = delete;
  Mqtt& operator=(const Mqtt&) = delete;

  void publish(const std::string& topic, const std::string& payload, bool retain);
  // Deletes what was retained under this topic, here and in the broker.
  void forget(const std::string& topic);
  // From now on next() also returns what is retained under the topic, then what is published there,
  // until look_no_more().
  void look_at(const std::vector<std::string>& filters);
  void look_no_more();
  // Deletes what another client has retained there.
  void clear(const std::string& topic);
  // The next message that matches `filter`.
  [[nodiscard]] std::optional<MqttMessage> next();
  // A sentence if the connection was made or lost since the last call.
  [[nodiscard]] std::optional<std::string> news();

private:
  struct State;
  std::unique_ptr<State> state_;
};

// "HOST:PORT", "HOST", "[::1]:1883". Throws Failure (usage).
[[nodiscard]] Mqtt::Place parse_broker(const std::string& text);

}  // namespace robosync::tool
