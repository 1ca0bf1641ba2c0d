// Configurations with random damage: whatever the text, the compiler says what is wrong or makes an
// image that the verifier accepts. Run under AddressSanitizer by the host-asan preset.
#include <cctype>
#include <random>

#include <catch2/catch.hpp>

#include "tests/compiler/compiled.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

constexpr int kRounds = 1500;

const std::vector<std::string>& fragments() {
  static const std::vector<std::string> list = {"{",
                                                "}",
                                                "[",
                                                "]",
                                                ",",
                                                ":",
                                                "\"",
                                                "\\",
                                                "\\u0000",
                                                "\\ud800",
                                                "null",
                                                "true",
                                                "-",
                                                "1e400",
                                                "1e-400",
                                                "99999999999999999999",
                                                "-0",
                                                "0x48",
                                                "\"50Hz\"",
                                                "\"1cm\"",
                                                "\"\"",
                                                "\xFF",
                                                "\xEF\xBB\xBF",
                                                "\xF0\x9F\xA4\x96",
                                                std::string(1, '\0'),
                                                "\n",
                                                "[[[[[[[[",
                                                "{\"a\":{\"a\":",
                                                "\"name\"",
                                                "\"channels\"",
                                                "\"virtual\"",
                                                "\"device\"",
                                                "\"sounds\"",
                                                "\"WHEN\""};
  return list;
}

class Mutator {
public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string damage(std::string text) {
    for (std::size_t count = 1 + below(4); count > 0; --count)
      change(text);
    return text;
  }

private:
  std::size_t below(std::size_t limit) {
    return limit == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_);
  }

  void change(std::string& text) {
    const std::size_t at = below(text.size() + 1);
    switch (below(6)) {
      case 0:
        text.erase(at, 1 + below(12));
        break;
      case 1:
        text.insert(at, fragments()[below(fragments().size())]);
        break;
      case 2:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), below(60)));
        break;
      case 4:
        replace_token(text);
        break;
      default:
        text.resize(at);
        break;
    }
  }

  // Exchanges one quoted string or number for a fragment: the JSON often stays well-formed.
  void replace_token(std::string& text) {
    std::size_t begin = text.find_first_of("\"0123456789", below(text.size() + 1));
    if (begin == std::string::npos) return;
    std::size_t end = begin + 1;
    if (text[begin] == '"')
      end = std::min(text.find('"', end), text.size() - 1) + 1;
    else
      while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0)
        ++end;
    text.replace(begin, end - begin, fragments()[below(fragments().size())]);
  }

  std::mt19937 random_;
};

void expect_sound(const Result& result) {
  CHECK(result.image.empty() == (result.diagnostics.errors() > 0));
  const std::string said = render_human(result.diagnostics, result.sources, false);
  CHECK(said.empty() == result.diagnostics.all().empty());
  for (const Diagnostic& diagnostic : result.diagnostics.all())
    CHECK(code_name(diagnostic.code) != "E0499");
}

}  // namespace

TEST_CASE("damaged configurations") {
  const std::string program =
      "WHEN touch LEVEL < 3\nDO MOVE arms SLOWLY\nELSE PLAY sound 'greeting.wav'\nEND\n"
      "WHEN proximity < 20cm AND room WARMTH > 20C\nDO BLINK lamp 3 TIMES\nEND\n";
  const std::string whole = common_robot();
  Mutator mutator(20231);
  int compiled = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::string text = mutator.damage(whole);
    INFO(text);
    const Result result = compile_text(program, text);
    expect_sound(result);
    compiled += result.image.empty() ? 0 : 1;
  }
  CHECK(compiled > 0);            // some damage does not matter …
  CHECK(compiled < kRounds / 2);  // … most does
}

TEST_CASE("damaged programs") {
  std::string whole;
  for (const char* name : {"conditions", "commands"})
    whole += read_file(disassembly_folder() / (std::string(name) + ".rsl"));
  Mutator mutator(424242);
  for (int round = 0; round < kRounds / 3; ++round) {
    const std::string text = mutator.damage(whole);
    INFO(text);
    expect_sound(compile_text(text, common_robot()));
  }
}
