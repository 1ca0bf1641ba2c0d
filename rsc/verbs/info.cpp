// rsc info --port P [--scan] [--format human|json]
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "rsc/console.hpp"
#include "rsc/device/current.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/device/introduction.hpp"
#include "rsc/device/keeping.hpp"
#include "rsc/device/past.hpp"
#include "rsc/device/scan.hpp"
#include "rsc/device/session.hpp"
#include "rsc/device/threads.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

// The running program's memory, part by part, computed from its image as the board does.
using Shares = std::array<std::uint32_t, policy::kWhose>;
std::optional<Shares> shares_of(const link::HelloReply& board, std::span<const std::byte> bytes) {
  vm::Image image;
  const policy::BoardMemory memory{board.arena_begin, board.arena_bytes, board.step_budget};
  if (!vm::verify(bytes, vm::Limits{}, image).ok()) return std::nullopt;
  return policy::shares_of(policy::needs_of(image, memory));
}

Json memory_json(const link::HelloReply& board, std::span<const std::byte> image) {
  Json object{
      {"arena_begin", board.arena_begin}, {"bytes", board.arena_bytes}, {"used", board.arena_used}};
  if (const auto shares = shares_of(board, image))
    for (std::size_t i = 0; i < shares->size(); ++i)
      object["by"][std::string(name_of(static_cast<policy::Whose>(i)))] = (*shares)[i];
  return object;
}

std::string memory_text(const link::HelloReply& board, std::span<const std::byte> image) {
  std::string text =
      fmt::format("memory    {} of {} bytes for programs", board.arena_used, board.arena_bytes);
  const auto shares = shares_of(board, image);
  if (!shares) return text + '\n';
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < shares->size(); ++i)
    parts.push_back(fmt::format("{} {}", name_of(static_cast<policy::Whose>(i)), (*shares)[i]));
  return text + fmt::format(": {}\n", fmt::join(parts, ", "));
}

Json board_json(const link::HelloReply& board, std::span<const std::byte> image) {
  Json object{{"name", text_of(board.board)},
              {"robot", robot_json(board)},
              {"firmware", text_of(board.firmware)},
              {"protocol", board.protocol},
              {"image_format", board.image_major},
              {"opcode_set", board.opcode_set},
              {"memory", memory_json(board, image)},
              {"step_budget", board.step_budget},
              {"drivers", link::drivers_of(board)},
              {"receive_window", board.receive_window},
              {"program", nullptr}};
  if (board.running != 0) {
    object["program"] = {{"hash", text_of(board.program_hash)}, {"bytes", board.image_bytes}};
  }
  return object;
}

Json status_json(const Past& past) {
  const link::Status& status = past.status;
  return {{"uptime_us", status.uptime_us},
          {"program_us", status.program_us},
          {"steps", status.steps},
          {"safety_checks", status.safety_checks},
          {"safety_late_us", status.safety_late_us},
          {"bad_frames", status.bad_frames},
          {"lost_events", status.lost_events},
          {"activations", status.activations},
          {"faults", status.faults},
          {"reset_reason", reset_reason(status)},
          {"last_fault", last_fault_json(past)}};
}

// The board's buses: `said` is the board's report about the program `image`; null: none.
struct Buses {
  Buses(const vm::Image* image, const link::Devices& said) : clears(said.bus_clears) {
    if (image != nullptr) devices = on_buses(*image, said);
  }
  std::vector<OnBus> devices;
  unsigned clears;
  std::optional<Scan> scan;
};

// What keeps the running program in `bytes` from its actuators.
struct Now {
  Now(Client& client, std::span<const std::byte> bytes) {
    const bool good = vm::verify(bytes, vm::Limits{}, image).ok();
    names.image = good ? &image : nullptr;
    current = current_of(client, names.image);
  }
  vm::Image image;
  TraceNames names;
  Current current;
};

std::string now_text(const Now& now) {
  std::string text;
  for (const Held& held : held_back(now.current, now.names))
    text += fmt::format("{:<9} {}\n", held.what, held.text);
  return text;
}

