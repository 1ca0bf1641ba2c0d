// Translates blocks of statements and expands DEFINEs in place.
//
// DEFINEs can use each other, so a short program can expand to a long one: the expanded size is
// limited, in total and for each response.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "compiler/sema/commands.hpp"

namespace robosync::compiler {

// ANY list, NEXT list, ITEM n OF list in place of a text.
struct ListChoice {
  enum class How : std::uint8_t { any, next, item, given };
  const ListName* list = nullptr;
  How how{};
  const ast::Expr* index = nullptr;    // for item
  const ChosenItem* chosen = nullptr;  // for given: passed to a DEFINE
  std::size_t at = 0, count = 1;       // which arguments ask for it
  Span span{};
};

class Statements {
public:
  Statements(const SourceMap& sources, const Robot& robot, Names& names, Expressions& expressions,
             Commands& commands, Diagnostics& diagnostics)
      : sources_(sources),
        robot_(robot),
        names_(names),
        expressions_(expressions),
        commands_(commands),
        diagnostics_(diagnostics) {}

  // Reports statements with mistakes and leaves them out.
  [[nodiscard]] ir::Block response(const ast::Block& block);
  // The body of a SAFETY rule: it may only stop, set and warn (E0404).
  [[nodiscard]] ir::Block safety(const ast::Block& block);
  // Checks the DEFINEs that nothing runs. Those of modules need not fit the robot.
  void check_unused_defines();

  // The line of the program in which `span` begins; 0 in a module.
  [[nodiscard]] std::uint16_t line_of(Span span) const;

private:
  void begin_response();
  ir::Block block(const ast::Block& block);
  void add(const ast::Stmt& stmt, ir::Block& result);
  bool within_budget(Span span);
  bool allowed_in_safety(const ast::Stmt& stmt);
  template <typename Node>
  void put(Node node, Span span, ir::Block& result) {
    if (endless_follow(result) != nullptr) report_never(result, span);
    result.push_back({std::move(node), line_of(span), span});
  }

  void add(const ast::Command& node, Span span, ir::Block& result);
  void add(const ast::Wait& node, Span span, ir::Block& result);
  Typed asked_again(const ast::Expr& condition);
  void add(const ast::WaitUntil& node, Span span, ir::Block& result);
  void add(const ast::Then& node, Span span, ir::Block& result);
  void add(const ast::Stop& node, Span span, ir::Block& result);
  void halt(const ast::Stop& node, Span span, ir::Block& result);
  void stop_given(const Binding& binding, const ast::Name& name, Span span, ir::Block& result);
  void stop_actuator(const ast::Name& name, Span span, ir::Block& result);
  static std::size_t else_ifs_of(const ast::If& node);
  bool has_room_for(const ast::If& node, Span span);
  void add(const ast::If& node, Span span, ir::Block& result);
  void add(const ast::Repeat& node, Span span, ir::Block& result);
  void add(const ast::PickOne& node, Span span, ir::Block& result);
  bool repeat_times(const ast::Expr& times, ir::Repeat& result);
  std::optional<vm::Value> weight(const ast::Expr& expr);
  void add(const ast::Set& node, Span span, ir::Block& result);
  void add(const ast::Raise& node, Span span, ir::Block& result);
  void add(const ast::Signal& node, Span span, ir::Block& result);
  VariableName* settable(const ast::Name& name, bool number, const ast::Expr* value = nullptr);
  std::string how_to_change(const ast::Name& name) const;
  std::string declaration_of(const ast::Name& name, const ast::Expr* value);
  void set_label(const ast::Set& node, const VariableName& variable, Span span, ir::Block& result);
  [[nodiscard]] bool is_restart(const ast::Command& node) const;
  void restart(const ast::Command& node, Span span, ir::Block& result);
  bool restarts_at(const ast::Command& node);
  bool in_range(const VariableName& variable, const Typed& value);
  void add(const ast::Log& node, Span span, ir::Block& result);
  void put_log(const ast::Log& node, const ChosenText* chosen, Span span, ir::Block& result);
  // follow.cpp
  void follow(const ast::Command& node, Span span, ir::Block& result);
  void add_followed(Followed followed, Span span, ir::Block& before, ir::Block& body);
  // The FOLLOW at the end of the block, if it has no FOR.
  static ir::Follow* endless_follow(ir::Block& block);
  void report_never(const ir::Block& block, Span span);
  // Puts the local before such a FOLLOW, for a statement that runs together with it.
  void put_first(ir::Local local, Span span, ir::Block& result);
  // lists.cpp
  using PutText = std::function<void(const ChosenText&, ir::Block&)>;
  std::optional<ListChoice> find_choice(const std::vector<ast::Argument>& arguments);
  std::optional<ListChoice> choice_in(const ast::Expr& expr);
  std::optional<ListChoice> choice_given(const ast::Name& name);
  std::optional<ChosenItem> chosen_item(const ListChoice& choice, Span span, ir::Block& result);
  std::optional<ListChoice> in_turn(const ast::Name& how, const ast::Name& list, bool surely);
  void choose(const ListChoice& choice, Span span, const PutText& put_text, ir::Block& result);
  Expression item_index(const ListName& list, Typed index, bool is_text, Span span,
                        ir::Block& result);
  Expression next_index(const ListChoice& choice, Span span, ir::Block& result);
  Expression any_index(const ListChoice& choice, Span span, ir::Block& result);
  using PutItem = std::function<void(std::size_t, ir::Block&)>;
  void put_one_of(const Expression& index, std::pair<std::size_t, std::size_t> places, Span span,
                  const PutItem& put_item, ir::Block& result);
  Expression choose_number(const NumberList& list, Typed index, Span span, ir::Block& result);
  // defines.cpp
  void add(const ast::Call& node, Span span, ir::Block& result);
  void run(DefineName& name, const std::vector<ast::Argument>& arguments, Span span,
           ir::Block& result);
  void run(const Binding& binding, const ast::Name& name,
           const std::vector<ast::Argument>& arguments, Span span, ir::Block& result);
  Typed followed(const ast::Expr& value);
  Expression in_local(Expression value, Span span, ir::Block& result);
  bool bind_name(std::string_view name, const ast::Define& define, Binding& binding);
  bool commands_parameter(const ast::Define& define, std::string_view folded, unsigned handed_on);
  std::optional<Bindings> bind(const DefineName& name, const std::vector<ast::Argument>& arguments,
                               Span span, ir::Block& result);
  Binding bind(const ast::Define& define, std::size_t parameter, const ast::Argument& argument,
               Span span, ir::Block& result);
  void expand(DefineName& name, const Bindings& bindings, ir::Block& result);
  bool may_run(const DefineName& name, Span use);
  void report_cycle(const DefineName& name, Span use);

  const SourceMap& sources_;
  const Robot& robot_;
  Names& names_;
  Expressions& expressions_;
  Commands& commands_;
  Diagnostics& diagnostics_;
  std::vector<const ast::Define*> open_;  // being expanded, outermost first
  std::size_t all_ = 0;                   // statements of the program so far
  // For the response being translated:
  std::size_t statements_ = 0;
  std::size_t locals_ = 0;
  std::size_t depth_ = 0;  // open blocks
  bool safety_ = false;
};

}  // namespace robosync::compiler
