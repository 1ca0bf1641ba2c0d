// One run of a response: where it is, what it has worked out, what it waits for. The tree itself is
// walked; a place in it is a stack of blocks.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <variant>
#include <vector>

#include "tests/oracles/rsl/inputs.hpp"

namespace robosync::oracle {

// A command and the actuators it is for.
struct Commanded {
  std::vector<std::size_t> actuators;
  Order order;
};
// A LOG or an ALERT.
struct Said {
  bool alert = false;
  std::string text;
  std::vector<Number> values;
};
using Effect = std::variant<Commanded, Said>;

// What a response puts out in one step.
struct Output {
  std::vector<Effect> effects;  // in their order
  Changes changes;
  std::map<std::size_t, Number> seen;  // what it SET, RAISEd or LOWERed, as it sees it itself
};

// "A THEN and a WAIT UNTIL last 20 ms at least." So does a FOLLOW, and until a rule begins again by itself.
inline constexpr Millis kLeastPause = 20;

// What a response needs of the robot it runs on.
struct Surroundings {
  Evaluator& evaluator;
  Chance& chance;
  const std::vector<compiler::ir::Variable>& variables;
  const Snapshot& snapshot;
  Millis now = 0;
  bool commands_done = false;  // of this response, all so far
};

class Response {
public:
  Response(const compiler::ir::Block& block, std::size_t rule) : rule_(rule) {
    places_.push_back({&block, 0, nullptr, 0, false});
  }

  [[nodiscard]] bool ended() const { return places_.empty(); }
  [[nodiscard]] bool waits() const { return pause_ != Pause::none; }
  // It is in a WAIT: then its rule may choose the other side at once.
  [[nodiscard]] bool waits_for_time() const { return pause_ == Pause::time && !came_too_soon_; }
  // When a WAIT is over, or a THEN at the earliest. Nothing of other pauses: those are looked at in every step.
  [[nodiscard]] std::optional<Millis> wait_ends() const;
  // Is what it waits for there? Notes it if it comes too soon.
  [[nodiscard]] bool may_go_on(const Surroundings& around);
  // A FOLLOW has looked once more, and goes on following.
  [[nodiscard]] bool follows_on() const { return follows_on_; }
  // To the next pause, or the end.
  Output run(const Surroundings& around);

private:
  enum class Pause { none, time, commands, condition, follow };
  struct Place {
    const compiler::ir::Block* block = nullptr;
    std::size_t next = 0;
    const compiler::ir::Repeat* loop = nullptr;
    std::int64_t rounds = 0;  // that are left, of a loop that counts
    bool follow = false;      // it is the body of a FOLLOW
  };

  [[nodiscard]] Sight sight(const Surroundings& around) const;
  [[nodiscard]] Number number(const compiler::Expression& expression) const;
  [[nodiscard]] Truth truth(const compiler::Expression& expression) const;
  void enter(const compiler::ir::Block& block) {
    places_.push_back({&block, 0, nullptr, 0, false});
  }
  void leave_block();
  void pause(Pause why, Number duration);
  bool comes_too_soon(Millis now);

  void run(const compiler::ir::Command& node);
  void run(const compiler::ir::Local& node);
  void run(const compiler::ir::Set& node);
  void run(const compiler::ir::Wait& node);
  void run(const compiler::ir::WaitUntil& node);
  void run(const compiler::ir::Follow& node);
  void run(const compiler::ir::Then& node);
  void run(const compiler::ir::If& node);
  void run(const compiler::ir::Repeat& node);
  void run(const compiler::ir::Pick& node);
  void run(const compiler::ir::Log& node);
  void run(const compiler::ir::Halt& node);

  std::size_t rule_;
  std::vector<Place> places_;
  std::map<std::size_t, Number> locals_;
  Pause pause_ = Pause::none;
  Millis paused_at_ = 0;  // or followed on
  Millis waits_since_ = 0;
  std::optional<Millis> until_;
  const compiler::Expression* condition_ = nullptr;
  const compiler::ir::Follow* follow_ = nullptr;
  bool follows_on_ = false;
  bool came_too_soon_ = false;  // what it waits until

  // While it runs.
  const Surroundings* around_ = nullptr;
  Output output_;
  std::map<std::size_t, Number> sums_;  // of what it SET, RAISEd and LOWERed, bounded by nothing
};

// Every actuator that a block could ever command or halt.
[[nodiscard]] std::set<std::size_t> actuators_of(const compiler::ir::Block& block);
// Calls visit(expression) for every expression in a block.
void for_each_condition(const compiler::ir::Block& block,
                        const std::function<void(const compiler::Expression&)>& visit);
// A LOG's text with the values in its {} places.
[[nodiscard]] std::string filled_in(const std::string& text, const std::vector<Number>& values);

}  // namespace robosync::oracle
