// Tables of the image under construction: the numbers of the things that the program uses, its texts, its timers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/ir/program.hpp"

namespace robosync::compiler {

// ---- numbers
//
// Numbers of the channels, actuators, groups, verbs and words that the program uses. Unused ones get no number and are not in the
// image. Variables keep the numbers from sema.

class Tables {
public:
  // Reports E0407 for more than the image format can number.
  Tables(const ir::Program& program, const Robot& robot, Diagnostics& diagnostics);

  // Valid if nothing was reported.
  [[nodiscard]] std::uint8_t input(ChannelRef ref) const { return channels_.at(ref); }
  // The index, in the Robot's list, of the sensor that has the channel with this number.
  [[nodiscard]] std::size_t sensor_of(std::uint8_t number) const {
    return std::ranges::find(channels_, number, [](const auto& entry) { return entry.second; })
        ->first.sensor;
  }
  [[nodiscard]] std::uint8_t variable(std::size_t place) const {
    return static_cast<std::uint8_t>(channels_.size() + place);
  }
  [[nodiscard]] std::uint8_t target(const ir::Command& command) const;
  // One for each `halt` instruction.
  [[nodiscard]] std::vector<std::uint8_t> targets(const ir::Halt& halt) const;
  [[nodiscard]] std::uint32_t mask_of(const std::vector<std::size_t>& actuators) const;
  [[nodiscard]] std::uint32_t mask_of(const ir::Halt& halt) const;
  [[nodiscard]] std::uint8_t number_of(std::size_t actuator) const {
    return actuators_.at(actuator);
  }
  [[nodiscard]] std::uint8_t verb(const ir::Command& command) const;
  [[nodiscard]] std::uint8_t word(const ir::Command& command) const;

  // Everything that has a number, in the order of the numbers: indexes in the Robot's lists.
  [[nodiscard]] const std::map<ChannelRef, std::uint8_t>& channels() const { return channels_; }
  [[nodiscard]] const std::map<std::size_t, std::uint8_t>& actuators() const { return actuators_; }
  [[nodiscard]] const std::map<std::size_t, std::uint8_t>& groups() const { return groups_; }
  // MOTIONs of several actuators are groups, numbered after the robot's: indexes in ir::Program::motions.
  [[nodiscard]] const std::map<std::size_t, std::uint8_t>& motion_groups() const {
    return motion_groups_;
  }
  [[nodiscard]] const std::vector<ir::Verb>& verbs() const { return verbs_; }
  [[nodiscard]] const std::vector<ir::Word>& words() const { return words_; }
  // Bit v: verb v is one of the verbs of the actuator at `place`.
  [[nodiscard]] std::uint32_t verbs_of(const ActuatorConfig& actuator, std::size_t place) const;

private:
  void use_encoders(const Robot& robot);
  void use_inputs(const Robot& robot);
  void use(const ir::Rule& rule);
  void use(const ir::Block& block);
  void use(const Expression& expression);
  void use(const ir::Command& command);
  void use(const ir::Halt& halt);
  void check_counts(const ir::Program& program, Diagnostics& diagnostics) const;

  std::map<ChannelRef, std::uint8_t> channels_;
  std::map<std::size_t, std::uint8_t> actuators_;
  std::map<std::size_t, std::uint8_t> groups_;
  std::map<std::size_t, std::uint8_t> motion_groups_;
  std::set<std::size_t> performers_;  // actuators in a MOTION …
  std::set<std::size_t> followers_;   // … that FOLLOW
  std::vector<ir::Verb> verbs_;       // in the order of first use
  std::vector<ir::Word> words_;
};

// ---- texts
//
// The string and label sections under construction.

class Strings {
public:
  // Equal strings share their place, and so does a string that another one ends with.
  [[nodiscard]] std::uint16_t offset(std::string_view text);
  // The index of the first of the labels' offsets, which are consecutive; equal rows share their place.
  [[nodiscard]] std::uint16_t row(const std::vector<std::string>& labels);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::vector<std::uint16_t>& labels() const { return labels_; }

private:
  // A string that one or more others end with.
  struct Ending {
    std::size_t end = 0;                     // offset of the zero of the first such string
    std::map<char, std::uint32_t> longer{};  // indexes in endings_, by the letter in front
  };

  std::string text_;
  std::vector<Ending> endings_;  // a tree; its root is the empty string
  std::vector<std::uint16_t> labels_;
};

// The index of `row` in `list`; appends it if it is not there yet.
template <typename Item>
std::uint16_t place_row(std::vector<Item>& list, const std::vector<Item>& row) {
  auto place = std::search(list.begin(), list.end(), row.begin(), row.end());
  if (place == list.end()) place = list.insert(list.end(), row.begin(), row.end());
  return static_cast<std::uint16_t>(place - list.begin());
}

// ---- timers
//
// The timer section under construction: one timer for each time word, in the order of the code.

[[nodiscard]] vm::TimerKind timer_kind(Operation time_word);

class Timers {
public:
  // Adds a timer for the time word; returns its index.
  [[nodiscard]] std::size_t add(const Expression& time_word);

  [[nodiscard]] const std::vector<vm::Timer>& records() const { return records_; }

private:
  std::vector<vm::Timer> records_;
  std::uint32_t memory_ = 0;  // words that the timers need so far
};

}  // namespace robosync::compiler
