// Reads one entry of "sensors", and a channel of it, which device descriptors have too. Values in robot.json override those of
// the descriptor. The unit of a channel is read first, because everything else may be written in it.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/names.hpp"
#include "compiler/config/values.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {

// ---- a channel

namespace {

// `value`, a raw count in thousandths, if one count is one `unit`.
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
                                 ", but `" + std::string(unit.spelling) + "` is " +
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
  if (!expect_kind(value, json::Kind::array, diagnostics, "\"labels\": [\"low\", \"high\"]"))
    return;
  channel.labels.clear();
  channel.truth = false;
  NameIndex known;
  for (const json::Value& item : value.items)
    add_label(item, known, channel, diagnostics);
  if (value.items.size() >= 2 && value.items.size() <= kMaxLabels) return;
  diagnostics
      .report(Code::E0205, "a channel can have 2 to " + std::to_string(kMaxLabels) +
                               " labels, but this one has " + std::to_string(value.items.size()))
      .label(value.span);
  channel.learns_words = true;  // so that the program's words are not reported as well
}

void read_truth(const json::Value& value, bool has_labels, ChannelConfig& channel,
                Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::boolean, diagnostics) || !value.truth) return;
  channel.truth = true;
  if (!has_labels) channel.labels = {"no", "yes"};
  if (channel.labels.size() != 2)
    diagnostics.report(Code::E0205, "a truth has two labels: for false, then for true")
        .label(value.span);
}

// Words have no unit and no scale: a reading is the index of a label.
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
    channel.stale_by_rate = true;
  }
  if (const auto* stale = fields.find("stale_after")) {
    channel.stale_ms = read_milliseconds(*stale, diagnostics).value_or(channel.stale_ms);
    channel.stale_by_rate = false;
  }
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

// ---- a sensor

