// See bridge.hpp.
#include "rsc/bridge/bridge.hpp"

#include <iostream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "compiler/source/utf8.hpp"
#include "rsc/bridge/topics.hpp"
#include "rsc/device/introduction.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/trace/channels.hpp"

namespace robosync::tool {
namespace {

std::string root_of(const std::string& name) {
  if (topic_part(name) != name)
    throw Failure(Exit::usage, fmt::format("`{}` cannot be part of a topic, in which /, + and # "
                                           "have a meaning: give the robot another --name",
                                           name));
  return "robosync/" + name + "/";
}

std::string as_text(const Json& payload) {
  return json_text(payload);
}

constexpr std::string_view kDo = "do/";
constexpr const char* kProgram = "program";

std::vector<std::string> topics_of_a_program(const std::string& root) {
  std::vector<std::string> filters{root + kProgram, root + "alerts"};
  for (const char* const folder :
       {"sensors", "variables", "actuators", "behaviors", "priorities", "safety"})
    filters.push_back(root + folder + "/#");
  return filters;
}

Json program_json(const vm::Image* image) {
  if (image == nullptr) return nullptr;
  return tool::text_of(image->header->program_hash);
}

constexpr std::size_t kMostPayload = 1000;
constexpr const char* kAway = R"({"online":false})";

}  // namespace

Bridge::Bridge(const Mqtt::Place& broker, const std::string& name)
    : root_(root_of(name)),
      mqtt_(broker, root_of(name) + "do/#", {root_of(name) + "online", kAway, true}) {
  mqtt_.look_at(topics_of_a_program(root_));
}

Bridge::~Bridge() {
  online(false);
}

void Bridge::publish(const std::string& topic, const Json& payload, bool retain) {
  mqtt_.publish(root_ + topic, as_text(payload), retain);
}

void Bridge::online(bool is) {
  is_online_ = is;
  publish("online", {{"online", is}}, true);
}

void Bridge::board(const link::HelloReply& board, const Past& past,
                   const std::vector<OnBus>& silent) {
  publish("board", introduction_json(board, past, silent), true);
}

void Bridge::stopped(bool is) {
  publish("stopped", {{"stopped", is}}, true);
}

void Bridge::program(const TraceNames& names, std::span<const std::byte>) {
  image_ = names.image;
  for (const std::string& topic : of_program_)
    mqtt_.forget(root_ + topic);
  of_program_.clear();
  publish(kProgram, {{"event", "program"}, {"program", program_json(image_)}}, true);
}

void Bridge::current(const Current& current, const TraceNames& names) {
  stopped(current.stopped);
  for (const link::Event& one : current.events)
    event(one, names);
}

void Bridge::event(const link::Event& event, const TraceNames& names) {
  Json line = read_json(trace_json(event, names));
  const Topic topic = topic_of(line);
  if (topic.name == kProgram)
    line["program"] = program_json(image_);
  else if (topic.retain)
    of_program_.insert(topic.name);
  publish(topic.name, line, topic.retain);
}

void Bridge::log(const std::string& text) {
  publish("log", {{"event", "log"}, {"text", text}}, false);
}

void Bridge::fault(const link::Fault& fault) {
  Json line{{"event", "fault"}};
  line.update(fault_json(fault));
  publish("faults", line, false);
}

void Bridge::missed(const std::string& why) {
  std::cerr << "rsc: " << why << '\n';
  publish("missed", {{"why", why}}, false);
}

bool Bridge::work(Session* session) {
  if ((session != nullptr) != is_online_) online(session != nullptr);
  if (const auto news = mqtt_.news()) std::cerr << "rsc: " << *news << '\n';
  while (const auto message = mqtt_.next())
    take(*message, session);
  return true;
}

// An earlier bridge may have retained messages of another program, or outdated ones of this program. They are cleared;
// this bridge's own messages arrive after them.
void Bridge::see_what_was_left(const std::string& topic, const MqttMessage& message) {
  if (message.retained)
    mqtt_.clear(message.topic);
  else if (topic == kProgram)
    mqtt_.look_no_more();
}

// Retained orders are refused: they would be obeyed again at each start.
void Bridge::take(const MqttMessage& message, Session* session) {
  std::string topic = message.topic.substr(root_.size());
  if (!topic.starts_with(kDo)) return see_what_was_left(topic, message);
  topic = topic.substr(kDo.size());
  std::string why;
  try {
    if (message.retained) throw std::invalid_argument("it was retained: publish it without that");
    obey(topic, message.payload, session);
    return;
  } catch (const std::invalid_argument& error) {
    why = error.what();
  } catch (const Failure& failure) {
    why = failure.what();
  }
  std::cerr << fmt::format("rsc: {}: {}\n", compiler::utf8::printable(message.topic), why);
  publish("refused", {{"topic", message.topic}, {"why", why}}, false);
}

void Bridge::obey(const std::string& topic, const std::string& payload, Session* session) {
  if (session == nullptr) throw std::invalid_argument("the robot is away");
  if (payload.size() > kMostPayload)
    throw std::invalid_argument(fmt::format("{} bytes are too many for a reading: {} at most",
                                            payload.size(), kMostPayload));
  if (topic == "stop") {
    session->client.stop();
    stopped(true);
  } else if (topic == "resume") {
    session->client.resume();
    stopped(false);
  } else if (const auto reading = reading_of(topic, payload)) {
    feed(compiler::utf8::printable(*reading), *session);
  } else {
    throw std::invalid_argument("a robot takes stop, resume and feed/SENSOR/CHANNEL");
  }
}

void Bridge::feed(const std::string& reading, Session& session) {
  if (image_ == nullptr) throw std::invalid_argument("no program runs");
  const std::size_t equals = reading.find('=');
  const std::uint8_t channel = find_channel(*image_, reading.substr(0, equals));
  const vm::Value value = parse_reading(*image_, channel, reading.substr(equals + 1));
  const link::FeedResult result =
      session.client.feed({.channel = channel, .at_us = 0, .value = value});
  if (result.error != link::FeedError::none)
    throw std::invalid_argument(result.error == link::FeedError::not_virtual
                                    ? "the board measures it; only virtual sensors can be fed"
                                    : "the board refused the reading");
}

}  // namespace robosync::tool
