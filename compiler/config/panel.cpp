// The lights of a panel or a strip: their number, their layout and their colour.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>

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
constexpr std::array kColors = {
#define COLOR(name, red, green, blue) Color{#name, red, green, blue},
#include "vm/colors.def"
#undef COLOR
};

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

vm::Value dimmed(const Color& pure, const Fields& fields, Diagnostics& diagnostics) {
  const auto* brightness = fields.find("brightness");
  const auto percent =
      brightness != nullptr ? read_percent(*brightness, diagnostics) : kUsualPanelPercent;
  return static_cast<vm::Value>(dimmed(pure.red, percent) << 16 | dimmed(pure.green, percent) << 8 |
                                dimmed(pure.blue, percent));
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
  panel.color = dimmed(pure, fields, diagnostics);
  return panel;
}

// A strip that is not wired may leave out how many lights it has.
PanelConfig read_strip(Fields& fields, Diagnostics& diagnostics) {
  PanelConfig strip{.lay = 1, .color = dimmed(kColors.front(), fields, diagnostics)};
  const auto* type = fields.find("type");
  const bool is_virtual = type != nullptr && type->text == "VIRTUAL";
  const auto* lights =
      is_virtual ? fields.find("lights") : fields.require("lights", "a `ws2812_strip`");
  if (lights == nullptr) return strip;
  const auto count = read_whole(*lights, 1, vm::kMostPanelLights, diagnostics);
  strip.lay = static_cast<std::uint8_t>(count.value_or(1));
  return strip;
}

}  // namespace

std::vector<std::string_view> panel_colors() {
  std::vector<std::string_view> names(kColors.size());
  std::ranges::transform(kColors, names.begin(), &Color::name);
  return names;
}

std::optional<PanelConfig> read_lights(Fields& fields, vm::DriverId driver,
                                       Diagnostics& diagnostics) {
  if (!vm::drives_panel(driver)) return std::nullopt;
  return vm::is_strip(driver) ? read_strip(fields, diagnostics) : read_panel(fields, diagnostics);
}

}  // namespace robosync::compiler