namespace {

// A misspelt name would be a second channel, of the first input.
void report_unknown_channel(const Device& device, const json::Value& channels,
                            const json::Member& member, Diagnostics& diagnostics) {
  std::vector<std::string> own, free;
  for (const ChannelConfig& channel : device.sensor.channels) {
    own.push_back(channel.name.text);
    if (std::ranges::none_of(channels.members, [&](const json::Member& other) {
          return same_name(other.key, channel.name.text);
        }))
      free.push_back(channel.name.text);
  }
  Diagnostic& d = diagnostics
                      .report(Code::E0202, "the device `" + device.name + "` has no channel `" +
                                               member.key + "`")
                      .label(member.key_span);
  did_you_mean(d, member.key_span, member.key, free, "\"");
  d.helps("it has " + list_names(own) + "; one of your own says its `input`");
}

// The descriptor's channel of this name; else, as the pattern for a new one, that of its input, or the first.
ChannelConfig pattern_for(const Device& device, const json::Value& channels,
                          const json::Member& member, Diagnostics& diagnostics) {
  const auto& known = device.sensor.channels;
  auto same = std::ranges::find_if(known, [&](const ChannelConfig& channel) {
    return same_name(channel.name.text, member.key);
  });
  if (same == known.end() && !device.is_generic()) {
    const auto input = std::ranges::find(member.value.members, "input", &json::Member::key);
    if (input == member.value.members.end())
      report_unknown_channel(device, channels, member, diagnostics);
    else
      same = std::ranges::find_if(known, [&](const ChannelConfig& channel) {
        return std::to_string(channel.input) == input->value.text;
      });
  }
  ChannelConfig channel = same == known.end() ? known.front() : *same;
  channel.name = {member.key, member.key_span};
  channel.unit_span = member.key_span;
  return channel;
}

void check_channel_names(const std::vector<ChannelConfig>& channels, Diagnostics& diagnostics) {
  const NameIndex places = index_of(channels);
  for (const ChannelConfig& channel : channels) {
    check_name(channel.name, diagnostics);
    const Spelled& first = channels[*places.find(channel.name.text)].name;
    if (first.text != channel.name.text)
      diagnostics
          .report(Code::E0101, channel.name.shown() + " and `" + first.text + "` are the same name")
          .label(channel.name.span)
          .label(first.span, "first given here", false);
  }
}

void read_channels(const json::Value& value, const Device& device, SensorConfig& sensor,
                   Diagnostics& diagnostics) {
  constexpr std::string_view example = "\"channels\": {\"LEVEL\": {\"range\": [0, 10]}}";
  if (!expect_kind(value, json::Kind::object, diagnostics, example)) return;
  report_repeated_keys(value, diagnostics);
  if (value.members.empty()) {
    diagnostics.report(Code::E0205, "a sensor needs at least one channel").label(value.span);
    return;
  }
  sensor.channels.clear();
  for (const json::Member& member : value.members) {
    ChannelConfig channel = pattern_for(device, value, member, diagnostics);
    read_channel(member.value, device.inputs, channel, diagnostics);
    sensor.channels.push_back(std::move(channel));
  }
  check_channel_names(sensor.channels, diagnostics);
}

void report_without(const char* key, const json::Value& value, const Device& device,
                    Diagnostics& diagnostics) {
  diagnostics.report(Code::E0205, "a " + device.name + " has no `" + key + "`")
      .label(value.span)
      .helps("remove it; `input` of a channel says what it reads");
}

// Only for devices with registers: on any other device, all channels would become the same input.
void read_register(const json::Value& value, const Device& device, SensorConfig& sensor,
                   Diagnostics& diagnostics) {
  if (!device.has_registers()) return report_without("register", value, device, diagnostics);
  for (ChannelConfig& channel : sensor.channels)
    channel.input =
        static_cast<std::uint8_t>(read_whole(value, 0, kRegisters - 1, diagnostics).value_or(0));
}

constexpr std::array<std::string_view, static_cast<std::size_t>(vm::SpiFormat::count_)> kFormats = {
    "uint16", "int16", "uint16le", "int16le", "uint8", "int8"};

void read_format(const json::Value& value, const Device& device, SensorConfig& sensor,
                 Diagnostics& diagnostics) {
  if (device.sensor.driver != vm::DriverId::spi_register)
    return report_without("format", value, device, diagnostics);
  sensor.format = static_cast<std::uint8_t>(read_choice(value, kFormats, diagnostics).value_or(0));
}

// Fed channels are not sampled: they have no period, and go stale only if robot.json says so.
void make_fed(SensorConfig& sensor, const json::Value* channels, Diagnostics& diagnostics) {
  sensor.driver = vm::DriverId::virtual_sensor;
  sensor.format = 0;
  for (ChannelConfig& channel : sensor.channels) {
    if (channel.stale_by_rate) channel.stale_ms = 0;
    channel.period_ms = 0;
  }
  if (channels == nullptr) return;
  for (const json::Member& channel : channels->members)
    for (const json::Member& key : channel.value.members)
      if (key.key == "rate")
        diagnostics.report(Code::N0001, "this sensor is fed, not sampled: its rate has no effect")
            .label(key.value.span);
}

// Without "channels", messages point to the sensor's name.
void place_channels(SensorConfig& sensor) {
  for (ChannelConfig& channel : sensor.channels) {
    channel.name.span = sensor.name.span;
    channel.unit_span = sensor.name.span;
  }
}

void check_place(const Fields& fields, const Device& device, const WiringType& type,
                 const Board::Part* part, WiringReader& wiring, const Wiring& place) {
  const vm::DriverId driver = device.sensor.driver;
  if (vm::is_on_i2c(driver)) {
    wiring.check_bus(fields, place);
    if (wiring.check_own_address(fields, place, device)) wiring.check_address(fields, place);
  }
  if (vm::is_on_spi(driver)) wiring.check_spi(fields, place);
  if (vm::is_on_pin(driver)) wiring.check_input(fields, place);
  if (vm::is_by_echo(driver)) wiring.check_echo(fields, place);
  if (vm::counts_edges(driver)) wiring.check_encoder(fields, place);
  if (vm::is_analog(driver)) wiring.check_analog(fields, place);
  if (vm::is_of_board(driver)) wiring.check_part(fields, part);
  const bool hears = vm::is_microphone(driver) && part != nullptr;
  if (vm::is_analog(driver) || hears) wiring.check_converter(fields, hears);
  if (driver == vm::DriverId::virtual_sensor) wiring.check_without_driver(fields, type, place);
  if (part == nullptr) wiring.check_volts(fields, device.volts);
}

// Its channels are those of a block of sound.
void check_sound_rate(const json::Value* channels, SensorConfig& sensor, Diagnostics& diagnostics) {
  if (sensor.period_ms == vm::kSoundPeriodMs) return;
  sensor.period_ms = vm::kSoundPeriodMs;
  for (const json::Member& channel : channels->members)
    for (const json::Member& key : channel.value.members)
      if (key.key == "rate")
        diagnostics
            .report(Code::E0205, fmt::format("a microphone is read every {} ms", sensor.period_ms))
            .label(key.value.span)
            .helps("remove this rate");
}

// All the edges of a period may come at once.
void check_encoder_rate(const json::Value* channels, SensorConfig& sensor,
                        Diagnostics& diagnostics) {
  if (sensor.period_ms <= vm::kMostEncoderPeriodMs) return;
  const std::uint16_t period = sensor.period_ms;
  sensor.period_ms = vm::kMostEncoderPeriodMs;
  for (const json::Member& member : channels->members)
    for (const json::Member& key : member.value.members) {
      if (key.key != "rate") continue;
      diagnostics
          .report(
              Code::E0205,
              fmt::format("this counts edges for {} ms, but a board counts for at most {} ms at a "
                          "time",
                          period, vm::kMostEncoderPeriodMs))
          .label(key.value.span)
          .helps(fmt::format("use a rate of at least {}Hz; `change` makes readings rarer",
                             1000 / vm::kMostEncoderPeriodMs));
      return;
    }
}

// The descriptor's own rate is always possible.
void check_rate(const Fields& fields, const Device& device, SensorConfig& sensor,
                Diagnostics& diagnostics) {
  const auto* const channels = fields.find("channels");
  if (vm::is_microphone(sensor.driver)) return check_sound_rate(channels, sensor, diagnostics);
  if (vm::counts_edges(sensor.driver)) return check_encoder_rate(channels, sensor, diagnostics);
  // What is fed has another driver and no period.
  const std::uint16_t shortest = device.shortest_period_ms();
  if (channels == nullptr || sensor.driver != device.sensor.driver) return;
  const bool by_echo = vm::is_by_echo(sensor.driver);
  for (std::size_t c = 0; c < channels->members.size() && c < sensor.channels.size(); ++c) {
    if (sensor.channels[c].period_ms >= shortest) continue;
    for (const json::Member& key : channels->members[c].value.members)
      if (key.key == "rate")
        diagnostics
            .report(Code::E0205,
                    fmt::format("this measures every {} ms, but {} {} ms{}",
                                sensor.channels[c].period_ms,
                                by_echo ? "the echoes of one burst take" : "each measurement takes",
                                shortest, by_echo ? " to die away" : ""))
            .label(key.value.span)
            .label(fields.find("device")->span, "of this device", false)
            .helps(fmt::format("use a rate of at most {}Hz", 1000 / shortest));
  }
}

// A reading that becomes unknown before the next one comes would be unknown again and again.
void check_stale_after(const json::Value* channels, const SensorConfig& sensor,
                       Diagnostics& diagnostics) {
  if (channels == nullptr) return;
  for (std::size_t c = 0; c < channels->members.size() && c < sensor.channels.size(); ++c) {
    const ChannelConfig& channel = sensor.channels[c];
    if (channel.stale_ms == 0 || channel.stale_ms >= channel.period_ms) continue;
    for (const json::Member& key : channels->members[c].value.members)
      if (key.key == "stale_after")
        diagnostics
            .report(Code::E0205,
                    fmt::format("a reading would become unknown after {} ms, but this is measured "
                                "every {} ms",
                                channel.stale_ms, channel.period_ms))
            .label(key.value.span)
            .helps(fmt::format("use a `stale_after` of {}ms, twice the time between two readings, "
                               "or a faster `rate`",
                               std::min(2 * channel.period_ms, UINT16_MAX)));
  }
}

}  // namespace

