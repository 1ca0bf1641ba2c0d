// Checks that an image is refused for exactly one reason, in exactly one place.
#pragma once

#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"

namespace robosync::vm::test {

inline void check_refused(const Bytes& bytes, const Verdict& expected, const Limits& limits = {}) {
  Image image;
  const Verdict verdict = verify(bytes, limits, image);
  INFO("refused: " << describe(verdict.refusal) << " (" << describe(verdict.section) << " "
                   << verdict.index << "), expected: " << describe(expected.refusal) << " ("
                   << describe(expected.section) << " " << expected.index << ")");
  CHECK(verdict.refusal == expected.refusal);
  CHECK(verdict.section == expected.section);
  CHECK(verdict.index == expected.index);
}

inline void check_refused(const ImageBuilder& image, const Verdict& expected,
                          const Limits& limits = {}) {
  check_refused(image.build(), expected, limits);
}

// The small robot, made wrong.
template <typename Wrong>
requires std::invocable<Wrong, ImageBuilder&>
void check_refused(Wrong wrong, const Verdict& expected) {
  ImageBuilder image = companion::make();
  wrong(image);
  check_refused(image, expected);
}

inline void check_accepted(const ImageBuilder& image, const Limits& limits = {}) {
  check_refused(image.build(), Verdict{}, limits);
}

}  // namespace robosync::vm::test
