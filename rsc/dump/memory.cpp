// What the program stores: variables, bands of checks, timers. In the image's order.
#include <vector>

#include <fmt/format.h>

#include "rsc/dump/parts.hpp"
#include "rsc/names.hpp"
#include "rsc/quantity.hpp"

namespace robosync::tool {
namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(vm::VariableKind::count_)> kKinds =
    {"number", "state", "feeling", "signal", "band", "timer", "number that is kept"};
constexpr std::array<std::string_view, static_cast<std::size_t>(vm::TimerKind::count_)> kTimers = {
#define TIMER(name, words, counts, doc) doc,
#include "vm/timers.def"
#undef TIMER
};
constexpr std::int64_t kWholeFade = std::int64_t{1} << 31;
constexpr int kPerMille = 1000;

std::string time(vm::Value value) {
  return format_quantity(value, vm::Dimension::duration);
}

std::string fade_text(const vm::Variable& variable) {
  if (variable.fade == 0) return {};
  const std::int64_t kept = (variable.fade * std::int64_t{kPerMille} + kWholeFade / 2) / kWholeFade;
  return fmt::format(", fades to {}: of the distance {}.{} % stay after {} ms",
                     format_quantity(variable.fades_to, variable.dimension), kept / 10, kept % 10,
                     vm::kFadeTickMs);
}

std::string variable_text(const vm::Image& image, std::size_t index) {
  const vm::Variable& variable = image.variables[index];
  std::string text =
      fmt::format("  {} {}: {}, starts at {}", index, image.string(variable.name),
                  word_of(kKinds, variable.kind), shown_value(image, variable, variable.initial));
  std::vector<std::string_view> labels;
  for (std::size_t i = 0; i < variable.label_count; ++i)
    labels.push_back(image.string(image.labels[variable.first_label + i]));
  if (!labels.empty()) return text + fmt::format(", labels {}\n", fmt::join(labels, " | "));
  if (variable.min > vm::kValueMin || variable.max < vm::kValueMax) {
    text += fmt::format(", range {} … {}", format_quantity(variable.min, variable.dimension),
                        format_quantity(variable.max, variable.dimension));
  }
  return text + fade_text(variable) + "\n";
}

vm::Dimension input_dimension(const vm::Image& image, std::size_t input) {
  const std::size_t channels = image.channels.size();
  return input < channels ? image.channels[input].dimension
                          : image.variables[input - channels].dimension;
}

// The limits of the number range mean no limit.
std::string range_text(vm::Value low, vm::Value high, vm::Dimension dimension) {
  if (low == vm::kValueMin && high == vm::kValueMax) return "anything";
  if (low == vm::kValueMin) return "up to " + format_quantity(high, dimension);
  if (high == vm::kValueMax) return "from " + format_quantity(low, dimension);
  return fmt::format("{} … {}", format_quantity(low, dimension), format_quantity(high, dimension));
}

std::string check_text(const vm::Image& image, const vm::Check& check) {
  const vm::Variable& variable = image.variables[check.variable];
  const vm::Dimension dimension = input_dimension(image, check.input);
  std::string text =
      fmt::format("  {}: of {}", image.string(variable.name), input_name(image, check.input));
  if (check.window > 1) {
    text += fmt::format(", median of {} samples, one every {} ms", check.window, check.sample_ms);
  }
  text += '\n';
  for (std::size_t i = 0; i < check.band_count; ++i) {
    const vm::Band& band = image.bands[check.first_band + i];
    const auto value = static_cast<vm::Value>(i) * vm::kScale;
    text += fmt::format("    {}: {}", shown_value(image, variable, value),
                        range_text(band.low, band.high, dimension));
    if (band.stay_low != band.low || band.stay_high != band.high) {
      text += ", stays " + range_text(band.stay_low, band.stay_high, dimension);
    }
    text += '\n';
  }
  return text;
}

std::string timer_text(std::size_t index, const vm::Timer& timer) {
  std::string text = fmt::format("  {} {}", index, word_of(kTimers, timer.kind));
  if (timer.count != 0) text += fmt::format(" {} times", timer.count);
  if (timer.kind == vm::TimerKind::changed) {
    text += " by " + format_quantity(timer.duration, vm::Dimension::number);
  } else if (timer.duration != 0) {
    text += " " + time(timer.duration);
  }
  return text + fmt::format(", memory from word {}\n", timer.state);
}

std::string modifiers_text(std::size_t index, const vm::Modifiers& modifiers) {
  std::string text = fmt::format("  {}", index);
  if (modifiers.cooldown != 0) text += " COOLDOWN " + time(modifiers.cooldown);
  if (modifiers.waiting != 0) text += " WAITING " + time(modifiers.waiting);
  if (modifiers.restarting != 0) text += " RESTARTING";
  return text + "\n";
}

// A heading only if there is something below it.
template <typename Records, typename Text>
std::string section(std::string_view heading, const Records& records, Text text_of) {
  if (records.empty()) return {};
  std::string text = fmt::format("\n{}\n", heading);
  for (std::size_t i = 0; i < records.size(); ++i)
    text += text_of(i);
  return text;
}

}  // namespace

std::string input_name(const vm::Image& image, std::size_t input) {
  if (input >= image.channels.size()) {
    return std::string(image.string(image.variables[input - image.channels.size()].name));
  }
  const vm::Channel& channel = image.channels[input];
  return fmt::format("{} {}", image.string(image.sensors[channel.sensor].name),
                     image.string(channel.name));
}

std::string shown_value(const vm::Image& image, const vm::Variable& variable, vm::Value value) {
  const bool is_label = variable.label_count > 0 && value >= 0 && value % vm::kScale == 0 &&
                        value / vm::kScale < variable.label_count;
  if (!is_label) return format_quantity(value, variable.dimension);
  const std::size_t label =
      std::size_t{variable.first_label} + static_cast<std::size_t>(value / vm::kScale);
  return std::string(image.string(image.labels[label]));
}

std::string dump_memory(const vm::Image& image) {
  return section("variables", image.variables,
                 [&](std::size_t i) { return variable_text(image, i); }) +
         section("checks", image.checks,
                 [&](std::size_t i) { return check_text(image, image.checks[i]); }) +
         section("timers", image.timers,
                 [&](std::size_t i) { return timer_text(i, image.timers[i]); }) +
         section("modifiers", image.modifiers,
                 [&](std::size_t i) { return modifiers_text(i, image.modifiers[i]); }) +
         section("constants (thousandths)", image.constants, [&](std::size_t i) {
           return fmt::format("  {:>4}  {}\n", i, image.constants[i]);
         });
}

}  // namespace robosync::tool
