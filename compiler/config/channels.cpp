// Reads a channel on top of its descriptor's values. The unit comes first: everything else may be
// written in it.
#include "compiler/config/channels.hpp"

#include <algorithm>

#include "compiler/config/fields.hpp"
#include "compiler/config/names.hpp"
#include "compiler/config/values.hpp"

namespace robosync::compiler {
namespace {

constexpr int kStalePeriods = 5;

// `value`, a raw count in thousandths, when one count is one `unit`.
vm::Value count_in(vm::Value value, const Unit& unit) {
  constexpr unsigned kDecimals = 3;
  const auto limit = value < 0 ? vm::kValueMin : vm::kValueMax;
  return to_value({value, kDecimals}, unit).value_or(limit);
}

// A descriptor without a unit gives raw counts: one count then becomes one of the new unit.
void change_unit(const Unit& unit, Span span, ChannelConfig& channel, Diagnostics& diagnostics) {
  const bool raw = channel.unit->dimension == vm::Dimension::number;
  if (!raw && unit.dimension != channel.unit->dimension) {
    diagnostics
        .report(Code::E0301, "the device measures " +
                                 std::string(dimension_phrase(channel.unit->dimension)) +
                                 ", and `" + std::string(unit.spelling) + "` is " +
                                 std::string(dimension_phrase(unit.dimension)))
        .label(span);
    return;
  }
  if (raw) {
    channel.min = count_in(channel.min, unit);
    channel.max = count_in(channel.max, unit);
    channel.scale = to_scale({1, 0}, unit).value_or(Scale{});
    channel.offset = count_in(0, unit);
  }
  channel.unit = &unit;
}

constexpr std::size_t kMaxLabels = 255;

void add_label(const json::Value& item, NameIndex& known, ChannelConfig& channel,
               Diagnostics& diagnostics) {
  const auto label = read_text(item, diagnostics);
  if (!label) return;
  if (!known.add(item.text, channel.labels.size()))
    diagnostics.report(Code::E0101, "the label `" + *label + "` is given twice").label(item.span);
  else
    channel.labels.push_back(*label);
}

// ["released", "pressed"]: 0 is released, 1 is pressed.
void read_labels(const json::Value& value, ChannelConfig& channel, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::array, diagnostics)) return;
  channel.labels.clear();
  channel.truth = false;
  NameIndex known;
  for (const json::Value& item : value.items)
    add_label(item, known, channel, diagnostics);
  if (value.items.size() < 2 || value.items.size() > kMaxLabels)
    diagnostics.report(Code::E0205, "a channel has from 2 to 255 labels").label(value.span);
}

void read_truth(const json::Value& value, bool has_labels, ChannelConfig& channel,
                Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::boolean, diagnostics) || !value.truth) return;
  channel.truth = true;
  if (!has_labels) channel.labels = {"no", "yes"};
  if (channel.labels.size() != 2)
    diagnostics.report(Code::E0205, "a truth has two labels: the one for false, then for true")
        .label(value.span);
}

// Words have no unit and no scale: a reading is the place of a label.
void read_words(const Fields& fields, ChannelConfig& channel, Diagnostics& diagnostics) {
  const auto* labels = fields.find("labels");
  if (labels != nullptr) read_labels(*labels, channel, diagnostics);
  if (const auto* truth = fields.find("truth"))
    read_truth(*truth, labels != nullptr, channel, diagnostics);
  if (channel.labels.empty()) return;
  for (const char* key : {"unit", "range", "scale", "offset", "change"})
    if (const auto* other = fields.find(key))
      diagnostics.report(Code::E0205, "a channel with labels has no \"" + std::string(key) + "\"")
          .label(other->span);
  channel.unit = &canonical_unit(vm::Dimension::number);
  channel.min = 0;
  channel.max = static_cast<vm::Value>(channel.labels.size() - 1) * vm::kScale;
  channel.change = 0;
  channel.offset = 0;
  channel.scale = Scale{};
}

}  // namespace

void read_channel(const json::Value& value, unsigned inputs, ChannelConfig& channel,
                  Diagnostics& diagnostics) {
  const Fields fields(value, Object::channel, diagnostics);
  if (const auto* unit_value = fields.find("unit")) {
    channel.unit_span = unit_value->span;
    if (const Unit* unit = read_unit(*unit_value, diagnostics))
      change_unit(*unit, unit_value->span, channel, diagnostics);
  }
  if (const auto* input = fields.find("input"))
    channel.input = static_cast<std::uint8_t>(
        read_whole(*input, 0, static_cast<std::int64_t>(inputs) - 1, diagnostics)
            .value_or(channel.input));
  if (const auto* range = fields.find("range")) {
    const auto read =
        read_range(*range, *channel.unit, diagnostics).value_or(Range{channel.min, channel.max});
    channel.min = read.low;
    channel.max = read.high;
  }
  if (const auto* rate = fields.find("rate")) {
    channel.period_ms = read_rate(*rate, diagnostics).value_or(channel.period_ms);
    channel.stale_ms =
        static_cast<std::uint16_t>(std::min(channel.period_ms * kStalePeriods, UINT16_MAX));
  }
  if (const auto* stale = fields.find("stale_after"))
    channel.stale_ms = read_milliseconds(*stale, diagnostics).value_or(channel.stale_ms);
  if (const auto* scale = fields.find("scale"))
    channel.scale = read_scale(*scale, *channel.unit, diagnostics).value_or(channel.scale);
  if (const auto* offset = fields.find("offset"))
    channel.offset = read_quantity(*offset, *channel.unit, diagnostics).value_or(channel.offset);
  if (const auto* change = fields.find("change")) {
    channel.change = read_difference(*change, *channel.unit, diagnostics).value_or(channel.change);
    if (channel.change < 0) {
      diagnostics.report(Code::E0205, "a change cannot be negative").label(change->span);
      channel.change = 0;
    }
  }
  read_words(fields, channel, diagnostics);
}

}  // namespace robosync::compiler
