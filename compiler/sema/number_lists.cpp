// Part of Expressions: LISTs in place of a number. ITEM of a list of numbers, and COUNT of any list.
#include <algorithm>
#include <utility>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/expressions.hpp"

namespace robosync::compiler {

const ListName* Expressions::find_list(const ast::Name& name) {
  const ListName* list = names_.find_list(name.text);
  if (list != nullptr || name.text.empty()) return list;
  const std::string kind = names_.kind_of(name.text);
  Diagnostic& d =
      diagnostics_
          .report(Code::E0501, kind.empty() ? "there is no LIST " + name.shown()
                                            : name.shown() + " is " + kind + ", not a LIST")
          .label(name.span);
  const auto candidates = names_.list_names_given();
  did_you_mean(d, name.span, name.text, candidates);
  if (d.help.empty())
    d.helps(candidates.empty()
                ? "declare it at the top: `LIST " + std::string(name.text) + ": \"one\", \"two\"`"
                : "LISTs: " + list_names(candidates));
  return nullptr;
}

void Expressions::check_lists() {
  for (const auto& [folded, list] : names_.lists())
    if (list.numbers) (void)numbers_of(list);
}

// `LIST words: hello, world`. Reports it once for the LIST.
bool Expressions::lacks_quotes(const ast::Expr& item) {
  const auto* const word = std::get_if<ast::Operand>(&item.node);
  if (word == nullptr || !names_.kind_of(word->name.text).empty() ||
      names_.find_sensor(word->name.text))
    return false;
  const std::string text(word->name.text);
  diagnostics_.report(Code::E0501, "there is no number called " + word->name.shown())
      .label(word->name.span)
      .helps("put a text in quotes: `\"" + text + "\"`");
  return true;
}

// Bare numbers take the unit of the first number.
const NumberList& Expressions::numbers_of(const ListName& list) {
  const auto [found, added] = lists_.emplace(&list, NumberList{&list, {}, nullptr});
  NumberList& numbers = found->second;
  if (!added) return numbers;
  const bool before = std::exchange(in_list_, true);
  std::vector<vm::Value> values;
  bool good = true;
  for (const ast::Argument& item : list.list->items) {
    const auto* amount = std::get_if<ast::Amount>(&item.value);
    if (amount == nullptr) good = false;  // a text, which has been reported
    if (amount == nullptr || amount->value == nullptr) continue;
    if (lacks_quotes(*amount->value)) {
      good = false;
      break;
    }
    if (numbers.unit == nullptr) {
      const Typed first = number(*amount->value);
      good = good && first.is_number();
      if (!first.is_number()) break;
      numbers.unit = first.unit != nullptr ? first.unit : &canonical_unit(vm::Dimension::number);
    }
    const auto value = constant_amount(
        *amount->value, {numbers.unit, std::string(list.list->name.text), list.list->name.span});
    good = good && value;
    if (value) values.push_back(value->code.constant);
  }
  in_list_ = before;
  if (good) numbers.values = std::move(values);
  return numbers;
}

const ChooseNumber* Expressions::set_choice(const ChooseNumber* choose) {
  return std::exchange(choose_, choose);
}

std::optional<std::size_t> Expressions::known_item(const ListName& list, const Typed& index) {
  const std::size_t count = list.count();
  const vm::Value value = index.code.constant;
  if (value % vm::kScale == 0 && value >= vm::kScale &&
      value <= static_cast<vm::Value>(count) * vm::kScale)
    return static_cast<std::size_t>(value / vm::kScale - 1);
  if (value % vm::kScale != 0) {
    diagnostics_.report(Code::E0509, "a position in a LIST is a whole number").label(index.span);
    return std::nullopt;
  }
  diagnostics_
      .report(Code::E0509, list.list->name.shown() + " has the " +
                               (list.numbers ? "numbers" : "texts") + " 1 to " +
                               std::to_string(count))
      .label(index.span, "outside that range")
      .label(list.list->name.span, "the LIST", false);
  return std::nullopt;
}

Typed Expressions::of(const ast::ItemOf& node, Span span) {
  const ListName* list = find_list(node.list);
  if (list == nullptr) return make_nothing(span);
  if (!list->numbers || in_list_) {
    diagnostics_
        .report(Code::E0306, list->numbers
                                 ? "a LIST cannot contain an ITEM of a LIST"
                                 : node.list.shown() + " holds texts, but a number is needed")
        .label(span)
        .label(list->list->name.span, "the LIST", false);
    return make_nothing(span);
  }
  const NumberList& numbers = numbers_of(*list);
  Typed index =
      amount(*node.index, {&canonical_unit(vm::Dimension::number), "ITEM", node.index->span});
  if (!index.is_number() || numbers.values.empty()) return make_nothing(span);
  if (index.is_constant()) {
    const auto item = known_item(*list, index);
    return item ? make_constant(numbers.values[*item], *numbers.unit, span) : make_nothing(span);
  }
  if (following_ && choose_ != nullptr) {  // passed to a DEFINE, which may FOLLOW it
    lost_ = true;
    return make_nothing(span);
  }
  if (choose_ == nullptr) {
    diagnostics_
        .report(Code::E0404, "an `ITEM` with a changing number can be chosen only in a response")
        .label(span)
        .helps("SET a variable to it in a rule, and use the variable here");
    return make_nothing(span);
  }
  Typed result = make_constant(0, *numbers.unit, span);
  result.code = (*choose_)(numbers, std::move(index));
  const auto [least, most] = std::ranges::minmax(numbers.values);
  result.low = least;
  result.high = most;
  return result;
}

Typed Expressions::of(const ast::CountOf& node, Span span) {
  const ListName* list = find_list(node.list);
  if (list == nullptr) return make_nothing(span);
  Typed count = make_constant(static_cast<vm::Value>(list->count()) * vm::kScale,
                              canonical_unit(vm::Dimension::number), span);
  return count;
}

}  // namespace robosync::compiler
