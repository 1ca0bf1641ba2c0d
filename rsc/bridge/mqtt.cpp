// See mqtt.hpp.
#include "rsc/bridge/mqtt.hpp"

#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <mosquitto.h>

#include "rsc/failure.hpp"
#include "rsc/loaded_library.hpp"
#include "rsc/tcp_port.hpp"

namespace robosync::tool {
namespace {

constexpr int kKeepAliveS = 10;
constexpr int kQos = 1;
constexpr unsigned kLeastDelayS = 1, kMostDelayS = 10;
constexpr std::size_t kMaxWaiting = 1000;  // messages for the robot; then the oldest are dropped

// The functions used of the library.
struct Mosquitto {
// clang-format off
#define MOSQUITTO_FUNCTIONS(F)                                                                     \
  F(lib_init) F(lib_cleanup) F(new) F(destroy) F(will_set) F(connect) F(disconnect) F(loop_start)  \
  F(loop_stop) F(publish) F(subscribe) F(unsubscribe) F(strerror) F(reconnect_delay_set) F(connect_callback_set)  \
  F(disconnect_callback_set) F(message_callback_set)
// clang-format on
#define FUNCTION(name) decltype(&mosquitto_##name) name##_ = nullptr;
  MOSQUITTO_FUNCTIONS(FUNCTION)
#undef FUNCTION

  Mosquitto() {
    const LoadedLibrary library("libmosquitto.so.1", "libmosquitto1", "rsc bridge");
#define FIND(name) library.find("mosquitto_" #name, name##_);
    MOSQUITTO_FUNCTIONS(FIND)
#undef FIND
  }
};

}  // namespace

struct Mqtt::State {
  Mosquitto library;
  mosquitto* client = nullptr;
  std::string filter;
  std::map<std::string, std::string> retained;  // what the broker should retain

  std::mutex mutex;  // guards the members below, which the library's thread writes
  std::deque<MqttMessage> came;
  std::optional<std::string> news;
  bool connected = false, again = false;
  std::vector<std::string> looks_at;

  void connects(int code) {
    const std::scoped_lock lock(mutex);
    if (code != 0) {
      news = "the broker refused the connection";
      return;
    }
    connected = true;
    again = true;
    news = "connected to the broker";
    library.subscribe_(client, nullptr, filter.c_str(), kQos);
    for (const std::string& looked_at : looks_at)
      library.subscribe_(client, nullptr, looked_at.c_str(), kQos);
  }
  void disconnects(int code) {
    const std::scoped_lock lock(mutex);
    if (code != 0 && connected) news = "the broker is away; looking for it again";
    connected = false;
  }
  void takes(const mosquitto_message& message) {
    const std::scoped_lock lock(mutex);
    const auto* const bytes = static_cast<const char*>(message.payload);
    came.push_back({message.topic,
                    {bytes, bytes + (bytes == nullptr ? 0 : message.payloadlen)},
                    message.retain});
    if (came.size() > kMaxWaiting) came.pop_front();
  }
};

Mqtt::Mqtt(const Place& broker, const std::string& filter, const MqttMessage& last_words)
    : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.filter = filter;
  state.library.lib_init_();
  state.client = state.library.new_(nullptr, true, &state);
  if (state.client == nullptr) throw Failure(Exit::outside, "libmosquitto does not start");
  state.library.connect_callback_set_(state.client, [](mosquitto*, void* self, int code) {
    static_cast<State*>(self)->connects(code);
  });
  state.library.disconnect_callback_set_(state.client, [](mosquitto*, void* self, int code) {
    static_cast<State*>(self)->disconnects(code);
  });
  state.library.message_callback_set_(state.client,
                                      [](mosquitto*, void* self, const mosquitto_message* message) {
                                        static_cast<State*>(self)->takes(*message);
                                      });
  state.library.will_set_(state.client, last_words.topic.c_str(),
                          static_cast<int>(last_words.payload.size()), last_words.payload.data(),
                          kQos, true);
  state.library.reconnect_delay_set_(state.client, kLeastDelayS, kMostDelayS, true);
  const int code =
      state.library.connect_(state.client, broker.host.c_str(), broker.port, kKeepAliveS);
  if (code == MOSQ_ERR_SUCCESS && state.library.loop_start_(state.client) == MOSQ_ERR_SUCCESS)
    return;
  state.library.destroy_(state.client);
  throw Failure(
      Exit::outside,
      fmt::format("mqtt://{}:{}: {}; is a broker running there?", broker.host, broker.port,
                  code == MOSQ_ERR_ERRNO ? "nobody answers" : state.library.strerror_(code)));
}

