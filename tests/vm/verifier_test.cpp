// The verifier as a whole: what it accepts, the header, the limits, the strings. A good image is
// made wrong in one place, and exactly that place refused. Records: verifier_records_test.cpp;
// code: verifier_code_test.cpp and verifier_flow_test.cpp.
#include "vm/verifier.hpp"

#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"
#include "tests/vm/refusal_checks.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
namespace robot = robosync::vm::test::companion;

namespace {

void check_header(Refusal refusal, const std::function<void(ImageHeader&)>& wrong,
                  const Limits& limits = {}) {
  ImageBuilder image = robot::make();
  image.patch_header = wrong;
  check_refused(image, {refusal, Section::header, 0}, limits);
}

}  // namespace

TEST_CASE("a good image is accepted and viewed") {
  const Bytes bytes = robot::make().build();
  Image image;
  const Verdict verdict = verify(bytes, {}, image);
  CAPTURE(describe(verdict.refusal), describe(verdict.section), verdict.index);
  REQUIRE(verdict.ok());
  CHECK(image.behaviors.size() == 3);
  CHECK(step_cost(image) == image.header->step_cost);
}

TEST_CASE("an image without anything is accepted") {
  const Bytes bytes = ImageBuilder{}.build();
  Image image;
  CHECK(verify(bytes, {}, image).ok());
  CHECK(step_cost(image) == 0);
}

TEST_CASE("of a refused image nothing is to be seen") {
  ImageBuilder builder = robot::make();
  builder.patch_header = [](ImageHeader& h) { ++h.step_cost; };  // noticed last
  const Bytes bytes = builder.build();
  Image image;
  CHECK_FALSE(verify(bytes, {}, image).ok());
  CHECK(image.header == nullptr);
  CHECK(image.code.empty());
}

TEST_CASE("every prefix of an image is refused") {
  const Bytes bytes = robot::make().build();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Image image;
    CHECK(verify(std::span(bytes).first(size), {}, image).refusal == Refusal::too_short);
  }
}

TEST_CASE("misaligned bytes are refused") {
  const Bytes good = robot::make().build();
  Bytes shifted(good.size() + 1);
  std::copy(good.begin(), good.end(), shifted.begin() + 1);
  Image image;
  CHECK(verify(std::span(shifted).subspan(1), {}, image).refusal == Refusal::bad_length);
}

TEST_CASE("the header is checked") {
  check_header(Refusal::bad_magic, [](auto& h) { h.magic ^= 1; });
  check_header(Refusal::wrong_version, [](auto& h) { ++h.format_major; });
  check_header(Refusal::wrong_opcodes, [](auto& h) { ++h.opcode_set; });
  check_header(Refusal::too_short, [](auto& h) { h.total_length += 4; });
  check_header(Refusal::bad_length, [](auto& h) { h.total_length -= 4; });
  check_header(Refusal::bad_length, [](auto& h) { ++h.rules; });
  check_header(Refusal::bad_length, [](auto& h) { --h.constants; });
  check_header(Refusal::bad_length, [](auto& h) { h.code = 0xFFFF; });
  check_header(Refusal::cost_differs, [](auto& h) { ++h.step_cost; });
  check_header(Refusal::cost_differs, [](auto& h) { --h.step_cost; });
  check_header(Refusal::cost_differs, [](auto& h) { h.step_cost = 0; });
}

TEST_CASE("an image for any board is accepted: whose it is, the tool looks at") {
  ImageBuilder image = robot::make();
  image.patch_header = [](auto& h) { h.board = 200; };
  Image view;
  CHECK(verify(image.build(), {}, view).ok());
}

TEST_CASE("one changed bit anywhere is a wrong checksum or worse") {
  const Bytes good = robot::make().build();
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes bytes = good;
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    Image image;
    REQUIRE_FALSE(verify(bytes, {}, image).ok());
  }
}

TEST_CASE("the board's limits hold, to the unit") {
  const Bytes bytes = robot::make().build();
  Image image;
  REQUIRE(view_image(bytes, image));
  const std::uint32_t cost = image.header->step_cost;
  const auto length = static_cast<std::uint32_t>(bytes.size());
  const auto at_limit = [&](auto field, auto value, Refusal beyond, Section section,
                            std::uint16_t index) {
    Limits limits;
    limits.*field = value;
    CHECK(verify(bytes, limits, image).ok());
    limits.*field = static_cast<decltype(value)>(value - 1);
    check_refused(bytes, {beyond, section, index}, limits);
  };
  at_limit(&Limits::image_bytes, length, Refusal::too_large, Section::header, 0);
  at_limit(&Limits::step_cost, cost, Refusal::too_costly, Section::header, 0);
  at_limit(&Limits::sensors, std::uint8_t{2}, Refusal::too_many, Section::header, 0);
  at_limit(&Limits::actuators, std::uint8_t{3}, Refusal::too_many, Section::header, 0);
  at_limit(&Limits::behaviors, std::uint8_t{3}, Refusal::too_many, Section::header, 0);
  at_limit(&Limits::rules, std::uint16_t{8}, Refusal::too_many, Section::header, 0);
  at_limit(&Limits::inputs, std::uint8_t{8}, Refusal::too_many, Section::header, 0);
  at_limit(&Limits::samples, std::uint16_t{5}, Refusal::too_many, Section::checks, 0);
  at_limit(&Limits::timer_words, std::uint16_t{10}, Refusal::too_many, Section::timers, 5);
  at_limit(&Limits::frame_cells, std::uint16_t{19}, Refusal::too_many, Section::behaviors, 2);
}

