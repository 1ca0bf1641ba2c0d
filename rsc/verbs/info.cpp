// rsc info --port P [--format human|json]
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "rsc/console.hpp"
#include "rsc/session.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

using Json = nlohmann::ordered_json;

// The numbers of link::ThreadInfo and link::Status; kernel::Category has the same order.
constexpr std::array<std::string_view, 6> kCategories = {"system",   "sensor",  "processing",
                                                         "behavior", "control", "safety"};
constexpr std::array<std::string_view, 4> kStates = {"blocked", "ready", "stopped", "absent"};
constexpr std::array<std::string_view, 3> kResetReasons = {"power", "watchdog", "software"};

template <std::size_t N>
std::string_view word(const std::array<std::string_view, N>& words, std::size_t number) {
  return number < N ? words[number] : "?";
}

std::string hash(const link::HelloReply& board) {
  return fmt::format("{:02x}", fmt::join(board.program_hash, ""));
}

Json board_json(const link::HelloReply& board) {
  Json object{{"name", text_of(board.board)},
              {"firmware", text_of(board.firmware)},
              {"protocol", board.protocol},
              {"image_format", board.image_major},
              {"opcode_set", board.opcode_set},
              {"slot_bytes", board.slot_bytes},
              {"step_budget", board.step_budget},
              {"drivers", board.drivers},
              {"receive_window", board.receive_window},
              {"program", nullptr}};
  if (board.running != 0) {
    object["program"] = {
        {"hash", hash(board)}, {"crc32", board.image_crc}, {"bytes", board.image_bytes}};
  }
  return object;
}

Json status_json(const link::Status& status) {
  return {{"uptime_us", status.uptime_us},
          {"program_us", status.program_us},
          {"steps", status.steps},
          {"safety_checks", status.safety_checks},
          {"safety_late_us", status.safety_late_us},
          {"bad_frames", status.bad_frames},
          {"lost_events", status.lost_events},
          {"activations", status.activations},
          {"faults", status.faults},
          {"reset_reason", word(kResetReasons, status.reset_reason)}};
}

Json thread_json(const link::ThreadInfo& thread) {
  return {{"name", text_of(thread.name)},
          {"category", word(kCategories, thread.category)},
          {"rank", thread.rank},
          {"priority", thread.priority},
          {"state", word(kStates, thread.state)},
          {"stack_bytes", thread.stack_bytes},
          {"stack_used", thread.stack_used},
          {"activations", thread.activations}};
}

void print_json(const link::HelloReply& board, const link::Status& status,
                const std::vector<link::ThreadInfo>& threads) {
  Json report{{"board", board_json(board)}, {"status", status_json(status)}};
  report["threads"] = Json::array();
  for (const link::ThreadInfo& thread : threads)
    report["threads"].push_back(thread_json(thread));
  std::cout << report.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

void print_human(const link::HelloReply& board, const link::Status& status,
                 const std::vector<link::ThreadInfo>& threads) {
  std::cout << fmt::format("board     {}, firmware {}, protocol {}\n", text_of(board.board),
                           text_of(board.firmware), board.protocol);
  std::cout << fmt::format("takes     images up to {} bytes, steps up to {} instructions\n",
                           board.slot_bytes, board.step_budget);
  if (board.running != 0) {
    std::cout << fmt::format("program   {} ({} bytes), for {:.3f} s, {} steps\n", hash(board),
                             board.image_bytes, static_cast<double>(status.program_us) / 1e6,
                             status.steps);
  } else {
    std::cout << "program   none\n";
  }
  std::cout << fmt::format("up        {:.3f} s (reset: {}), {} activations, {} faults\n",
                           static_cast<double>(status.uptime_us) / 1e6,
                           word(kResetReasons, status.reset_reason), status.activations,
                           status.faults);
  std::cout << fmt::format("safety    {} checks, latest by {} us\n", status.safety_checks,
                           status.safety_late_us);
  std::cout << fmt::format("line      {} bad frames, {} lost events\n\n", status.bad_frames,
                           status.lost_events);
  std::cout
      << "rank  thread            category    priority  state    stack used/bytes     woken\n";
  for (const link::ThreadInfo& thread : threads) {
    std::cout << fmt::format("{:>4}  {:<16}  {:<10}  {:>8}  {:<8} {:>10}/{:<6}  {:>9}\n",
                             thread.rank, text_of(thread.name), word(kCategories, thread.category),
                             thread.priority, word(kStates, thread.state), thread.stack_used,
                             thread.stack_bytes, thread.activations);
  }
}

void info(const std::string& port, Format format) {
  Session session(port);
  const link::Status status = session.client.status();
  const std::vector<link::ThreadInfo> threads = session.client.threads();
  format == Format::json ? print_json(session.board, status, threads)
                         : print_human(session.board, status, threads);
}

}  // namespace

void add_info(CLI::App& app) {
  struct Options {
    std::string port;
    Format format = Format::human;
  };
  auto options = std::make_shared<Options>();
  add_port_option(app, options->port);
  add_format_option(app, options->format);
  app.callback([options] { info(options->port, options->format); });
}

}  // namespace robosync::tool
