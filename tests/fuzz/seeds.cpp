#include "tests/fuzz/seeds.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>

#include "tests/support/operands.hpp"
#include "tests/vm/companion.hpp"

namespace robosync::fuzz {
namespace {

using vm::kNoIndex;
using vm::test::ImageBuilder;

// One behaviour of an image with the code, constants, timers and inputs that it uses.
class Carver {
public:
  Carver(const vm::Image& image, const vm::Behavior& behavior)
      : image_(image), behavior_(behavior) {}

  Seed carve() {
    take_wiring();
    const auto inputs = image_.inputs.subspan(behavior_.first_input, behavior_.input_count);
    out_.inputs.assign(inputs.begin(), inputs.end());
    for (std::size_t r = 0; r < behavior_.rule_count; ++r)
      take_rule(image_.rules[behavior_.first_rule + r]);
    vm::Behavior behavior = behavior_;
    if (behavior.name != kNoIndex) behavior.name = 0;
    behavior.first_rule = behavior.first_input = 0;
    out_.behaviors.push_back(behavior);
    return out_.build();
  }

private:
  template <typename Record>
  static void take(std::span<const Record> from, std::vector<Record>& to) {
    to.assign(from.begin(), from.end());
    for (Record& record : to)
      record.name = 0;
  }
  // All of it: code and records refer to it by number.
  void take_wiring() {
    out_.name("text");
    take(image_.sensors, out_.sensors);
    take(image_.channels, out_.channels);
    take(image_.actuators, out_.actuators);
    take(image_.groups, out_.groups);
    take(image_.verbs, out_.verbs);
    take(image_.words, out_.words);
    take(image_.variables, out_.variables);
    out_.labels.assign(image_.labels.size(), 0);
    out_.checks.assign(image_.checks.begin(), image_.checks.end());
    out_.bands.assign(image_.bands.begin(), image_.bands.end());
  }
  void take_rule(vm::Rule rule) {
    if (rule.condition_length > 0)
      rule.condition_start = take_code(rule.condition_start, rule.condition_length);
    rule.then_response = take_response(rule.then_response);
    rule.else_response = take_response(rule.else_response);
    if (rule.modifiers != vm::kNoModifiers) {
      out_.modifiers.push_back(image_.modifiers[rule.modifiers]);
      rule.modifiers = static_cast<std::uint8_t>(out_.modifiers.size() - 1);
    }
    out_.rules.push_back(rule);
  }
  std::uint16_t take_response(std::uint16_t index) {
    if (index == kNoIndex) return kNoIndex;
    const auto [place, is_new] = responses_.try_emplace(index, out_.responses.size());
    if (is_new) {
      vm::Response response = image_.responses[index];
      response.start = take_code(response.start, response.length);
      out_.responses.push_back(response);
    }
    return static_cast<std::uint16_t>(place->second);
  }
  std::uint16_t take_code(std::size_t start, std::size_t length) {
    const auto at = static_cast<std::uint16_t>(out_.code.size());
    for (std::size_t w = start; w < start + length; ++w)
      out_.code.push_back(take_word(image_.code[w]));
    return at;
  }
  Word take_word(Word word) {
    for (std::size_t place = 0; place < kPlaces; ++place) {
      const unsigned value = operand(word, place);
      const Operand kind = kind_of(word, place);
      if (kind == Operand::const8 || kind == Operand::const16)
        word = with_operand(word, place, out_.constant(image_.constants[value]));
      if (kind == Operand::timer) {
        const vm::Timer& timer = image_.timers[value];
        word = with_operand(word, place, out_.timer(timer.kind, timer.duration, timer.count));
      }
      if (kind == Operand::string) word = with_operand(word, place, 0);
    }
    return word;
  }

  const vm::Image& image_;
  const vm::Behavior& behavior_;
  ImageBuilder out_;
  std::map<std::uint16_t, std::size_t> responses_;
};

// The costs in opcodes.def may be others than when the image was compiled.
void declare_cost(Seed& bytes) {
  vm::Image view;
  if (!vm::view_image(bytes, view)) return;
  const std::uint32_t cost = vm::step_cost(view);
  std::memcpy(bytes.data() + offsetof(vm::ImageHeader, step_cost), &cost, sizeof cost);
  vm::test::repair_crc(bytes);
}

void add(Seeds& seeds, Seed bytes, const std::string& name) {
  declare_cost(bytes);
  vm::Image image;
  if (!vm::verify(bytes, {}, image).ok()) throw std::runtime_error(name + " is refused");
  for (const vm::Behavior& behavior : image.behaviors) {
    Seed carved = Carver(image, behavior).carve();
    vm::Image view;
    // A mask of groups may be wider than what is left: such a one is not used.
    if (vm::verify(carved, {}, view).ok()) seeds.carved.push_back(std::move(carved));
  }
  seeds.whole.push_back(std::move(bytes));
}

Seed read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

Seeds load_seeds(const std::string& folder) {
  Seeds seeds;
  add(seeds, vm::test::companion::make().build(), "the companion");
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".rsb") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  if (paths.empty()) throw std::runtime_error("no images in " + folder);
  for (const auto& path : paths)
    add(seeds, read(path), path.string());
  return seeds;
}

}  // namespace robosync::fuzz
