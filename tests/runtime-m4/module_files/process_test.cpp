// A module in its own process: it works as in the firmware, and any violation is reported in one line.
#include "runtime-m4/module_files/process.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include "runtime-m4/algorithms/modules.hpp"
#include "runtime-m4/module_files/description.hpp"
#include "runtime-m4/module_files/registry.hpp"
#include "tests/support/folder.hpp"

using namespace robosync;
using module_files::Process;

namespace {

std::string hostile(const std::string& how) {
  return HOSTILE_MODULES "/" + how + ".so";
}

// Loads the module and gives it a sample, as far as possible.
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
    {"crashes_while_loaded", "it touched memory that is not its own, while it was loaded"},
    {"writes_a_file_while_loaded", ""},  // it cannot
    {"forks_while_loaded", "it called the operating system, while it was loaded"},
#if !defined(ROBOSYNC_SANITIZE)
    {"takes_all_memory_while_loaded", ""},  // it gets none
#endif
    {"beyond_state", "it touched memory beyond its state, in process()"},
    {"reads_beyond_state", "it touched memory beyond its state, in process()"},
    {"below_state", "it touched memory beyond its state, in process()"},
    {"beyond_an_odd_state", "it touched memory beyond its state, in process()"},
    {"beyond_scratch", "it touched memory beyond its scratch, in process()"},
    {"below_scratch", "it touched memory beyond its scratch, in process()"},
    {"beyond_outputs", "it touched memory beyond its outputs, in process()"},
    {"below_outputs", "it touched memory beyond its outputs, in process()"},
    {"into_inputs", "it wrote into its inputs or parameters, in process()"},
    {"into_config", "it wrote into its inputs or parameters, in process()"},
    {"keeps_a_static", "it wrote to a static variable, in process()"},
    {"into_a_constant", "it touched memory that is not its own, in process()"},
    {"calls_the_system", "it called the operating system, in process()"},
    {"opens_a_file", "it called the operating system, in process()"},  // even to read it
    {"writes_to_what_is_open", ""},  // only the line to this process is open
    {"ends_its_process", "it ended its process, in process()"},
    {"divides_by_zero",
     "it divided by zero, overflowed, or did something else that C does not define, in process()"},
    {"traps",
     "it divided by zero, overflowed, or did something else that C does not define, in process()"},
    {"overflows_its_stack", "it touched memory that is not its own, in process()"},
    {"other_abi", "it is made for another version of robosync_module.h than 1: compile it again"},
    {"no_module", "it does not describe itself completely: something is NULL that must not be"},
    {"incomplete", "it does not describe itself completely: something is NULL that must not be"},
    {"too_many_inputs", "it has more inputs, outputs, parameters or words than a module may have"},
    {"too_many_outputs", "it has more inputs, outputs, parameters or words than a module may have"},
    {"too_many_parameters",
     "it has more inputs, outputs, parameters or words than a module may have"},
    {"null_name", "it does not describe itself completely: something is NULL that must not be"},
    {"boundless", ""},  // it has 96 bytes of each
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
    {"crashes_while_loaded", "it touched memory that is not its own, while it was loaded"},
};

// The test's own working directory, until its end: the files that a module tries to write have names without a folder.
class Elsewhere {
public:
  Elsewhere() : before_(std::filesystem::current_path()) {
    std::filesystem::current_path(own_.path());
  }
  ~Elsewhere() { std::filesystem::current_path(before_); }
  Elsewhere(const Elsewhere&) = delete;
  Elsewhere& operator=(const Elsewhere&) = delete;

private:
  test::Folder own_;
  std::filesystem::path before_;
};

}  // namespace

TEST_CASE("whatever a module does, its process ends and says what it was") {
  const Elsewhere elsewhere;
  std::ofstream("hostile.out") << "whole";
  for (const auto& [how, trouble] : kTroubles) {
    INFO(how);
    CHECK(trouble_of(how) == trouble);
  }
  CHECK(std::filesystem::file_size("hostile.out") == 5);
}