TEST_CASE("the format's own limits hold whatever the board says") {
  Limits generous;
  generous.actuators = generous.behaviors = 255;
  SECTION("actuators") {
    ImageBuilder image = robot::make();
    image.actuators.resize(kMaxActuators, image.actuators[2]);  // it has no pin, but a line
    for (std::size_t a = 3; a < kMaxActuators; ++a)
      image.actuators[a].bus = static_cast<std::uint8_t>(a);
    // STOP ALL means all of them.
    image.responses[robot::stop].actuators = image.behaviors[0].actuators = 0xFFFFFFFF;
    check_accepted(image, generous);
    image.actuators.push_back(image.actuators[0]);
    check_refused(image, {Refusal::too_many, Section::header, 0}, generous);
  }
  SECTION("verbs") {
    ImageBuilder image = robot::make();
    image.verbs.resize(kMaxVerbs, image.verbs[0]);
    check_accepted(image, generous);
    image.verbs.push_back(image.verbs[0]);
    check_refused(image, {Refusal::too_many, Section::header, 0}, generous);
  }
  SECTION("groups") {
    ImageBuilder image = robot::make();
    image.groups.resize(127, image.groups[0]);  // the 128th would be kAllActuators
    check_accepted(image, generous);
    image.groups.push_back(image.groups[0]);
    check_refused(image, {Refusal::too_many, Section::header, 0}, generous);
  }
  SECTION("inputs") {
    generous.inputs = 255;
    ImageBuilder image = robot::make();
    image.variables.resize(252, image.variables[robot::visitors]);
    check_accepted(image, generous);
    image.variables.push_back(image.variables[0]);
    check_refused(image, {Refusal::too_many, Section::header, 0}, generous);
  }
  SECTION("behaviours") {
    ImageBuilder image = robot::make();
    const auto add_behavior = [&] {
      Behavior behavior = image.behaviors[robot::back_off];
      behavior.rule_count = 1;
      behavior.actuators = 0b010;
      behavior.priority = static_cast<std::int16_t>(image.behaviors.back().priority - 1);
      behavior.first_rule = static_cast<std::uint16_t>(image.rules.size());
      image.behaviors.push_back(behavior);
      image.rules.push_back(image.rules[robot::hello]);
    };
    while (image.behaviors.size() < kMaxBehaviors)
      add_behavior();
    check_accepted(image, generous);
    add_behavior();
    check_refused(image, {Refusal::too_many, Section::header, 0}, generous);
  }
}

TEST_CASE("the string pool ends with a NUL, and names lie inside it") {
  check_refused([](auto& i) { i.strings.back() = 'x'; },
                {Refusal::bad_string, Section::strings, 0});
  const auto outside = [](ImageBuilder& i) { return static_cast<std::uint16_t>(i.strings.size()); };
  check_refused([&](auto& i) { i.sensors[1].name = outside(i); },
                {Refusal::bad_string, Section::sensors, 1});
  check_refused([&](auto& i) { i.channels[2].name = outside(i); },
                {Refusal::bad_string, Section::channels, 2});
  check_refused([&](auto& i) { i.actuators[1].name = kNoIndex; },
                {Refusal::bad_string, Section::actuators, 1});
  check_refused([&](auto& i) { i.groups[0].name = outside(i); },
                {Refusal::bad_string, Section::groups, 0});
  check_refused([&](auto& i) { i.verbs[1].name = outside(i); },
                {Refusal::bad_string, Section::verbs, 1});
  check_refused([&](auto& i) { i.words[3].name = outside(i); },
                {Refusal::bad_string, Section::words, 3});
  check_refused([&](auto& i) { i.variables[4].name = outside(i); },
                {Refusal::bad_string, Section::variables, 4});
  check_refused([&](auto& i) { i.behaviors[1].name = outside(i); },
                {Refusal::bad_string, Section::behaviors, 1});
  check_refused([&](auto& i) { i.labels[3] = outside(i); },
                {Refusal::bad_string, Section::labels, 3});
  check_refused([](auto& i) { i.strings.clear(); }, {Refusal::bad_string, Section::sensors, 0});
}

TEST_CASE("padding after odd sections is zero") {
  ImageBuilder image = robot::make();
  image.inputs.push_back(0);
  image.labels.push_back(0);
  while (image.strings.size() % 4 == 0 || image.inputs.size() % 4 == 0) {
    image.strings.push_back('\0');
    image.inputs.push_back(0);
  }
  const Bytes good = image.build();
  Image view;
  REQUIRE(view_image(good, view));
  const auto damage = [&](const void* end_of_section, Section section) {
    Bytes bytes = good;
    const auto place =
        static_cast<std::size_t>(static_cast<const std::byte*>(end_of_section) - good.data());
    bytes[place] = std::byte{7};
    repair_crc(bytes);
    check_refused(bytes, {Refusal::bad_value, section, 0});
  };
  damage(view.inputs.data() + view.inputs.size(), Section::inputs);
  damage(view.labels.data() + view.labels.size(), Section::labels);
  damage(view.strings.data() + view.strings.size(), Section::strings);
}

TEST_CASE("the texts for people") {
  CHECK(describe(Refusal::bad_crc).find("checksum") != std::string_view::npos);
  CHECK(describe(Refusal::none) == "the image may run");
  CHECK(describe(static_cast<Refusal>(200)) == "an unknown reason");
  CHECK(describe(Section::source_lines) == "source lines");
  CHECK(describe(Section::adaptations) == "adaptation");
  CHECK(describe(static_cast<Section>(200)) == "an unknown section");
}
