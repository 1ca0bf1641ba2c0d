// See convert.hpp. Lanes are variables with the text of the present span, empty in between; curves hold numbers or words; denials
// and messages are events.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "rsc/escaped.hpp"
#include "rsc/trace/convert.hpp"
#include "rsc/trace/lanes.hpp"

namespace robosync::tool {
namespace {

// A name without the characters that VCD names must not have: spaces, brackets, dots.
std::string identifier(std::string_view name) {
  std::string safe(name);
  std::ranges::replace_if(
      safe, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return safe;
}

// Printable characters, counting: "!", "\"", …, "~", "!\"", …
std::string code_of(std::size_t number) {
  constexpr std::size_t kFirst = '!', kCount = '~' - '!' + 1;
  std::string code;
  for (std::size_t left = number + 1; left > 0; left = (left - 1) / kCount)
    code += static_cast<char>(kFirst + (left - 1) % kCount);
  return code;
}

// GTKWave ends a word at a space.
std::string word(std::string_view text) {
  std::string safe =
      escaped(text, {{' ', "\\x20"}, {'\t', "\\t"}, {'\n', "\\n"}, {'\r', "\\r"}, {'\\', "\\\\"}});
  return "s" + safe;
}

class Dump {
public:
  void add(const Lane& lane) {
    if (!lane.spans.empty()) {
      const std::string code = declare(lane.group, "string 1", lane.name);
      begins_ += fmt::format("s {}\n", code);
      for (const Span& span : lane.spans) {
        change(span.from_us, word(span.text) + " " + code);
        change(span.to_us, "s " + code);
      }
    }
    if (lane.moments.empty()) return;
    const bool is_message = lane.group == LaneGroup::robot;
    const std::string code =
        declare(lane.group, "event 1", is_message ? lane.name : lane.name + " denied");
    for (const Moment& moment : lane.moments)
      change(moment.at_us, "1" + code);
  }

  void add(const Curve& curve) {
    const std::string name = curve.unit.empty() ? curve.name : curve.name + " " + curve.unit;
    const std::string code = declare(curve.group, curve.has_words ? "string 1" : "real 64", name);
    begins_ += fmt::format("{} {}\n", curve.has_words ? "s" : "rnan", code);
    for (const Sample& sample : curve.samples) {
      const std::string number = sample.number ? fmt::format("{}", *sample.number) : "";
      const std::string value = curve.has_words ? word(sample.number ? number : sample.word)
                                                : "r" + (sample.number ? number : "nan");
      change(sample.at_us, fmt::format("{} {}", value, code));
    }
  }

  [[nodiscard]] std::string text(std::uint64_t end_us) const {
    std::string all = "$version rsc trace convert $end\n$timescale 1us $end\n";
    for (const auto& [group, variables] : declared_)
      all += fmt::format("$scope module {} $end\n{}$upscope $end\n", name_of(group), variables);
    all += "$enddefinitions $end\n$dumpvars\n" + begins_ + "$end\n";
    for (const auto& [at, lines] : changes_)
      all += fmt::format("#{}\n{}", at, lines);
    if (changes_.empty() || changes_.rbegin()->first < end_us) all += fmt::format("#{}\n", end_us);
    return all;
  }

private:
  // Two names may have become equal.
  std::string declare(LaneGroup group, const char* type, const std::string& name) {
    std::string unique = identifier(name);
    for (int i = 2; !names_.emplace(group, unique).second; ++i)
      unique = fmt::format("{}_{}", identifier(name), i);
    std::string code = code_of(count_++);
    declared_[group] += fmt::format("$var {} {} {} $end\n", type, code, unique);
    return code;
  }

  void change(std::uint64_t at_us, const std::string& line) {
    changes_[at_us].append(line).append("\n");
  }

  std::map<LaneGroup, std::string> declared_;
  std::set<std::pair<LaneGroup, std::string>> names_;
  std::size_t count_ = 0;
  std::string begins_;                            // the initial values
  std::map<std::uint64_t, std::string> changes_;  // by time
};

}  // namespace

std::string vcd_of(const std::string& file) {
  Lanes lanes;
  read_trace(file, [&](const TraceLine& line) { lanes.see(line); });
  lanes.finish();
  Dump dump;
  for (const Lane& lane : lanes.lanes())
    dump.add(lane);
  for (const Curve& curve : lanes.curves())
    dump.add(curve);
  return dump.text(lanes.end_us());
}

}  // namespace robosync::tool
