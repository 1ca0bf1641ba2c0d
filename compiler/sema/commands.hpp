// Checks commands (`MOVE arms SLOWLY`) against the actuators' abilities and translates them.
#pragma once

#include "compiler/sema/expressions.hpp"
#include "compiler/sema/motions.hpp"
#include "compiler/sema/names.hpp"
#include "compiler/sema/texts.hpp"

namespace robosync::compiler {

// Words of RSL that are used like a verb, as kPerform is; not keywords.
inline constexpr std::string_view kFollow = "FOLLOW";
inline constexpr std::string_view kRestart = "RESTART";

// The most parts of an expression that is passed to a DEFINE and that a FOLLOW in it evaluates repeatedly.
inline constexpr std::size_t kMostFollowed = 100;

// A text from a LIST, which replaces the arguments that ask for it.
struct ChosenText {
  std::size_t at = 0, count = 0;  // which arguments
  const std::string& text;
  Span span;  // of the text in its LIST
};

// Shared by the parts of Commands.
// The word, if the argument is a word without a preposition; otherwise nullptr.
[[nodiscard]] const ast::Word* plain_word(const ast::Argument& argument);
// Makes the fix uncertain: a word of RSL is only a guess in place of a verb or a word of a device.
void doubt_keyword(Diagnostic& diagnostic);
[[nodiscard]] bool is_given(const ir::Command& command, vm::Param param);
[[nodiscard]] std::vector<std::string> verb_names(const ActuatorConfig& actuator);
void report_twice(Span span, const std::string& what, Diagnostics& diagnostics);

// FOLLOW of one actuator, or of a group whose members all do it in the same way.
struct Followed {
  ir::Command command;   // its TO is the value
  vm::Value margin = 0;  // the least change of the value
};
struct Follow {
  std::vector<Followed> all;
  std::optional<Expression> lasts;  // FOR
};

class Commands {
public:
  Commands(const Robot& robot, Names& names, Expressions& expressions, Motions& motions,
           Diagnostics& diagnostics)
      : robot_(robot),
        names_(names),
        expressions_(expressions),
        motions_(motions),
        diagnostics_(diagnostics) {}

  // One command for an actuator, or for a group whose members all understand it in the same way; otherwise
  // one for each member. Empty after a mistake, which has been reported.
  [[nodiscard]] std::vector<ir::Command> translate(const ast::Command& command,
                                                   const ChosenText* chosen = nullptr);

  // Reports a command that has nothing to say, play or show, and returns true. `span` is that of its statement.
  bool lacks_content(const ir::Command& command, Span span);
  // Reports a command that exceeds the limit of a motor, and returns true. `node` is its source.
  bool gives_too_much(const ast::Command& node, const ir::Command& command);
  // Of a drive.
  void note_no_amount(const ast::Command& node, const ir::Command& command);

  // Is it FOLLOW, which is not a verb of any robot?
  [[nodiscard]] bool is_follow(const ast::Command& command) const;
  // Nothing after a mistake, which has been reported.
  [[nodiscard]] std::optional<Follow> follow(const ast::Command& command);

  // The actuator or group that STOP names; reports an unknown name.
  [[nodiscard]] std::optional<Target> find_stopped(const ast::Name& name);

private:
  // An evaluated argument; the actuator's units are applied later.
  struct Given {
    const ast::Argument* argument = nullptr;
    vm::Param param{};  // of numbers
    Typed number;
    bool is_number = false;
    std::optional<std::string> text;  // in quotes, here or where it is passed to a DEFINE
    Span text_span{};
    std::vector<Expression> values{};  // for the {} places of `text`
  };
  struct Recipient {  // one command for one actuator
    const ActuatorConfig& actuator;
    const VerbConfig& verb;
    const ast::Command& command;
    Diagnostics& diagnostics;
  };

