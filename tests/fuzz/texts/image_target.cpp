// Images as somebody forges them who knows the format: the checksum is right, and so is the declared cost. What the verifier
// accepts is run, each instruction checked (exercise.hpp).
#include <array>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "tests/fuzz/exercise.hpp"
#include "tests/fuzz/host_engine.hpp"
#include "tests/fuzz/texts/require.hpp"
#include "tests/fuzz/texts/targets.hpp"
#include "vm/disassembler.hpp"
#include "vm/identity.hpp"
#include "vm/verifier.hpp"

namespace robosync::fuzz {
namespace {

constexpr std::uint64_t kSeed = 1;  // of the values that an accepted image computes with

// Of bytes that are as long as a header.
void declare_cost(std::span<std::byte> bytes) {
  vm::Image view;
  if (!vm::view_image(bytes, view)) return;
  const std::uint32_t cost = vm::step_cost(view);
  std::memcpy(bytes.data() + offsetof(vm::ImageHeader, step_cost), &cost, sizeof cost);
  vm::seal(bytes);
}

}  // namespace

void image(std::string_view input) {
  std::vector<std::uint64_t> words((input.size() + 7) / 8);  // an image is aligned to four bytes
  const std::span bytes(reinterpret_cast<std::byte*>(words.data()), input.size());
  input.copy(reinterpret_cast<char*>(bytes.data()), input.size());
  if (bytes.size() >= sizeof(vm::ImageHeader)) vm::seal(bytes);
  vm::Image view;
  vm::Verdict verdict = vm::verify(bytes, vm::Limits{}, view);
  if (verdict.refusal == vm::Refusal::cost_differs) {
    declare_cost(bytes);
    verdict = vm::verify(bytes, vm::Limits{}, view);
  }
  if (!verdict.ok()) return;
  std::array<char, 128> line{};
  for (const vm::Word word : view.code)
    (void)vm::disassemble(view, word, line);
  static HostEngine engine([](const char* what) { require(false, what); });
  const Facts facts = exercise(view, kSeed, engine);
  require(facts.worst <= view.header->step_cost, "a step costs more than declared");
}

}  // namespace robosync::fuzz
