// Builds images for tests, right ones and wrong ones: fill in records, build(), and, for damage
// that the builder would not make, patch the header or the bytes. companion.hpp has a good one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vm/identity.hpp"
#include "vm/image.hpp"
#include "vm/opcode.hpp"
#include "vm/timers.hpp"
#include "vm/verifier.hpp"

namespace robosync::vm::test {

// std::vector's memory is aligned for any record.
using Bytes = std::vector<std::byte>;

inline void repair_crc(std::span<std::byte> bytes) {
  if (bytes.size() >= sizeof(ImageHeader)) seal(bytes);
}

struct ImageBuilder {
  std::vector<Sensor> sensors;
  std::vector<Channel> channels;
  std::vector<Actuator> actuators;
  std::vector<Group> groups;
  std::vector<Verb> verbs;
  std::vector<WordEntry> words;
  std::vector<Variable> variables;
  std::vector<Check> checks;
  std::vector<Band> bands;
  std::vector<Behavior> behaviors;
  std::vector<Modifiers> modifiers;
  std::vector<Timer> timers;
  std::vector<Rule> rules;
  std::vector<Response> responses;
  std::vector<std::uint8_t> inputs;
  std::vector<Value> constants;
  std::vector<Word> code;
  std::vector<std::uint16_t> labels;
  std::string strings;
  std::vector<SourceLine> source_lines;
  std::vector<Adaptation> adaptations;
  std::vector<Trait> traits;
  std::vector<Motion> motions;
  std::vector<Track> tracks;
  std::vector<Key> keys;
  // Applied to the finished header, before the CRC.
  std::function<void(ImageHeader&)> patch_header = [](ImageHeader&) {};

  std::uint16_t name(std::string_view text) {
    const auto offset = static_cast<std::uint16_t>(strings.size());
    strings.append(text).push_back('\0');
    return offset;
  }
  std::uint16_t constant(Value value) {
    const auto place = std::find(constants.begin(), constants.end(), value);
    const auto index = static_cast<std::uint16_t>(place - constants.begin());
    if (place == constants.end()) constants.push_back(value);
    return index;
  }
  // Appends labels; the place of the first.
  std::uint16_t add_labels(std::initializer_list<std::string_view> texts) {
    const auto first = static_cast<std::uint16_t>(labels.size());
    for (const std::string_view text : texts)
      labels.push_back(name(text));
    return first;
  }
  // Appends a timer, with the memory behind that of the one before; its index.
  unsigned timer(TimerKind kind, Value duration, std::uint8_t count = 0) {
    unsigned state = 0;
    for (const Timer& before : timers)
      state += timer_words(before);
    timers.push_back({kind, count, static_cast<std::uint16_t>(state), duration});
    return static_cast<unsigned>(timers.size() - 1);
  }
  // Appends a code object; its start.
  std::uint16_t object(std::initializer_list<Word> object_words) {
    const auto start = static_cast<std::uint16_t>(code.size());
    code.insert(code.end(), object_words);
    return start;
  }
  std::uint16_t response(std::uint32_t mask, std::initializer_list<Word> object_words) {
    const std::uint16_t start = object(object_words);
    responses.push_back({start, static_cast<std::uint16_t>(object_words.size()), mask});
    return static_cast<std::uint16_t>(responses.size() - 1);
  }
  void rule(std::uint16_t then_response, std::uint16_t else_response,
            std::initializer_list<Word> condition, std::uint16_t line = 1) {
    rule_of(else_response == kNoIndex ? RuleKind::when : RuleKind::when_else, then_response,
            condition, line);
    rules.back().else_response = else_response;
  }
  void rule_of(RuleKind kind, std::uint16_t then_response, std::initializer_list<Word> condition,
               std::uint16_t line = 1) {
    const std::uint16_t start = condition.size() == 0 ? std::uint16_t{0} : object(condition);
    rules.push_back({start, static_cast<std::uint16_t>(condition.size()), then_response, kNoIndex,
                     line, kind, kNoModifiers});
  }

  [[nodiscard]] Bytes build() const {
    Bytes bytes(sizeof(ImageHeader));
#define IMAGE_SECTION(records, Record, Count, check, name) append(bytes, records);
#include "vm/sections.def"
#undef IMAGE_SECTION
    ImageHeader header = counts();
    header.total_length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(bytes.data(), &header, sizeof header);
    Image view;
    if (view_image(bytes, view)) header.step_cost = step_cost(view);
    patch_header(header);
    std::memcpy(bytes.data(), &header, sizeof header);
    repair_crc(bytes);
    return bytes;
  }

private:
  template <typename Records>
  static void append(Bytes& bytes, const Records& records) {
    const auto raw = std::as_bytes(std::span(records));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
    while (bytes.size() % 4 != 0)
      bytes.push_back(std::byte{0});
  }
  [[nodiscard]] ImageHeader counts() const {
    ImageHeader header{};
    header.magic = kMagic;
    header.format_major = kFormatMajor;
    header.opcode_set = opcode_set_id();
#define IMAGE_SECTION(records, Record, Count, check, name) \
  header.records = static_cast<Count>(records.size());
#include "vm/sections.def"
#undef IMAGE_SECTION
    return header;
  }
};

}  // namespace robosync::vm::test
