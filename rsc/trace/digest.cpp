// The events are not trusted.
#include "rsc/trace/digest.hpp"

#include <cstdlib>

namespace robosync::tool {
namespace {

using link::EventKind;

constexpr std::int64_t kParts = 10;  // parts of a feeling's range: a change by one is shown

}  // namespace

bool Digest::shows(const link::Event& event) {
  switch (event.kind) {
    case EventKind::input:
    case EventKind::fire:
    case EventKind::win:
    case EventKind::done:
    case EventKind::cancel:
    case EventKind::finished:
    case EventKind::wait:
    case EventKind::go_on:
    case EventKind::priority:
      return false;
    case EventKind::set:
      return shows_value(event);
    default:
      return true;  // also new kinds of events: better too much than unseen
  }
}

// A fading feeling changes in every step: it is shown after each tenth of its range, and when it has
// settled.
bool Digest::shows_value(const link::Event& event) {
  if (event.subject >= image_.variables.size() || event.value_count == 0) return true;
  const vm::Variable& variable = image_.variables[event.subject];
  // Hidden variables of NEXT and ANY: their names have a space, which no name in a program has.
  if (image_.string(variable.name).find(' ') != std::string_view::npos) return false;
  const vm::Value value = event.values[0];
  vm::Value& last = shown_[event.subject];
  if (last == vm::kUnknown) last = variable.initial;
  const bool known = value != vm::kUnknown && last != vm::kUnknown;
  if (variable.fade != 0 && known && value != variable.fades_to) {
    const std::int64_t range = std::int64_t{variable.max} - variable.min;
    if (std::abs(std::int64_t{value} - last) * kParts < range) return false;
  }
  last = value;
  return true;
}

}  // namespace robosync::tool
