// See page_recorder.hpp.
#include "rsc/timeline/page_recorder.hpp"

#include <algorithm>
#include <iostream>
#include <span>
#include <vector>

#include "rsc/output.hpp"
#include "rsc/timeline/page.hpp"

namespace robosync::tool {

// After another rsc had the line, the same program may still be running; its page then
// continues.
void PageRecorder::program(const TraceNames& names, std::span<const std::byte> image) {
  const bool goes_on = program_ && std::ranges::equal(program_->bytes(), image);
  if (goes_on) return;
  timeline_.reset();
  program_.reset();
  if (names.image == nullptr) return;
  program_ = std::make_unique<Program>(std::vector<std::byte>(image.begin(), image.end()),
                                       "the running program");
}

void PageRecorder::event(const link::Event& event, const TraceNames& names) {
  if (!program_) return;
  if (event.kind == link::EventKind::activated) timeline_.reset();
  names_ = {&program_->image(), names.threads, names.origin};
  if (!timeline_) timeline_ = std::make_unique<TimelineRecorder>(*program_, names_);
  timeline_->see(event);
  end_us_ = event.time_us;
}

void PageRecorder::write(const std::string& file, const std::string& title) {
  if (!timeline_) {
    std::cerr << "note: nothing happened that a page could show; none was written\n";
    return;
  }
  const std::vector<std::string> none;
  const auto& lines = names_.origin == nullptr ? none : names_.origin->lines;
  const std::string page = timeline_page(title, timeline_->finish(end_us_), lines);
  write_output(file, std::as_bytes(std::span(page)));
  timeline_.reset();
}

}  // namespace robosync::tool
