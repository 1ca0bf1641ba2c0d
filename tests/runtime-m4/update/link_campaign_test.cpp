// The host's and the board's own link code against everything that can go wrong at the same time: frames lost, doubled,
// changed, late and overtaken; a host that goes away after any byte; a board that is reset in any millisecond, or loses its power
// at any byte that it writes; faults in the trial, rollbacks, trials that go back afterwards. Each run is one life of a robot,
// drawn with its seed.
//
// Checked in every millisecond: the running program's name matches its bytes, and a host has sent it or the board has kept it.
// At the end: soon after a reset the robot runs the program that it has kept or, if its power was cut, the one that it had kept
// or was about to keep; and an upload over a good line succeeds.
// ROBOSYNC_LINK_RUNS: number of runs (`scripts/soak link`), ROBOSYNC_LINK_SEED: seed of the first.
#include <cstdlib>
#include <functional>
#include <optional>
#include <random>

#include <catch2/catch.hpp>

#include "rsc/device/keeping.hpp"
#include "rsc/failure.hpp"
#include "tests/runtime-m4/update/kept.hpp"
#include "vm/identity.hpp"

using namespace robosync;
using link::ProgramHash;
using std::chrono::milliseconds;
using test::Bytes;
using test::kStoreBytes;
using test::MemoryStore;
using test::name_of;
using test::Robot;

namespace {

constexpr unsigned kStartMs = 100;  // from a reset to the kept program

std::uint64_t setting(const char* name, std::uint64_t otherwise) {
  const char* const value = std::getenv(name);
  return value != nullptr ? std::strtoull(value, nullptr, 10) : otherwise;
}

using Random = std::mt19937;
bool one_in(Random& random, unsigned count) {
  return random() % count == 0;
}

// A bad line damages one frame in `rate`.
test::Damage damage(Random& random, unsigned rate) {
  auto late = std::make_shared<Bytes>();
  return [&random, rate, late](const Bytes& frame, std::size_t) {
    Bytes out = frame;
    if (one_in(random, rate)) {
      switch (random() % 5) {
        case 0:
          out.clear();
          break;
        case 1:
          out.insert(out.end(), frame.begin(), frame.end());
          break;
        case 2:
          out[random() % out.size()] ^= static_cast<std::byte>(1U << (random() % 8));
          break;
        case 3:
          out.erase(out.begin() + static_cast<std::ptrdiff_t>(random() % out.size()));
          break;
        default:  // overtaken by the next one
          std::swap(out, *late);
          return out;
      }
    }
    out.insert(out.end(), late->begin(), late->end());
    late->clear();
    return out;
  };
}

// The host's line, until the host or the board goes away.
class Line final : public tool::Transport {
public:
  explicit Line(Robot& robot) : robot_(robot) {}
  std::size_t read(std::span<std::byte> bytes, milliseconds timeout) override {
    const std::size_t count = robot_.read(bytes, timeout);
    return cut_ ? 0 : count;
  }
  void write(std::span<const std::byte> bytes) override {
    const std::size_t passes = std::min(bytes.size(), left_.value_or(bytes.size()));
    if (left_) *left_ -= passes;
    if (!cut_) robot_.write(bytes.first(passes));
  }
  std::string name() const override { return "line"; }
  Clock::time_point now() const override { return robot_.now(); }

  void end_after(std::size_t bytes) { left_ = bytes; }
  void cut() { cut_ = true; }

private:
  Robot& robot_;
  std::optional<std::size_t> left_;
  bool cut_ = false;
};

struct Programs {
  std::vector<tool::Program> all;
  Programs() {
    all.push_back(test::program(3));
    all.push_back(test::program(5));
    all.push_back(test::long_program());
    all.push_back(test::compile("SAFETY guard\n  WHEN touch LEVEL > 4\n  DO STOP ALL\nEND\n" +
                                test::program_text(4)));
  }
  bool has(const ProgramHash& name) const {
    return std::ranges::find(all, name, name_of) != all.end();
  }
};

// One life of a robot, from a reset to the next one.
class Life {
public:
  Life(const Programs& programs, MemoryStore& memory, Random& random)
      : programs_(programs), memory_(memory), random_(random), robot_(boards::kMemory, &memory) {
    robot_.each_tick = [this] { look(); };
    robot_.run(kStartMs);
    tool::Client client(robot_);
    REQUIRE(client.hello().running == 1);
    before_ = client.kept();
  }

  void play() {
    draw_what_goes_wrong();
    try {
      upload();
      robot_.run(random_() % 600);
      if (one_in(random_, 4)) robot_.server.report({});
      if (one_in(random_, 4)) feed();
      if (one_in(random_, 4)) roll_back();
    } catch (const tool::Failure&) {
      // Mostly something with the line.
    }
    robot_.run(random_() % 600);
    after_ = kept();
  }

