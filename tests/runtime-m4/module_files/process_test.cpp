// A module in a process of its own: it works as it does in the firmware, and whatever it does instead is said in one line.
#include "runtime-m4/module_files/process.hpp"

#include <filesystem>
#include <fstream>
#include <map>

#include <catch2/catch.hpp>

#include "runtime-m4/module_files/description.hpp"
#include "runtime-m4/module_files/registry.hpp"

using namespace robosync;
using module_files::Process;

namespace {

std::string hostile(const std::string& how) {
  return HOSTILE_MODULES "/" + how + ".so";
}

// Loads the module and gives it a sample, as far as that goes.
std::string trouble_of(const std::string& how) {
  Process module(hostile(how));
  const module_files::Config config = {1000};
  module_files::State state{};
  module_files::Outputs outputs{};
  std::uint32_t changed = 0;
  const bool works =
      module.init(config, 20, state) && module.process(config, {2000}, state, outputs, changed);
  CHECK(works == module.trouble().empty());
  CHECK_FALSE(module.process(config, {2000}, state, outputs, changed) != works);
  return module.trouble();
}

const std::map<std::string, std::string> kTroubles = {
    {"well", ""},
    {"crashes", "it touched memory that is not its own, in process()"},
    {"hangs", "it did not come to an end within a second, in process()"},
    {"hangs_while_loaded", "it did not come to an end within a second, while it was loaded"},
    {"crashes_while_loaded", "it touched memory that is not its own, while it was loaded"},
    {"writes_a_file_while_loaded", ""},  // it cannot
    {"forks_while_loaded", "it called the operating system, while it was loaded"},
    {"beyond_state", "it touched memory beyond its state, in process()"},
    {"below_state", "it touched memory beyond its state, in process()"},
    {"beyond_scratch", "it touched memory beyond its scratch, in process()"},
    {"beyond_outputs", "it touched memory beyond its outputs, in process()"},
    {"into_inputs", "it wrote into its inputs or parameters, in process()"},
    {"into_config", "it wrote into its inputs or parameters, in process()"},
    {"keeps_a_static", "it wrote to a static variable, in process()"},
    {"into_a_constant", "it touched memory that is not its own, in process()"},
    {"calls_the_system", "it called the operating system, in process()"},
    {"ends_its_process", "it ended its process, in process()"},
    {"divides_by_zero", "it divided by zero, or did worse to numbers, in process()"},
    {"overflows_its_stack", "it touched memory that is not its own, in process()"},
    {"other_abi", "it is made for another version of robosync_module.h than 1: compile it again"},
    {"no_module", "it does not describe itself completely: something is NULL that must not be"},
    {"incomplete", "it does not describe itself completely: something is NULL that must not be"},
    {"too_many_inputs", "it has more inputs, outputs, parameters or words than a module may have"},
    {"many_words", "it has more inputs, outputs, parameters or words than a module may have"},
    {"wild_name", "it touched memory that is not its own, while it described itself"},
    {"crashes_in_cost", "it touched memory that is not its own, in cost()"},
};

const std::map<std::string, std::string> kMistakes = {
    {"no_name", "its output is called \"two words\", which is no name"},
    {"unordered_range", "the usual value of its parameter firm is out of its range"},
    {"two_alike", "it has two outputs FIRM"},
    {"too_large", "its state and scratch come to 104 bytes, more than 96"},
    {"free_of_cost", "its cost() is 0"},
};

}  // namespace

TEST_CASE("whatever a module does, its process ends and says what it was") {
  for (const auto& [how, trouble] : kTroubles) {
    INFO(how);
    CHECK(trouble_of(how) == trouble);
  }
  CHECK_FALSE(std::filesystem::exists("hostile.out"));
}

TEST_CASE("a file that is no module says so") {
  Process missing("no_such_file.so");
  CHECK_THAT(missing.trouble(), Catch::StartsWith("it cannot be loaded: "));
  const std::string text = "text.so";
  std::ofstream(text) << "not a module";
  CHECK_THAT(Process(text).trouble(), Catch::StartsWith("it cannot be loaded: "));
  const std::string other_name = "other_name.so";
  std::filesystem::copy_file(hostile("well"), other_name,
                             std::filesystem::copy_options::overwrite_existing);
  CHECK(Process(other_name).trouble() ==
        "it has no function other_name_describe(); a module is called like its file");
}

TEST_CASE("a module that does not describe what the interface asks for is not used") {
  for (const auto& [how, mistake] : kMistakes) {
    INFO(how);
    const module_files::Loaded loaded = module_files::load(hostile(how));
    CHECK(loaded.description == nullptr);
    CHECK(loaded.why_not == mistake);
  }
}

TEST_CASE("a module in a file works as one of the firmware, and several algorithms share it") {
  const module_files::Loaded loaded = module_files::load(hostile("well"));
  REQUIRE(loaded.description != nullptr);
  CHECK(module_files::load(hostile("well")).number == loaded.number);  // it is there already
  const robosync_description& names = *loaded.description;
  CHECK(std::string(names.name) == "hostile");
  CHECK(std::string(names.outputs[0].labels[1]) == "yes");
  const robosync_module& module = *names.module;
  const std::int32_t low[] = {1000}, high[] = {5000};
  CHECK(module.state_bytes(low) == 8);
  CHECK(module.cost(low) == 60);
  std::int32_t a[2] = {}, b[2] = {};
  std::uint64_t state_of_a = 0, state_of_b = 0;
  module.init(&state_of_a, low, 20);
  module.init(&state_of_b, high, 20);
  const std::int32_t input[] = {2000};
  const robosync_block with_low = {input, a, low}, with_high = {input, b, high};
  CHECK(module.process(&state_of_a, nullptr, &with_low) == 3);
  CHECK(module.process(&state_of_b, nullptr, &with_high) == 0);
  CHECK((a[0] == 1000 && a[1] == 1000));
  CHECK((b[0] == 0 && b[1] == 0));
  CHECK(static_cast<std::int32_t>(state_of_a) == 1);
  CHECK(static_cast<std::int32_t>(state_of_b) == 0);
}
