// Exact conversion of written numbers.
#include "compiler/units/units.hpp"

#include <catch2/catch.hpp>

using namespace robosync;
using namespace robosync::compiler;

namespace {

std::optional<vm::Value> value_of(std::string_view number, std::string_view unit) {
  const auto decimal = parse_decimal(number);
  const Unit* found = find_unit(unit);
  if (!decimal || found == nullptr) return std::nullopt;
  return to_value(*decimal, *found);
}

}  // namespace

TEST_CASE("numbers become exact thousandths") {
  CHECK(value_of("0.1", "") == 100);
  CHECK(value_of("1", "ms") == 1);
  CHECK(value_of("1.5", "s") == 1500);
  CHECK(value_of("2", "min") == 120000);
  CHECK(value_of("80", "cm") == 800000);
  CHECK(value_of("0.0005", "m") == 500);
  CHECK(value_of("40", "%") == 40000);
  CHECK(value_of("-2.5", "mA") == -3);
  CHECK(value_of("1e3", "Hz") == 1000000);
  CHECK(value_of("2.5e-1", "kHz") == 250000);
}

TEST_CASE("rounding is half away from zero") {
  CHECK(value_of("0.0005", "") == 1);
  CHECK(value_of("-0.0005", "") == -1);
  CHECK(value_of("0.00049", "") == 0);
  CHECK(value_of("0.000499999", "") == 0);
  CHECK(value_of("0.5", "ms") == 1);
  CHECK(value_of("0.4999", "ms") == 0);
}

TEST_CASE("Fahrenheit has another zero") {
  CHECK(value_of("32", "F") == 0);
  CHECK(value_of("212", "F") == 100000);
  CHECK(value_of("-40", "F") == -40000);
  CHECK(value_of("68", "F") == 20000);
  CHECK(value_of("33", "F") == 556);   // 0.5555… C
  CHECK(value_of("31", "F") == -556);  // away from zero on both sides
}

TEST_CASE("radians") {
  CHECK(value_of("1", "rad") == 57296);  // 57.295779… deg
  CHECK(value_of("3.141592654", "rad") == 180000);
  CHECK(value_of("-1.570796327", "rad") == -90000);
  CHECK(value_of("37480.66", "rad") == 2147483631);  // …631.36: nearly all there is
}

TEST_CASE("the range ends where values end") {
  CHECK(value_of("2147483.647", "") == vm::kValueMax);
  CHECK(value_of("-2147483.647", "") == vm::kValueMin);
  CHECK(!value_of("2147483.648", ""));
  CHECK(value_of("2147483.6474", "") == vm::kValueMax);
  CHECK(!value_of("2147483.6475", ""));
  CHECK(!value_of("3000", "m"));
  CHECK(!value_of("9999999999999999", "rad"));
}

TEST_CASE("what is not a number, or needs more digits than a value has") {
  for (const char* text : {"", "-", ".", ".5", "5x", "1e", "1e+", "1e99", "--1", "1.2.3", "0x10",
                           "99999999999999999", "0.0000000001", "1e-10"}) {
    INFO(text);
    CHECK(!parse_decimal(text));
  }
  CHECK(value_of("1.50000000000000000000000", "") == 1500);
  CHECK(value_of("00000000000000000000007", "") == 7000);
  CHECK(value_of("0e99", "") == 0);
}

TEST_CASE("units in any case; every dimension's own unit is one canonical unit") {
  CHECK(find_unit("CM") == find_unit("cm"));
  CHECK(find_unit("parsec") == nullptr);
  CHECK(find_unit("Seconds") == find_unit("s"));
  CHECK(find_unit("°") == find_unit("deg"));
  CHECK(find_unit("°C") == find_unit("C"));
  CHECK(find_unit("percent") == find_unit("%"));
  CHECK(find_unit("degrees/second") == find_unit("deg/s"));
  CHECK(find_unit("centimetres/s") == find_unit("cm/s"));
  CHECK(find_unit("deg/min") == nullptr);
  CHECK(find_unit("/s") == nullptr);
  CHECK(find_unit("deg/") == nullptr);
  CHECK(value_of("1.5", "h") == 5'400'000);
  for (const Unit& unit : units()) {
    const Unit& own = canonical_unit(unit.dimension);
    CHECK(own.factor == vm::kScale);
    CHECK(own.divisor == 1);
    CHECK(own.offset == 0);
    CHECK(find_unit(unit.spelling) == &unit);
  }
}

