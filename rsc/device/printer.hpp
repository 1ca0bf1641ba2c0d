// Prints what a watch sees, line by line on stdout, for people or as JSON. Losses go to stderr.
#pragma once

#include "rsc/console.hpp"
#include "rsc/device/viewer.hpp"

namespace robosync::tool {

class Printer final : public Viewer {
public:
  explicit Printer(Format format) : format_(format) {}

  void board(const link::HelloReply& board, const Past& past,
             const std::vector<OnBus>& silent) override;
  void current(const Current& current, const TraceNames& names) override;
  void event(const link::Event& event, const TraceNames& names) override;
  void log(const std::string& text) override;
  void fault(const link::Fault& fault) override;
  void threads(ThreadList now, ThreadList before) override;
  void missed(const std::string& why) override;
  bool work(Session* session) override;  // throws Failure (outside) if stdout cannot be written

private:
  Format format_;
};

}  // namespace robosync::tool
