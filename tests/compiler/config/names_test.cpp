// Names as robot.json and RSL share them.
#include "compiler/config/names.hpp"

#include <string>
#include <vector>

#include <catch2/catch.hpp>

using namespace robosync::compiler;

TEST_CASE("case and underscores make no difference", "[names]") {
  const std::vector<std::string> names = {"touchLevel", "touch_level", "TOUCH__LEVEL_", "touch", "",
                                          "_",          "touchLevels", "tuch_level"};
  for (const std::string& a : names)
    for (const std::string& b : names) {
      INFO(a << " " << b);
      CHECK(same_name(a, b) == (fold_name(a) == fold_name(b)));
    }
}

TEST_CASE("an index finds the first of each name", "[names]") {
  const std::vector<std::string> names = {"touchLevel", "head", "touch_level", "HEAD", ""};
  NameIndex index;
  CHECK(index.empty());
  std::vector<bool> added;
  for (std::size_t i = 0; i < names.size(); ++i)
    added.push_back(index.add(names[i], i));
  CHECK(added == std::vector<bool>{true, true, false, false, true});
  CHECK(index.find("TOUCHLEVEL") == 0);
  CHECK(index.find("_head") == 1);
  CHECK(index.find("_") == 4);
  CHECK_FALSE(index.find("heads").has_value());
}
