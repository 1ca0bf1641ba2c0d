// Read with Jansson. May assume nothing of the text. Promises that a wrong scenario gets one
// message with file and line, and that a right one has its stimuli in order of time.
#include "rsc/trace/scenario.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <jansson.h>

#include "compiler/diagnostics/nearest.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/quantity.hpp"
#include "rsc/trace/channels.hpp"
#include "rsc/trace/json_lines.hpp"

namespace robosync::tool {
namespace {

constexpr std::uint64_t kRampPeriodUs = 50'000;  // for a sensor that says no period of its own
constexpr std::size_t kMaxStimuli = 1'000'000;

struct FreeJson {
  void operator()(json_t* value) const { json_decref(value); }
};

std::uint64_t microseconds(std::string_view text) {
  return static_cast<std::uint64_t>(parse_duration(text).count()) * 1000;
}

class ScenarioReader {
public:
  ScenarioReader(const std::string& file, const vm::Image& image)
      : file_(file), text_(read_text(file)), image_(image) {}

  Scenario read();

private:
  [[noreturn]] void fail(std::size_t line, std::string_view message) const {
    throw Failure(Exit::program, fmt::format("{}:{}: {}", file_, line, message));
  }

  // Line of a key in the element at hand, or else of the element.
  std::size_t line_of_key(std::string_view key) const {
    const std::string_view element(text_.data() + element_.begin, element_.end - element_.begin);
    const std::size_t at = element.find(fmt::format("\"{}\"", key));
    return line_of(text_, element_.begin + (at == std::string_view::npos ? 0 : at));
  }

  // What goes wrong inside `body` is wrong with the value of this key.
  template <typename Body>
  auto at_key(std::string_view key, Body body) const {
    try {
      return body();
    } catch (const std::invalid_argument& error) {
      fail(line_of_key(key), error.what());
    }
  }

  void check_keys(json_t* object, std::initializer_list<const char*> known) const {
    const std::vector<std::string> names(known.begin(), known.end());
    const char* key = nullptr;
    json_t* value = nullptr;
    json_object_foreach(object, key, value) {
      if (std::ranges::find(names, key) != names.end()) continue;
      const auto near = compiler::nearest(key, names);
      fail(line_of_key(key), fmt::format("there is no key `{}` here{}", key,
                                         near ? fmt::format("; did you mean `{}`?", *near) : ""));
    }
  }

  static std::uint64_t time(json_t* value) {
    if (!json_is_string(value)) {
      throw std::invalid_argument("a time is a string with a unit, like \"1.5s\"");
    }
    return microseconds(json_string_value(value));
  }

  // A number is good for channels without a unit; others say theirs, or one of their words.
  vm::Value reading(json_t* value, std::uint8_t channel) const {
    const auto parse = [&](std::string_view text) { return parse_reading(image_, channel, text); };
    if (json_is_string(value)) return parse(json_string_value(value));
    if (json_is_boolean(value) && image_.channels[channel].label_count > 0)
      return parse(json_is_true(value) ? "true" : "false");
    if (json_is_integer(value)) return parse(std::to_string(json_integer_value(value)));
    if (json_is_real(value)) return parse(fmt::format("{:.3f}", json_real_value(value)));
    throw std::invalid_argument(
        "a reading is a number, a string with a unit like \"20cm\", or a word of the channel");
  }

  json_t* need(json_t* object, const char* key) const {
    json_t* const value = json_object_get(object, key);
    if (value == nullptr) {
      fail(line_of(text_, element_.begin), fmt::format("this stimulus has no `{}`", key));
    }
    return value;
  }

  std::string_view need_string(json_t* object, const char* key) const {
    json_t* const value = need(object, key);
    if (!json_is_string(value)) fail(line_of_key(key), fmt::format("`{}` is not a string", key));
    return json_string_value(value);
  }

  std::uint8_t channel_of(json_t* stimulus) const {
    const std::string_view sensor = need_string(stimulus, "sensor");
    const bool named = json_object_get(stimulus, "channel") != nullptr;
    const std::string_view channel = named ? need_string(stimulus, "channel") : "";
    return at_key(named ? "channel" : "sensor",
                  [&] { return find_channel(image_, sensor, channel); });
  }