std::optional<SensorConfig> read_sensor(const json::Value& value, WiringReader& wiring,
                                        Diagnostics& diagnostics) {
  Fields fields(value, Object::sensor, diagnostics);
  const auto name = read_name(fields, "a sensor", diagnostics);
  const Board::Part* part = find_part(fields, wiring.board(), true);
  const WiringType* type = choose_type(fields, part, true, diagnostics);
  if (!name) return std::nullopt;
  const Device* const known = choose_device(fields, type, *name, wiring.board(), true, diagnostics);
  const Device& device = known != nullptr ? *known : virtual_device(true);
  SensorConfig sensor = device.sensor;
  sensor.name = *name;
  if (part != nullptr) sensor.part = part->name;
  place_channels(sensor);
  sensor.is_unknown = known == nullptr;
  if (sensor.is_unknown) return sensor;
  const bool is_driven = device.has_driver;
  if (type != nullptr) {
    const Wiring place = wiring.read_sensor(fields, *type, part, device.sensor.driver);
    sensor.bus = place.bus;
    sensor.address = place.place;
    if (type->name != "VIRTUAL" && is_driven)
      check_place(fields, device, *type, part, wiring, place);
    else if (type->name != "VIRTUAL")
      wiring.check_without_driver(fields, *type, place);
  }
  if (const auto* number = fields.find("register"))
    read_register(*number, device, sensor, diagnostics);
  if (const auto* format = fields.find("format")) read_format(*format, device, sensor, diagnostics);
  const auto* channels = fields.find("channels");
  if (channels != nullptr) read_channels(*channels, device, sensor, diagnostics);
  const bool is_virtual = type != nullptr && type->name == "VIRTUAL";
  if (vm::counts_edges(device.sensor.driver)) {
    if (!is_virtual) scale_encoder(fields, sensor, channels, diagnostics);
  } else {
    for (const char* key : {"pulses_per_turn", "wheel"})
      if (const auto* foreign = fields.find(key))
        report_without(key, *foreign, device, diagnostics);
  }
  if (is_virtual || !is_driven) make_fed(sensor, channels, diagnostics);
  for (const ChannelConfig& channel : sensor.channels)
    if (channel.period_ms != 0 && (sensor.period_ms == 0 || channel.period_ms < sensor.period_ms))
      sensor.period_ms = channel.period_ms;
  check_rate(fields, device, sensor, diagnostics);
  check_stale_after(channels, sensor, diagnostics);
  return sensor;
}

}  // namespace robosync::compiler
