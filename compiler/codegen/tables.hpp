// Numbers for what the program uses: channels, actuators, groups, verbs, words. What it does not
// use gets none, and does not travel in the image. Variables have the numbers that sema gave them.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/ir/program.hpp"

namespace robosync::compiler {

class Tables {
public:
  // Reports E0407 when there is more than the image format can number.
  Tables(const Program& program, Diagnostics& diagnostics);

  // Valid when nothing was reported.
  [[nodiscard]] std::uint8_t input(ChannelRef ref) const { return channels_.at(ref); }
  [[nodiscard]] std::uint8_t variable(std::size_t place) const {
    return static_cast<std::uint8_t>(channels_.size() + place);
  }
  [[nodiscard]] std::uint8_t target(const ProgramCommand& command) const;
  // One for each `halt` instruction.
  [[nodiscard]] std::vector<std::uint8_t> targets(const ProgramHalt& halt) const;
  [[nodiscard]] std::uint32_t mask_of(const std::vector<std::size_t>& actuators) const;
  [[nodiscard]] std::uint32_t mask_of(const ProgramHalt& halt) const;
  [[nodiscard]] std::uint8_t verb(const ProgramCommand& command) const;
  [[nodiscard]] std::uint8_t word(const ProgramCommand& command) const;

  // What has a number, in the order of the numbers: places in the Robot's lists.
  [[nodiscard]] const std::map<ChannelRef, std::uint8_t>& channels() const { return channels_; }
  [[nodiscard]] const std::map<std::size_t, std::uint8_t>& actuators() const { return actuators_; }
  [[nodiscard]] const std::map<std::size_t, std::uint8_t>& groups() const { return groups_; }
  [[nodiscard]] const std::vector<ProgramVerb>& verbs() const { return verbs_; }
  [[nodiscard]] const std::vector<ProgramWord>& words() const { return words_; }
  // Bit v: verb v is one of the actuator's.
  [[nodiscard]] std::uint32_t verbs_of(const ActuatorConfig& actuator) const;

private:
  void use(const ProgramRule& rule);
  void use(const ProgramBlock& block);
  void use(const Expression& expression);
  void use(const ProgramCommand& command);
  void use(const ProgramHalt& halt);
  void check_counts(const Program& program, Diagnostics& diagnostics) const;

  std::map<ChannelRef, std::uint8_t> channels_;
  std::map<std::size_t, std::uint8_t> actuators_;
  std::map<std::size_t, std::uint8_t> groups_;
  std::vector<ProgramVerb> verbs_;  // in the order of first use
  std::vector<ProgramWord> words_;
};

}  // namespace robosync::compiler
