#include "tests/generators/images/draft.hpp"

#include <algorithm>
#include <cstring>

#include "tests/support/operands.hpp"

namespace robosync::fuzz {

using namespace vm;  // the names of sections.def

const std::array<SectionInfo, kSectionCount> kSections = {{
    {0, 0, 0},
#define IMAGE_SECTION(records, Record, Count, check, name) \
  {sizeof(Record), offsetof(ImageHeader, records), sizeof(Count)},
#include "vm/sections.def"
#undef IMAGE_SECTION
}};

namespace {

constexpr std::size_t padded(std::size_t bytes) {
  return (bytes + 3) / 4 * 4;
}

}  // namespace

void Draft::assign(std::span<const std::byte> bytes) {
  size_ = std::min(bytes.size(), kCapacity);
  std::copy_n(bytes.begin(), size_, bytes_.begin());
  look();
}

void Draft::look() {
  sound_ = vm::view_image(bytes(), view_);
  std::size_t next = sizeof(ImageHeader);
  for (std::size_t s = 1; s < kSectionCount; ++s) {
    places_[s] = static_cast<std::uint32_t>(next);
    next += padded(count(static_cast<Section>(s)) * kSections[s].record_size);
  }
  places_[kSectionCount] = static_cast<std::uint32_t>(next);
}

void Draft::resize(std::size_t size) {
  size = std::min(size, kCapacity);
  if (size > size_) std::fill(bytes_.begin() + size_, bytes_.begin() + size, std::byte{0x5A});
  size_ = size;
  sound_ = false;
}

std::size_t Draft::count(Section section) const {
  const SectionInfo& info = kSections[static_cast<std::size_t>(section)];
  std::size_t count = 0;
  std::memcpy(&count, bytes_.data() + info.count_place, info.count_size);
  return count;
}

void Draft::set_count(Section section, std::size_t count) {
  const SectionInfo& info = kSections[static_cast<std::size_t>(section)];
  std::memcpy(bytes_.data() + info.count_place, &count, info.count_size);
}

std::span<std::byte> Draft::record(Section section, std::size_t index) {
  const auto s = static_cast<std::size_t>(section);
  const std::size_t size = kSections[s].record_size;
  return {bytes_.data() + places_[s] + index * size, size};
}

bool Draft::insert(Section section, std::size_t index, std::size_t count) {
  const auto s = static_cast<std::size_t>(section);
  const SectionInfo& info = kSections[s];
  const std::size_t records = this->count(section);
  const std::size_t most = info.count_size == 1 ? 0xFF : 0xFFFF;
  const std::size_t old_size = records * info.record_size;
  const std::size_t new_size = old_size + count * info.record_size;
  const std::size_t grown = padded(new_size) - padded(old_size);
  if (records + count > most || size_ + grown > kCapacity) return false;
  std::byte* const begin = bytes_.data() + places_[s];
  std::byte* const behind = begin + padded(old_size);
  std::memmove(behind + grown, behind, size_ - static_cast<std::size_t>(behind - bytes_.data()));
  std::byte* const at = begin + index * info.record_size;
  std::memmove(at + count * info.record_size, at, old_size - index * info.record_size);
  std::memset(at, 0, count * info.record_size);
  std::memset(begin + new_size, 0, padded(new_size) - new_size);
  size_ += grown;
  set_count(section, records + count);
  header().total_length = static_cast<std::uint32_t>(size_);
  look();
  return true;
}

void Draft::erase(Section section, std::size_t index, std::size_t count) {
  const auto s = static_cast<std::size_t>(section);
  const SectionInfo& info = kSections[s];
  const std::size_t records = this->count(section);
  const std::size_t old_size = records * info.record_size;
  const std::size_t new_size = old_size - count * info.record_size;
  const std::size_t shrunk = padded(old_size) - padded(new_size);
  std::byte* const begin = bytes_.data() + places_[s];
  std::byte* const at = begin + index * info.record_size;
  std::memmove(at, at + count * info.record_size, new_size - index * info.record_size);
  std::memset(begin + new_size, 0, padded(old_size) - new_size);
  std::byte* const behind = begin + padded(old_size);
  std::memmove(behind - shrunk, behind, size_ - static_cast<std::size_t>(behind - bytes_.data()));
  size_ -= shrunk;
  set_count(section, records - count);
  header().total_length = static_cast<std::uint32_t>(size_);
  look();
}

std::optional<Object> Draft::object_of(std::size_t rule, Part part) const {
  if (rule >= view_.rules.size()) return std::nullopt;
  std::size_t b = 0;
  while (b < view_.behaviors.size() &&
         rule - view_.behaviors[b].first_rule >= view_.behaviors[b].rule_count)
    ++b;
  if (b == view_.behaviors.size()) return std::nullopt;
  const vm::Rule& record = view_.rules[rule];
  Object object{
      b, rule, part, record.condition_start, record.condition_length, vm::Context::condition};
  if (part != Part::condition) {
    const auto index = part == Part::then_response ? record.then_response : record.else_response;
    if (index >= view_.responses.size()) return std::nullopt;
    object.start = view_.responses[index].start;
    object.length = view_.responses[index].length;
    object.context =
        record.kind == vm::RuleKind::safety ? vm::Context::safety : vm::Context::response;
  }
  if (object.length == 0 || object.start + object.length > view_.code.size()) return std::nullopt;
  return object;
}

std::optional<Object> Draft::object(Random& random) {
  if (!sound_ || view_.rules.empty()) return std::nullopt;
  const std::size_t rule = random.below(view_.rules.size());
  const std::uint32_t draw = random.below(8);
  const Part part = draw < 3   ? Part::condition
                    : draw < 7 ? Part::then_response
                               : Part::else_response;
  return object_of(rule, part);
}

// `by` words come before (or, less than 0, go at) the word `at` of the object.
void Draft::move_jumps(const Object& object, std::size_t at, std::ptrdiff_t by) {
  for (std::size_t w = object.start; w < object.start + object.length; ++w) {
    const Word before = word(w);
    if (!is_opcode(before)) continue;
    const Distance distance = distance_of(vm::opcode_of(before));
    if (distance.jump == Jump::none) continue;
    const std::size_t far = operand(before, distance.place);
    const bool crosses =
        distance.jump == Jump::ahead ? w < at && w + 1 + far > at : w >= at && w + 1 <= at + far;
    if (!crosses) continue;
    const auto moved = static_cast<std::ptrdiff_t>(far) + by;
    word(w) = with_operand(before, distance.place, static_cast<unsigned>(moved));
  }
}

void Draft::move_objects(std::size_t at, std::ptrdiff_t by) {
  const auto move = [&](std::uint16_t& start, std::uint16_t& length) {
    if (start > at)
      start = static_cast<std::uint16_t>(start + by);
    else if (at < std::size_t{start} + length)
      length = static_cast<std::uint16_t>(length + by);
  };
  for (std::size_t i = 0; i < count(Section::rules); ++i) {
    auto& rule = as<vm::Rule>(Section::rules, i);
    move(rule.condition_start, rule.condition_length);
  }
  for (std::size_t i = 0; i < count(Section::responses); ++i) {
    auto& response = as<vm::Response>(Section::responses, i);
    move(response.start, response.length);
  }
}

bool Draft::insert_words(const Object& object, std::size_t at, std::span<const Word> words,
                         bool mend) {
  if (count(Section::code) + words.size() > 0xFFFF || size_ + 4 * words.size() > kCapacity)
    return false;
  if (mend) move_jumps(object, at, static_cast<std::ptrdiff_t>(words.size()));
  if (!insert(Section::code, at, words.size())) return false;
  for (std::size_t i = 0; i < words.size(); ++i)
    word(at + i) = words[i];
  move_objects(at, static_cast<std::ptrdiff_t>(words.size()));
  return true;
}

void Draft::erase_words(const Object& object, std::size_t at, std::size_t count, bool mend) {
  for (; count > 0; --count) {
    if (mend) move_jumps(object, at, -1);
    erase(Section::code, at, 1);
    move_objects(at, -1);
  }
}

bool Draft::replace(const Object& object, std::span<const Word> words) {
  const std::size_t same = std::min(words.size(), object.length);
  if (words.size() > same) {
    if (!insert_words(object, object.start, words.subspan(same), false)) return false;
  } else {
    erase_words(object, object.start, object.length - same, false);
  }
  for (std::size_t i = 0; i < words.size(); ++i)
    word(object.start + i) = words[i];
  return true;
}

void Draft::put_crc() {
  if (size_ < sizeof(ImageHeader)) return;
  header().crc32 = fast_crc32(bytes().subspan(offsetof(ImageHeader, total_length)));
}

}  // namespace robosync::fuzz
