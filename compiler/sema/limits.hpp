// LIMIT: the speed of an actuator, or what a sensor of the same name measures.
#pragma once

#include "compiler/sema/commands.hpp"

namespace robosync::compiler {

class Limits {
public:
  // `robot` is changed: its commands are checked against the stricter limits.
  Limits(Robot& robot, Names& names, Expressions& expressions, Diagnostics& diagnostics)
      : robot_(robot), names_(names), expressions_(expressions), diagnostics_(diagnostics) {}

  // Adds a speed limit to `program`, or the SAFETY rule that keeps the limit. `line` is its own.
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
