// A robot for tests: RSL and JSON compiled by the real compiler, run by the real simulator, its
// trace as lines of text with names instead of numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "link/events.hpp"
#include "runtime-m4/sim/simulator.hpp"
#include "vm/image.hpp"

namespace robosync::test {

// Compiles; fails the test on errors. A vector's memory has the alignment that the VM requires.
std::vector<std::byte> compile(const std::string& rsl, const std::string& json);

// Two fed sensors, near and far, and four virtual actuators a to d; b and c are the group
// bc. With this, most tests need only RSL.
extern const char* const kPlainRobot;

// The program of most tests: two behaviours, `high` (b0) before `low` (b1), with the given rules.
std::string high_and_low(const std::string& high, const std::string& low);
// "HEAD DO body END", also with the conditions that start the behaviours: far Y > 50, near X > 10.
std::string rule(const std::string& head, const std::string& body);
std::string when_far(const std::string& body);
std::string when_near(const std::string& body);
// `body` when the virtual `near X` is above 10; SAFETY stops everything above 90, until it is below 5.
std::string stops_when_far(const std::string& body);

// "1020 #3 command left_arm MOVE SLOWLY to=90": program time in ms, step, event. Values in units.
std::string describe(const link::Event& event, const vm::Image& image);

class Robot {
public:
  explicit Robot(const std::string& rsl, const std::string& json = kPlainRobot);

  // Sensors that no rule reads are not in the image.
  bool has(std::string_view channel) const;
  // In program milliseconds and whole units of the channel.
  void feed(std::uint64_t at_ms, std::string_view channel, int units);
  void feed_raw(std::uint64_t at_ms, std::string_view channel, vm::Value thousandths);
  void run(std::uint64_t until_ms) { simulator_.run_until(until_ms * 1000); }

  const std::vector<std::string>& lines() const { return lines_; }
  std::string trace() const;  // all lines
  // The lines with one of these events, "fire win command".
  std::string only(std::string_view events) const;
  link::Status status() const { return simulator_.status(); }
  const vm::Image& image() const { return image_; }
  const std::vector<std::byte>& bytes() const { return bytes_; }

private:
  std::vector<std::byte> bytes_;
  vm::Image image_;
  std::vector<std::string> lines_;
  sim::Simulator simulator_;
};

}  // namespace robosync::test
