// rsc monitor --port P [--format human|json] [--duration 5s] [--threads]
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "rsc/console.hpp"
#include "rsc/device/watch.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct MonitorOptions {
  std::string port;
  Format format = Format::human;
  std::optional<std::chrono::milliseconds> duration;
  bool threads = false;
};

}  // namespace

void add_monitor(Options& options) {
  auto asked = std::make_shared<MonitorOptions>();
  add_port_option(options, asked->port);
  add_format_option(options, asked->format);
  add_duration_option(options, "--duration", asked->duration, "how long; else until Ctrl-C");
  options.flag("--threads", asked->threads,
               "once a second, every thread's priority and share of the processor, too");
  options.runs([asked] {
    Session session(asked->port);
    Watch watch(session, asked->format, asked->threads);
    watch.introduce();
    watch.show(asked->duration);
  });
}

}  // namespace robosync::tool
