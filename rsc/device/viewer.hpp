// Who is told what a watch sees of a board (watch.hpp): somebody who prints it,
// records it, draws it, passes it on.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "link/events.hpp"
#include "link/messages.hpp"
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

  // First of all, and when the board has started again; `silent`: the devices
  // on its buses that do not answer.
  virtual void board(const link::HelloReply& /*board*/, const Past& /*past*/,
                     const std::vector<OnBus>& /*silent*/) {}
  // What the numbers of events mean from here on; both stay until the next
  // call. `image`: empty when no program runs.
  virtual void program(const TraceNames& /*names*/, std::span<const std::byte> /*image*/) {}
  virtual void event(const link::Event& /*event*/, const TraceNames& /*names*/) {}
  virtual void log(const std::string& /*text*/) {}
  virtual void fault(const link::Fault& /*fault*/) {}
  // Once a second, if the watch asks for them.
  virtual void threads(ThreadList /*now*/, ThreadList /*before*/) {}
  virtual void status(const link::Status& /*status*/) {}  // once a second
  // Why something that has happened is not shown.
  virtual void missed(const std::string& /*why*/) {}

  // A program that it has uploaded, with what its source says of it; null when it has not. `hash`: which one is asked for.
  // It stays.
  [[nodiscard]] virtual const Program* uploaded(const link::ProgramHash& /*hash*/) const {
    return nullptr;
  }

  // Often. What the viewer wants of the board, and whether it wants to go on;
  // `session`: null while the line is lost or lent. What it throws ends the
  // watch.
  virtual bool work(Session* /*session*/) { return true; }
};

}  // namespace robosync::tool
