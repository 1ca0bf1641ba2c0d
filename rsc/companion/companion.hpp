// Runs the programs of the algorithms that robot.json puts on a companion computer, and feeds their readings to the robot. It
// is a viewer of a watch (device/viewer.hpp), which owns the line.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "compiler/config/robot.hpp"
#include "rsc/companion/outlet.hpp"
#include "rsc/companion/worker.hpp"
#include "rsc/device/viewer.hpp"

namespace robosync::tool {

struct CompanionSources {
  std::string camera, microphone;  // a device or a file; empty: the default
  std::string preview;             // a PNG of the camera's picture; empty: none
  std::string programs;            // the folder of the modules' programs; empty: search
};

// The path of a module's program: in `folder`, next to rsc, in the companion's build or on the PATH. Empty: not found.
[[nodiscard]] std::string find_companion_program(const std::string& module,
                                                 const std::string& folder);

// The algorithms of a robot.json. Errors in it go to stderr, then Failure (program) is thrown. `reads_words`: read the files of
// taught words, which must be there.
[[nodiscard]] std::vector<compiler::SensorConfig> algorithms_in(const std::string& config,
                                                                bool reads_words);

class Companion final : public Viewer {
public:
  // `algorithms`: those with `companion`. `tells`: print what the robot is fed, without repetitions.
  Companion(std::vector<compiler::SensorConfig> algorithms, CompanionSources sources, bool tells);
  ~Companion() override;

  void program(const TraceNames& names, std::span<const std::byte> image) override;
  void missed(const std::string& why) override;
  // False: all recordings have ended, or no program works any more.
  bool work(Session* session) override;

  // Every program has given up.
  [[nodiscard]] bool has_failed() const;

private:
  struct Output {
    std::string name;
    std::uint8_t channel = 0;  // in the image
    Outlet outlet;
    std::optional<vm::Value> shown;
  };
  struct Hearer {
    compiler::SensorConfig algorithm;
    std::unique_ptr<Worker> worker;  // null: the running program does not read it
    std::vector<Output> outputs;
  };

  void connect(Hearer& hearer);
  [[nodiscard]] Worker::Plan plan_of(const Hearer& hearer) const;
  [[nodiscard]] bool take(Hearer& hearer, const std::string& line) const;
  void feed(Session& session);
  void feed_one(Session& session, const Hearer& hearer, Output& output, vm::Value value);
  void show(const Hearer& hearer, Output& output, vm::Value value) const;

  CompanionSources sources_;
  bool tells_;
  std::vector<Hearer> hearers_;
  const vm::Image* image_ = nullptr;
};

}  // namespace robosync::tool
