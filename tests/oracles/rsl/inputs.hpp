// Where the values of a step come from: readings, what was SET, what fades, the bands of CHECKs.
#pragma once

#include <deque>
#include <map>
#include <vector>

#include "tests/oracles/rsl/evaluator.hpp"
#include "tests/oracles/rsl/trace.hpp"

namespace robosync::oracle {

// What one response did to one variable.
struct Change {
  Number set;              // the value it SET, RAISEs after that included …
  std::int64_t raise = 0;  // … or only RAISEs and LOWERs
};
using Changes = std::map<std::size_t, Change>;

// A value inside the variable's range.
[[nodiscard]] std::int64_t clamped(const compiler::ir::Variable& variable, std::int64_t value);

class Inputs {
public:
  Inputs(const compiler::ir::Program& program, const compiler::Robot& robot, Trace& trace);

  // Gives whether that is news: it differs enough from what is known.
  bool feed(compiler::ChannelRef channel, std::int64_t value, Millis now);
  // What the responses of one step did, the most important first.
  void stage(std::vector<Changes> changes) { staged_.push_back(std::move(changes)); }

  // A step begins: everything new enters the snapshot.
  void enter(Millis now);
  [[nodiscard]] const Snapshot& snapshot() const { return snapshot_; }
  // Readings as they are, which is what SAFETY rules look at.
  [[nodiscard]] Snapshot readings(Millis heard, Millis now) const;

private:
  struct Channel {
    const compiler::ChannelConfig* config = nullptr;
    Number value;  // as last published
    bool news = false;
    Millis heard = 0;  // when the last reading came
  };
  struct Fade {  // the way from where it was last changed
    std::int64_t way = 0;
    Millis began = 0;
  };
  struct Smoothing {
    std::deque<std::int64_t> samples;
    Millis sampled = 0;
    std::int64_t held = 0;
    std::size_t band = SIZE_MAX;
  };

  [[nodiscard]] bool is_stale(const Channel& channel, Millis now) const;
  void put(std::size_t variable, Number value);
  void begin_fade(std::size_t variable, Millis now);
  void enter_readings(Millis now);
  void enter_variables(Millis now);
  void fade(Millis now);
  void check(const compiler::ir::Check& check, Smoothing& smoothing, Millis now);
  [[nodiscard]] Number smoothed(const compiler::ir::Check& check, Smoothing& smoothing,
                                Number value, Millis now) const;

  const compiler::ir::Program& program_;
  Trace& trace_;
  std::map<compiler::ChannelRef, Channel> channels_;
  Snapshot snapshot_;
  std::vector<std::vector<Changes>> staged_;  // by steps
  std::map<std::size_t, Fade> fades_;
  std::vector<Smoothing> smoothing_;
};

}  // namespace robosync::oracle
