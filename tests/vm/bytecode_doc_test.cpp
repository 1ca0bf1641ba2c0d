// docs/bytecode.md lists the opcodes; the list is generated from opcodes.def and compared here.
// ROBOSYNC_UPDATE_GOLDEN=1 rewrites the part between the two markers.
#include <catch2/catch.hpp>

#include "tests/vm/golden.hpp"
#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;

namespace {

constexpr std::string_view kPath = "docs/bytecode.md";

// As opcodes.def spells them.
struct Spelled {
  std::array<std::string_view, 3> operands;
  std::string_view flow, effect;
};
constexpr std::array<Spelled, kOpcodes.size()> kSpelled = {{
#define OPCODE(name, a, b, c, contexts, flow, effect, cost, doc) {{#a, #b, #c}, #flow, #effect},
#include "vm/opcodes.def"
#undef OPCODE
}};

// What there is of them, with commas between.
std::string listed(std::initializer_list<std::string_view> names) {
  std::string list;
  for (const std::string_view name : names)
    if (name != "none" && name != "next") list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

std::string_view context_name(Context context) {
  switch (context) {
    case Context::condition:
      return "condition";
    case Context::response:
      return "response";
    case Context::safety:
      return "safety";
    case Context::acting:
      return "response, safety";
    case Context::any:
      return "all";
  }
  return "";
}

std::string opcode_table() {
  std::string table =
      "| code | opcode | A, B, C | stands in | flow, effect | cost | "
      "|\n|---|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < kOpcodes.size(); ++i) {
    const OpcodeInfo& info = kOpcodes[i];
    const auto& [operands, flow, effect] = kSpelled[i];
    table += "| " + std::to_string(i) + " | `" + std::string(info.name) + "` | " +
             listed({operands[0], operands[1], operands[2]}) + " | " +
             std::string(context_name(info.contexts)) + " | " + listed({flow, effect}) + " | " +
             std::to_string(info.cost) + " | " + std::string(info.doc) + " |\n";
  }
  return table;
}

std::string refusal_table() {
  std::string table = "| number | refusal | what a person reads |\n|---|---|---|\n";
  std::size_t number = 0;
#define REFUSAL(name, text) \
  table += "| " + std::to_string(++number) + " | `" #name "` | " text " |\n";
#include "vm/refusals.def"
#undef REFUSAL
  return table;
}

// The text between the markers of `part`, and with it replaced by `wanted`.
struct Generated {
  std::string actual;
  std::string replaced;
};
Generated find_generated(const std::string& document, const std::string& part,
                         const std::string& wanted) {
  const std::string begin = "<!-- generated: " + part + " -->\n";
  const std::string end = "<!-- end of " + part + " -->\n";
  const std::size_t start = document.find(begin);
  const std::size_t stop = document.find(end);
  REQUIRE(start != std::string::npos);
  REQUIRE(stop != std::string::npos);
  const std::size_t first = start + begin.size();
  return {document.substr(first, stop - first),
          document.substr(0, first) + wanted + document.substr(stop)};
}

void check_generated(const std::string& part, const std::string& wanted) {
  const std::string path(kPath);
  if (update_golden()) write_text(path, find_generated(read_text(path), part, wanted).replaced);
  CHECK(find_generated(read_text(path), part, wanted).actual == wanted);
}

}  // namespace

TEST_CASE("docs/bytecode.md has the opcodes of opcodes.def") {
  check_generated("opcodes", opcode_table());
}

TEST_CASE("docs/bytecode.md has the refusals of refusals.def") {
  check_generated("refusals", refusal_table());
}
