// See topics.hpp.
#include "rsc/bridge/topics.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "rsc/json.hpp"

namespace robosync::tool {
namespace {

constexpr std::string_view kFeed = "feed/";

std::string part_of(const Json& event, const char* key) {
  const auto found = event.find(key);
  if (found == event.end()) return "?";
  return topic_part(found->is_string() ? found->get<std::string>() : found->dump());
}

std::string rule_of(const Json& event) {
  return event.contains("line") ? "line " + part_of(event, "line")
                                : "rule " + part_of(event, "rule");
}

}  // namespace

std::string topic_part(const std::string& name) {
  std::string part = name.empty() ? "?" : name;
  std::ranges::replace_if(
      part,
      [](unsigned char c) { return c < 0x20 || c == 0x7F || c == '/' || c == '+' || c == '#'; },
      '_');
  return part;
}

Topic topic_of(const Json& event) {
  const std::string kind = event.value("event", "?");
  const auto is = [&](std::initializer_list<std::string_view> kinds) {
    return std::ranges::find(kinds, kind) != kinds.end();
  };
  if (kind == "activated") return {"program"};
  if (is({"input", "stale"}))
    return {"sensors/" + part_of(event, "sensor") + "/" + part_of(event, "channel")};
  if (kind == "set") return {"variables/" + part_of(event, "variable")};
  if (is({"command", "done", "cancel", "halt", "release", "overrun", "blocked"}))
    return {"actuators/" + part_of(event, "actuator")};
  if (is({"trip", "resume"})) return {"safety/" + rule_of(event)};
  if (kind == "priority") return {"priorities/" + part_of(event, "behavior")};
  if (kind == "alert") return {"alerts"};
  if (kind == "log") return {"log", false};
  if (event.contains("rule"))
    return {"behaviors/" +
            (event.contains("behavior") ? part_of(event, "behavior") : rule_of(event))};
  return {"faults", false};
}

std::optional<std::string> reading_of(const std::string& topic, const std::string& payload) {
  if (!topic.starts_with(kFeed)) return std::nullopt;
  std::string channel = topic.substr(kFeed.size());
  std::ranges::replace(channel, '/', '.');
  const Json value = read_json(payload);
  std::string text = payload;  // 20cm
  if (value.is_string()) text = value.get<std::string>();
  if (value.is_object() && value.contains("value"))
    text =
        value["value"].is_string() ? value["value"].get<std::string>() : json_text(value["value"]);
  return channel + "=" + text;
}

}  // namespace robosync::tool
