// Shows how a line of RSL is written: a correct line of the same kind (lines.def), filled with fitting names from the
// user's program and robot.json where there are any.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// The names that the program itself declares.
struct OwnNames {
  struct Name {
    TokenKind declared = TokenKind{};  // REMEMBER, FEELING, STATE, TIMER or MOTION
    std::string_view name;
    std::string_view more;  // the unit of a number; the first word of a STATE
  };
  std::vector<Name> names;

  OwnNames(const Tokens& program, const SourceFile& source);
  // The declaration of one of these kinds with this name; without a name, the first one. Null when there is none.
  [[nodiscard]] const Name* find(std::initializer_list<TokenKind> declared,
                                 std::string_view name) const;
};

class Examples {
public:
  // All three must outlive this; `robot` may be null.
  Examples(const Tokens& program, const SourceFile& source, const Vocabulary* robot)
      : own_(program, source), source_(source), robot_(robot) {}

  // "`WAIT` is written like this: `WAIT 2s`", for the line of the token `at`, an index into `piece`.
  // Empty when that token begins its line: then the kind of line is unknown.
  [[nodiscard]] std::string written_like(const Tokens& piece, std::size_t at) const;
  // "MOVE left_arm UP SLOWLY"
  [[nodiscard]] std::string command() const { return command("", false); }
  // Of this actuator, if the robot has it; with `places`, as in Vocabulary.
  [[nodiscard]] std::string command(std::string_view actuator, bool places) const;
  // "touch LEVEL > 5", about the first of these words that is a sensor; if none is, about any.
  [[nodiscard]] std::string condition(const std::vector<std::string_view>& words) const;
  // Of the robot; without a robot, of none.
  [[nodiscard]] bool is_verb(std::string_view word) const;
  [[nodiscard]] bool is_sensor(std::string_view word) const;
  [[nodiscard]] bool is_actuator(std::string_view word) const;  // or a group of them

private:
  OwnNames own_;
  const SourceFile& source_;
  const Vocabulary* robot_;
};

}  // namespace robosync::compiler
