// docs/bytecode.md lists the opcodes; the list is generated from opcodes.def and compared here.
// ROBOSYNC_UPDATE_GOLDEN=1 rewrites the part between the two markers.
#include <catch2/catch.hpp>

#include "tests/support/generated.hpp"
#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

using namespace robosync::vm;

namespace {

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

void check_generated(const std::string& part, const std::string& wanted) {
  robosync::testing::expect_generated(
      std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "docs/bytecode.md", part, wanted);
}

}  // namespace

TEST_CASE("docs/bytecode.md has the opcodes of opcodes.def") {
  check_generated("opcodes", opcode_table());
}

TEST_CASE("docs/bytecode.md has the sections of sections.def, in their order") {
  const std::string page =
      robosync::testing::read_file(std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "docs/bytecode.md");
  std::size_t at = 0;
  for (std::size_t s = 1; describe(static_cast<Section>(s)) != "an unknown section"; ++s) {
    const std::string row = "| " + std::string(describe(static_cast<Section>(s))) + " | `";
    CAPTURE(row);
    at = page.find(row, at);
    REQUIRE(at != std::string::npos);
  }
  CHECK(at != 0);
}

TEST_CASE("docs/bytecode.md has the refusals of refusals.def") {
  check_generated("refusals", refusal_table());
}
