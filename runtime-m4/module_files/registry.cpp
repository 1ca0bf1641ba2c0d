// A module's functions know nothing about their caller but the arguments, so each place in the list has its own functions.
#include "runtime-m4/module_files/registry.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "runtime-m4/algorithms/modules.hpp"
#include "runtime-m4/module_files/description.hpp"
#include "runtime-m4/module_files/process.hpp"

namespace robosync::module_files {
namespace {

namespace fs = std::filesystem;

struct Place {
  explicit Place(const std::string& file) : process(file), description(process.described()) {}

  Config all_of(const std::int32_t* config) const {
    Config all{};
    std::copy_n(config, description.module().parameters, all.begin());
    return all;
  }

  Process process;
  Description description;
  fs::file_time_type written;
  std::string path;
  bool gave_up = false;
};

std::array<std::unique_ptr<Place>, kMostFiles> places;

// --- the functions it is called by ---

// For a module in trouble: more than any board has.
constexpr std::uint32_t kTooMuch = UINT32_MAX;

Sizes sizes_of(Place& place, const std::int32_t* config) {
  Sizes sizes;
  if (!place.process.measure(place.all_of(config), sizes)) return {kTooMuch, kTooMuch, kTooMuch};
  return sizes;
}

std::size_t state_bytes_of(Place& place, const std::int32_t* config) {
  const std::uint32_t bytes = sizes_of(place, config).state;
  return std::min<std::size_t>(bytes, ROBOSYNC_MOST_BYTES);
}

// A failure is not reported here: the first process() then fails.
void init(Place& place, void* memory, const std::int32_t* config, std::uint32_t period_ms) {
  State state{};
  if (place.process.init(place.all_of(config), period_ms, state))
    std::copy_n(state.begin(), state_bytes_of(place, config), static_cast<std::byte*>(memory));
}

std::uint32_t process(Place& place, void* memory, const robosync_block& block) {
  const robosync_module& module = place.description.module();
  State state{};
  const std::size_t bytes = state_bytes_of(place, block.config);
  // If the module is in trouble, it is unknown how much of the memory is its own.
  if (!place.process.trouble().empty()) return ROBOSYNC_FAILED;
  auto* const own = static_cast<std::byte*>(memory);
  std::copy_n(own, bytes, state.begin());
  Inputs inputs{};
  std::copy_n(block.inputs, module.inputs, inputs.begin());
  Outputs outputs{};
  std::copy_n(block.outputs, module.outputs, outputs.begin());
  std::uint32_t changed = 0;
  if (!place.process.process(place.all_of(block.config), inputs, state, outputs, changed))
    return ROBOSYNC_FAILED;
  place.gave_up = place.gave_up || changed == ROBOSYNC_FAILED;
  std::copy_n(state.begin(), bytes, own);
  std::copy_n(outputs.begin(), module.outputs, block.outputs);
  return changed;
}

template <std::size_t kPlace>
void set_functions_of(robosync_module& module) {
  module.state_bytes = [](const std::int32_t* config) {
    return sizes_of(*places[kPlace], config).state;
  };
  module.scratch_bytes = [](const std::int32_t* config) {
    return sizes_of(*places[kPlace], config).scratch;
  };
  module.cost = [](const std::int32_t* config) { return sizes_of(*places[kPlace], config).cost; };
  module.init = [](void* state, const std::int32_t* config, std::uint32_t period_ms) {
    init(*places[kPlace], state, config, period_ms);
  };
  module.process = [](void* state, void*, const robosync_block* block) {
    return process(*places[kPlace], state, *block);
  };
}

template <std::size_t... kPlaces>
void set_functions(robosync_module& module, std::size_t place, std::index_sequence<kPlaces...>) {
  constexpr void (*kSet[])(robosync_module&) = {set_functions_of<kPlaces>...};
  kSet[place](module);
}

// --- the list ---

// The place of a file that is already there, else a free one, else none.
std::size_t place_for(const std::string& path) {
  const auto is_its = [&path](const auto& place) {
    return place != nullptr && place->path == path;
  };
  const auto own = std::ranges::find_if(places, is_its);
  const auto is_free = [](const auto& place) { return place == nullptr; };
  const auto found = own != places.end() ? own : std::ranges::find_if(places, is_free);
  return static_cast<std::size_t>(found - places.begin());
}

// Uses the usual parameters; the firmware's judge() checks with the program's own.
std::string mistake_in_sizes(Place& place) {
  Sizes sizes;
  if (!place.process.measure(place.description.usual(), sizes)) return place.process.trouble();
  const std::uint64_t bytes = (std::uint64_t{sizes.state} + 7) / 8 * 8 + sizes.scratch;
  if (bytes > ROBOSYNC_MOST_BYTES)
    return "its state and scratch come to " + std::to_string(bytes) + " bytes, more than " +
           std::to_string(ROBOSYNC_MOST_BYTES);
  return sizes.cost == 0 ? "its cost() is 0" : "";
}

std::string mistake_in(Place& place) {
  if (!place.process.trouble().empty()) return place.process.trouble();
  if (!place.description.mistake().empty()) return place.description.mistake();
  return mistake_in_sizes(place);
}

}  // namespace

Loaded load(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {nullptr, 0, "it is not a file"};
  const fs::file_time_type written = fs::last_write_time(path, error);
  const std::size_t number = place_for(path);
  if (number == kMostFiles)
    return {nullptr, 0, "there are " + std::to_string(kMostFiles) + " others already"};
  auto& place = places[number];
  if (place == nullptr || place->written != written) {
    place = std::make_unique<Place>(path);
    if (std::string why = mistake_in(*place); !why.empty()) {
      place.reset();
      return {nullptr, 0, std::move(why)};
    }
    place->path = path;
    place->written = written;
    set_functions(place->description.module(), number, std::make_index_sequence<kMostFiles>());
  }
  if (!place->process.trouble().empty()) return {nullptr, 0, place->process.trouble()};
  return {&place->description.in_c(), algorithms::kFirstInFile + number, ""};
}

std::vector<std::string> troubles() {
  std::vector<std::string> texts;
  for (const auto& place : places) {
    if (place == nullptr) continue;
    if (!place->process.trouble().empty())
      texts.push_back(place->path + ": " + place->process.trouble());
    else if (place->gave_up)
      texts.push_back(place->path + ": it gave up: its process() came to ROBOSYNC_FAILED");
  }
  return texts;
}

}  // namespace robosync::module_files

namespace robosync::algorithms {

const robosync_description* find_in_file(std::size_t number) {
  const std::size_t place = number - kFirstInFile;
  if (place >= module_files::kMostFiles || module_files::places[place] == nullptr) return nullptr;
  return &module_files::places[place]->description.in_c();
}

}  // namespace robosync::algorithms
