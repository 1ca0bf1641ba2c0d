// Records what a watch sees for the page of `rsc run --html` (timeline/page.hpp).
// Shows the program that ran last.
#pragma once

#include <memory>
#include <string>

#include "rsc/device/viewer.hpp"
#include "rsc/timeline/recorder.hpp"

namespace robosync::tool {

class PageRecorder final : public Viewer {
public:
  void program(const TraceNames& names, std::span<const std::byte> image) override;
  void event(const link::Event& event, const TraceNames& names) override;
  // Throws Failure: outside if the page cannot be written, program if no program
  // ran.
  void write(const std::string& file, const std::string& title);

private:
  std::unique_ptr<Program> program_;  // null: no program is running
  TraceNames names_;
  std::unique_ptr<TimelineRecorder> timeline_;
  std::uint64_t end_us_ = 0;
};

}  // namespace robosync::tool
