// Publishes what a watch sees to a broker, and carries out what others publish for the
// robot: feed, stop, resume.
#pragma once

#include <set>
#include <string>

#include "rsc/bridge/mqtt.hpp"
#include "rsc/device/viewer.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

class Bridge final : public Viewer {
public:
  // Throws as Mqtt().
  Bridge(const Mqtt::Place& broker, const std::string& name);
  ~Bridge() override;

  void board(const link::HelloReply& board, const Past& past,
             const std::vector<OnBus>& silent) override;
  void program(const TraceNames& names, std::span<const std::byte> image) override;
  void current(const Current& current, const TraceNames& names) override;
  void event(const link::Event& event, const TraceNames& names) override;
  void log(const std::string& text) override;
  void fault(const link::Fault& fault) override;
  void missed(const std::string& why) override;
  bool work(Session* session) override;

private:
  void publish(const std::string& topic, const Json& payload, bool retain);
  void online(bool is);
  void stopped(bool is);
  void take(const MqttMessage& message, Session* session);
  void see_what_was_left(const std::string& topic, const MqttMessage& message);
  void obey(const std::string& topic, const std::string& payload, Session* session);
  void feed(const std::string& reading, Session& session);

  std::string root_;  // "robosync/NAME/"
  Mqtt mqtt_;
  std::set<std::string> of_program_;  // topics that become void when another program runs
  const vm::Image* image_ = nullptr;
  bool is_online_ = false;
};

}  // namespace robosync::tool