Mqtt::~Mqtt() {
  state_->library.disconnect_(state_->client);
  state_->library.loop_stop_(state_->client, false);
  state_->library.destroy_(state_->client);
  state_->library.lib_cleanup_();
}

void Mqtt::publish(const std::string& topic, const std::string& payload, bool retain) {
  if (retain) {
    state_->retained[topic] = payload;
    const std::scoped_lock lock(state_->mutex);
    if (!state_->connected || state_->again) return;  // next() sends it once
  }
  state_->library.publish_(state_->client, nullptr, topic.c_str(), static_cast<int>(payload.size()),
                           payload.data(), retain ? kQos : 0, retain);
}

// An empty message deletes the retained one.
void Mqtt::forget(const std::string& topic) {
  if (state_->retained.erase(topic) > 0)
    state_->library.publish_(state_->client, nullptr, topic.c_str(), 0, nullptr, kQos, true);
}

void Mqtt::look_at(const std::vector<std::string>& filters) {
  const std::scoped_lock lock(state_->mutex);
  state_->looks_at = filters;
  if (!state_->connected) return;  // connects() subscribes
  for (const std::string& filter : filters)
    state_->library.subscribe_(state_->client, nullptr, filter.c_str(), kQos);
}

void Mqtt::look_no_more() {
  const std::scoped_lock lock(state_->mutex);
  for (const std::string& filter : state_->looks_at)
    state_->library.unsubscribe_(state_->client, nullptr, filter.c_str());
  state_->looks_at.clear();
}

void Mqtt::clear(const std::string& topic) {
  if (!state_->retained.contains(topic))
    state_->library.publish_(state_->client, nullptr, topic.c_str(), 0, nullptr, kQos, true);
}

std::optional<MqttMessage> Mqtt::next() {
  bool again = false;
  std::optional<MqttMessage> message;
  {
    const std::scoped_lock lock(state_->mutex);
    again = std::exchange(state_->again, false);
    if (!state_->came.empty()) {
      message = std::move(state_->came.front());
      state_->came.pop_front();
    }
  }
  if (again)
    for (const auto& [topic, payload] : std::map(state_->retained))
      publish(topic, payload, true);
  return message;
}

std::optional<std::string> Mqtt::news() {
  const std::scoped_lock lock(state_->mutex);
  return std::exchange(state_->news, std::nullopt);
}

Mqtt::Place parse_broker(const std::string& text) {
  Mqtt::Place place;
  const std::size_t bracket = text.rfind(']');
  const std::size_t colon = text.rfind(':');
  const bool has_port =
      colon != std::string::npos && (bracket == std::string::npos || colon > bracket);
  place.host = text.substr(0, has_port ? colon : text.size());
  if (place.host.starts_with('[') && place.host.ends_with(']'))
    place.host = place.host.substr(1, place.host.size() - 2);
  if (has_port) {
    const auto port = tcp_port(std::string_view(text).substr(colon + 1));
    if (port)
      place.port = *port;
    else
      place.host.clear();
  }
  if (place.host.empty())
    throw Failure(Exit::usage,
                  fmt::format("`{}` is not a broker; write HOST:PORT, as in localhost:1883", text));
  return place;
}

}  // namespace robosync::tool