  void read_stimuli(json_t* stimuli) {
    if (stimuli == nullptr) return;
    if (!json_is_array(stimuli)) fail(line_of_key("stimuli"), "`stimuli` is not an array");
    const std::vector<TextRange> places = array_elements(text_, "stimuli");
    std::size_t index = 0;
    json_t* stimulus = nullptr;
    json_array_foreach(stimuli, index, stimulus) {
      element_ = places.at(index);
      if (!json_is_object(stimulus)) {
        fail(line_of(text_, element_.begin), "a stimulus is an object");
      }
      read_stimulus(stimulus);
    }
  }

  void read_stimulus(json_t* stimulus) {
    if (json_object_get(stimulus, "csv") != nullptr) {
      fail(line_of_key("csv"), "csv recordings are not in this version of rsc yet");
    }
    const bool ramp = json_object_get(stimulus, "ramp") != nullptr;
    if (ramp) {
      check_keys(stimulus, {"from", "to", "sensor", "channel", "ramp"});
      read_ramp(stimulus);
    } else {
      check_keys(stimulus, {"at", "sensor", "channel", "value"});
      const std::uint8_t channel = channel_of(stimulus);
      json_t* const at = need(stimulus, "at");
      json_t* const value = need(stimulus, "value");
      const std::uint64_t at_us = at_key("at", [&] { return time(at); });
      add(at_us, channel, at_key("value", [&] { return reading(value, channel); }));
    }
  }

  void read_ramp(json_t* stimulus) {
    const std::uint8_t channel = channel_of(stimulus);
    json_t* const from_value = need(stimulus, "from");
    json_t* const to_value = need(stimulus, "to");
    json_t* const ramp = need(stimulus, "ramp");
    const std::uint64_t from = at_key("from", [&] { return time(from_value); });
    const std::uint64_t to = at_key("to", [&] { return time(to_value); });
    if (to <= from) fail(line_of_key("to"), "the ramp ends before it starts");
    if (json_array_size(ramp) != 2) {
      fail(line_of_key("ramp"), "`ramp` is [first reading, last reading]");
    }
    const auto end = [&](std::size_t which) {
      return at_key("ramp", [&] { return reading(json_array_get(ramp, which), channel); });
    };
    add_ramp(from, to, channel, end(0), end(1));
  }

  // A reading in each period of the sensor, and the last one.
  void add_ramp(std::uint64_t from, std::uint64_t to, std::uint8_t channel, std::int64_t first,
                std::int64_t last) {
    const std::uint16_t period_ms = image_.sensors[image_.channels[channel].sensor].period_ms;
    const std::uint64_t period = period_ms > 0 ? period_ms * std::uint64_t{1000} : kRampPeriodUs;
    const auto length = static_cast<std::int64_t>(to - from);
    for (std::uint64_t at = from; at < to; at += period) {
      // Milliseconds keep the product of two 32-bit spans inside 64 bits.
      const auto done = static_cast<std::int64_t>(at - from) / 1000;
      add(at, channel, static_cast<vm::Value>(first + (last - first) * done / (length / 1000)));
    }
    add(to, channel, static_cast<vm::Value>(last));
  }

  void add(std::uint64_t at, std::uint8_t channel, vm::Value value) {
    if (scenario_.stimuli.size() == kMaxStimuli) {
      fail(line_of(text_, element_.begin), "the scenario has more than a million readings");
    }
    scenario_.stimuli.push_back({at, channel, value});
  }

  const std::string& file_;
  std::string text_;
  const vm::Image& image_;
  TextRange element_;  // the stimulus at hand
  Scenario scenario_;
};

Scenario ScenarioReader::read() {
  json_error_t error{};
  const std::unique_ptr<json_t, FreeJson> root(
      json_loadb(text_.data(), text_.size(), JSON_REJECT_DUPLICATES, &error));
  if (!root) fail(static_cast<std::size_t>(std::max(error.line, 1)), error.text);
  element_ = {0, text_.size()};
  if (!json_is_object(root.get())) fail(1, "a scenario is an object: {\"stimuli\": […]}");
  check_keys(root.get(), {"duration", "stimuli"});
  if (json_t* const duration = json_object_get(root.get(), "duration")) {
    scenario_.duration_us = at_key("duration", [&] { return time(duration); });
  }
  read_stimuli(json_object_get(root.get(), "stimuli"));
  std::ranges::stable_sort(scenario_.stimuli, {}, &Stimulus::at_us);
  return std::move(scenario_);
}

}  // namespace

Scenario read_scenario(const std::string& file, const vm::Image& image) {
  return ScenarioReader(file, image).read();
}

}  // namespace robosync::tool
