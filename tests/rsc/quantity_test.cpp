// Quantities on the command line.
#include "rsc/quantity.hpp"

#include <stdexcept>

#include <catch2/catch.hpp>

using namespace robosync;
using Catch::EndsWith;
using tool::parse_quantity;
using vm::Dimension;

TEST_CASE("quantities with the unit of their dimension") {
  CHECK(parse_quantity("2", Dimension::number) == 2000);
  CHECK(parse_quantity("-0.5", Dimension::number) == -500);
  CHECK(parse_quantity("20cm", Dimension::length) == 200'000);
  CHECK(parse_quantity(" 1.5 s ", Dimension::duration) == 1500);
  CHECK(parse_quantity("30C", Dimension::temperature) == 30'000);
  CHECK(parse_quantity("50%", Dimension::percent) == 50'000);
}

TEST_CASE("numbers as other programs write them") {
  CHECK(parse_quantity("1e-05m", Dimension::length) == 10);
  CHECK(parse_quantity("-2.5E+1 cm", Dimension::length) == -250'000);
  CHECK(parse_quantity("1e3", Dimension::number) == 1'000'000);
  CHECK(parse_quantity("0.30000000000000004", Dimension::number) == 300);
  CHECK(parse_quantity("1.2345678901234567e-05m", Dimension::length) == 12);
  CHECK_THROWS_WITH(parse_quantity("1e-", Dimension::number),
                    Catch::Contains("there is no unit `e-`"));
  CHECK_THROWS_WITH(parse_quantity("-", Dimension::number), Catch::Contains("not a number"));
}

TEST_CASE("what is not a quantity of the dimension is said") {
  using Catch::Contains;
  CHECK_THROWS_WITH(parse_quantity("", Dimension::number), Contains("not a number"));
  CHECK_THROWS_WITH(parse_quantity("far", Dimension::length), Contains("`far` is not a number"));
  CHECK_THROWS_WITH(parse_quantity("5parsec", Dimension::length), Contains("no unit `parsec`"));
  CHECK_THROWS_WITH(parse_quantity("5", Dimension::length),
                    EndsWith("; it takes a number with mm, cm or m"));
  CHECK_THROWS_WITH(parse_quantity("5", Dimension::length, "cm"), EndsWith("; write it as 5cm"));
  CHECK_THROWS_WITH(parse_quantity("20deg", Dimension::length, "cm"),
                    EndsWith("; it takes a number with mm, cm or m"));
  CHECK_THROWS_WITH(parse_quantity("5", Dimension::force), EndsWith("; write it as 5N"));
  CHECK_THROWS_WITH(parse_quantity("5s", Dimension::force), EndsWith("; it takes a number with N"));
  CHECK_THROWS_WITH(parse_quantity("1m", Dimension::duration),
                    EndsWith("; it takes a number with ms, s, min or h"));
  CHECK_THROWS_WITH(parse_quantity("5s", Dimension::length), Contains("a time"));
  CHECK_THROWS_WITH(parse_quantity("5cm", Dimension::number), Contains("a plain number"));
  CHECK_THROWS_WITH(parse_quantity("3000000", Dimension::number), Contains("too large"));
}

TEST_CASE("durations") {
  CHECK(tool::parse_duration("10s") == std::chrono::seconds(10));
  CHECK(tool::parse_duration("250ms") == std::chrono::milliseconds(250));
  CHECK(tool::parse_duration("0s").count() == 0);
  CHECK_THROWS_AS(tool::parse_duration("-1s"), std::invalid_argument);
  CHECK_THROWS_AS(tool::parse_duration("10"), std::invalid_argument);
}