TEST_CASE("values are written in any unit") {
  CHECK(format_value(800000, *find_unit("cm")) == "80cm");
  CHECK(format_value(25000, *find_unit("cm")) == "2.5cm");
  CHECK(format_value(-1500, *find_unit("s")) == "-1.5s");
  CHECK(format_value(20000, *find_unit("F")) == "68F");
  for (std::int64_t degrees = -459; degrees < 1000; ++degrees) {
    const Unit& unit = *find_unit("F");
    const auto whole = to_value({degrees, 0}, unit), tenth = to_value({degrees * 10 + 1, 1}, unit);
    CHECK(format_value(whole.value(), unit) == std::to_string(degrees) + "F");
    CHECK(format_value(tenth.value(), unit) == written({degrees * 10 + 1, 1}) + "F");
  }
  CHECK(format_value(1, *find_unit("")) == "0.001");
  CHECK(format_value(vm::kValueMin, *find_unit("")) == "-2147483.647");
}

TEST_CASE("scales are exact fractions") {
  const auto scale = [](std::string_view number, std::string_view unit) {
    return to_scale(*parse_decimal(number), *find_unit(unit));
  };
  CHECK(scale("1", "")->numerator == 1000);
  CHECK(scale("0.0625", "C")->numerator == 125);
  CHECK(scale("0.0625", "C")->denominator == 2);
  CHECK(scale("-1", "mV")->numerator == -1);
  CHECK(!scale("0", ""));
  CHECK(!scale("0.00000001", ""));  // 1 / 100000 thousandths
  CHECK(!scale("9999999", ""));
}

TEST_CASE("the place of a value in a text is a unit in curly brackets") {
  const auto found = [](std::string_view text) {
    const auto place = find_place(text);
    return place ? std::string(text.substr(place->begin, place->size)) + ">" +
                       std::string(place->unit->spelling)
                 : std::string();
  };
  CHECK(found("at {cm} now {}") == "{cm}>cm");
  CHECK(found("{}") == "{}>");
  CHECK(found("{ {x} } {{deg/s}") == "{deg/s}>deg/s");
  CHECK(found("{seconds}") == "{seconds}>s");
  for (const char* none : {"", "{", "}", "{x}", "cm", "{cm", "cm}", "} {", "{ cm}"})
    CHECK(found(none).empty());
  for (const Unit& unit : units())
    CHECK(found(place_for(unit)) == place_for(unit) + ">" + std::string(unit.spelling));
  CHECK(found("{+cm}").empty());
  CHECK(place_for(difference_unit(*find_unit("cm"))) == "{cm}");
}

TEST_CASE("the place of a word in a text has all its words") {
  const std::vector<std::string> words{"calm", "", "very happy"};
  CHECK(place_for(words) == "{|calm||very happy}");
  const auto place = find_place("I am {|calm||very happy} now");
  REQUIRE(place);
  CHECK(place->begin == 5);
  CHECK(place->size == 19);
  CHECK(place->unit == nullptr);
  CHECK(shown_at(*place, 0) == "calm");
  CHECK(shown_at(*place, 1000).empty());
  CHECK(shown_at(*place, 2000) == "very happy");
  CHECK(shown_at(*place, 3000) == "word 3");
  CHECK(shown_at(*place, vm::kUnknown) == "unknown");
  CHECK(shown_at(*find_place("{cm}"), 355'000) == "35.5cm");
  for (const char* const wrong : {"a|b", "a{", "}"})
    CHECK(place_for(std::vector<std::string>{"calm", wrong}).empty());
}

TEST_CASE("a difference of temperatures has no offset") {
  const Unit& more = difference_unit(*find_unit("F"));
  CHECK(is_of_differences(more));
  CHECK_FALSE(is_of_differences(*find_unit("F")));
  CHECK_FALSE(is_of_differences(difference_unit(*find_unit("C"))));
  CHECK(to_value({9, 0}, more) == 5000);
  CHECK(format_value(5000, more) == "9F");
  CHECK(place_for(more) == "{+F}");
  CHECK(find_place("by {+F} more")->unit == &more);
}
