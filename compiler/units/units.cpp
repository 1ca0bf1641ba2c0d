// Units and exact conversion. 128-bit integers hold every intermediate result: a mantissa has at most 16 digits, a factor 17.
#include "compiler/units/units.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"

namespace robosync::compiler {
namespace {

using Wide = __int128;

constexpr unsigned kMaxDecimals = 9;
constexpr unsigned kMaxDigits = 16;
constexpr int kMaxExponent = 15;

constexpr std::array kUnits = {
#define UNIT(spelling, dimension, factor, offset, divisor) \
  Unit{spelling, vm::Dimension::dimension, factor, offset, divisor},
#define UNIT_NAME(other, spelling)
#include "compiler/units/units.def"
#undef UNIT_NAME
#undef UNIT
};

constexpr auto kDifferenceUnits = [] {
  auto units = kUnits;
  for (Unit& unit : units)
    unit.offset = 0;
  return units;
}();
constexpr char kDifferenceSign = '+';
constexpr char kWordSign = '|';  // in front of each word

struct OtherName {
  std::string_view name, spelling;
};
constexpr std::array kOtherNames = {
#define UNIT(spelling, dimension, factor, offset, divisor)
#define UNIT_NAME(other, spelling) OtherName{other, spelling},
#include "compiler/units/units.def"
#undef UNIT_NAME
#undef UNIT
};

struct DimensionText {
  std::string_view canonical_unit;
  std::string_view phrase;
};
constexpr std::array kDimensions = {
#define DIMENSION(name, unit, phrase) DimensionText{unit, phrase},
#include "vm/dimensions.def"
#undef DIMENSION
};

// The index in kUnits of each dimension's canonical unit.
constexpr auto kCanonical = [] {
  std::array<std::size_t, kDimensions.size()> places{};
  for (std::size_t i = 0; i < places.size(); ++i)
    while (kUnits.at(places.at(i)).spelling != kDimensions.at(i).canonical_unit)
      ++places.at(i);
  return places;
}();

constexpr Wide power_of_ten(unsigned exponent) {
  Wide power = 1;
  for (unsigned i = 0; i < exponent; ++i)
    power *= 10;
  return power;
}

Wide divide_half_away(Wide numerator, Wide denominator) {
  const Wide half = denominator / 2;
  return (numerator < 0 ? numerator - half : numerator + half) / denominator;
}

// Reads "digits[.digits]" from the front of `text` into `number`.
bool read_mantissa(std::string_view& text, Decimal& number) {
  unsigned digits = 0;
  bool point = false;
  bool any = false;
  while (!text.empty()) {
    const char c = text.front();
    if (c == '.' && !point && any) {
      point = true;
    } else if (c >= '0' && c <= '9') {
      any = true;
      digits += number.mantissa != 0 || c != '0';
      if (digits > kMaxDigits) return false;
      number.mantissa = number.mantissa * 10 + (c - '0');
      number.decimals += point;
    } else {
      break;
    }
    text.remove_prefix(1);
  }
  return any;
}

// Reads "e[±]digits", or nothing, up to the end of `text`.
std::optional<int> read_exponent(std::string_view text) {
  if (text.empty()) return 0;
  if (text.front() != 'e' && text.front() != 'E') return std::nullopt;
  text.remove_prefix(1);
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  if (text.empty()) return std::nullopt;
  int exponent = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    exponent = std::min(exponent * 10 + (c - '0'), 10000);
  }
  return negative ? -exponent : exponent;
}

// mantissa / 10^decimals * 10^exponent with 0 … kMaxDecimals decimals, or nullopt.
std::optional<Decimal> normalise(std::int64_t mantissa, int decimals) {
  while (decimals > 0 && mantissa % 10 == 0) {
    mantissa /= 10;
    if (mantissa == 0) return Decimal{};
    --decimals;
  }
  if (mantissa == 0) return Decimal{};
  if (decimals < -kMaxExponent || decimals > static_cast<int>(kMaxDecimals)) return std::nullopt;
  const auto limit = static_cast<std::int64_t>(power_of_ten(kMaxDigits));
  for (; decimals < 0; ++decimals) {
    if (mantissa >= limit) return std::nullopt;
    mantissa *= 10;
  }
  return Decimal{mantissa, static_cast<unsigned>(decimals)};
}

}  // namespace