std::string buses_text(const Buses& buses) {
  std::string scan = buses.scan ? scan_text(*buses.scan) : std::string();
  if (buses.devices.empty() && buses.clears == 0) return scan;
  unsigned failed = 0;
  for (const OnBus& device : buses.devices)
    failed += device.failed;
  std::string text = fmt::format("buses     {} sensors, {} failed transfers, {} bus clears\n",
                                 buses.devices.size(), failed, buses.clears);
  for (const OnBus& device : buses.devices)
    text += device.silent ? "silent    " + silent_text(device) + '\n'
                          : "found     " + found_text(device) + '\n';
  return text + scan;
}

void print_board_json(const link::HelloReply& board, std::span<const std::byte> image,
                      const Past& past, const Now& now, const Buses& buses, const link::Kept& kept,
                      const link::Authority& owner, const std::vector<link::ThreadInfo>& threads) {
  Json report{{"board", board_json(board, image)}, {"status", status_json(past)}};
  report["state"] = current_json(now.current, now.names);
  report["owner"] = owner_json(owner);
  report["kept"] = keeping_json(kept);
  report["buses"] = {{"clears", buses.clears}, {"devices", devices_json(buses.devices)}};
  if (buses.scan) report["buses"]["scan"] = scan_json(*buses.scan);
  report["threads"] = threads_json(threads, {});
  std::cout << json_text(report) << '\n';
}

void print_human(const link::HelloReply& board, std::span<const std::byte> image, const Past& past,
                 const Now& now, const Buses& buses, const link::Kept& kept,
                 const link::Authority& owner, const std::vector<link::ThreadInfo>& threads) {
  const link::Status& status = past.status;
  std::cout << fmt::format("board     {}, firmware {}, protocol {}\n", text_of(board.board),
                           text_of(board.firmware), board.protocol);
  const std::string robot = text_of(board.robot);
  if (!robot.empty()) std::cout << fmt::format("robot     {}\n", robot);
  std::cout << fmt::format("owner     {}\n", owner_text(owner));
  std::cout << memory_text(board, image);
  std::cout << fmt::format("takes     steps up to {} instructions\n", board.step_budget);
  if (board.running != 0) {
    std::cout << fmt::format("program   {} ({} bytes), for {:.3f} s, {} steps\n",
                             text_of(board.program_hash), board.image_bytes,
                             static_cast<double>(status.program_us) / 1e6, status.steps);
  } else {
    std::cout << "program   none\n";
  }
  std::cout << "reset     " << keeping_text(kept) << '\n';
  if (kept.given_up_hash != link::ProgramHash{})
    std::cout << fmt::format(
        "given up  program {}: in its trial one of its threads faulted, or a SAFETY rule tripped\n",
        text_of(kept.given_up_hash));
  if (kept.state != link::Keeping::no_store)
    std::cout << "rollback  " << rollback_text(kept) << '\n';
  std::cout << now_text(now);
  std::cout << "up        " << past_text(status) << '\n';
  if (past.has_fault()) std::cout << "fault     " << fault_text(past.fault) << '\n';
  std::cout << fmt::format("safety    {} checks, latest by {} us\n", status.safety_checks,
                           status.safety_late_us);
  std::cout << buses_text(buses);
  std::cout << fmt::format("line      {} bad frames, {} lost events\n\n", status.bad_frames,
                           status.lost_events);
  std::cout << threads_table(threads, {});
}

void info(const std::string& port, bool scans, Format format) {
  Session session(port);
  const Past past(session.client);
  const std::vector<link::ThreadInfo> threads = session.client.threads();
  const std::vector<std::byte> image = session.client.running_image();
  const Now now(session.client, image);
  Buses buses(now.names.image, session.client.devices());
  if (scans) buses.scan = scan_buses(session.client, text_of(session.board.board), buses.devices);
  const link::Kept kept = session.client.kept();
  const link::Authority owner = session.client.authority();
  format == Format::json
      ? print_board_json(session.board, image, past, now, buses, kept, owner, threads)
      : print_human(session.board, image, past, now, buses, kept, owner, threads);
}

}  // namespace

void add_info(Options& options) {
  struct InfoOptions {
    std::string port;
    bool scan = false;
    Format format = Format::human;
  };
  auto asked = std::make_shared<InfoOptions>();
  add_port_option(options, asked->port);
  options.flag("--scan", asked->scan,
               "also ask each address of each I2C bus whether anything answers");
  add_format_option(options, asked->format);
  options.runs([asked] { info(asked->port, asked->scan, asked->format); });
}

}  // namespace robosync::tool
