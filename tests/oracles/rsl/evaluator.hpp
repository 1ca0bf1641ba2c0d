// What expressions are worth, and what their time words remember.
#pragma once

#include <map>
#include <vector>

#include "compiler/ir/program.hpp"
#include "tests/oracles/rsl/past.hpp"

namespace robosync::oracle {

// The values that all rules of a step see.
struct Snapshot {
  std::map<compiler::ChannelRef, Number> channels;  // one that is not there is unknown
  std::vector<Number> variables;
  Millis now = 0;
};

// What one expression sees: the snapshot and, in a response, what that has set and worked out.
struct Sight {
  const Snapshot& snapshot;
  const std::map<std::size_t, Number>* own = nullptr;
  const std::map<std::size_t, Number>* locals = nullptr;
  Chance* chance = nullptr;  // of its behaviour; null where nothing is drawn
};

class Evaluator {
public:
  [[nodiscard]] Number number(const compiler::Expression& expression, const Sight& sight);
  [[nodiscard]] Truth truth(const compiler::Expression& expression, const Sight& sight);

  // Notes what the time words of an expression see in this step; `truth` gives them from then on.
  void remember(const compiler::Expression& expression, const Sight& sight, Moment now);
  // Is an event in it true now? BECOMES, CHANGES, TIMES WITHIN and THEN … WITHIN are, for a moment.
  [[nodiscard]] bool happens(const compiler::Expression& expression) const;

private:
  struct Word {
    Past past;
    Truth now;
  };
  [[nodiscard]] Number arithmetic(const compiler::Expression& expression, const Sight& sight);
  [[nodiscard]] Truth comparison(const compiler::Expression& expression, const Sight& sight);

  std::map<const compiler::Expression*, Word> words_;
};

}  // namespace robosync::oracle
