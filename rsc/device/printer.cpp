// See printer.hpp. Promises that each line is flushed immediately.
#include "rsc/device/printer.hpp"

#include <iostream>

#include <fmt/format.h>

#include "rsc/device/introduction.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {
namespace {

void print(const Json& line) {
  std::cout << json_text(line) << std::endl;
}

}  // namespace

void Printer::board(const link::HelloReply& board, const Past& past,
                    const std::vector<OnBus>& silent) {
  if (format_ == Format::json) {
    Json line{{"event", "board"}};
    line.update(introduction_json(board, past, silent));
    return print(line);
  }
  std::cout << fmt::format("        board  {}, up {}{}\n", text_of(board.board),
                           past_text(past.status),
                           past.has_fault() ? "; last fault: " + fault_text(past.fault) : "");
  const std::string robot = text_of(board.robot);
  if (!robot.empty()) std::cout << "        robot  " << robot << '\n';
  std::cout << "        owner  " << owner_text(past.owner) << '\n';
  for (const OnBus& device : silent)
    std::cout << "       silent  " << silent_text(device) << '\n';
  std::cout.flush();
}

void Printer::current(const Current& current, const TraceNames& names) {
  const std::vector<Held> held = held_back(current, names);
  if (held.empty()) return;
  if (format_ == Format::json) {
    Json line{{"event", "state"}};
    line.update(current_json(current, names));
    return print(line);
  }
  for (const Held& one : held)
    std::cout << fmt::format("{:>13}  {}\n", one.what, one.text);
  std::cout.flush();
}

void Printer::event(const link::Event& event, const TraceNames& names) {
  std::cout << (format_ == Format::json ? trace_json(event, names) : trace_line(event, names))
            << std::endl;
}

void Printer::log(const std::string& text) {
  if (format_ == Format::json)
    print({{"event", "log"}, {"text", text}});
  else
    std::cout << "          log  " << text << std::endl;
}

void Printer::fault(const link::Fault& fault) {
  if (format_ == Format::human) {
    std::cout << "        fault  " << fault_text(fault) << std::endl;
    return;
  }
  Json line{{"event", "fault"}};
  line.update(fault_json(fault));
  print(line);
}

void Printer::threads(ThreadList now, ThreadList before) {
  if (format_ == Format::json)
    print({{"event", "threads"}, {"threads", threads_json(now, before)}});
  else
    std::cout << '\n' << threads_table(now, before) << std::endl;
}

void Printer::missed(const std::string& why) {
  std::cerr << "rsc: " << why << '\n';
}

bool Printer::work(Session*) {
  if (!std::cout) throw Failure(Exit::outside, "could not write to stdout");
  return true;
}

}  // namespace robosync::tool