std::span<const Unit> units() {
  return kUnits;
}

namespace {

// "degrees/second": either side may be any name of a unit.
const Unit* find_rate(std::string_view spelling) {
  const std::size_t slash = spelling.find('/');
  if (slash == std::string_view::npos) return nullptr;
  const Unit* const way = find_unit(spelling.substr(0, slash));
  const Unit* const time = find_unit(spelling.substr(slash + 1));
  if (way == nullptr || time == nullptr) return nullptr;
  const std::string rate = std::string(way->spelling) + "/" + std::string(time->spelling);
  for (const Unit& unit : kUnits)
    if (unit.spelling == rate) return &unit;
  return nullptr;
}

}  // namespace

const Unit* find_unit(std::string_view spelling) {
  for (const Unit& unit : kUnits)
    if (ascii::same(unit.spelling, spelling)) return &unit;
  for (const OtherName& other : kOtherNames)
    if (ascii::same(other.name, spelling)) return find_unit(other.spelling);
  return find_rate(spelling);
}

bool is_rounded(Decimal number, const Unit& unit) {
  return unit.divisor == 1 &&
         Wide{number.mantissa} * unit.factor % power_of_ten(number.decimals) != 0;
}

const Unit& canonical_unit(vm::Dimension dimension) {
  return kUnits[kCanonical[static_cast<std::size_t>(dimension)]];
}

const Unit& difference_unit(const Unit& unit) {
  if (unit.offset == 0) return unit;
  const auto same = [&](const Unit& other) { return other.spelling == unit.spelling; };
  return *std::ranges::find_if(kDifferenceUnits, same);
}

bool is_of_differences(const Unit& unit) {
  return std::ranges::any_of(kDifferenceUnits, [&](const Unit& other) { return &other == &unit; });
}

std::string_view dimension_phrase(vm::Dimension dimension) {
  return kDimensions[static_cast<std::size_t>(dimension)].phrase;
}

std::string_view written_unit(std::string_view number) {
  return number.substr(std::min(number.find_first_not_of("0123456789."), number.size()));
}

std::optional<Decimal> parse_decimal(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);
  // Trailing zeros of a fraction do not count as digits.
  Decimal number;
  const std::size_t exponent_at = text.find_first_of("eE");
  std::string_view mantissa = text.substr(0, exponent_at);
  if (mantissa.find('.') != std::string_view::npos) {
    while (mantissa.size() > 1 && mantissa.back() == '0')
      mantissa.remove_suffix(1);
  }
  if (!read_mantissa(mantissa, number) || !mantissa.empty()) return std::nullopt;
  const auto exponent =
      read_exponent(exponent_at == std::string_view::npos ? "" : text.substr(exponent_at));
  if (!exponent) return std::nullopt;
  auto result = normalise(number.mantissa, static_cast<int>(number.decimals) - *exponent);
  if (result && negative) result->mantissa = -result->mantissa;
  return result;
}

std::optional<vm::Value> to_value(Decimal number, const Unit& unit) {
  const Wide ten = power_of_ten(number.decimals);
  const Wide value = divide_half_away(Wide{number.mantissa} * unit.factor + Wide{unit.offset} * ten,
                                      Wide{unit.divisor} * ten);
  if (value < vm::kValueMin || value > vm::kValueMax) return std::nullopt;
  return static_cast<vm::Value>(value);
}

