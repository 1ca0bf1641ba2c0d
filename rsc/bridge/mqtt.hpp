// A connection to an MQTT broker, by libmosquitto. That is loaded when it is
// wanted: nobody else needs it installed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace robosync::tool {

struct MqttMessage {
  std::string topic, payload;
  bool retained = false;  // it was there before this connection
};

// Its own thread talks to the broker, and finds it again when it was away. Then
// what was published with `retain` is published again, for it may have
// forgotten.
class Mqtt {
public:
  // `last_words`: what the broker publishes (retained) when this program dies.
  // Throws Failure (outside) when libmosquitto is not installed, or there is no
  // broker.
  struct Place {
    std::string host;
    int port = 1883;
  };
  Mqtt(const Place& broker, const std::string& filter, const MqttMessage& last_words);
  ~Mqtt();
  Mqtt(const Mqtt&) = delete;
  Mqtt& operator=(const Mqtt&) = delete;

  void publish(const std::string& topic, const std::string& payload, bool retain);
  // Forgets what was retained there, here and in the broker.
  void forget(const std::string& topic);
  // From now on next() has what is retained there, and then what is published: until look_no_more().
  void look_at(const std::vector<std::string>& filters);
  void look_no_more();
  // Takes away what somebody else has left there.
  void clear(const std::string& topic);
  // The next that came for `filter`.
  [[nodiscard]] std::optional<MqttMessage> next();
  // The connection came or went since it was asked last: a sentence.
  [[nodiscard]] std::optional<std::string> news();

private:
  struct State;
  std::unique_ptr<State> state_;
};

// "HOST:PORT", "HOST", "[::1]:1883". Throws Failure (usage).
[[nodiscard]] Mqtt::Place parse_broker(const std::string& text);

}  // namespace robosync::tool
