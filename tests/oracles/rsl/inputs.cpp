#include "tests/oracles/rsl/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

namespace robosync::oracle {
namespace {

constexpr Millis kFadeEvery = 100;  // "ten times a second"

}  // namespace

Inputs::Inputs(const compiler::ir::Program& program, const compiler::Robot& robot, Trace& trace)
    : program_(program), trace_(trace), smoothing_(program.checks.size()) {
  for (std::size_t s = 0; s < robot.sensors.size(); ++s)
    for (std::size_t c = 0; c < robot.sensors[s].channels.size(); ++c)
      channels_[{s, c}].config = &robot.sensors[s].channels[c];
  for (std::size_t v = 0; v < program.variables.size(); ++v) {
    const compiler::ir::Variable& variable = program.variables[v];
    const bool band = variable.kind == vm::VariableKind::band;
    snapshot_.variables.push_back(band ? std::nullopt : Number(variable.initial));
    if (!band) begin_fade(v, 0);
  }
}

// ---- readings

bool Inputs::feed(compiler::ChannelRef channel, std::int64_t value, Millis now) {
  Channel& fed = channels_.at(channel);
  value = std::clamp<std::int64_t>(value, fed.config->min, fed.config->max);
  const bool known = fed.value && !is_stale(fed, now);
  const std::int64_t least = std::max<std::int64_t>(fed.config->change, 1);
  fed.heard = now;
  if (known && std::abs(value - *fed.value) < least) return false;
  fed.value = value;
  fed.news = true;
  return true;
}

bool Inputs::is_stale(const Channel& channel, Millis now) const {
  return channel.config->stale_ms != 0 && now > channel.heard + channel.config->stale_ms;
}

void Inputs::enter_readings(Millis now) {
  for (auto& [ref, channel] : channels_) {
    Number& seen = snapshot_.channels[ref];
    if (channel.value && is_stale(channel, now)) {
      if (seen) trace_.channel("stale", ref, std::nullopt);
      seen = std::nullopt;
    }
    if (!channel.news) continue;
    channel.news = false;
    if (seen != channel.value) trace_.channel("input", ref, channel.value);
    seen = channel.value;
  }
}

Snapshot Inputs::readings(Millis heard, Millis now) const {
  Snapshot result = snapshot_;
  result.now = now;
  for (const auto& [ref, channel] : channels_)
    result.channels[ref] = is_stale(channel, heard) ? std::nullopt : channel.value;
  return result;
}

// ---- what is remembered

std::int64_t clamped(const compiler::ir::Variable& variable, std::int64_t value) {
  return std::clamp<std::int64_t>(value, variable.min, variable.max);
}

void Inputs::put(std::size_t variable, Number value) {
  if (snapshot_.variables[variable] == value) return;
  snapshot_.variables[variable] = value;
  trace_.variable(variable, value);
}

// Of several SETs the most important one counts; a RAISE changes what the less important left. "The sum is
// bounded once."
void Inputs::enter_variables(Millis now) {
  std::map<std::size_t, std::int64_t> values;
  for (const std::vector<Changes>& step : staged_)
    for (auto response = step.rbegin(); response != step.rend(); ++response)
      for (const auto& [variable, change] : *response) {
        const auto before = values.emplace(variable, *snapshot_.variables[variable]).first->second;
        values[variable] = change.set ? *change.set : *add(before, change.raise);
      }
  staged_.clear();
  for (const auto& [variable, value] : values) {
    snapshot_.variables[variable] = clamped(program_.variables[variable], value);
    begin_fade(variable, now);
  }
}

void Inputs::begin_fade(std::size_t variable, Millis now) {
  const compiler::ir::Variable& config = program_.variables[variable];
  const std::int64_t way = *snapshot_.variables[variable] - config.fades_to;
  fades_.erase(variable);
  if (config.fade != 0 && way != 0) fades_[variable] = {way, now};
}

// Of the way, the same part is left after each tenth of a second. What is less than a thousandth is
// cut off, so it ends.
void Inputs::fade(Millis now) {
  for (auto next = fades_.begin(); next != fades_.end();) {
    const auto& [variable, fade] = *next;
    const Millis since = now - fade.began;
    std::int64_t left = fade.way;
    if (since > 0 && since % kFadeEvery == 0) {
      const compiler::ir::Variable& config = program_.variables[variable];
      const long double part = static_cast<long double>(config.fade) / 2147483648.0L;
      left =
          static_cast<std::int64_t>(static_cast<long double>(fade.way) *
                                    std::pow(part, static_cast<long double>(since / kFadeEvery)));
      snapshot_.variables[variable] = config.fades_to + left;
    }
    next = left == 0 ? fades_.erase(next) : std::next(next);
  }
}

// ---- CHECKs

Number Inputs::smoothed(const compiler::ir::Check& check, Smoothing& smoothing, Number value,
                        Millis now) const {
  if (check.window <= 1) return value;
  if (!value) {
    smoothing.samples.clear();
    return std::nullopt;
  }
  const auto sample = [&](std::int64_t it, Millis at) {
    smoothing.sampled = at;
    smoothing.samples.push_back(it);
    if (smoothing.samples.size() > check.window) smoothing.samples.pop_front();
  };
  if (smoothing.samples.empty()) {
    sample(*value, now);
  } else if (now == smoothing.sampled) {
    smoothing.samples.back() = *value;
  } else {
    // What it has kept at an instant counts when that millisecond is over.
    if (now > smoothing.sampled + check.sample_ms) sample(smoothing.held, now - 1);
    if (now == smoothing.sampled + check.sample_ms && *value != smoothing.held) sample(*value, now);
  }
  smoothing.held = *value;
  std::vector<std::int64_t> sorted(smoothing.samples.begin(), smoothing.samples.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted[(sorted.size() - 1) / 2];
}

// "The first band that has the value is it. A band is left only when the value is past its border
// by the margin."
void Inputs::check(const compiler::ir::Check& check, Smoothing& smoothing, Millis now) {
  const bool channel = check.input.operation == compiler::Operation::input;
  const Number value = smoothed(
      check, smoothing,
      channel ? snapshot_.channels[check.input.channel] : snapshot_.variables[check.input.index],
      now);
  if (!value) {
    put(check.variable, std::nullopt);
    return;
  }
  const std::size_t last = smoothing.band;
  if (last < check.bands.size() && *value >= check.bands[last].stay_low &&
      *value <= check.bands[last].stay_high) {
    put(check.variable, static_cast<std::int64_t>(last) * 1000);
    return;
  }
  const auto band = std::find_if(check.bands.begin(), check.bands.end(), [&](const vm::Band& b) {
    return *value >= b.low && *value <= b.high;
  });
  if (band == check.bands.end()) {
    put(check.variable, std::nullopt);
    return;
  }
  smoothing.band = static_cast<std::size_t>(band - check.bands.begin());
  put(check.variable, static_cast<std::int64_t>(smoothing.band) * 1000);
}

void Inputs::enter(Millis now) {
  snapshot_.now = now;
  enter_readings(now);
  const std::vector<Number> before = snapshot_.variables;
  fade(now);
  enter_variables(now);
  for (std::size_t v = 0; v < before.size(); ++v)
    if (snapshot_.variables[v] != before[v]) trace_.variable(v, snapshot_.variables[v]);
  for (std::size_t c = 0; c < program_.checks.size(); ++c)
    check(program_.checks[c], smoothing_[c], now);
}

}  // namespace robosync::oracle
