// rsc monitor --port P [--format human|json] [--duration 5s] [--threads]
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "rsc/console.hpp"
#include "rsc/verb.hpp"
#include "rsc/watch.hpp"

namespace robosync::tool {
namespace {

struct Options {
  std::string port;
  Format format = Format::human;
  std::optional<std::chrono::milliseconds> duration;
  bool threads = false;
};

}  // namespace

void add_monitor(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_port_option(app, options->port);
  add_format_option(app, options->format);
  add_duration_option(app, "--duration", options->duration, "how long; else until Ctrl-C");
  app.add_flag("--threads", options->threads,
               "once a second, every thread's priority and share of the processor, too");
  app.callback([options] {
    Session session(options->port);
    Watch(session, options->format, options->threads).show(options->duration);
  });
}

}  // namespace robosync::tool
