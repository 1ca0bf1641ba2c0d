// LIMIT: limits the speed of an actuator, or the reading of a sensor of the same name.
#pragma once

#include "compiler/sema/commands.hpp"

namespace robosync::compiler {

class Limits {
public:
  // Changes `robot`, so that commands are checked against the stricter limits.
  Limits(Robot& robot, Names& names, Expressions& expressions, Diagnostics& diagnostics)
      : robot_(robot), names_(names), expressions_(expressions), diagnostics_(diagnostics) {}

  // Adds a speed limit to `program`, or the SAFETY rule that enforces the limit. `line` is the line of the LIMIT.
  void add(const ast::Limit& limit, std::uint16_t line, ir::Program& program);

private:
  void limit_speed(const ast::Limit& limit, const Target& target, ir::Program& program);
  void limit_reading(const ast::Limit& limit, ChannelRef channel, std::uint16_t line,
                     ir::Program& program);
  [[nodiscard]] std::optional<ChannelRef> find_channel(const ast::Limit& limit) const;
  void report_unknown(const ast::Limit& limit);

  Robot& robot_;
  Names& names_;
  Expressions& expressions_;
  Diagnostics& diagnostics_;
};

}  // namespace robosync::compiler
