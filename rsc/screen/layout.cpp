// See layout.hpp.
#include "rsc/screen/layout.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>

#include "rsc/trace/time_units.hpp"

namespace robosync::tool::screen {
namespace {

constexpr std::array<std::string_view, 8> kBlocks = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr std::array<std::string_view, 8> kMarks = {"_", ".", ":", "-", "=", "+", "*", "#"};
constexpr std::uint64_t kSparkUs = 30'000'000;
constexpr std::string_view kKeys =
    "q quit  space pause  / filter  f force a "
    "sensor  s stop  r resume  b rollback";
constexpr std::size_t kLeastLog = 4;

struct Section {
  std::string heading;
  std::vector<Line> lines;
};

// The length in bytes of the first character if it is printable; else 0.
std::size_t printable(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC2 ? 2 : 0;
  if (length == 0 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
  const bool is_control = first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0;
  return is_control ? 0 : length;
}

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

// Padded to the width of a table column.
std::string cell(std::string_view text, std::size_t columns) {
  std::string cut = fitted(text, columns);
  cut.append(columns - std::min(columns, width_of(cut)), ' ');
  return cut + " ";
}

bool has(std::string_view text, std::string_view part) {
  const auto same = [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  };
  if (part.empty()) return true;
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

Section sensors(const Model& model, const View& view, std::size_t columns) {
  Section section{"SENSORS", {}};
  for (const SensorRow& row : model.sensors()) {
    if (!has(row.name, view.filter)) continue;
    const std::size_t spark = columns > 70 ? std::min<std::size_t>(columns - 60, 60) : 10;
    section.lines.push_back(
        {{cell(row.name, 24)},
         {cell(row.value, 12), row.value == "unknown" ? Style::quiet : Style::plain},
         {cell(row.band, 12), Style::good},
         {sparkline(row, model.now_us(), kSparkUs, spark, view.blocks), Style::quiet}});
  }
  return section;
}

Section behaviors(const Model& model, const View& view) {
  Section section{"BEHAVIOURS", {}};
  for (const BehaviorRow& row : model.behaviors()) {
    if (!has(row.name, view.filter)) continue;
    const std::string raised = row.priority == row.written
                                   ? ""
                                   : fmt::format("{:+}", std::int64_t{row.priority} - row.written);
    section.lines.push_back({{cell(row.name, 24)},
                             {cell(fmt::format("{}{}", row.written, raised), 12),
                              raised.empty() ? Style::plain : Style::good},
                             {cell(row.state, 12), Style::good},
                             {row.denied.empty() ? "" : "denied " + row.denied, Style::quiet}});
  }
  return section;
}

Section actuators(const Model& model, const View& view) {
  Section section{"ACTUATORS", {}};
  for (const ActuatorRow& row : model.actuators()) {
    if (!has(row.name, view.filter)) continue;
    section.lines.push_back(
        {{cell(row.name, 24)},
         {cell(row.owner, 24), Style::good},
         {row.halted ? "HALTED " : "", Style::bad},
         {row.command},
         {row.denied.empty() ? "" : "  denied to " + row.denied, Style::quiet}});
  }
  return section;
}

Section variables(const Model& model, const View& view) {
  Section section{"VARIABLES", {}};
  for (const auto& [name, value] : model.variables())
    if (has(name, view.filter)) section.lines.push_back({{cell(name, 24)}, {value}});
  return section;
}

// Always shown, even if nothing is wrong.
Section safety(const Model& model) {
  Section section{"SAFETY", {}};
  if (model.is_stopped())
    section.lines.push_back(
        {{"stopped by a person: all outputs are in their safe state", Style::bad}});
  for (const std::string& trip : model.trips())
    section.lines.push_back({{trip + " is tripped", Style::bad}});
  if (section.lines.empty()) section.lines.push_back({{"nothing is tripped", Style::quiet}});
  for (const std::string& alert : model.alerts())
    section.lines.push_back({{alert, Style::bad}});
  return section;
}

// Unusual states come first: the rest may be cut off.
Line title(const Model& model, const View& view) {
  Line line;
  if (view.lost) line.push_back({"LINE LOST ", Style::bad});
  if (model.is_stopped()) line.push_back({"STOPPED ", Style::bad});
  if (view.paused) line.push_back({"PAUSED ", Style::bad});
  if (!view.filter.empty()) line.push_back({"filter: " + view.filter + "  ", Style::good});
  line.push_back({fmt::format("{}  {}  up {}  program {} since {}", model.board_name(), view.port,
                              seconds_text(model.uptime_us()), model.program_name(),
                              seconds_text(model.now_us())),
                  Style::heading});
  return line;
}

Line sums(const Model& model) {
  const ThreadSums& sums = model.sums();
  const std::string load = sums.load ? fmt::format("{:.1f} %", *sums.load) : "?";
  const bool bad = sums.missed > 0 || model.faults() > 0 || model.lost_events() > 0;
  return {{fmt::format("load {}  missed {}  faults {}  events lost {}", load, sums.missed,
                       model.faults(), model.lost_events()),
           bad ? Style::bad : Style::quiet}};
}

// Removes lines from the longest section until all fit, of equal ones from the lower one, and shows how many
// are left out.
void shorten(std::vector<Section>& sections, std::size_t room) {
  std::erase_if(sections, [](const Section& section) { return section.lines.empty(); });
  std::size_t all = sections.size();  // their headings
  std::vector<std::size_t> left;
  for (const Section& section : sections) {
    left.push_back(section.lines.size());
    all += section.lines.size();
  }
  for (; all > room; --all) {
    const auto longest = std::max_element(left.rbegin(), left.rend());
    if (*longest == 0) break;
    --*longest;
  }
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::size_t out = sections[i].lines.size() - left[i];
    sections[i].lines.resize(left[i]);
    if (out > 0) sections[i].heading += fmt::format(" (and {} more)", out);
  }
}

// The newest lines that fit, oldest first.
std::vector<Line> newest(const Model& model, const View& view, std::size_t room) {
  std::vector<Line> lines;
  for (auto line = model.log().rbegin(); line != model.log().rend() && lines.size() < room; ++line)
    if (has(*line, view.filter)) lines.push_back({{*line}});
  std::ranges::reverse(lines);
  return lines;
}

void cut(Line& line, std::size_t columns) {
  for (Piece& piece : line) {
    piece.text = fitted(piece.text, columns);
    columns -= std::min(columns, width_of(piece.text));
  }
}

}  // namespace

std::string fitted(std::string_view text, std::size_t columns) {
  std::string result;
  for (std::size_t used = 0; used < columns && !text.empty(); ++used) {
    const std::size_t length = printable(text);
    result += length == 0 ? std::string_view("?") : text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::string sparkline(const SensorRow& sensor, std::uint64_t now_us, std::uint64_t span_us,
                      std::size_t columns, bool blocks) {
  std::optional<vm::Value> least, most;
  for (const auto& [at, value] : sensor.history) {
    if (!value) continue;
    least = std::min(least.value_or(*value), *value);
    most = std::max(most.value_or(*value), *value);
  }
  const std::int64_t range = least ? std::max<std::int64_t>(std::int64_t{*most} - *least, 1) : 1;
  const auto& levels = blocks ? kBlocks : kMarks;
  std::string line;
  for (std::size_t i = 0; i < columns; ++i) {
    // The value at the end of the column's time span.
    const std::uint64_t ago_us = span_us * (columns - 1 - i) / columns;
    std::optional<vm::Value> then;
    for (const auto& [at, value] : sensor.history)
      if (at + ago_us <= now_us) then = value;
    if (!then || now_us < ago_us) {
      line += ' ';
      continue;
    }
    const std::int64_t level = (std::int64_t{*then} - *least) * 7 / range;
    line += levels.at(static_cast<std::size_t>(level));
  }
  return line;
}

std::vector<Line> lay_out(const Model& model, const View& view, std::size_t rows,
                          std::size_t columns) {
  std::vector<Section> sections = {sensors(model, view, columns), behaviors(model, view),
                                   actuators(model, view), variables(model, view), safety(model)};
  constexpr std::size_t kAround = 4;  // title, sums, heading of the log, keys
  shorten(sections, rows > kAround + kLeastLog ? rows - kAround - kLeastLog : 0);
  std::vector<Line> lines = {title(model, view), sums(model)};
  for (Section& section : sections) {
    lines.push_back({{section.heading, Style::heading}});
    std::ranges::move(section.lines, std::back_inserter(lines));
  }
  lines.push_back({{"LOG", Style::heading}});
  const std::size_t room = rows > lines.size() + 1 ? rows - lines.size() - 1 : 0;
  std::ranges::move(newest(model, view, room), std::back_inserter(lines));
  lines.resize(rows);
  if (rows > 0)
    lines.back() = {{view.prompt.empty() ? std::string(kKeys) : view.prompt, Style::heading}};
  for (Line& line : lines)
    cut(line, columns);
  return lines;
}

}  // namespace robosync::tool::screen