namespace {

// Values are coarser than thousandths of F. Of the numbers that mean the same value, returns the one with the fewest decimals.
std::int64_t shortest(std::int64_t thousandths, std::int64_t value, const Unit& unit) {
  constexpr unsigned kDecimals = 3;
  for (unsigned decimals = 0; decimals < kDecimals; ++decimals) {
    const Wide power = power_of_ten(kDecimals - decimals);
    const auto shorter = static_cast<std::int64_t>(divide_half_away(Wide{thousandths}, power));
    if (to_value({shorter, decimals}, unit) == value)
      return shorter * static_cast<std::int64_t>(power);
  }
  return thousandths;
}

}  // namespace

std::string format_value(std::int64_t value, const Unit& unit) {
  const Wide scaled =
      divide_half_away((Wide{value} * unit.divisor - unit.offset) * 1000, Wide{unit.factor});
  const std::int64_t thousandths = shortest(static_cast<std::int64_t>(scaled), value, unit);
  std::string text = thousandths < 0 ? "-" : "";
  const std::int64_t magnitude = std::abs(thousandths);
  text += std::to_string(magnitude / 1000);
  std::string fraction = std::to_string(1000 + magnitude % 1000).substr(1);
  while (!fraction.empty() && fraction.back() == '0')
    fraction.pop_back();
  if (!fraction.empty()) text += "." + fraction;
  return text + std::string(unit.spelling);
}

std::string format_acceleration(std::int64_t whole, const Unit& speed) {
  return format_value(whole * vm::kScale, speed) + "2";
}

std::string written(Decimal number) {
  const bool negative = number.mantissa < 0;
  std::string digits = std::to_string(number.mantissa).substr(negative ? 1 : 0);
  if (digits.size() <= number.decimals) digits.insert(0, number.decimals + 1 - digits.size(), '0');
  if (number.decimals > 0) digits.insert(digits.size() - number.decimals, ".");
  return negative ? "-" + digits : digits;
}

namespace {

// Rounds to a whole number if that has enough digits; never farther from 0 than `value`.
std::string toward_zero(vm::Value value, const Unit& unit) {
  constexpr std::int64_t enough = 1000;
  const Wide scaled = (Wide{value} * unit.divisor - unit.offset) * vm::kScale / unit.factor;
  const auto thousandths = static_cast<std::int64_t>(scaled);
  const std::int64_t whole = thousandths / vm::kScale;
  const bool short_of = std::abs(whole) < enough;
  const Decimal number{short_of ? thousandths : whole, short_of ? 3U : 0U};
  return written(number) + std::string(unit.spelling);
}

}  // namespace

std::string smallest(const Unit& unit) {
  return toward_zero(vm::kValueMin, unit);
}
std::string largest(const Unit& unit) {
  return toward_zero(vm::kValueMax, unit);
}

std::string no_room_for(std::string_view number, const Unit& unit) {
  return "the robot cannot store `" + std::string(number) + "`: its numbers go from " +
         smallest(unit) + " to " + largest(unit);
}

std::string too_many_digits(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  const std::size_t exponent_at = std::min(text.find_first_of("eE"), text.size());
  const auto exponent = read_exponent(text.substr(exponent_at));
  std::string digits(text.substr(0, exponent_at));
  const std::size_t point = std::min(digits.find('.'), digits.size());
  if (point < digits.size()) {
    digits.erase(point, 1);
    while (digits.size() > point && digits.back() == '0')
      digits.pop_back();
  }
  if (!exponent || digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos)
    return {};
  // The number of digits, as if it were written without an exponent.
  const auto behind = static_cast<std::int64_t>(digits.size() - point) - *exponent;
  const std::size_t zeros = std::min(digits.find_first_not_of('0'), digits.size());
  const std::int64_t all =
      static_cast<std::int64_t>(digits.size() - zeros) + std::max<std::int64_t>(-behind, 0);
  if (all > kMaxDigits)
    return "this number has " + std::to_string(all) + " digits; the limit is " +
           std::to_string(kMaxDigits);
  return "this number has " + std::to_string(behind) + " decimal places; the limit is " +
         std::to_string(kMaxDecimals);
}

