// What the programs of modules have in common: how they are started, and what they say (docs/companion.md).
//
// On stdout a line for each output that is known, at least once a period: NAME VALUE. What is wrong goes to stderr, and the
// exit code says whether it helps to start the program again.
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

// --NAME VALUE …, some of them several times, and --no-pace.
class Arguments {
public:
  // Throws Failure (asked_wrongly), as all of these.
  Arguments(int count, char** texts);

  const std::string& text(const std::string& name) const;
  std::string text_or(const std::string& name, const std::string& otherwise) const;
  // All that it was given with; none, when it was not.
  const std::vector<std::string>& texts(const std::string& name) const;
  bool has(const std::string& name) const { return !texts(name).empty(); }
  double number(const std::string& name) const;
  std::chrono::milliseconds period() const;  // --period, in ms
  const std::vector<std::string>& words() const { return texts("word"); }
  // Recordings are read as fast as they can be, and not in their own time.
  bool no_pace() const { return no_pace_; }

private:
  std::map<std::string, std::vector<std::string>> texts_;
  bool no_pace_ = false;
};

// Throws Failure (outside) when nobody listens any more.
void say(const std::string& output, const std::string& value);
void say(const std::string& output, double value);

// Runs `work`; what it throws is said, and becomes the exit code.
int run(void (*work)(const Arguments&), int count, char** texts);

}  // namespace robosync::companion
