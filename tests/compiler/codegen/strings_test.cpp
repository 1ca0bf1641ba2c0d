// Names and texts of an image: where each stands, against a search through all that is there.
#include <random>
#include <string>

#include <catch2/catch.hpp>

#include "compiler/codegen/tables.hpp"

using namespace robosync::compiler;

TEST_CASE("a string stands where it is first found, or at the end", "[strings]") {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    Strings strings;
    for (int i = 0; i < 60; ++i) {
      std::string text(random() % 6, ' ');
      for (char& c : text)
        c = static_cast<char>('a' + random() % 2);
      const std::string before = strings.text();
      const std::string entry = text + '\0';
      const std::size_t found = before.find(entry);
      const std::uint16_t place = strings.offset(text);
      INFO("'" << text << "' after '" << before << "'");
      CHECK(place == (found == std::string::npos ? before.size() : found));
      CHECK(strings.text() == (found == std::string::npos ? before + entry : before));
    }
  }
}

TEST_CASE("more than an image holds is not taken", "[strings]") {
  Strings strings;
  for (int i = 0; i < 100'000; ++i)
    static_cast<void>(strings.offset("text " + std::to_string(i)));
  CHECK(strings.text().size() > UINT16_MAX);
  CHECK(strings.text().size() < UINT16_MAX + 100);
}
