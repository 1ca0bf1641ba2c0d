// The layout of a board's store: two records and two slots for programs (program_store.hpp), two records of the owner's key
// (key_store.hpp), and a ring of records of KEPT numbers (number_store.hpp). Each begins on its own page, so that a power cut
// damages no other. In flash, where a power cut does not damage the rest of the page, each page of the ring is filled with
// records.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/store.hpp"

namespace robosync::update {

class StoreLayout {
public:
  static constexpr std::uint32_t kRecords = 2;
  static constexpr std::uint32_t kSlots = 2;
  // Pages wear out. With one write a second, 16 pages of a million writes each last half a year. In flash, whose pages last
  // ten thousand erases, the ring is a third of the store: at least 500 records, which last about two months.
  static constexpr std::uint32_t kRing = 16;

  static constexpr std::uint32_t kNumbersBytes = 144;  // of a record in the ring
  static constexpr std::uint32_t kKeys = 2;
  static constexpr std::uint32_t kKeyBytes = 64;  // of a key record

  constexpr explicit StoreLayout(const boards::Store& store)
      : page_(store.page()),
        numbers_(pages(kNumbersBytes)),
        together_(store.is_flash() ? numbers_ / kNumbersBytes : 1),
        ring_(store.is_flash() ? store.size() / 3 / numbers_ : kRing),
        first_number_(store.size() / page_ * page_ - ring_ * numbers_),
        first_key_(first_number_ - kKeys * pages(kKeyBytes)) {}

  std::uint32_t record_at(std::uint32_t record) const { return record * page_; }
  std::uint32_t slot_at(std::uint32_t slot) const { return kRecords * page_ + slot * slot_bytes(); }
  std::uint32_t slot_bytes() const { return (first_key_ / page_ - kRecords) / kSlots * page_; }
  std::uint32_t key_at(std::uint32_t record) const {
    return first_key_ + record * pages(kKeyBytes);
  }
  std::uint32_t ring() const { return ring_ * together_; }  // places
  std::uint32_t numbers_at(std::uint32_t place) const {
    return first_number_ + place / together_ * numbers_ + place % together_ * kNumbersBytes;
  }

private:
  constexpr std::uint32_t pages(std::uint32_t bytes) const {
    return (bytes + page_ - 1) / page_ * page_;
  }

  std::uint32_t page_;
  std::uint32_t numbers_;   // bytes of one part of the ring: whole pages
  std::uint32_t together_;  // records in a part
  std::uint32_t ring_;      // parts
  std::uint32_t first_number_, first_key_;
};

}  // namespace robosync::update
