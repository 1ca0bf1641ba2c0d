// Checks expressions and translates them: resolves names, converts units, folds constants.
#pragma once

#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include "compiler/sema/names.hpp"
#include "compiler/sema/quantities.hpp"

namespace robosync::compiler {

// A text of a LIST, chosen at run time.
struct ChosenItem {
  const ListName* list = nullptr;
  Expression index;                              // from 1
  std::pair<std::size_t, std::size_t> places{};  // from 0: the range it is in
};

// The argument for a parameter of the DEFINE being translated.
struct Binding {
  std::string name;  // folded
  Typed value;       // nothing while checking a DEFINE that nothing runs
  std::optional<std::string> text;
  Span span;               // of the argument
  std::string actuator{};  // the actuator or group passed
  DefineName* define = nullptr;
  bool is_number = true;  // none of the other kinds
  std::optional<ChosenItem> chosen{};
  Typed followed{};  // the value for a FOLLOW, evaluated each time; nothing: too long
};
using Bindings = std::vector<Binding>;

// A LIST of numbers with one unit.
struct NumberList {
  const ListName* list = nullptr;
  std::vector<vm::Value> values;  // empty after a mistake
  const Unit* unit = nullptr;
};
// Puts the code that chooses from a list before the statement being translated. Returns the local that holds the number.
using ChooseNumber = std::function<Expression(const NumberList& list, Typed index)>;

// True in a DEFINE that nothing runs: the argument could be anything.
[[nodiscard]] inline bool is_open(const Binding& binding) {
  return binding.is_number && binding.value.type == Type::nothing;
}

class Expressions {
public:
  Expressions(Names& names, Diagnostics& diagnostics) : names_(names), diagnostics_(diagnostics) {}

  // Type::nothing after a mistake, which has been reported.
  [[nodiscard]] Typed condition(const ast::Expr& expr);
  [[nodiscard]] Typed number(const ast::Expr& expr);
  [[nodiscard]] Typed any(const ast::Expr& expr);
  // Is it a channel whose words are those that the program compares it with?
  [[nodiscard]] bool learns_words(const Typed& word) const;
  [[nodiscard]] Typed number_of(Typed result);  // reports any other type
  [[nodiscard]] Typed operand(const ast::Operand& operand, Span span);

  // A condition whose comparisons have hysteresis: MARGIN, which may be null.
  [[nodiscard]] Typed condition(const ast::Expr& expr, const ast::Expr* margin);

  // A number of the wanted dimension; a bare number gets the wanted unit.
  [[nodiscard]] Typed amount(const ast::Expr& expr, const Wanted& wanted);
  // The same, but constant (E0305).
  [[nodiscard]] std::optional<Typed> constant_amount(const ast::Expr& expr, const Wanted& wanted);
  [[nodiscard]] std::optional<Typed> constant(const ast::Expr& expr, std::string_view what);
  // `what` names the word that takes the duration: "COOLDOWN". A constant must be above 0.
  [[nodiscard]] Typed duration(const ast::Expr& expr, std::string_view what);
  [[nodiscard]] std::optional<vm::Value> constant_duration(const ast::Expr& expr,
                                                           std::string_view what);

  // Checks every LET, used or not.
  void check_constants();

  // Sets the visible parameters; nullptr: none. Returns the previous ones.
  const Bindings* set_bindings(const Bindings* bindings);
  [[nodiscard]] const Binding* find_binding(std::string_view name) const;
  // `ANY jokes`, `NEXT jokes`, where `jokes` is a LIST of texts
  [[nodiscard]] bool chooses_text(std::string_view word, std::string_view list) const;
  // Sets whether expressions are for a FOLLOW, which evaluates parameters each time, not beforehand.
  // Returns the previous setting.
  bool set_following(bool following);
  // Since set_following(): was there a parameter without such a value, because it would be too long?
  [[nodiscard]] bool has_lost() const { return lost_; }
  // The LIST of this name; reports an unknown name.
  const ListName* find_list(const ast::Name& name);
  bool lacks_quotes(const ast::Expr& item);
  // Reports mistakes in LISTs of numbers.
  void check_lists();
  // The item, from 0, of a constant index; reports an index outside the list.
  std::optional<std::size_t> known_item(const ListName& list, const Typed& index);
  // Sets how a statement chooses from a list; null (as in conditions): it cannot. Returns the previous setting.
  const ChooseNumber* set_choice(const ChooseNumber* choose);
  // Reports a TIMER in a value that is evaluated only when something else changes. False if there is one.
  bool stands_still(const Expression& value, Span span, std::string_view where);
  // Reports "`who` is given a number, but an actuator is needed".
  void report_given(const Binding& binding, const ast::Name& name, std::string_view wanted);

