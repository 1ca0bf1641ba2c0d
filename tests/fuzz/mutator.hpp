// Changes an image: mostly in ways that leave it one that the verifier has to look at closely.
#pragma once

#include <vector>

#include "tests/generators/images/draft.hpp"

namespace robosync::fuzz {

using Seed = std::vector<std::byte>;  // an image that is accepted

class Mutator {
public:
  // `donors`: what else there is to take pieces from; not empty.
  Mutator(Random& random, const std::vector<Seed>& donors) : random_(random), donors_(donors) {}

  // One to four changes, and the checksum made right again; mostly.
  void mutate(Draft& draft);

private:
  void change(Draft& draft);
  void change_code(Draft& draft, const Object& object);
  void change_operand(Draft& draft, const Object& object);
  void change_opcode(Draft& draft, const Object& object);
  void insert_word(Draft& draft, const Object& object);
  void swap_words(Draft& draft, const Object& object);
  void repeat_words(Draft& draft, const Object& object);
  void change_distance(Draft& draft, const Object& object);
  void splice_object(Draft& draft, const Object& object);

  void change_record(Draft& draft);
  void never_grow_stale(Draft& draft);
  void change_field(std::span<std::byte> record, std::span<const std::byte> neighbour);
  void change_records(Draft& draft);
  void splice_section(Draft& draft);
  void change_header(Draft& draft);
  void change_bytes(Draft& draft);
  void change_size(Draft& draft);

  [[nodiscard]] Section section_with(const Draft& draft);
  [[nodiscard]] std::size_t place_in(const Object& object) {
    return object.start + random_.below(object.length);
  }

  Random& random_;
  const std::vector<Seed>& donors_;
  Draft donor_;
};

}  // namespace robosync::fuzz
