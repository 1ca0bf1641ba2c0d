// rsc monitor --port P [--format human|json] [--duration 5s] [--threads] [--plain] [--record R.jsonl]
//             [--html OUT.html] [--upload FILE [--config FILE]] [--key FILE]
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rsc/console.hpp"
#include "rsc/device/line_recorder.hpp"
#include "rsc/device/printer.hpp"
#include "rsc/device/saved_uploads.hpp"
#include "rsc/device/watch.hpp"
#include "rsc/failure.hpp"
#include "rsc/output.hpp"
#include "rsc/screen/screen.hpp"
#include "rsc/timeline/page_recorder.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct MonitorOptions {
  std::string port, key, record, html, upload;
  CompileOptions how;
  Format format = Format::human;
  std::optional<std::chrono::milliseconds> duration;
  bool threads = false;
  bool plain = false;
};

// The full screen on a terminal, else lines.
std::unique_ptr<Viewer> view_of(const MonitorOptions& options) {
  if (!options.plain && options.format == Format::human)
    if (auto terminal = screen::Terminal::open())
      return std::make_unique<screen::Screen>(std::move(terminal), options.port);
  return std::make_unique<Printer>(options.format);
}

void monitor(const MonitorOptions& options) {
  if (options.upload.empty())
    refuse_alone(given_option(options.how), "--upload FILE, which is compiled for it");
  check_outputs({{options.record, FileKind::replay}, {options.html}},
                {options.upload, options.how.config});
  const Place place{options.port, options.key};
  auto session = open_session(place);
  const std::unique_ptr<Viewer> view = view_of(options);
  const bool is_screen = dynamic_cast<screen::Screen*>(view.get()) != nullptr;
  PageRecorder page;
  std::optional<LineRecorder> recorder;
  std::optional<SavedUploads> uploads;
  std::vector<Viewer*> viewers = {view.get()};
  if (!options.html.empty()) viewers.push_back(&page);
  if (!options.record.empty()) viewers.push_back(&recorder.emplace(options.record));
  if (!options.upload.empty()) viewers.push_back(&uploads.emplace(options.upload, options.how));
  Watch watch(session, place, viewers, options.threads || is_screen);
  watch.introduce();
  watch.show(options.duration);
  if (!options.html.empty()) page.write(options.html, options.port);
}

}  // namespace

void add_monitor(Options& options) {
  auto asked = std::make_shared<MonitorOptions>();
  add_port_option(options, asked->port);
  add_key_option(options, asked->key);
  add_format_option(options, asked->format);
  add_duration_option(options, "--duration", asked->duration, "how long; else until Ctrl-C");
  options.flag("--threads", asked->threads,
               "also show each thread's priority and CPU share, once a second");
  options.flag("--plain", asked->plain, "lines instead of the full screen, also on a terminal");
  options.option("--record", "R.jsonl", asked->record, "record it for rsc replay");
  options.option("--html", "OUT.html", asked->html, "at the end, write a web page that shows it");
  options.option("--upload", "FILE", asked->upload,
                 "upload this program first, and again whenever one of its "
                 "files is saved");
  add_config_option(options, asked->how.config);
  options.runs([asked] {
    asked->how.judged = Judged::by_time;
    monitor(*asked);
  });
}

}  // namespace robosync::tool