TEST_CASE("a file that is no module says so") {
  const Elsewhere elsewhere;
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
  CHECK(module_files::load(hostile("well")).number == loaded.number);  // it is already loaded
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

// ---- a module's description

namespace {

module_files::Name name(const std::string& text) {
  module_files::Name result{};
  std::ranges::copy(text, result.begin());
  return result;
}

module_files::Described described() {
  module_files::Described said{};
  said.inputs = said.outputs = said.parameters = 1;
  said.shortest_period_ms = 5;
  said.usual_period_ms = 20;
  said.longest_period_ms = 50;
  said.name = name("touch");
  said.input_names[0] = name("FORCE");
  said.input_units[0] = ROBOSYNC_AS_INPUT;
  said.output[0] = {name("FIRM"), ROBOSYNC_NUMBER, 2, 0, 1000};
  said.words[0] = name("no");
  said.words[1] = name("yes");
  said.parameter_names[0] = name("firm");
  said.parameter_units[0] = ROBOSYNC_AS_INPUT;
  said.ranges[0] = {1000, 0, 10000};
  return said;
}

std::string mistake_of(void (*spoil)(module_files::Described&)) {
  module_files::Described said = described();
  spoil(said);
  return module_files::Description(said).mistake();
}

}  // namespace

TEST_CASE("each thing that a module says of itself is looked at") {
  using Said = module_files::Described;
  const std::string counts = "it needs 1 to 4 inputs, 1 to 8 outputs and at most 12 parameters";
  const std::string periods =
      "its usual period does not lie between its shortest and its longest one";
  const std::string step = "its output FIRM has 2 words, so it goes from 0 to 1 and has no unit";
  const std::string range = "the usual value of its parameter firm is out of its range";
  CHECK(mistake_of([](Said&) {}).empty());
  CHECK(mistake_of([](Said& said) { said.inputs = 0; }) == counts);
  CHECK(mistake_of([](Said& said) { said.inputs = 5; }) == counts);
  CHECK(mistake_of([](Said& said) { said.outputs = 0; }) == counts);
  CHECK(mistake_of([](Said& said) { said.outputs = 9; }) == counts);
  CHECK(mistake_of([](Said& said) { said.parameters = 13; }) == counts);
  CHECK(mistake_of([](Said& said) { said.shortest_period_ms = 0; }) == periods);
  CHECK(mistake_of([](Said& said) { said.usual_period_ms = 4; }) == periods);
  CHECK(mistake_of([](Said& said) { said.usual_period_ms = 51; }) == periods);
  CHECK(mistake_of([](Said& said) { said.name = name("1a"); }) ==
        "its module is called \"1a\", which is no name");
  CHECK(mistake_of([](Said& said) { said.input_names[0] = name(""); }) ==
        "its input is called \"\", which is no name");
  CHECK(mistake_of([](Said& said) { said.output[0].name = name("a-b"); }) ==
        "its output is called \"a-b\", which is no name");
  CHECK(mistake_of([](Said& said) { said.words[1] = name("a b"); }) ==
        "its word is called \"a b\", which is no name");
  CHECK(mistake_of([](Said& said) {
          said.parameter_names[0] = name("\x1b[2J");
        }).starts_with("its parameter is called"));
  CHECK(mistake_of([](Said& said) { said.input_units[0] = 200; }) ==
        "its input has a unit that is none: 200");
  CHECK(mistake_of([](Said& said) {
          said.output[0].unit = ROBOSYNC_AS_INPUT;
        }).starts_with("its output FIRM has a unit that is none"));
  CHECK(mistake_of([](Said& said) { said.parameter_units[0] = 200; }) ==
        "its parameter has a unit that is none: 200");
  CHECK(mistake_of([](Said& said) { said.parameter_units[0] = ROBOSYNC_COUNT; }) == "");
  CHECK(mistake_of([](Said& said) { said.input_units[0] = ROBOSYNC_COUNT; }) ==
        "its input has a unit that is none: 254");
  CHECK(mistake_of([](Said& said) { said.output[0].words = 0, said.output[0].most = 0; }) ==
        "the range of its output FIRM is empty");
  CHECK(mistake_of([](Said& said) { said.output[0].unit = ROBOSYNC_NUMBER + 1; }) == step);
  CHECK(mistake_of([](Said& said) { said.output[0].least = -1; }) == step);
  CHECK(mistake_of([](Said& said) { said.output[0].most = 2000; }) == step);
  CHECK(mistake_of([](Said& said) { said.ranges[0].usual = -1; }) == range);
  CHECK(mistake_of([](Said& said) { said.ranges[0].usual = 10001; }) == range);
}

TEST_CASE("more words than there is room for are not read") {
  const auto words_of = [](std::uint8_t count) {
    module_files::Described said = described();
    for (auto& word : said.words)
      word = name("w");
    said.output[0].words = count;
    said.output[0].most = (count - 1) * ROBOSYNC_ONE;
    return module_files::Description(said).mistake();
  };
  CHECK(words_of(module_files::kMostWords - 1).empty());
  CHECK(words_of(255) == "it has too many words");
}

// ---- users of modules

TEST_CASE("a module in trouble fails, changes nothing of its algorithm, and is told of") {
  const std::string file = hostile("crashes");
  const module_files::Loaded loaded = module_files::load(file);
  REQUIRE(loaded.description != nullptr);
  const robosync_module& module = *loaded.description->module;
  const std::int32_t config[] = {1000}, input[] = {2000};
  std::vector<std::byte> state(8);  // no more: it may only use this much
  std::int32_t outputs[2] = {7, 7};
  const robosync_block block = {input, outputs, config};
  module.init(state.data(), config, 20);
  std::ranges::fill(state, std::byte{9});
  for (int i = 0; i < 2; ++i)
    CHECK(module.process(state.data(), nullptr, &block) == ROBOSYNC_FAILED);
  CHECK((outputs[0] == 7 && outputs[1] == 7));
  CHECK(std::ranges::all_of(state, [](std::byte byte) { return byte == std::byte{9}; }));
  CHECK(module.state_bytes(config) > ROBOSYNC_MOST_BYTES);  // so it is refused
  const std::string what = "it touched memory that is not its own, in process()";
  CHECK(module_files::troubles() == std::vector<std::string>{file + ": " + what});
  CHECK(module_files::load(file).why_not == what);
}

TEST_CASE("there is room for so many files, and no number is another one's") {
  using algorithms::find_in_file, algorithms::kFirstInFile;
  CHECK(module_files::load(".").why_not == "it is not a file");
  CHECK(find_in_file(kFirstInFile + module_files::kMostFiles - 1) == nullptr);  // yet
  const auto folders =
      std::filesystem::temp_directory_path() / ("robosync-files-" + std::to_string(getpid()));
  std::string why_not;
  for (std::size_t i = 0; i <= module_files::kMostFiles && why_not.empty(); ++i) {
    const std::filesystem::path folder = folders / std::to_string(i);
    std::filesystem::create_directories(folder);
    std::filesystem::copy_file(hostile("well"), folder / "well.so",
                               std::filesystem::copy_options::overwrite_existing);
    why_not = module_files::load(folder / "well.so").why_not;
  }
  std::filesystem::remove_all(folders);
  CHECK(why_not == "there are " + std::to_string(module_files::kMostFiles) + " others already");
  CHECK(find_in_file(kFirstInFile + module_files::kMostFiles) == nullptr);
  CHECK(find_in_file(kFirstInFile + module_files::kMostFiles - 1) != nullptr);
  CHECK(find_in_file(kFirstInFile - 1) == nullptr);
  CHECK(find_in_file(std::size_t{1} << 44) == nullptr);
}

// ---- its process

#if defined(__x86_64__)
TEST_CASE("the numbers of another machine's calls are no way out") {
  CHECK_THAT(trouble_of("calls_as_another_machine"), Catch::Contains("in process()"));
}
#endif

TEST_CASE("a module that answers and then is gone is noticed when it is next asked") {
  Process module(hostile("answers_and_ends"));
  const module_files::Config config = {1000};
  module_files::State state{};
  module_files::Outputs outputs{};
  std::uint32_t changed = 0;
  REQUIRE(module.process(config, {2000}, state, outputs, changed));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  CHECK_FALSE(module.process(config, {2000}, state, outputs, changed));
  CHECK(module.trouble() == "it ended its process, in process()");
}

// Processor seconds of the processes that have ended.
static double seconds_of_children() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  return static_cast<double>(used.ru_utime.tv_sec) +
         static_cast<double>(used.ru_utime.tv_usec) / 1e6;
}

// The last test: it takes half a minute, most of it waiting.
TEST_CASE("one that goes on is ended when it has had its second, one that waits later") {
  const std::string why = "it did not come to an end within a second, ";
  for (const auto& [how, where] : std::map<std::string, std::string>{
           {"hangs", "in process()"}, {"hangs_while_loaded", "while it was loaded"}}) {
    const double before = seconds_of_children();
    CHECK(trouble_of(how) == why + where);
    CHECK(seconds_of_children() - before < 3);
  }
  CHECK(trouble_of("waits") == why + "in process()");  // it uses no processor time
}
