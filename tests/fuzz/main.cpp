// Fuzzes the verifier and runs what it accepts; scripts/fuzz is for people. Prints one JSON object.
//
// usage: fuzz_images --images N --seed S --seeds FOLDER [--saved FILE] [--emit FILE]
// [--all-refusals]
//   --saved         where the image at fault is written to (default: fuzz-failed.rsb)
//   --emit          writes the images and what came of them, for the board (block.hpp)
//   --all-refusals  fails unless every reason to refuse, and every opcode, was seen
// Exit code 0: no accepted image did what it must not do.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/fuzz/campaign.hpp"

#if defined(ROBOSYNC_SANITIZE)
#include <sanitizer/common_interface_defs.h>
#endif

namespace robosync::fuzz {
namespace {

constexpr std::string_view kRefusalNames[] = {
    "accepted",
#define REFUSAL(name, text) #name,
#include "vm/refusals.def"
#undef REFUSAL
};

struct Options {
  std::uint64_t images = 200000;
  std::uint64_t seed = 1;
  std::string seeds;
  std::string saved = "fuzz-failed.rsb";
  std::string emit;
  bool all = false;
};

Options parse(int count, char** words) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--all-refusals") {
      options.all = true;
      continue;
    }
    if (i + 1 == count) throw std::runtime_error("usage: see tests/fuzz/main.cpp");
    const std::string value = words[++i];
    if (word == "--images")
      options.images = std::stoull(value);
    else if (word == "--seed")
      options.seed = std::stoull(value);
    else if (word == "--seeds")
      options.seeds = value;
    else if (word == "--saved")
      options.saved = value;
    else if (word == "--emit")
      options.emit = value;
    else
      throw std::runtime_error("usage: see tests/fuzz/main.cpp");
  }
  return options;
}

// The image at fault is saved, whether a check or a sanitizer has seen it.
const Campaign* running = nullptr;
const Options* wanted = nullptr;
void save() {
  if (running == nullptr) return;
  const auto bytes = running->image();
  std::ofstream(wanted->saved, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  std::fprintf(stderr, "seed %llu, image %llu: saved as %s\n",
               static_cast<unsigned long long>(wanted->seed),
               static_cast<unsigned long long>(running->totals().images), wanted->saved.c_str());
  running = nullptr;
}

void failed(const char* what) {
  std::fprintf(stderr, "an accepted image: %s\n", what);
  save();
  std::_Exit(1);
}

// Is everything there was to be seen seen? Says what is not.
bool saw_all(const Totals& totals) {
  bool all = true;
  for (std::size_t i = 0; i < kRefusals; ++i) {
    // Names the line and the store look at; what is drawn here has none.
    if (totals.verdicts[i] > 0 || i == static_cast<std::size_t>(vm::Refusal::wrong_name)) continue;
    std::fprintf(stderr, "no image was %s\n", std::string(kRefusalNames[i]).c_str());
    all = false;
  }
  for (std::size_t i = 0; i < kOpcodeCount; ++i) {
    if (totals.opcodes[i] > 0) continue;
    std::fprintf(stderr, "no accepted image has %s\n", std::string(vm::kOpcodes[i].name).c_str());
    all = false;
  }
  return all;
}

void print(const Options& options, const Totals& totals) {
  const double seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  std::printf(
      "{\"seed\": %llu, \"images\": %llu, \"bytes\": %llu, \"runs\": %llu, ",
      static_cast<unsigned long long>(options.seed), static_cast<unsigned long long>(totals.images),
      static_cast<unsigned long long>(totals.length), static_cast<unsigned long long>(totals.runs));
  std::printf("\"pauses\": %llu, \"exact\": %llu, \"worst_ratio\": %.4f, \"cpu_seconds\": %.1f",
              static_cast<unsigned long long>(totals.pauses),
              static_cast<unsigned long long>(totals.exact), totals.worst_ratio, seconds);
  const char* separator = ", \"verdicts\": {";
  for (std::size_t i = 0; i < kRefusals; ++i) {
    std::printf("%s\"%s\": %llu", separator, std::string(kRefusalNames[i]).c_str(),
                static_cast<unsigned long long>(totals.verdicts[i]));
    separator = ", ";
  }
  std::printf("}}\n");
}

class Emitter {
public:
  Emitter(const std::string& path, std::uint64_t images) {
    if (path.empty()) return;
    file_.open(path, std::ios::binary);
    const BlockHeader header{kBlockMagic, Mode::run, static_cast<std::uint32_t>(images), 0};
    put(&header, sizeof header);
  }
  void put(const Entry& entry, std::span<const std::byte> bytes) {
    if (!file_.is_open()) return;
    put(&entry, sizeof entry);
    put(bytes.data(), bytes.size());
    constexpr char kPadding[4] = {};
    put(kPadding, (4 - bytes.size() % 4) % 4);
  }

private:
  void put(const void* data, std::size_t size) {
    file_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  std::ofstream file_;
};

int run(const Options& options) {
  const Seeds seeds = load_seeds(options.seeds);
  Campaign campaign(seeds, options.seed, failed);
  wanted = &options;
  running = &campaign;
#if defined(ROBOSYNC_SANITIZE)
  __sanitizer_set_death_callback(save);
#endif
  Emitter emitter(options.emit, options.images);
  for (std::uint64_t i = 0; i < options.images; ++i) {
    const Entry entry = campaign.step();
    emitter.put(entry, campaign.image());
  }
  running = nullptr;
  print(options, campaign.totals());
  return options.all && !saw_all(campaign.totals()) ? 1 : 0;
}

}  // namespace
}  // namespace robosync::fuzz

int main(int count, char** words) {
  try {
    return robosync::fuzz::run(robosync::fuzz::parse(count, words));
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "fuzz_images: %s\n", problem.what());
    return 3;
  }
}
