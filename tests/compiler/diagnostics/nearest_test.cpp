// The word that was meant.
#include "compiler/diagnostics/nearest.hpp"

#include <string>
#include <vector>

#include <catch2/catch.hpp>

using namespace robosync::compiler;

TEST_CASE("mistakes between words", "[nearest]") {
  CHECK(mistakes("WHEN", "when") == 0);
  CHECK(mistakes("WHNE", "WHEN") == 1);
  CHECK(mistakes("COOLDWN", "COOLDOWN") == 1);
  CHECK(mistakes("", "abc") == 3);
  CHECK(mistakes("kitten", "sitting") == 3);
  CHECK(mistakes(std::string(100000, 'a'), "b") == 100000);
}

TEST_CASE("the nearest word, if any is near", "[nearest]") {
  const std::vector<std::string> words = {"WHEN", "WHILE", "DO", "END", "touch"};
  CHECK(nearest("WHNE", words) == "WHEN");
  CHECK(nearest("toch", words) == "touch");
  CHECK(nearest("OD", words) == "DO");
  CHECK(nearest("ENDD", words) == "END");
  CHECK_FALSE(nearest("banana", words).has_value());
  CHECK_FALSE(nearest("TO", words).has_value());  // no swap, no missing letter: another word
  CHECK_FALSE(nearest("", words).has_value());
  CHECK_FALSE(nearest("x", {}).has_value());
}
