// An image that is being changed, in memory of its own: records and code words can be put in and
// taken out of any section, and what refers to code is moved with it.
//
// While sound(), the sections fill it as the header says. Nothing else about the records is
// assumed.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "tests/generators/images/random.hpp"
#include "vm/image.hpp"
#include "vm/opcode.hpp"

namespace robosync::fuzz {

using vm::Section;

// A section's records: their size, and where in the header they are counted.
struct SectionInfo {
  std::uint8_t record_size;
  std::uint8_t count_place;
  std::uint8_t count_size;
};
inline constexpr std::size_t kSectionCount = static_cast<std::size_t>(Section::count_);
extern const std::array<SectionInfo, kSectionCount> kSections;  // of the header: none

// A code object as a rule runs it.
enum class Part : std::uint8_t { condition, then_response, else_response };
struct Object {
  std::size_t behavior;
  std::size_t rule;
  Part part;
  std::size_t start, length;  // words; inside the code section
  vm::Context context;
};

class Draft {
public:
  static constexpr std::size_t kCapacity = 16384;

  void assign(std::span<const std::byte> bytes);

  [[nodiscard]] std::span<const std::byte> bytes() const { return {bytes_.data(), size_}; }
  [[nodiscard]] std::span<std::byte> bytes() { return {bytes_.data(), size_}; }
  [[nodiscard]] vm::ImageHeader& header() {
    return *reinterpret_cast<vm::ImageHeader*>(bytes_.data());
  }
  [[nodiscard]] const vm::Image& view() const { return view_; }
  // Do the counts in the header still fit the bytes?
  [[nodiscard]] bool sound() const { return sound_; }
  // Finds the sections again, after the header was written to.
  void look();

  // Cuts off what stands behind, or adds garbage, whatever the header says.
  void resize(std::size_t size);
  [[nodiscard]] std::size_t count(Section section) const;
  // A record's bytes, to be written to. It exists.
  [[nodiscard]] std::span<std::byte> record(Section section, std::size_t index);
  // Something of the section at `section`, which is not code, as a record to be written to.
  template <typename Record>
  [[nodiscard]] Record& as(Section section, std::size_t index) {
    return *reinterpret_cast<Record*>(record(section, index).data());
  }
  [[nodiscard]] vm::Word& word(std::size_t index) { return as<vm::Word>(Section::code, index); }

  // `count` records of zeros before the one at `index`. False where there is no room for them.
  bool insert(Section section, std::size_t index, std::size_t count);
  void erase(Section section, std::size_t index, std::size_t count);

  // The code object of some rule; none where the records say nonsense.
  [[nodiscard]] std::optional<Object> object(Random& random);
  [[nodiscard]] std::optional<Object> object_of(std::size_t rule, Part part) const;
  // The same with code: jumps across and the objects behind are told, if `mend`.
  bool insert_words(const Object& object, std::size_t at, std::span<const vm::Word> words,
                    bool mend);
  void erase_words(const Object& object, std::size_t at, std::size_t count, bool mend);
  // Gives the object other words.
  bool replace(const Object& object, std::span<const vm::Word> words);

  void put_crc();

private:
  void set_count(Section section, std::size_t count);
  void move_jumps(const Object& object, std::size_t at, std::ptrdiff_t by);
  void move_objects(std::size_t at, std::ptrdiff_t by);

  alignas(8) std::array<std::byte, kCapacity> bytes_;
  std::size_t size_ = 0;
  std::array<std::uint32_t, kSectionCount + 1> places_{};  // of the sections; then the end
  vm::Image view_;
  bool sound_ = false;
};

// CRC-32 as vm::crc32() gives it, eight bytes at a time: most of what a mutant costs.
[[nodiscard]] std::uint32_t fast_crc32(std::span<const std::byte> bytes);

}  // namespace robosync::fuzz
