// Part of Statements: texts and numbers from a LIST. A statement with a text becomes a binary search over statements,
// one for each text of the list, so that a list of 64 takes six tests. A number is chosen in the same way before the
// statement, into a local.
//
// ANY and NEXT each remember the index of their last text, from 1, in a variable.
#include <utility>

#include "compiler/sema/statements.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMaxTexts = 64;  // more would nest more blocks than a robot can

Expression make_variable(std::size_t index) {
  Expression result;
  result.operation = Operation::variable;
  result.index = index;
  return result;
}

vm::Value whole(std::size_t number) {
  return static_cast<vm::Value>(number) * vm::kScale;
}

// A random whole number from 1 to `most`: draws a number of thousandths and multiplies it by 1000.
Expression drawn(std::size_t most) {
  return make_binary(Operation::multiply,
                     make_binary(Operation::random, make_constant_code(1),
                                 make_constant_code(static_cast<vm::Value>(most))),
                     make_constant_code(vm::kScale * vm::kScale));
}

// number MOD count + 1
Expression place_behind(Expression number, std::size_t count) {
  return make_binary(
      Operation::add,
      make_binary(Operation::modulo, std::move(number), make_constant_code(whole(count))),
      make_constant_code(vm::kScale));
}

}  // namespace

// ---- finding the choice

// `ANY jokes`, `NEXT jokes`. Reports an unknown list if such a choice is `surely` meant.
std::optional<ListChoice> Statements::in_turn(const ast::Name& how, const ast::Name& list,
                                              bool surely) {
  const std::string folded = fold_name(how.text);
  if ((folded != "any" && folded != "next") || expressions_.find_binding(how.text) != nullptr)
    return std::nullopt;
  if (names_.find_list(list.text) == nullptr && !surely) return std::nullopt;
  ListChoice choice;
  choice.list = expressions_.find_list(list);
  if (choice.list != nullptr && choice.list->numbers) {
    if (!expressions_.numbers_of(*choice.list).values.empty())  // else its mistake is reported
      diagnostics_
          .report(Code::E0306,
                  how.shown() + " chooses a text, but " + list.shown() + " holds numbers")
          .label(list.span)
          .label(choice.list->list->name.span, "the LIST", false)
          .helps("choose a number by its position: `(ITEM 1 OF " + std::string(list.text) + ")`");
    choice.list = nullptr;
  }
  choice.how = folded == "any" ? ListChoice::How::any : ListChoice::How::next;
  choice.span = {how.span.file, how.span.begin, list.span.end};
  return choice;
}

// A parameter of a DEFINE that was passed a text of a LIST.
std::optional<ListChoice> Statements::choice_given(const ast::Name& name) {
  const Binding* const binding = expressions_.find_binding(name.text);
  if (binding == nullptr || !binding->chosen) return std::nullopt;
  ListChoice choice;
  choice.list = binding->chosen->list;
  choice.how = ListChoice::How::given;
  choice.chosen = &*binding->chosen;
  choice.span = name.span;
  return choice;
}

std::optional<ListChoice> Statements::choice_in(const ast::Expr& expr) {
  if (const auto* operand = std::get_if<ast::Operand>(&expr.node)) {
    if (!operand->channel) return choice_given(operand->name);
    const bool sensor = names_.find_sensor(operand->name.text).has_value();
    return in_turn(operand->name, *operand->channel, !sensor);
  }
  const auto* item = std::get_if<ast::ItemOf>(&expr.node);
  if (item == nullptr) return std::nullopt;
  const ListName* const named = names_.find_list(item->list.text);
  if (named != nullptr && named->numbers) return std::nullopt;
  ListChoice choice;
  choice.list = expressions_.find_list(item->list);
  choice.how = ListChoice::How::item;
  choice.index = item->index.get();
  choice.span = expr.span;
  return choice;
}

// The first one; a second one is rare.
std::optional<ListChoice> Statements::find_choice(const std::vector<ast::Argument>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    std::optional<ListChoice> choice;
    const auto* word = std::get_if<ast::Word>(&arguments[i].value);
    const auto* behind =
        i + 1 < arguments.size() ? std::get_if<ast::Word>(&arguments[i + 1].value) : nullptr;
    if (word != nullptr) choice = choice_given(word->name);
    if (word != nullptr && behind != nullptr && !choice) {
      const bool known = names_.is_word(word->name.text) || names_.find_target(word->name.text);
      choice = in_turn(word->name, behind->name, !known);
      if (choice) choice->count = 2;
    }
    const auto* amount = std::get_if<ast::Amount>(&arguments[i].value);
    if (amount != nullptr && amount->value != nullptr) choice = choice_in(*amount->value);
    if (!choice) continue;
    choice->at = i;
    return choice;
  }
  return std::nullopt;
}

// ---- choosing the text

void Statements::choose(const ListChoice& choice, Span span, const PutText& put_text,
                        ir::Block& result) {
  const auto chosen = chosen_item(choice, span, result);
  if (!chosen) return;
  for (std::size_t i = chosen->places.first; i <= chosen->places.second; ++i)
    if (!within_budget(choice.span)) return;
  const auto put_item = [&](std::size_t item, ir::Block& into) {
    const Span place = choice.list->list->items[item].span;
    put_text({choice.at, choice.count, choice.list->texts[item], place}, into);
  };
  put_one_of(chosen->index, chosen->places, span, put_item, result);
}

