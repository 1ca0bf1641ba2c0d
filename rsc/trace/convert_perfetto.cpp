// See convert.hpp. Each group of lanes is a "process" and each lane a "thread", so that Perfetto draws them below each
// other.
#include <cstddef>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "rsc/json.hpp"
#include "rsc/trace/convert.hpp"
#include "rsc/trace/lanes.hpp"

namespace robosync::tool {
namespace {

class Events {
public:
  Events() {
    for (std::size_t i = 0; i < kLaneGroups; ++i) {
      const auto group = static_cast<LaneGroup>(i);
      about(group, 0, "process_name", {{"name", name_of(group)}});
      about(group, 0, "process_sort_index", {{"sort_index", i}});
    }
  }

  void add(const Lane& lane) {
    const std::size_t thread = new_thread(lane.group, lane.name);
    for (const Span& span : lane.spans)
      add({{"ph", "X"}, {"ts", span.from_us}, {"dur", span.to_us - span.from_us}}, lane.group,
          thread, span.text);
    for (const Moment& moment : lane.moments)
      add({{"ph", "i"}, {"s", "t"}, {"ts", moment.at_us}}, lane.group, thread, moment.text);
  }

  // A counter; if values are words, a lane. A counter cannot show unknown values.
  void add(const Curve& curve, std::uint64_t end_us) {
    const std::string name =
        curve.unit.empty() ? curve.name : fmt::format("{} ({})", curve.name, curve.unit);
    const std::size_t thread = curve.has_words ? new_thread(curve.group, name) : 0;
    for (std::size_t i = 0; i < curve.samples.size(); ++i) {
      const Sample& sample = curve.samples[i];
      const std::uint64_t until_us =
          i + 1 < curve.samples.size() ? curve.samples[i + 1].at_us : end_us;
      if (curve.has_words) {
        const std::string text = sample.number ? fmt::format("{}", *sample.number) : sample.word;
        if (!text.empty())
          add({{"ph", "X"}, {"ts", sample.at_us}, {"dur", until_us - sample.at_us}}, curve.group,
              thread, text);
      } else if (sample.number) {
        add({{"ph", "C"}, {"ts", sample.at_us}, {"args", {{"value", *sample.number}}}}, curve.group,
            0, name);
      }
    }
  }

  [[nodiscard]] std::string text() && {
    const Json whole{{"traceEvents", std::move(events_)}, {"displayTimeUnit", "ms"}};
    return json_text(whole) + "\n";
  }

private:
  void add(Json event, LaneGroup group, std::size_t thread, const std::string& name) {
    event["pid"] = static_cast<std::size_t>(group) + 1;  // Perfetto hides process 0
    event["tid"] = thread;
    event["name"] = name;
    events_.push_back(std::move(event));
  }

  void about(LaneGroup group, std::size_t thread, const char* what, const Json& args) {
    add({{"ph", "M"}, {"args", args}}, group, thread, what);
  }

  std::size_t new_thread(LaneGroup group, const std::string& name) {
    ++threads_;
    about(group, threads_, "thread_name", {{"name", name}});
    about(group, threads_, "thread_sort_index", {{"sort_index", threads_}});
    return threads_;
  }

  Json events_ = Json::array();
  std::size_t threads_ = 0;
};

}  // namespace

std::string perfetto_of(const std::string& file) {
  Lanes lanes;
  read_trace(file, [&](const TraceLine& line) { lanes.see(line); });
  lanes.finish();
  Events events;
  for (const Lane& lane : lanes.lanes())
    events.add(lane);
  for (const Curve& curve : lanes.curves())
    events.add(curve, lanes.end_us());
  return std::move(events).text();
}

}  // namespace robosync::tool
