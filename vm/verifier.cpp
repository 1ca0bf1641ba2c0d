// The verifier: checks the header and the checksum, then the records, then the code of all rules, and
// that the code does no more than the records declare.
//
// The work is linear in the image, except for code: code is checked once for every rule that uses it,
// and that is bounded (check_code).
#include "vm/verifier.hpp"

#include <algorithm>

#include "vm/verify_object.hpp"

namespace robosync::vm {
namespace {

constexpr std::uint16_t kOpcodeSet = opcode_set_id();

// kAllActuators must not be the number of a group.
constexpr unsigned kMaxGroups = kAllActuators - kGroupBit;

bool are_too_many(const ImageHeader& header, const Limits& limits) {
  const unsigned inputs = unsigned{header.channels} + header.variables;
  return header.sensors > limits.sensors || header.actuators > limits.actuators ||
         header.behaviors > limits.behaviors || header.rules > limits.rules ||
         inputs > limits.inputs || inputs > kMaxInputs || header.actuators > kMaxActuators ||
         header.behaviors > kMaxBehaviors || header.verbs > kMaxVerbs || header.groups > kMaxGroups;
}

// Everything that must be true before any section can be read.
Refusal check_header(std::span<const std::byte> bytes, const Limits& limits, Image& image) {
  if (bytes.size() < sizeof(ImageHeader)) return Refusal::too_short;
  const bool sections_fit = view_image(bytes, image);
  if (image.header == nullptr) return Refusal::bad_length;  // not 4-aligned: the caller's error
  const ImageHeader& header = *image.header;
  if (header.magic != kMagic) return Refusal::bad_magic;
  if (header.format_major != kFormatMajor) return Refusal::wrong_version;
  if (header.total_length > bytes.size()) return Refusal::too_short;
  if (!sections_fit) return Refusal::bad_length;
  if (bytes.size() > limits.image_bytes) return Refusal::too_large;
  constexpr std::size_t kCovered = offsetof(ImageHeader, total_length);
  if (crc32(bytes.subspan(kCovered)) != header.crc32) return Refusal::bad_crc;
  if (header.opcode_set != kOpcodeSet) return Refusal::wrong_opcodes;
  if (header.adaptations > 1) return Refusal::bad_value;
  if (are_too_many(header, limits)) return Refusal::too_many;
  return header.step_cost > limits.step_cost ? Refusal::too_costly : Refusal::none;
}

constexpr std::string_view kRefusalTexts[] = {
    "the image may run",
#define REFUSAL(name, text) text,
#include "vm/refusals.def"
#undef REFUSAL
};

constexpr std::string_view kSectionNames[] = {
    "header",
#define IMAGE_SECTION(records, Record, Count, check, name) name,
#include "vm/sections.def"
#undef IMAGE_SECTION
};

// Checks a response and computes its cost; 0 if there is none.
bool check_response(Frame& frame, const Rule& rule, std::uint16_t index, std::uint32_t& cost) {
  cost = 0;
  if (index == kNoIndex) return true;
  const Response& response = frame.verification.image.responses[index];
  const ObjectKind kind = rule.kind == RuleKind::safety ? ObjectKind::safety : ObjectKind::response;
  std::uint32_t actuators = 0;
  if (!check_object(frame, kind, {response.start, response.length}, cost, actuators)) return false;
  if (actuators != response.actuators)
    return frame.verification.refuse(Refusal::mask_differs, Section::responses, index);
  frame.actuators |= actuators;
  return true;
}

// A response shared by several rules is checked for each, because the meaning of its words depends on
// the frame of the behaviour that runs it. An image cannot make that take long: at most as many words
// are checked as the board allows instructions in one step (check_object).
bool check_code(Verification& verification) {
  const Image& image = verification.image;
  for (std::size_t b = 0; b < image.behaviors.size(); ++b) {
    const Behavior& behavior = image.behaviors[b];
    Frame frame(verification, behavior);
    for (std::size_t r = 0; r < behavior.rule_count; ++r) {
      RuleCost cost;
      if (!check_rule(frame, image.rules[behavior.first_rule + r], cost)) return false;
      verification.step_cost += cost.step();
    }
    if (frame.actuators != behavior.actuators)
      return verification.refuse(Refusal::mask_differs, Section::behaviors, b);
  }
  return true;
}

}  // namespace

std::string_view describe(Refusal refusal) {
  const auto index = static_cast<std::size_t>(refusal);
  return index < std::size(kRefusalTexts) ? kRefusalTexts[index] : "an unknown reason";
}

std::string_view describe(Section section) {
  const auto index = static_cast<std::size_t>(section);
  return index < std::size(kSectionNames) ? kSectionNames[index] : "an unknown section";
}

bool Verification::refuse(Refusal refusal, Section section, std::size_t index) {
  verdict = {refusal, section, static_cast<std::uint16_t>(index)};
  return false;
}

bool check_rule(Frame& frame, const Rule& rule, RuleCost& cost) {
  if (!check_response(frame, rule, rule.then_response, cost.then_response) ||
      !check_response(frame, rule, rule.else_response, cost.else_response))
    return false;
  if (rule.condition_length == 0) return true;
  const ObjectKind kind = rule.kind == RuleKind::every ? ObjectKind::period : ObjectKind::condition;
  std::uint32_t none = 0;
  return check_object(frame, kind, {rule.condition_start, rule.condition_length}, cost.condition,
                      none);
}

Verdict verify(std::span<const std::byte> bytes, const Limits& limits, Image& image) {
  Verification verification(image, limits);
  verification.verdict.refusal = check_header(bytes, limits, image);
  bool good = verification.verdict.ok() && check_records(verification) && check_code(verification);
  if (good && verification.step_cost != image.header->step_cost)
    good = verification.refuse(Refusal::cost_differs, Section::header, 0);
  if (!good) image = {};
  return verification.verdict;
}

std::uint32_t step_cost(const Image& image) {
  Limits limits;
  limits.step_cost = UINT32_MAX;
  limits.frame_cells = limits.timer_words = limits.samples = UINT16_MAX;
  Verification verification(image, limits);
  if (!check_records(verification) || !check_code(verification)) return 0;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(verification.step_cost, UINT32_MAX));
}

}  // namespace robosync::vm