// Nothing after a mistake, which has been reported.
std::optional<ChosenItem> Statements::chosen_item(const ListChoice& choice, Span span,
                                                  ir::Block& result) {
  if (choice.list == nullptr) return std::nullopt;
  const std::size_t count = choice.list->count();
  if (safety_ || count > kMaxTexts) {
    Diagnostic& d =
        diagnostics_
            .report(safety_ ? Code::E0404 : Code::E0407,
                    safety_
                        ? "a SAFETY rule cannot choose from a LIST"
                        : choice.list->list->name.shown() + " has " + std::to_string(count) +
                              " texts; a rule can choose from at most " + std::to_string(kMaxTexts))
            .label(choice.span);
    if (!safety_)
      d.helps("make two LISTs of it, and let `PICK ONE` with two OPTIONs choose between them");
    return std::nullopt;
  }
  if (choice.chosen != nullptr) return *choice.chosen;
  ChosenItem chosen{choice.list, {}, {0, count - 1}};
  if (choice.how == ListChoice::How::item) {
    Typed number = expressions_.amount(
        *choice.index, {&canonical_unit(vm::Dimension::number), "ITEM", choice.index->span});
    if (!number.is_number()) return std::nullopt;
    if (number.is_constant()) {
      const auto item = expressions_.known_item(*choice.list, number);
      if (!item) return std::nullopt;
      chosen.places = {*item, *item};
    } else {
      chosen.index = item_index(*choice.list, std::move(number), true, span, result);
    }
  } else if (count > 1) {
    chosen.index = choice.how == ListChoice::How::next ? next_index(choice, span, result)
                                                       : any_index(choice, span, result);
  }
  return chosen;
}

// Evaluates the index once. An index outside the list takes the nearest item and is logged; for a text, so is an unknown one,
// because it takes none.
Expression Statements::item_index(const ListName& list, Typed index, bool is_text, Span span,
                                  ir::Block& result) {
  const std::string name(list.list->name.text);
  const std::size_t count = list.count();
  Expression local =
      in_local(make_binary(Operation::round, std::move(index.code), make_constant_code(vm::kScale)),
               span, result);
  const ir::Log log{
      false, "there is no ITEM {} OF " + name + ", which has " + std::to_string(count), {local}};
  ir::If outside;
  outside.condition = make_binary(
      Operation::logical_or, make_binary(Operation::less, local, make_constant_code(vm::kScale)),
      make_binary(Operation::greater, local, make_constant_code(whole(count))));
  put(log, span, outside.then_block);
  if (!is_text) {
    put(std::move(outside), span, result);
    return local;
  }
  // An IF with an unknown condition runs neither side.
  const std::size_t known = locals_++;
  put(ir::Local{known, make_constant_code(0), true}, span, result);
  for (ir::Block* const side : {&outside.then_block, &outside.else_block})
    put(ir::Local{known, make_constant_code(vm::kScale), true}, span, *side);
  put(std::move(outside), span, result);
  ir::If unknown;
  unknown.condition = make_binary(Operation::equal, make_local(known), make_constant_code(0));
  put(log, span, unknown.then_block);
  put(std::move(unknown), span, result);
  return local;
}

Expression Statements::next_index(const ListChoice& choice, Span span, ir::Block& result) {
  const std::size_t last = choice.list->next.value_or(0);
  put(ir::Set{last, place_behind(make_variable(last), choice.list->count()), false}, span, result);
  return make_variable(last);
}

// The first time, any item. After that, moves on by a random number of items that never returns to the same one.
Expression Statements::any_index(const ListChoice& choice, Span span, ir::Block& result) {
  const std::size_t count = choice.list->count();
  const std::size_t last = choice.list->any.value_or(0);
  ir::If first;
  first.condition = make_binary(Operation::equal, make_variable(last), make_constant_code(0));
  put(ir::Set{last, drawn(count), false}, span, first.then_block);
  Expression further = make_binary(
      Operation::add,
      make_binary(Operation::subtract, make_variable(last), make_constant_code(vm::kScale)),
      drawn(count - 1));
  put(ir::Set{last, place_behind(std::move(further), count), false}, span, first.else_block);
  put(std::move(first), span, result);
  return make_variable(last);
}

// ---- one block for each item

void Statements::put_one_of(const Expression& index, std::pair<std::size_t, std::size_t> places,
                            Span span, const PutItem& put_item, ir::Block& result) {
  const auto [first, last] = places;
  if (first == last) return put_item(first, result);
  const std::size_t middle = (first + last) / 2;
  ir::If lower;
  lower.condition =
      make_binary(Operation::less_equal, index, make_constant_code(whole(middle + 1)));
  put_one_of(index, {first, middle}, span, put_item, lower.then_block);
  put_one_of(index, {middle + 1, last}, span, put_item, lower.else_block);
  put(std::move(lower), span, result);
}

// ---- numbers

// An unknown index gives an unknown number: the index is in neither half.
Expression Statements::choose_number(const NumberList& list, Typed index, Span span,
                                     ir::Block& result) {
  const std::size_t local = locals_++;
  const Expression place = item_index(*list.list, std::move(index), false, span, result);
  put(ir::Local{local, place, true}, span, result);
  const auto put_number = [&](std::size_t item, ir::Block& into) {
    put(ir::Local{local, make_constant_code(list.values[item]), true}, span, into);
  };
  put_one_of(place, {0, list.values.size() - 1}, span, put_number, result);
  return make_local(local);
}

}  // namespace robosync::compiler
