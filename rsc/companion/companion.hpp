// What hears and sees for a robot: the programs of the algorithms that robot.json puts on a companion computer, and how what
// they say gets to the robot. A viewer of a watch (device/viewer.hpp), which keeps the line.
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
  std::string camera, microphone;  // a device or a file; empty: the usual one
  std::string preview;             // a PNG with what the camera saw; empty: none
  std::string programs;  // the folder that the programs of the modules stand in; empty: looked for
};

// Where the program of a module stands: in `folder`, or beside rsc, in the build of the companion, on the PATH. Empty: nowhere.
[[nodiscard]] std::string find_companion_program(const std::string& module,
                                                 const std::string& folder);

// The algorithms of a robot.json that run on a companion computer. What is wrong with it is said on stderr, then Failure
// (program) is thrown. `reads_words`: those that have been taught words must have them.
[[nodiscard]] std::vector<compiler::SensorConfig> companion_algorithms(const std::string& config,
                                                                       bool reads_words);

class Companion final : public Viewer {
public:
  // `algorithms`: those with `companion`. `tells`: what the robot is fed is shown, but for repetitions.
  Companion(std::vector<compiler::SensorConfig> algorithms, CompanionSources sources, bool tells);
  ~Companion() override;

  void program(const TraceNames& names, std::span<const std::byte> image) override;
  void missed(const std::string& why) override;
  // False: the recordings are over, or nothing works any more.
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
    std::unique_ptr<Worker> worker;  // null: the program that runs reads nothing of it
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
