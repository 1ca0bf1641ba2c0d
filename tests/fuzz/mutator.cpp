#include "tests/fuzz/mutator.hpp"

#include <algorithm>
#include <cstring>

#include "tests/generators/images/writer.hpp"

namespace robosync::fuzz {

using vm::ImageHeader;

namespace {

constexpr std::uint32_t kEdgeWords[] = {
    0,   1,   2,   31,   32,     33,     63,         64,         127,        128,
    254, 255, 256, 1000, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0x80000001, 0xFFFFFFFF};

}  // namespace

void Mutator::mutate(Draft& draft) {
  for (auto left = 1 + random_.below(4); left > 0 && draft.sound(); --left)
    change(draft);
  draft.put_crc();
  if (random_.one_in(500)) draft.bytes()[random_.below(draft.bytes().size())] ^= std::byte{1};
}

void Mutator::change(Draft& draft) {
  const std::uint32_t draw = random_.below(128);
  if (draw < 80) {
    if (const auto object = draft.object(random_)) return change_code(draft, *object);
    return change_record(draft);
  }
  if (draw < 110) return change_record(draft);
  if (draw < 118) return change_records(draft);
  if (draw < 121) return splice_section(draft);
  if (draw < 124) return change_header(draft);
  if (draw < 126) return change_bytes(draft);
  if (draw < 127) return change_size(draft);
  never_grow_stale(draft);
}

void Mutator::change_code(Draft& draft, const Object& object) {
  const std::uint32_t draw = random_.below(32);
  if (draw < 10) return change_operand(draft, object);
  if (draw < 14) return change_opcode(draft, object);
  if (draw < 18) return insert_word(draft, object);
  if (draw < 21) {
    if (object.length < 2) return;
    return draft.erase_words(object, place_in(object), 1, !random_.one_in(8));
  }
  if (draw < 23) return swap_words(draft, object);
  if (draw < 24) return repeat_words(draft, object);
  if (draw < 26) return change_distance(draft, object);
  if (draw < 28) return splice_object(draft, object);
  Writer writer(draft, object, random_);
  draft.replace(object, writer.grow());
}

// What stands before the word decides what is likely to be right in it.
void Mutator::change_operand(Draft& draft, const Object& object) {
  const std::size_t at = place_in(object);
  const Word before = draft.word(at);
  if (!is_opcode(before)) return;
  const std::size_t place = random_.below(kPlaces);
  const unsigned now = operand(before, place);
  unsigned then = 0;
  switch (random_.below(8)) {
    case 0:
      then = now + 1;
      break;
    case 1:
      then = now - 1;
      break;
    case 2:
      then = random_.next();
      break;
    default: {
      Drawer drawer(draft, object, random_);
      for (std::size_t w = object.start; w < at; ++w)
        drawer.learn(draft.word(w));
      then = drawer.draw(before, place);
    }
  }
  draft.word(at) = with_operand(before, place, then);
}

void Mutator::change_opcode(Draft& draft, const Object& object) {
  const std::size_t at = place_in(object);
  const Word before = draft.word(at);
  if (random_.one_in(16)) {
    draft.word(at) = (before & ~0xFFU) | random_.below(256);
    return;
  }
  const auto opcode = static_cast<Opcode>(random_.below(kOpcodeCount));
  if (is_opcode(before) && look_alike(opcode, vm::opcode_of(before))) {
    draft.word(at) = (before & ~0xFFU) | static_cast<Word>(opcode);
    return;
  }
  Drawer drawer(draft, object, random_);
  for (std::size_t w = object.start; w < at; ++w)
    drawer.learn(draft.word(w));
  Word word = drawer.instruction(opcode);
  const Distance distance = distance_of(opcode);
  if (distance.jump != Jump::none) word = with_operand(word, distance.place, random_.below(4));
  draft.word(at) = word;
}

void Mutator::insert_word(Draft& draft, const Object& object) {
  const std::size_t at = place_in(object);
  Drawer drawer(draft, object, random_);
  for (std::size_t w = object.start; w < at; ++w)
    drawer.learn(draft.word(w));
  const Word word = random_.one_in(4)
                        ? drawer.instruction(static_cast<Opcode>(random_.below(kOpcodeCount)))
                        : drawer.plain();
  draft.insert_words(object, at, std::span(&word, 1), !random_.one_in(8));
}

void Mutator::swap_words(Draft& draft, const Object& object) {
  if (object.length < 2) return;
  const std::size_t at = object.start + random_.below(object.length - 1);
  std::swap(draft.word(at), draft.word(at + 1));
}

void Mutator::repeat_words(Draft& draft, const Object& object) {
  if (object.length > 200) return;
  const std::size_t from = place_in(object);
  const std::size_t most = std::min<std::size_t>(object.start + object.length - from, 16);
  std::array<Word, 16> copy{};
  const std::size_t length = 1 + random_.below(most);
  for (std::size_t i = 0; i < length; ++i)
    copy[i] = draft.word(from + i);
  draft.insert_words(object, from, std::span(copy).first(length), true);
}

void Mutator::change_distance(Draft& draft, const Object& object) {
  const std::size_t first = random_.below(object.length);
  for (std::size_t i = 0; i < object.length; ++i) {
    const std::size_t at = object.start + (first + i) % object.length;
    const Word before = draft.word(at);
    if (!is_opcode(before)) continue;
    const Distance distance = distance_of(vm::opcode_of(before));
    if (distance.jump == Jump::none) continue;
    const unsigned far = operand(before, distance.place);
    const unsigned by = 1 + random_.below(random_.one_in(8) ? 300 : 3);
    draft.word(at) = with_operand(before, distance.place, random_.one_in(2) ? far + by : far - by);
    return;
  }
}

// An object of another image, some of its operands drawn anew.
void Mutator::splice_object(Draft& draft, const Object& object) {
  donor_.assign(donors_[random_.below(donors_.size())]);
  const auto other = donor_.object(random_);
  if (!other || other->length > 100) return;
  std::array<Word, 100> words{};
  Drawer drawer(draft, object, random_);
  for (std::size_t i = 0; i < other->length; ++i) {
    Word word = donor_.word(other->start + i);
    for (std::size_t place = 0; is_opcode(word) && place < kPlaces; ++place) {
      const Operand kind = kind_of(word, place);
      const bool distance =
          kind == Operand::ahead || kind == Operand::ahead8 || kind == Operand::back;
      if (distance || kind == Operand::none || random_.below(4) != 0) continue;
      word = with_operand(word, place, drawer.draw(word, place));
    }
    drawer.learn(word);
    words[i] = word;
  }
  draft.replace(object, std::span(words).first(other->length));
}

Section Mutator::section_with(const Draft& draft) {
  Section section = Section::rules;
  for (int tries = 0; tries < 20; ++tries) {
    section = static_cast<Section>(1 + random_.below(kSectionCount - 1));
    if (draft.count(section) > 0) break;
  }
  return section;
}

void Mutator::change_record(Draft& draft) {
  const Section section = section_with(draft);
  const std::size_t count = draft.count(section);
  if (count == 0) return;
  const std::size_t index = random_.below(count);
  change_field(draft.record(section, index), draft.record(section, random_.below(count)));
}

// Too rare to be hit by chance: a sensor that SAFETY may read.
void Mutator::never_grow_stale(Draft& draft) {
  const std::size_t count = draft.count(Section::channels);
  if (count == 0) return;
  const std::span<std::byte> record = draft.record(Section::channels, random_.below(count));
  std::memset(record.data() + offsetof(vm::Channel, stale_ms), 0, sizeof(vm::Channel::stale_ms));
}

// One number of 1, 2 or 4 bytes at a place where one may stand.
void Mutator::change_field(std::span<std::byte> record, std::span<const std::byte> neighbour) {
  std::size_t width = std::size_t{1} << random_.below(3);
  while (width > record.size())
    width /= 2;
  const std::size_t at = random_.below(record.size() / width) * width;
  std::uint32_t value = 0;
  std::memcpy(&value, record.data() + at, width);
  switch (random_.below(8)) {
    case 0:
      ++value;
      break;
    case 1:
      --value;
      break;
    case 2:
      value ^= 1U << random_.below(8 * width);
      break;
    case 3:
      value = random_.next();
      break;
    case 4:
      value = random_.below(16);
      break;
    case 5:
      value = kEdgeWords[random_.below(std::size(kEdgeWords))];
      break;
    default:
      std::memcpy(&value, neighbour.data() + at, width);
      break;
  }
  std::memcpy(record.data() + at, &value, width);
}

// One more record, like another, or one less, or two change places.
void Mutator::change_records(Draft& draft) {
  const Section section = section_with(draft);
  const std::size_t count = draft.count(section);
  if (count == 0 || section == Section::code) return;
  const std::size_t index = random_.below(count);
  const std::size_t other = random_.below(count);
  switch (random_.below(3)) {
    case 0: {
      std::array<std::byte, 64> copy{};
      const auto like = draft.record(section, other);
      std::copy(like.begin(), like.end(), copy.begin());
      if (!draft.insert(section, index, 1)) return;
      const auto record = draft.record(section, index);
      std::copy_n(copy.begin(), record.size(), record.begin());
      return;
    }
    case 1:
      return draft.erase(section, index, 1);
    default: {
      const auto left = draft.record(section, index);
      const auto right = draft.record(section, other);
      if (index != other) std::swap_ranges(left.begin(), left.end(), right.begin());
    }
  }
}

// A whole section of another image.
void Mutator::splice_section(Draft& draft) {
  donor_.assign(donors_[random_.below(donors_.size())]);
  const Section section = section_with(donor_);
  const std::size_t given = donor_.count(section);
  const std::size_t present = draft.count(section);
  if (given > present) {
    if (!draft.insert(section, present, given - present)) return;
  } else {
    draft.erase(section, given, present - given);
  }
  for (std::size_t i = 0; i < given; ++i) {
    const auto from = donor_.record(section, i);
    std::copy(from.begin(), from.end(), draft.record(section, i).begin());
  }
}

// Counts and what stands before them; the sections may no longer fit.
void Mutator::change_header(Draft& draft) {
  const auto bytes = draft.bytes().first(sizeof(ImageHeader));
  const std::size_t from = random_.one_in(4) ? 0 : offsetof(ImageHeader, sensors);
  change_field(bytes.subspan(from), bytes.subspan(from));
  draft.look();
}

void Mutator::change_bytes(Draft& draft) {
  const auto bytes = draft.bytes();
  for (auto left = 1 + random_.below(4); left > 0; --left)
    bytes[random_.below(bytes.size())] = static_cast<std::byte>(random_.next());
  draft.look();
}

void Mutator::change_size(Draft& draft) {
  const std::size_t size = draft.bytes().size();
  std::size_t then = random_.below(2 * size);
  if (random_.one_in(4)) then = random_.below(2 * sizeof(ImageHeader));
  draft.resize(then);
  if (then < sizeof(ImageHeader) || random_.one_in(2)) return;
  draft.header().total_length = static_cast<std::uint32_t>(then);
  draft.look();
}

}  // namespace robosync::fuzz
