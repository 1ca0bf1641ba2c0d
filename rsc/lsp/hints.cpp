// textDocument/inlayHint and textDocument/signatureHelp: the priority that robot.json gives a BEHAVIOR, the worst-case cost
// of a rule, and what a verb takes.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "compiler/query/describe.hpp"
#include "compiler/reading.hpp"
#include "compiler/source/ascii.hpp"
#include "rsc/lsp/answers.hpp"
#include "rsc/lsp/uris.hpp"
#include "rsc/timing.hpp"

namespace robosync::tool::lsp {

namespace ast = compiler::ast;
using compiler::SourceFile, compiler::Span;

namespace {

// The program that the text belongs to, and which of its files it is.
std::optional<Asked> asked_about(Desk desk, const Json& params) {
  const auto path = path_of(address_in(params));
  const auto users = path ? desk.workspace.users_of(*path) : std::vector<const Checked*>();
  if (users.empty() || path->extension() == ".json") return std::nullopt;
  return Asked{users.front(), users.front()->file(*path).value(), 0};
}

}  // namespace

std::map<std::uint32_t, std::uint32_t> costs_by_line(const compiler::Result& result,
                                                     compiler::FileId file) {
  std::map<std::uint32_t, std::uint32_t> costs;
  vm::Image image;
  if (result.image.empty() || !vm::view_image(result.image, image)) return costs;
  const SourceFile& source = result.sources.file(file);
  for (const BehaviorTiming& behavior : timing_of(image, memory_of(result.board)).behaviors)
    for (const RuleTiming& rule : behavior.rules) {
      const Span span = result.rules.at(rule.number);
      if (span.file != file) continue;
      std::uint32_t& cost = costs[source.line_of(span.begin)];
      cost = std::max(cost, rule.cost.step());
    }
  return costs;
}

namespace {

class Hints {
public:
  Hints(const Asked& asked, Encoding encoding, Json range)
      : result_(asked.checked->result()),
        file_(asked.file),
        source_(result_.sources.file(asked.file)),
        encoding_(encoding),
        begin_(offset_of(source_, place_in(range.at("start")), encoding)),
        end_(offset_of(source_, place_in(range.at("end")), encoding)) {}

  Json all() {
    for (const ast::Tree* const tree : result_.reading->trees())
      for (const ast::Item& item : tree->items)
        if (const auto* behavior = std::get_if<ast::Behavior>(&item.node)) priority_of(*behavior);
    for (const auto& [line, cost] : costs_by_line(result_, file_)) {
      const auto begin = source_.line_start(line);
      const std::string_view text = source_.line(line);
      const auto end = text.find_last_not_of(" \t\r") + 1;
      add(begin + static_cast<std::uint32_t>(end), fmt::format("at most {} instructions", cost));
    }
    return std::move(hints_);
  }

private:
  void priority_of(const ast::Behavior& behavior) {
    if (behavior.priority || behavior.name.span.file != file_ || !result_.reading->robot) return;
    for (const compiler::BehaviorConfig& one : result_.reading->robot->behaviors)
      if (one.priority && compiler::same_name(one.name.text, behavior.name.text))
        add(behavior.name.span.end, fmt::format("PRIORITY {}", *one.priority));
  }

  void add(std::uint32_t offset, const std::string& label) {
    if (offset < begin_ || offset > end_) return;
    hints_.push_back({{"position", position_json(place_of(source_, offset, encoding_))},
                      {"label", label},
                      {"paddingLeft", true}});
  }

  const compiler::Result& result_;
  compiler::FileId file_;
  const SourceFile& source_;
  Encoding encoding_;
  std::uint32_t begin_, end_;
  Json hints_ = Json::array();
};

// The words of a line before a position.
std::vector<std::string_view> words_before(const SourceFile& source, std::uint32_t offset) {
  const std::uint32_t line = source.line_of(offset);
  std::string_view text = source.line(line).substr(0, offset - source.line_start(line));
  std::vector<std::string_view> words;
  constexpr std::string_view kBetweenWords = " \t";
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(kBetweenWords), text.size()));
    if (text.empty()) return words;
    words.push_back(text.substr(0, text.find_first_of(kBetweenWords)));
    text.remove_prefix(words.back().size());
  }
}

bool is_target(const compiler::Robot& robot, std::size_t actuator, std::string_view word) {
  if (compiler::same_name(robot.actuators[actuator].name.text, word)) return true;
  return std::ranges::any_of(robot.groups, [&](const compiler::GroupConfig& group) {
    return compiler::same_name(group.name.text, word) &&
           std::ranges::find(group.members, actuator) != group.members.end();
  });
}

// What the verb takes on the actuators that are named after it, else on all that know it.
Json signatures_of(const compiler::Robot& robot, std::string_view verb, std::string_view target) {
  Json named = Json::array(), all = Json::array();
  for (std::size_t place = 0; place < robot.actuators.size(); ++place) {
    const compiler::ActuatorConfig& actuator = robot.actuators[place];
    const compiler::VerbConfig* const known = actuator.find_verb(verb);
    if (known == nullptr) continue;
    const Json signature = {{"label", compiler::query::describe_verb(actuator, *known)},
                            {"parameters", Json::array()}};
    all.push_back(signature);
    if (is_target(robot, place, target)) named.push_back(signature);
  }
  return named.empty() ? all : named;
}

}  // namespace

Json inlay_hints(Desk desk, const Json& params) {
  const auto asked = asked_about(desk, params);
  if (!asked) return nullptr;
  return Hints(*asked, desk.workspace.encoding(), params.at("range")).all();
}

Json signature_help(Desk desk, const Json& params) {
  const auto asked = asked_at(desk, params);
  if (!asked || asked->file == compiler::kConfigurationFile) return nullptr;
  const compiler::Result& result = asked->checked->result();
  if (!result.reading->robot) return nullptr;
  const auto words = words_before(result.sources.file(asked->file), asked->offset);
  // The last verb of the line: a command may follow DO, ELSE or OPTION.
  for (std::size_t at = words.size(); at > 0; --at) {
    const std::string_view target = at < words.size() ? words[at] : std::string_view();
    Json found = signatures_of(*result.reading->robot, words[at - 1], target);
    if (!found.empty()) return {{"signatures", std::move(found)}, {"activeSignature", 0}};
  }
  return nullptr;
}

}  // namespace robosync::tool::lsp
