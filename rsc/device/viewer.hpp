// A receiver of what a watch sees of a board (watch.hpp): it prints it, records it, draws it or passes it on.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "link/events.hpp"
#include "link/messages.hpp"
#include "rsc/device/current.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/device/past.hpp"
#include "rsc/device/session.hpp"
#include "rsc/device/threads.hpp"
#include "rsc/program.hpp"
#include "rsc/trace/trace_format.hpp"

namespace robosync::tool {

class Viewer {
public:
  Viewer() = default;
  virtual ~Viewer() = default;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  // Called first, and after each restart of the board; `silent`: the devices on its buses that do not answer.
  virtual void board(const link::HelloReply& /*board*/, const Past& /*past*/,
                     const std::vector<OnBus>& /*silent*/) {}
  // After that, and whenever events were missed: what holds now.
  virtual void current(const Current& /*current*/, const TraceNames& /*names*/) {}
  // What the numbers in events mean from here on; both stay valid until the next call. `image`: empty if no program runs.
  virtual void program(const TraceNames& /*names*/, std::span<const std::byte> /*image*/) {}
  virtual void event(const link::Event& /*event*/, const TraceNames& /*names*/) {}
  virtual void log(const std::string& /*text*/) {}
  virtual void fault(const link::Fault& /*fault*/) {}
  // Once a second, if the watch asks for them.
  virtual void threads(ThreadList /*now*/, ThreadList /*before*/) {}
  virtual void status(const link::Status& /*status*/) {}  // once a second
  // Why some events are not shown.
  virtual void missed(const std::string& /*why*/) {}

  // The program with this hash, with what its source says of it, if this viewer uploaded it; else null. It stays valid.
  [[nodiscard]] virtual const Program* uploaded(const link::ProgramHash& /*hash*/) const {
    return nullptr;
  }

  // Called often: the viewer talks to the board here, and returns whether to continue. `session`: null while the line is
  // lost or lent. An exception ends the watch.
  virtual bool work(Session* /*session*/) { return true; }
};

}  // namespace robosync::tool