  // Its numbers; none after a mistake, which has been reported.
  const NumberList& numbers_of(const ListName& list);

private:
  // MARGIN while its condition is translated. A bare number takes the unit of the first comparison.
  struct Margin {
    Typed value;
    bool used = false;
  };

  Typed of(const ast::Quantity& node, Span span);
  Typed of(const ast::Operand& node, Span span) { return operand(node, span); }
  Typed of(const ast::Comparison& node, Span span);
  Typed of(const ast::Not& node, Span span);
  Typed of(const ast::Logic& node, Span span);
  // Arithmetic.
  Typed of(const ast::Negate& node, Span span);
  Typed of(const ast::Arithmetic& node, Span span);
  Typed of(const ast::Random& node, Span span);
  // functions.cpp, number_lists.cpp
  Typed of(const ast::Function& node, Span span);
  Typed of(const ast::ItemOf& node, Span span);
  Typed of(const ast::CountOf& node, Span span);
  Typed of_one(Operation operation, const ast::Function& node, Span span);
  Typed of_two(Operation operation, const ast::Function& node, Span span);
  // conditions.cpp: words and truths
  Typed of(const ast::Is& node, Span span);
  Typed of(const ast::IsTruth& node, Span span);
  Typed of(const ast::Becomes& node, Span span);
  // conditions.cpp: time words
  Typed of(const ast::IsBetween& node, Span span);
  Typed of(const ast::Changes& node, Span span);
  Typed of(const ast::For& node, Span span);
  Typed of(const ast::ThenWithin& node, Span span);
  Typed of(const ast::TimesWithin& node, Span span);

  // Are there parameters? What holds for one argument may not hold for the next.
  [[nodiscard]] bool is_given() const { return bindings_ != nullptr && !bindings_->empty(); }
  Typed constant(ConstantName& name, const ast::Operand& operand, Span span);
  const Typed& value_of(ConstantName& name);
  Typed channel(ChannelRef ref, Span span);
  Typed variable(VariableName& name, Span span);
  Typed parameter(const Binding& binding, const ast::Operand& operand, Span span);
  Typed negative_point(Typed literal, Span span);
  bool report_points(const Typed& left, Typed& right);
  Typed sum(const ast::Arithmetic& node, Typed left, Typed right, Span span);
  Typed product(const ast::Arithmetic& node, Typed left, Typed right, Span span);
  Typed combine(ast::ArithmeticOp op, Typed left, Typed right, const Unit* unit, Span span);
  Typed fold(const Typed& left, const Typed& right, Typed result);
  void check_divisor(const Typed& divisor);
  bool asks_nothing(const ast::Logic& node);
  void report_word_comparison(const ast::Comparison& node, const Typed& word);
  std::optional<std::size_t> place_of(const ast::Name& label, const Typed& word, bool quoted);
  Typed label_test(Operation operation, const ast::Expr& value, const ast::Name& label, Span span,
                   bool quoted = false);
  // timers.cpp
  Typed time_between(Typed value, Typed low, Typed high, Span span);
  Typed time_comparison(ast::Relation relation, Typed left, Typed right, Span span);
  Expression compare(ast::Relation relation, Typed left, Typed right);
  Expression between(Typed value, Typed same, Typed low, Typed high);
  bool takes_margin(const Typed& left, const Typed& right);

  Names& names_;
  Diagnostics& diagnostics_;
  std::map<const ast::Let*, Typed> constants_;
  std::vector<const ast::Let*> open_;  // being evaluated, to detect cycles
  const Bindings* bindings_ = nullptr;
  std::map<const ListName*, NumberList> lists_;
  bool in_list_ = false;  // evaluating its numbers
  const ChooseNumber* choose_ = nullptr;
  bool following_ = false;
  bool lost_ = false;
  Margin* margin_ = nullptr;
};

// The index of a label; reports an unknown one with E0501 and lists the valid ones.
[[nodiscard]] std::optional<std::size_t> find_label(Names& names,
                                                    const std::vector<std::string>& labels,
                                                    const ast::Name& label, std::string_view owner,
                                                    Diagnostics& diagnostics, bool quoted = false);
[[nodiscard]] vm::Value label_value(std::size_t place);

// Reports "`mood` is a word (`calm` or `happy`), not a number".
Diagnostic& report_word(const Typed& word, std::string_view wanted, Diagnostics& diagnostics);

}  // namespace robosync::compiler
