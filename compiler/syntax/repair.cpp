// See repair.hpp.
#include "compiler/syntax/repair.hpp"

#include <algorithm>

#include "compiler/syntax/edit.hpp"
#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/unit_apart.hpp"
#include "compiler/syntax/wording.hpp"

namespace robosync::compiler {

namespace {

// The number of tokens that the grammar advanced beyond the place where it stopped before.
std::size_t gain(const Edit& edit, const Attempt& before, const Attempt& after) {
  const std::size_t end_of_inserted = edit.at + edit.inserted.size();
  if (after.stopped_at < end_of_inserted) return 0;
  const std::size_t now = after.stopped_at - edit.inserted.size() + edit.removed;
  const std::size_t jumped = std::max(before.stopped_at, edit.at + edit.removed);
  return now > jumped ? now - jumped : 0;
}

// How far the grammar must get for a change to count as the right one despite a later mistake: some
// words, or past the end of the line.
constexpr std::size_t far_enough = 10;
constexpr std::size_t over_a_line = 8;
constexpr int incomplete = 8;
constexpr int step_short = 6;
constexpr int not_allowed = 20;  // grammatical, but an action objects

bool passes_a_line(const Tokens& changed, const Edit& edit, const Attempt& after) {
  const std::size_t from = edit.at + edit.inserted.size();
  const std::size_t to = std::min(after.stopped_at, changed.size());
  for (std::size_t at = from; at < to; ++at) {
    if (changed[at].kind == Kinds::NEWLINE && at > from) return true;
  }
  return false;
}

int judge(const Edit& edit, const Attempt& before, const Attempt& after, const Tokens& changed,
          std::size_t objections) {
  if (after.complete) return edit.cost + not_allowed * static_cast<int>(objections);
  std::size_t reached = std::min(gain(edit, before, after), far_enough);
  if (passes_a_line(changed, edit, after)) reached = std::max(reached, over_a_line);
  return edit.cost + incomplete + step_short * static_cast<int>(far_enough - reached);
}

const Edit* best_edit(const std::vector<Edit>& edits, const Tokens& tokens, const Attempt& failure,
                      Reader& reader, Budget& budget) {
  const Edit* best = nullptr;
  int fewest = 0;
  for (const Edit& edit : edits) {
    if (best != nullptr && fewest <= edit.cost) break;  // no later one can be better
    Tokens changed = edited(tokens, edit);
    if (!budget.spend(changed.size())) break;
    Diagnostics objections;
    const Attempt attempt = reader.read(changed, &objections);
    const bool stuck = !attempt.complete && gain(edit, failure, attempt) == 0;
    if (stuck && edit.what != Edit::What::skip) continue;
    const int points = judge(edit, failure, attempt, changed, objections.all().size());
    if (best != nullptr && points >= fewest) continue;
    best = &edit;
    fewest = points;
  }
  return best;
}

// Nothing helped: leaves out the rest of the line, but at least one token.
Edit last_resort(const Tokens& tokens, const Attempt& failure) {
  Edit edit;
  edit.what = Edit::What::skip;
  edit.at = std::min(failure.stopped_at, tokens.size() - 1);
  std::size_t end = edit.at + 1;
  while (end < tokens.size() && tokens[end].kind != Kinds::NEWLINE)
    ++end;
  edit.removed = end - edit.at;
  return edit;
}

std::optional<Edit> known_mistake(const Tokens& tokens, const Attempt& failure,
                                  const SourceFile& source, const Examples& examples,
                                  Diagnostics& diagnostics) {
  if (auto joined = explain_joined_command(tokens, source, failure, examples, diagnostics))
    return joined;
  if (auto raised = explain_raised(tokens, source, failure, examples, diagnostics)) return raised;
  for (const auto explain_one : {explain_spoken_form, explain_wrong_form, explain_unit_apart,
                                 explain_misplaced_word, explain_foreign_habit, explain_habit})
    if (auto habit = explain_one(tokens, source, failure, diagnostics)) return habit;
  return explain_sentence(tokens, source, failure, examples, diagnostics);
}

}  // namespace

void mend(Tokens& tokens, const Attempt& failure, Reader& reader, const Examples& examples,
          Diagnostics& diagnostics, Budget& budget) {
  if (const auto known = known_mistake(tokens, failure, reader.source(), examples, diagnostics)) {
    tokens = edited(tokens, *known);
    return;
  }
  constexpr std::size_t readings = 3;  // the most that possible_edits() makes
  std::vector<Edit> edits;
  if (budget.spend(readings * tokens.size())) edits = possible_edits(tokens, failure, reader);
  const Edit* found = best_edit(edits, tokens, failure, reader, budget);
  const Edit edit = found != nullptr ? *found : last_resort(tokens, failure);
  explain({tokens, reader.source(), failure, edit, examples}, diagnostics);
  tokens = edited(tokens, edit);
}

}  // namespace robosync::compiler
