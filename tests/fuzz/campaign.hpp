// Image after image: takes one, changes it, makes it right again where only a declaration is wrong,
// verifies it, and runs it if it is accepted. The same seed gives the same images.
#pragma once

#include <array>

#include "tests/fuzz/block.hpp"
#include "tests/fuzz/host_engine.hpp"
#include "tests/fuzz/seeds.hpp"

namespace robosync::fuzz {

inline constexpr std::size_t kRefusals = 1 +
#define REFUSAL(name, text) 1 +
#include "vm/refusals.def"
#undef REFUSAL
                                         0;

struct Totals {
  std::uint64_t images = 0;
  std::array<std::uint64_t, kRefusals>
      verdicts{};  // by refusal (no_room, no_pin, no_bus, no_input, reserved_address: by a board drawn for it); the first: accepted
  std::array<std::uint64_t, kOpcodeCount> opcodes{};  // accepted images that have it
  std::uint64_t runs = 0, pauses = 0;
  double worst_ratio = 0;    // of the cost seen in a step to the cost declared
  std::uint64_t exact = 0;   // accepted images of which a step did cost what is declared
  std::uint64_t length = 0;  // bytes of all images
};

class Campaign {
public:
  // `failed` is told what is wrong, while image() is the one; it does not return.
  Campaign(const Seeds& seeds, std::uint64_t seed, std::function<void(const char*)> failed);

  // One more image. What the board is to find with it.
  Entry step();
  [[nodiscard]] std::span<const std::byte> image() const { return draft_.bytes(); }
  [[nodiscard]] const Totals& totals() const { return totals_; }

private:
  void choose();
  bool repair(const vm::Verdict& verdict);
  [[nodiscard]] std::uint32_t mask_of(std::size_t response);
  vm::Verdict verify(bool tight);
  void read_names();
  void lay_out();
  void wire();
  void compute();
  void run(Entry& entry);
  void keep();

  Random random_;
  const Seeds& seeds_;
  std::vector<Seed> pool_;  // carved seeds, and accepted images that came of them
  Draft draft_;
  Mutator mutator_;
  HostEngine engine_;
  Slot image_slot_{Draft::kCapacity, std::size_t{1} << 19};
  vm::Image accepted_;
  Totals totals_;
};

}  // namespace robosync::fuzz
