// The word that was meant.
#include "compiler/diagnostics/nearest.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

using namespace robosync::compiler;

namespace {

// The definition, without any short cut: dynamic programming over the whole matrix.
std::size_t naive_mistakes(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const bool same = a[i - 1] == b[j - 1];
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string random_word(std::mt19937& random) {
  std::string word(random() % 8, ' ');
  for (char& c : word)
    c = static_cast<char>('a' + random() % 3);
  return word;
}

}  // namespace

TEST_CASE("mistakes between words", "[nearest]") {
  CHECK(mistakes("WHEN", "when") == 0);
  CHECK(mistakes("WHNE", "WHEN") == 1);
  CHECK(mistakes("COOLDWN", "COOLDOWN") == 1);
  CHECK(mistakes("", "abc") == 3);
  CHECK(mistakes("kitten", "sitting") == 3);
  CHECK(mistakes(std::string(100000, 'a'), "b") == 100000);
}

TEST_CASE("mistakes between random words are what the definition says", "[nearest]") {
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const std::string a = random_word(random);
    const std::string b = random_word(random);
    INFO(a << " " << b);
    const std::size_t wrong = naive_mistakes(a, b);
    CHECK(mistakes(a, b) == wrong);
    const std::size_t longer = std::max(a.size(), b.size());
    if (longer > 2 && !a.empty())
      CHECK(is_near(a, b) == (wrong <= std::max<std::size_t>(1, longer / 3)));
  }
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
