// See waiting_commands.hpp.
#include "compiler/sema/waiting_commands.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "compiler/ir/walk.hpp"

namespace robosync::compiler {
namespace {

// The largest numbers of commands that may wait at one place of a response.
struct Waiting {
  std::map<std::size_t, unsigned> of;  // by actuator
  unsigned all = 0;

  void merge(const Waiting& other) {
    for (const auto& [actuator, count] : other.of)
      of[actuator] = std::max(of[actuator], count);
    all = std::max(all, other.all);
  }
  bool operator==(const Waiting&) const = default;
};

std::set<std::size_t> actuators_of(const ir::Program& program) {
  std::set<std::size_t> all;
  const auto add = [&](const ir::Command& command) {
    all.insert(command.actuators.begin(), command.actuators.end());
  };
  for_each_rule(program, [&](const ir::Rule& rule) {
    for_each_of<ir::Command>(rule.then_response, add);
    for_each_of<ir::Command>(rule.else_response, add);
  });
  return all;
}

class Response {
public:
  Response(unsigned most, const Names& names, Diagnostics& diagnostics)
      : most_(most), names_(names), diagnostics_(diagnostics) {}

  void check(const ir::Block& block) {
    Waiting waiting;
    walk(block, waiting);
  }

private:
  void walk(const ir::Block& block, Waiting& waiting) {
    for (const ir::Statement& statement : block) {
      if (reported_) return;
      if (const auto* command = std::get_if<ir::Command>(&statement.node)) {
        add(*command, statement.span, waiting);
      } else if (const auto* loop = std::get_if<ir::Repeat>(&statement.node)) {
        repeat(*loop, waiting);
      } else {
        branch(statement, waiting);
        if (is_pause(statement)) waiting = {};
      }
    }
  }

  // Exactly one of its blocks runs: an IF without an ELSE has an empty one.
  void branch(const ir::Statement& statement, Waiting& waiting) {
    const Waiting before = waiting;
    bool first = true;
    for_each_block(statement, [&](const ir::Block& block) {
      Waiting after = before;
      walk(block, after);
      if (std::exchange(first, false)) waiting = {};
      waiting.merge(after);
    });
  }

  // A round that adds a command is too much after a few rounds; any other round soon changes nothing. How often a loop runs that
  // has no constant count is not known: twice, as almost all do.
  void repeat(const ir::Repeat& loop, Waiting& waiting) {
    const vm::Value rounds = ir::constant_count(loop).value_or(2 * vm::kScale) / vm::kScale;
    for (vm::Value round = 0; round < rounds && !reported_; ++round) {
      const Waiting before = waiting;
      walk(loop.body, waiting);
      if (waiting == before) return;
    }
  }

  // A STOP drops what waits. A FOLLOW replaces the one that waits.
  void add(const ir::Command& command, Span span, Waiting& waiting) {
    if (command.verb.action == vm::Action::follow) return;
    for (const std::size_t actuator : command.actuators) {
      unsigned& count = waiting.of[actuator];
      if (command.verb.action == vm::Action::stop) {
        waiting.all -= std::min(waiting.all, count);
        count = 0;
        continue;
      }
      ++count;
      ++waiting.all;
      if (reported_ || (count <= vm::kMaxQueued && waiting.all <= most_)) continue;
      report(count > vm::kMaxQueued ? fmt::format("`{}`", names_.actuator(actuator).name.text)
                                    : "all its actuators",
             count > vm::kMaxQueued ? vm::kMaxQueued : most_, span);
    }
  }

  void report(const std::string& whose, unsigned most, Span span) {
    reported_ = true;
    diagnostics_
        .report(Code::E0407, fmt::format("{} commands for {} are still waiting here, the most that "
                                         "the robot keeps: this one would be lost",
                                         most, whose))
        .label(span)
        .helps("put THEN before it: the response goes on when all commands so far are done");
  }

  unsigned most_;
  const Names& names_;
  Diagnostics& diagnostics_;
  bool reported_ = false;
};

}  // namespace

void check_waiting_commands(const ir::Program& program, const Names& names,
                            Diagnostics& diagnostics) {
  const unsigned most = vm::max_queued(static_cast<unsigned>(actuators_of(program).size()));
  for_each_rule(program, [&](const ir::Rule& rule) {
    for (const ir::Block* response : {&rule.then_response, &rule.else_response})
      Response(most, names, diagnostics).check(*response);
  });
}

}  // namespace robosync::compiler
