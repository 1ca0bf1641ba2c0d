// The texts that the tool carries are those of the repository, and a damaged one is noticed.
#include "compiler/source/embedded.hpp"

#include <sstream>
#include <vector>

#include <catch2/catch.hpp>

#include "rsc/modules/texts.hpp"
#include "rsc/templates.hpp"
#include "rsc/timeline/page.hpp"
#include "tests/compiler/compiled.hpp"

using namespace robosync;

namespace {

std::string in_repository(const std::string& path) {
  return compiler::testing::read_file(compiler::testing::source_folder() / path);
}

// The folder of examples/ that a template is made from.
std::string example_of(std::string_view name) {
  std::istringstream list(in_repository("rsc/templates.txt"));
  std::string line, first, second;
  while (std::getline(list, line))
    if (std::istringstream(line) >> first >> second && first == name) return second;
  return {};
}

std::string without_schema(const std::string& text) {
  std::istringstream lines(text);
  std::string line, result;
  while (std::getline(lines, line))
    if (line.find("\"$schema\"") == std::string::npos) result += line + "\n";
  return result;
}

// "robosync", as gzip packs it.
constexpr unsigned char kPacked[] = {0x1f, 0x8b, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x03,
                                     0x2b, 0xca, 0x4f, 0xca, 0x2f, 0xae, 0xcc, 0x4b, 0x06, 0x00,
                                     0x23, 0x11, 0x98, 0xa5, 0x08, 0x00, 0x00, 0x00};

}  // namespace

TEST_CASE("what the tool carries is what stands in the repository") {
  std::size_t files = 0;
  for (const tool::Template& robot : tool::templates())
    for (const tool::TemplateFile& file : robot.files) {
      const std::string path = "examples/" + example_of(robot.name) + "/" + std::string(file.name);
      CAPTURE(path);
      CHECK(file.text() == without_schema(in_repository(path)));
      ++files;
    }
  CHECK(files >= 20);
  CHECK(tool::module_header() == in_repository("runtime-m4/algorithms/robosync_module.h"));
  CHECK(tool::counting_program() == in_repository("rsc/modules/count_on_m4.c.in"));
  const tool::PageParts page = tool::page_parts();
  CHECK(page.html.text() == in_repository("rsc/timeline/timeline.html"));
  CHECK(page.style.text() == in_repository("rsc/timeline/timeline.css"));
  CHECK(page.script.text().size() > 10'000);
}

TEST_CASE("a packed text is unpacked, and one that is damaged, or has another size, is noticed") {
  constexpr std::size_t kSize = 8;
  CHECK(compiler::unpacked(kPacked, kSize) == "robosync");
  CHECK_THROWS(compiler::unpacked(kPacked, kSize - 1));
  CHECK_THROWS(compiler::unpacked(kPacked, kSize + 1));
  CHECK_THROWS(compiler::unpacked(std::span(kPacked).first(std::size(kPacked) - 1), kSize));
  // The text, its checksum, its size; some bits behind the text mean nothing.
  for (const std::size_t at : {10, 12, 14, 20, 24}) {
    std::vector<unsigned char> damaged(std::begin(kPacked), std::end(kPacked));
    damaged[at] ^= 4U;
    CHECK_THROWS(compiler::unpacked(damaged, kSize));
  }
}