namespace {

// "cm", "+F".
const Unit* unit_of_place(std::string_view text) {
  if (!text.starts_with(kDifferenceSign)) return find_unit(text);
  const Unit* const unit = find_unit(text.substr(1));
  return unit == nullptr || unit->offset == 0 ? nullptr : &difference_unit(*unit);
}

}  // namespace

std::optional<ValuePlace> find_place(std::string_view text) {
  for (std::size_t begin = text.find('{'); begin != std::string_view::npos;
       begin = text.find('{', begin + 1)) {
    const std::size_t end = text.find('}', begin);
    if (end == std::string_view::npos) break;
    const std::string_view what = text.substr(begin + 1, end - begin - 1);
    if (what.starts_with(kWordSign)) return ValuePlace{begin, end + 1 - begin, nullptr, what};
    if (const Unit* const unit = unit_of_place(what))
      return ValuePlace{begin, end + 1 - begin, unit};
  }
  return std::nullopt;
}

std::string place_for(const Unit& unit) {
  return (is_of_differences(unit) ? std::string("{") + kDifferenceSign : "{") +
         std::string(unit.spelling) + "}";
}

std::string place_for(std::span<const std::string> words) {
  std::string place = "{";
  for (const std::string& word : words) {
    if (word.find_first_of("{|}") != std::string::npos) return {};
    (place += kWordSign) += word;
  }
  return place += "}";
}

std::string shown_at(const ValuePlace& place, vm::Value value) {
  if (value == vm::kUnknown) return "unknown";
  if (place.unit != nullptr) return format_value(value, *place.unit);
  std::string_view rest = place.words;
  for (vm::Value left = value; left >= vm::kScale && !rest.empty(); left -= vm::kScale)
    rest.remove_prefix(std::min(rest.find(kWordSign, 1), rest.size()));
  if (rest.empty()) return fmt::format("word {}", value / vm::kScale);
  rest.remove_prefix(1);
  return std::string(rest.substr(0, rest.find(kWordSign)));
}

namespace {

struct Fraction {
  Wide numerator, denominator;
};

// Thousandths of the canonical unit for one count, in lowest terms.
Fraction scale_of(Decimal number, const Unit& unit) {
  Fraction result{Wide{number.mantissa} * unit.factor,
                  power_of_ten(number.decimals) * unit.divisor};
  Wide divisor = result.numerator;
  for (Wide rest = result.denominator; rest != 0;) {
    const Wide next = divisor % rest;
    divisor = rest;
    rest = next;
  }
  if (divisor < 0) divisor = -divisor;
  return {result.numerator / divisor, result.denominator / divisor};
}

std::string digits_of(Wide number) {
  std::string digits;
  const bool negative = number < 0;
  do {
    digits.insert(digits.begin(), static_cast<char>('0' + std::abs(static_cast<int>(number % 10))));
    number /= 10;
  } while (number != 0);
  return negative ? "-" + digits : digits;
}

constexpr Wide kMostDenominator = UINT16_MAX;
constexpr Wide kMostNumerator = INT32_MAX;

}  // namespace

std::optional<Scale> to_scale(Decimal number, const Unit& unit) {
  const auto [numerator, denominator] = scale_of(number, unit);
  if (numerator == 0 || denominator > kMostDenominator || numerator > kMostNumerator ||
      -numerator > kMostNumerator)
    return std::nullopt;
  return Scale{static_cast<std::int32_t>(numerator), static_cast<std::uint16_t>(denominator)};
}

std::string why_no_scale(Decimal number, const Unit& unit) {
  const auto [numerator, denominator] = scale_of(number, unit);
  if (numerator == 0) return "a scale cannot be 0";
  const std::string thousandths =
      "in thousandths of `" + std::string(canonical_unit(unit.dimension).spelling) + "`";
  return "this scale is " + digits_of(numerator) + "/" + digits_of(denominator) +
         (unit.dimension == vm::Dimension::number ? " in thousandths" : " " + thousandths) +
         ", but a robot stores fractions up to " + digits_of(kMostNumerator) + "/" +
         digits_of(kMostDenominator);
}

}  // namespace robosync::compiler
