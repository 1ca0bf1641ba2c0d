// Shared by the modules' programs: their arguments and their output (docs/companion.md).
//
// They print a line to stdout for each known output, at least once a period: NAME VALUE. Errors go to stderr, and the exit code
// says whether starting the program again helps.
#pragma once

#include <chrono>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "companion/exit.hpp"

namespace robosync::companion {

class Failure : public std::runtime_error {
public:
  Failure(Exit exit, const std::string& message) : std::runtime_error(message), exit_(exit) {}
  Exit exit() const { return exit_; }

private:
  Exit exit_;
};

// --NAME VALUE …, some of them repeated, and --no-pace.
class Arguments {
public:
  // Throws Failure (asked_wrongly). So do the members below.
  Arguments(int count, char** texts);

  const std::string& text(const std::string& name) const;
  std::string text_or(const std::string& name, const std::string& otherwise) const;
  // All values that it was given; empty if it was not given.
  const std::vector<std::string>& texts(const std::string& name) const;
  bool has(const std::string& name) const { return !texts(name).empty(); }
  double number(const std::string& name) const;
  std::chrono::milliseconds period() const;  // --period, in ms
  const std::vector<std::string>& words() const { return texts("word"); }
  // Recordings are read as fast as possible, not in real time.
  bool no_pace() const { return no_pace_; }

private:
  std::map<std::string, std::vector<std::string>> texts_;
  bool no_pace_ = false;
};

// Throws Failure (outside) when the reader has gone.
void say(const std::string& output, const std::string& value);
void say(const std::string& output, double value);

// Runs `work`. An exception that it throws is printed and becomes the exit code.
int run(void (*work)(const Arguments&), int count, char** texts);

}  // namespace robosync::companion