  // The word in the actuator's place; nullptr: none.
  [[nodiscard]] const ast::Word* first_word(const ast::Command& command) const;
  [[nodiscard]] bool is_chosen(std::size_t argument) const {
    return chosen_ != nullptr && argument >= chosen_->at && argument < chosen_->at + chosen_->count;
  }
  // The actuator, and the arguments.
  std::optional<Target> find_target(const ast::Command& command, std::size_t& named_by);
  std::optional<Target> only_target(const ast::Command& command);
  bool is_given_another(const ast::Command& command);
  void report_no_target(const ast::Command& command, const std::vector<std::size_t>& able);
  // Words that are not verbs (unknown_verbs.cpp).
  void report_unknown_verb(const ast::Command& command);
  bool is_torn_name(const ast::Command& command);
  void report_run_define(const ast::Command& command, Diagnostic& diagnostic) const;
  bool begins_with_actuator(const ast::Command& command);
  bool calls_define(const ast::Command& command);
  bool is_foreign(const ast::Command& command);
  std::optional<std::vector<Given>> evaluate(const ast::Command& command, std::size_t named_by);
  Given evaluate(const ast::Argument& argument, std::string_view verb);
  // Then a word of the program is what it says.
  [[nodiscard]] bool says_any_text(std::string_view verb) const;
  // The text whose parts begin at `first`; without a text after a mistake.
  Given put_together(const ast::Command& command, std::size_t first);
  bool has_decimal_comma(const ast::Argument& part, const ast::Argument& next);
  bool lacks_brackets(const ast::Command& command, std::size_t place);
  // Arguments that together mean something else (misread.cpp).
  bool is_misread(const ast::Command& command, std::size_t place);
  bool is_word_of_program(const ast::Command& command, std::size_t place);
  bool is_second_command(const ast::Command& command, std::size_t place);
  bool is_foreign_preposition(const ast::Command& command, std::size_t place);
  bool is_reading(const ast::Command& command, std::size_t place);
  bool lacks_comma(const ast::Command& command, std::size_t place);
  bool lacks_list(const ast::Command& command, std::size_t place);
  [[nodiscard]] bool can_go_to(std::string_view verb) const;
  bool is_unit_apart(const ast::Command& command, std::size_t place);
  static bool is_sensor_meant(const Recipient& to, const ast::Word& word, const Names& names);
  // Parts that are each correct but wrong together (whole_commands.cpp).
  static bool says_twice(const Recipient& to, const std::vector<Given>& given,
                         const ir::Command& result);
  static bool repeats_nothing(const Recipient& to, const std::vector<Given>& given,
                              const ir::Command& result);
  static bool goes_two_ways(const Recipient& to, const std::vector<Given>& given);
  static void warn_of_a_sweep(const Recipient& to, const std::vector<Given>& given,
                              const ir::Command& result);
  static void help_with_files(const Recipient& to, Diagnostic& d);
  Typed evaluate_value(const ast::Argument& argument);
  [[nodiscard]] bool is_known_word(std::string_view word) const;  // of any actuator
  [[nodiscard]] bool names_a_number(const ast::Name& name) const;

  // PERFORM (perform.cpp).
  std::vector<ir::Command> perform(const ast::Command& command);
  bool add_to_performance(const Given& given, ir::Command& result);
  void report_no_motion(const ast::Command& command);

  // FOLLOW (follow.cpp).
  std::vector<ir::Command> expected_follow(const ast::Command& command);
  std::optional<Follow> follow(const ast::Command& command, bool expected);
  // The FOLLOW evaluates the values of a DEFINE's parameters each time.
  std::optional<std::vector<Given>> evaluate_followed(const ast::Command& command,
                                                      std::size_t named_by);
  std::optional<Followed> follow_by(std::size_t actuator, const std::vector<Given>& given,
                                    const ast::Name& verb, Diagnostics& diagnostics) const;
  static bool add_to_follow(const ActuatorConfig& actuator, const Given& given, Followed& result,
                            Diagnostics& diagnostics);
  bool lasts(const Given& given, Follow& result);

  // The command for one actuator.
  std::optional<ir::Command> for_actuator(std::size_t actuator, const ast::Command& command,
                                          const std::vector<Given>& given,
                                          Diagnostics& diagnostics) const;
  static bool is_number_alone(const Given& given);
  static bool is_to_be_said(const VerbConfig& verb, const Given& given);
  static bool is_to_be_shown(const Recipient& to, const Given& given);
  bool add(const Recipient& to, const Given& given, ir::Command& result) const;
  bool add_word(const Recipient& to, const ast::Word& word, Span span, ir::Command& result) const;
  void report_no_text(const Recipient& to, const Given& given) const;
  void warn_of_hidden(const Recipient& to, const ast::Word& word) const;
  bool add_text(const Recipient& to, const Given& given, ir::Command& result) const;
  bool say_values(const Recipient& to, const Given& given, ir::Command& result) const;
  bool add_number(const Recipient& to, const Given& given, vm::Param param,
                  ir::Command& result) const;
  static void report_not_taken(const Recipient& to, const Given& given);
  static void report_foreign_word(const Recipient& to, const WordConfig& word, Span span);
  bool is_in_place_of_actuator(const ast::Command& command, const ast::Word& word) const;
  void call_it_actuator(const Recipient& to, const ast::Word& word, Diagnostic& d) const;
  void report_unknown_word(const Recipient& to, const ast::Word& word) const;

  const Robot& robot_;
  Names& names_;
  Expressions& expressions_;
  Motions& motions_;
  Diagnostics& diagnostics_;
  const ChosenText* chosen_ = nullptr;
};

}  // namespace robosync::compiler
