// The lights of a panel: their layout and their colour.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "compiler/config/entries.hpp"
#include "compiler/config/values.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

constexpr std::array<std::string_view, 2> kSizes = {"5x5", "8x8"};

struct Color {
  std::string_view name;
  std::uint8_t red, green, blue;
};
constexpr std::array kColors = {Color{"white", 255, 255, 255}, Color{"red", 255, 0, 0},
                                Color{"orange", 255, 80, 0},   Color{"yellow", 255, 180, 0},
                                Color{"green", 0, 255, 0},     Color{"cyan", 0, 255, 255},
                                Color{"blue", 0, 0, 255},      Color{"purple", 180, 0, 255}};

static_assert(255 * kMostPanelPercent / 100 <= vm::kMostLight);

Color read_color(const json::Value& value, Diagnostics& diagnostics) {
  return kColors.at(read_choice(value, panel_colors(), diagnostics).value_or(0));
}

std::int64_t read_percent(const json::Value& value, Diagnostics& diagnostics) {
  return read_whole(value, 1, kMostPanelPercent, diagnostics).value_or(kUsualPanelPercent);
}

// A part of the colour that is not 0 stays at least 1.
std::uint32_t dimmed(std::uint8_t part, std::int64_t percent) {
  const auto rest = static_cast<std::uint32_t>(part * percent / 100);
  return part == 0 ? 0 : std::max(rest, 1U);
}

}  // namespace

std::vector<std::string_view> panel_colors() {
  std::vector<std::string_view> names(kColors.size());
  std::ranges::transform(kColors, names.begin(), &Color::name);
  return names;
}

std::span<const std::string_view> panel_keys() {
  static constexpr std::array<std::string_view, 4> kKeys = {"size", "zigzag", "color",
                                                            "brightness"};
  return kKeys;
}

PanelConfig read_panel(const Fields& fields, Diagnostics& diagnostics) {
  PanelConfig panel;
  const auto* size = fields.find("size");
  if (size != nullptr && read_choice(*size, kSizes, diagnostics).value_or(0) == 1)
    panel.lay |= vm::kPanelIsLarge;
  const auto* zigzag = fields.find("zigzag");
  if (zigzag != nullptr && expect_kind(*zigzag, json::Kind::boolean, diagnostics) && zigzag->truth)
    panel.lay |= vm::kPanelGoesBack;
  const auto* color = fields.find("color");
  const Color pure = color != nullptr ? read_color(*color, diagnostics) : kColors.front();
  const auto* brightness = fields.find("brightness");
  const auto percent =
      brightness != nullptr ? read_percent(*brightness, diagnostics) : kUsualPanelPercent;
  panel.color =
      static_cast<vm::Value>(dimmed(pure.red, percent) << 16 | dimmed(pure.green, percent) << 8 |
                             dimmed(pure.blue, percent));
  return panel;
}

}  // namespace robosync::compiler