  // What may run after the next reset.
  bool may_start_with(const ProgramHash& name) const {
    if (after_) return name == after_->kept_hash;
    return name == before_.kept_hash || name == before_.previous_hash || name == name_of(*next_);
  }

private:
  void draw_what_goes_wrong() {
    if (const unsigned rate = std::array{0U, 0U, 40U, 8U, 3U}[random_() % 5]; rate != 0) {
      robot_.to_board.set(damage(random_, rate));
      robot_.to_host.set(damage(random_, rate));
    }
    if (one_in(random_, 4)) line_.end_after(random_() % 900);
    if (one_in(random_, 4)) reset_at_ = robot_.kernel.now() / 1000 + random_() % 900;
    if (one_in(random_, 4)) memory_.power_for = random_() % 2500;
  }

  // Based on the running program or on another one: the host may be wrong about which one runs.
  void upload() {
    next_ = &programs_.all[random_() % programs_.all.size()];
    const tool::Program& base = programs_.all[random_() % programs_.all.size()];
    tool::Client client(line_, milliseconds(600), one_in(random_, 2));
    tool::UploadOptions options;
    options.timeout = milliseconds(1500);
    options.trial = milliseconds(1 + random_() % 400);
    options.confirm = !one_in(random_, 5);
    if (!one_in(random_, 4)) options.base = base.bytes();
    (void)tool::upload(client, client.hello(), next_->bytes(), options);
  }
  void feed() {
    tool::Client client(line_, milliseconds(600));
    client.feed({.channel = 0, .at_us = 0, .value = 7000});
  }
  void roll_back() {
    tool::Client client(line_, milliseconds(600));
    client.roll_back(client.kept().previous_hash);
  }

  // The board's report, when it has nothing left to do.
  std::optional<link::Kept> kept() {
    robot_.to_board.set({});
    robot_.to_host.set({});
    if (memory_.dead) return std::nullopt;
    robot_.run(4500);  // enough also after a host that left no program, or half of one
    tool::Client client(robot_);
    link::Kept kept = client.kept();
    // A trial may end while the reply that reports it is on its way.
    for (unsigned asked = 1; asked < 10 && kept.state == link::Keeping::on_trial; ++asked) {
      robot_.run(kept.trial_ms + 500);
      kept = client.kept();
    }
    if (memory_.dead) return std::nullopt;
    REQUIRE(kept.state != link::Keeping::reading);
    REQUIRE(kept.state != link::Keeping::on_trial);
    REQUIRE(client.hello().running == 1);
    return kept;
  }

  void look() {
    if (reset_at_ && robot_.kernel.now() / 1000 >= *reset_at_) {
      memory_.dead = true;
      line_.cut();
    }
    if (!robot_.runtime.running()) return;
    const vm::ImageHeader& header = *robot_.runtime.image().header;
    if (seen_ == header.program_hash) return;
    seen_ = header.program_hash;
    const std::span image(reinterpret_cast<const std::byte*>(&header), header.total_length);
    if (!programs_.has(seen_) || !vm::is_named(image, {}))
      FAIL("a program runs that nobody has sent");
  }

  const Programs& programs_;
  MemoryStore& memory_;
  Random& random_;
  Robot robot_;
  Line line_{robot_};
  std::optional<std::uint64_t> reset_at_;
  ProgramHash seen_{};
  link::Kept before_{};
  std::optional<link::Kept> after_;
  const tool::Program* next_ = &programs_.all.front();
};

void run(const Programs& programs, const MemoryStore& first, std::uint64_t seed) {
  CAPTURE(seed);
  Random random(static_cast<Random::result_type>(seed));
  MemoryStore memory = first;
  for (auto lives = 1 + random() % 3; lives > 0; --lives) {
    Life life(programs, memory, random);
    life.play();
    memory.switch_on();
    Robot next(boards::kMemory, &memory);
    next.run(kStartMs);
    REQUIRE(next.runtime.running());
    REQUIRE(life.may_start_with(next.runtime.image().header->program_hash));
  }
  Robot well(boards::kMemory, &memory);
  well.run(kStartMs);
  tool::Client client(well);
  const tool::Program& last = programs.all[random() % programs.all.size()];
  REQUIRE(tool::upload(client, client.hello(), last.bytes(), {}).activation.running == 1);
  REQUIRE(client.hello().program_hash == name_of(last));
}

}  // namespace

TEST_CASE("whatever happens to the line, the host and the power, a whole program runs") {
  const Programs programs;
  MemoryStore first(kStoreBytes);
  {
    Robot robot(boards::kMemory, &first);
    test::run_on(robot, programs.all[0]);
    robot.run(test::kTrialMs + 2000);
  }
  const std::uint64_t begin = setting("ROBOSYNC_LINK_SEED", 1);
  const std::uint64_t runs = setting("ROBOSYNC_LINK_RUNS", 200);
  for (std::uint64_t seed = begin; seed < begin + runs; ++seed)
    run(programs, first, seed);
}
