// Shows how a line of RSL is written, by a right one of the same kind (lines.def), with the names that the user has given
// in the program and in robot.json, where there are some that fit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// What the program itself declares.
struct OwnNames {
  struct Name {
    TokenKind declared = TokenKind{};  // REMEMBER, FEELING, STATE, TIMER or MOTION
    std::string_view name;
    std::string_view more;  // the unit of a number; the first word of a STATE
  };
  std::vector<Name> names;

  OwnNames(const Tokens& program, const SourceFile& source);
  // Of these kinds: the one of this name, or without a name the first. Null when there is none.
  [[nodiscard]] const Name* find(std::initializer_list<TokenKind> declared,
                                 std::string_view name) const;
};

class Examples {
public:
  // All of them must outlive this; `robot` may be null.
  Examples(const Tokens& program, const SourceFile& source, const Vocabulary* robot)
      : own_(program, source), source_(source), robot_(robot) {}

  // "`WAIT` is written like this: `WAIT 2s`", for the line of the token `at`, a place in some piece of the program.
  // Empty when that token begins its line: then it is not known what the line is.
  [[nodiscard]] std::string written_like(const Tokens& piece, std::size_t at) const;
  // "MOVE left_arm UP SLOWLY"
  [[nodiscard]] std::string command() const;

private:
  OwnNames own_;
  const SourceFile& source_;
  const Vocabulary* robot_;
};

}  // namespace robosync::compiler
