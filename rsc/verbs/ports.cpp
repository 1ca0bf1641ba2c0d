// rsc ports [--format human|json]
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "rsc/console.hpp"
#include "rsc/device/seen_boards.hpp"
#include "rsc/json.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

Json json_of(const SeenPort& seen) {
  Json object{{"port", seen.port.name},
              {"description", seen.port.description},
              {"board", nullptr},
              {"may_be", seen.may_be}};
  if (seen.answer) {
    object["board"] = seen.answer->board;
    object["firmware"] = seen.answer->firmware;
  }
  return object;
}

std::string line_of(const SeenPort& seen) {
  std::string text = fmt::format("{:<20}  {}", seen.port.name, seen.port.description);
  if (seen.answer)
    text += fmt::format("  {}, firmware {}", seen.answer->board, seen.answer->firmware);
  else if (!seen.may_be.empty())
    text += fmt::format("  may be {}, but RoboSync does not answer: rsc flash --board {}",
                        fmt::join(seen.may_be, " or "), seen.may_be.front());
  return text;
}

void ports(Format format) {
  const std::vector<SeenPort> found = look_at_ports(list_serial_ports(), ask_board);
  const std::vector<SeenDrive> drives = look_at_drives();
  if (format == Format::json) {
    auto list = Json::array();
    for (const SeenPort& seen : found)
      list.push_back(json_of(seen));
    for (const SeenDrive& seen : drives)
      list.push_back({{"drive", seen.place.string()}, {"board", seen.board}});
    std::cout << json_text(list) << '\n';
    return;
  }
  for (const SeenPort& seen : found)
    std::cout << line_of(seen) << '\n';
  for (const SeenDrive& seen : drives)
    std::cout << fmt::format("{:<20}  the drive of a {}\n", seen.place.string(), seen.board);
  const bool seen = !drives.empty() || std::ranges::any_of(found, [](const SeenPort& port) {
    return port.answer || !port.may_be.empty();
  });
  if (!seen)
    std::cerr << fmt::format(
        "rsc: no {} found; is the board plugged in? (`scripts/robot` starts an "
        "emulated one)\n",
        found.empty() ? "serial ports" : "board");
}

}  // namespace

void add_ports(Options& options) {
  auto format = std::make_shared<Format>(Format::human);
  add_format_option(options, *format);
  options.runs([format] { ports(*format); });
}

}  // namespace robosync::tool
