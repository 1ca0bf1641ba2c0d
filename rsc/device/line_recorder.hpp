// Records what a watch sees in a file, for rsc replay (trace/replay_file.hpp).
#pragma once

#include <fstream>
#include <string>

#include "rsc/device/viewer.hpp"

namespace robosync::tool {

class LineRecorder final : public Viewer {
public:
  // Throws Failure (outside) if the file cannot be written.
  explicit LineRecorder(const std::string& file);

  void program(const TraceNames& names, std::span<const std::byte> image) override;
  void event(const link::Event& event, const TraceNames& names) override;
  void status(const link::Status& status) override;
  void missed(const std::string& why) override;
  bool work(Session* session) override;  // throws Failure (outside) when the disk is full

private:
  std::string file_;
  std::ofstream stream_;
  bool missed_ = false;  // since the last status of the board
};

}  // namespace robosync::tool
