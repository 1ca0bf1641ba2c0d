// The host's and the board's own link code against everything that can go wrong at the same time: frames lost, doubled,
// changed, late and overtaken; a host that goes away after any byte; a board that is reset in any millisecond, or loses its power
// at any byte that it writes; faults in the trial, rollbacks, trials that go back afterwards. Each run is some lives of a robot,
// drawn with its seed.
//
// Checked in every millisecond:
// * The running program's name matches its bytes. It is the kept one, the one that this life's host sends, or the one that a person
//   has asked to come back.
// * Its own SAFETY rule is in force, and no other: the actuator is halted exactly as long as the program's hazard is at its own limit.
// * The KEPT numbers are whole, and never go back.
// Checked whenever a record of programs is written: the image is whole, and the program has earned it. It has stood its trial without
// a fault and without a new SAFETY trip, and its host wants it kept, or a person asked for it.
// At a start: the kept program runs with the KEPT numbers, both as the last whole record says.
// At the end: a program that has stood its trial is the kept one, and an upload over a good line succeeds.
// ROBOSYNC_LINK_RUNS: number of runs (`scripts/soak link`), ROBOSYNC_LINK_SEED: seed of the first.
#include <cstdlib>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "rsc/device/keeping.hpp"
#include "rsc/failure.hpp"
#include "runtime-m4/layers/kept.hpp"
#include "runtime-m4/update/number_store.hpp"
#include "runtime-m4/update/store_layout.hpp"
#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/update/kept.hpp"
#include "vm/identity.hpp"

using namespace robosync;
using link::ProgramHash;
using std::chrono::milliseconds;
using test::Bytes;
using test::kStartMs;
using test::MemoryStore;
using test::name_of;
using test::Robot;

namespace {

constexpr std::uint32_t kCampaignStoreBytes = 16'384;

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

// What the programs of this campaign have in common: two KEPT numbers that belong together, and a SAFETY rule on a hazard that
// comes and goes. The rule has another limit in each program. To the board it is the same rule, so no trial fails because of it.
// A step changes three bytes of the number, so that half of an old one shows.
constexpr vm::Value kStep = 70'003;
constexpr unsigned kHazards = 6;
enum Input : std::uint8_t { touch_level, visits, twice, hazard };
constexpr layers::ActuatorMask kLeftArm = 1, kRightArm = 2;

std::string common(unsigned limit) {
  const std::string at = std::to_string(limit);
  return "REMEMBER visits = 0 KEPT\nREMEMBER twice = 0 KEPT\nREMEMBER hazard = " +
         std::to_string(kHazards - 1) + "\nSAFETY pinch\n  WHEN hazard >= " + at +
         "\n  DO STOP left_arm\n  RESUME WHEN hazard < " + at +
         "\nEND\nEVERY 20ms\nDO\n  RAISE visits BY 70.003\n  RAISE twice BY 140.006\n" +
         "  SET hazard TO (hazard + 1) MOD " + std::to_string(kHazards) + "\nEND\n";
}

struct Sent {
  tool::Program program;
  vm::Value limit;  // of its hazard
  bool trips;       // it has a SAFETY rule of its own, which may trip in its trial
};

struct Programs {
  std::vector<Sent> all;
  std::uint32_t visits_key = 0;  // in records of KEPT numbers

  Programs() {
    add(test::program_text(3), false);
    add(test::program_text(5), false);
    add(test::long_program_text(), false);
    add("SAFETY reach\n  WHEN touch LEVEL > 4\n  DO STOP right_arm\nEND\n" +  // never fed: at once
            test::program_text(4),
        true);
    add("REMEMBER heat = 0\nWHEN touch LEVEL > 6 DO SET heat TO 5 END\n"  // if it is fed
        "SAFETY hot\n  WHEN heat > 4\n  DO STOP right_arm\nEND\n" +
            test::program_text(4),
        true);
    const vm::Image image = all.front().program.image();
    visits_key = layers::kept_key(image, image.variables[0]);
  }
  const Sent* find(const ProgramHash& name) const {
    const auto found =
        std::ranges::find(all, name, [](const Sent& sent) { return name_of(sent.program); });
    return found == all.end() ? nullptr : &*found;
  }
  const Sent& any(Random& random) const { return all[random() % all.size()]; }

private:
  void add(const std::string& text, bool trips) {
    const auto limit = static_cast<unsigned>(all.size()) + 1;
    all.push_back(
        {test::compile(common(limit) + text), static_cast<vm::Value>(limit * 1000), trips});
  }
};

// What the store holds for certain, read from the bytes as they are written: it does not depend on what the board believes.
struct Books {
  ProgramHash kept{};
  vm::Value visits = 0;
};

// Reads what is written into the store, and keeps the books.
class Bookkeeper {
public:
  // `may_keep`: has the program earned it?
  using MayKeep = std::function<bool(const ProgramHash&)>;
  Bookkeeper(const Programs& programs, MemoryStore& memory, Books& books, MayKeep may_keep)
      : programs_(programs),
        memory_(memory),
        layout_(memory),
        books_(books),
        may_keep_(std::move(may_keep)) {
    memory.wrote = [this](std::uint32_t end) { look(end); };
  }
  ~Bookkeeper() { memory_.wrote = {}; }
  Bookkeeper(const Bookkeeper&) = delete;
  Bookkeeper& operator=(const Bookkeeper&) = delete;

  const std::string& wrong() const { return wrong_; }

private:
  // As ProgramStore writes it (docs/link.md).
  struct Record {
    std::uint32_t magic, number, kept_bytes;
    ProgramHash kept;
    std::uint32_t previous_bytes;
    ProgramHash previous;
    std::uint32_t slot, reserved[2], crc32;
  };
  static_assert(sizeof(Record) == 48);

  // `end`: behind the bytes that were written.
  void look(std::uint32_t end) {
    for (std::uint32_t record = 0; record < update::StoreLayout::kRecords; ++record)
      if (end == layout_.record_at(record) + sizeof(Record)) program_recorded(end);
    for (std::uint32_t place = 0; place < layout_.ring(); ++place)
      if (end == layout_.numbers_at(place) + sizeof(update::NumberStore::Record))
        numbers_recorded(end);
  }

  void program_recorded(std::uint32_t end) {
    const auto record = test::bytes_before<Record>(memory_, end);
    if (record.kept == books_.kept) return;
    const Sent* const sent = programs_.find(record.kept);
    const auto slot = memory_.bytes.begin() + layout_.slot_at(record.slot);
    if (sent == nullptr ||
        !std::ranges::equal(sent->program.bytes(), std::span(slot, sent->program.bytes().size()))) {
      wrong_ = "the store names a program that is not whole in it";
    } else if (!may_keep_(record.kept)) {
      wrong_ = "the store names a program that has not earned it";
    }
    books_.kept = record.kept;
  }

  void numbers_recorded(std::uint32_t end) {
    const auto record = test::bytes_before<update::NumberStore::Record>(memory_, end);
    for (const layers::KeptNumber& number : std::span(record.entries).first(record.count))
      if (number.key == programs_.visits_key) books_.visits = number.value;
  }

  const Programs& programs_;
  MemoryStore& memory_;
  update::StoreLayout layout_;
  Books& books_;
  MayKeep may_keep_;
  std::string wrong_;
};

// What may be said of the running program in any millisecond.
class Watch {
public:
  Watch(const Programs& programs, const Robot& robot, const Books& books)
      : programs_(programs), robot_(robot), visits_(books.visits) {}

  // In the first millisecond of a program. Returns its name.
  ProgramHash begin() {
    const vm::ImageHeader& header = *robot_.runtime.image().header;
    const std::span image(reinterpret_cast<const std::byte*>(&header), header.total_length);
    sent_ = programs_.find(header.program_hash);
    if (sent_ == nullptr || !vm::is_named(image, {})) FAIL("a program runs that nobody has sent");
    began_ = robot_.kernel.now();
    tripped_ = false;
    return header.program_hash;
  }

  void look() {
    look_at_numbers();
    look_at_rules();
  }
  vm::Value visits_now() const { return value(visits); }
  bool has_tripped() const { return tripped_; }  // a rule besides the common one

private:
  // A robot waits for the readings of SAFETY rules for 100 ms. Nothing moves, and no rule is in force, until then.
  static constexpr kernel::Duration kWaits = kernel::milliseconds(102);

  vm::Value value(Input input) const { return RuntimePeer::value(robot_.runtime, input); }

  void look_at_numbers() {
    const vm::Value now = value(visits);
    if (now % kStep != 0 || value(twice) != 2 * now) FAIL("a KEPT number is torn");
    if (now < visits_) FAIL("a KEPT number goes back");
    visits_ = now;
  }

  void look_at_rules() {
    const layers::ActuatorMask halted = RuntimePeer::halted(robot_.runtime);
    if (!RuntimePeer::has_begun(robot_.runtime)) {
      if (robot_.kernel.now() > began_ + kWaits)
        FAIL("no SAFETY rule comes into force " << robot_.kernel.now() << " " << began_ << " limit "
                                                << sent_->limit << " start "
                                                << robot_.runtime.image().header->safety_start_ms);
      return;
    }
    if (((halted & kLeftArm) != 0) != (value(hazard) >= sent_->limit))
      FAIL("the SAFETY rule in force is not the program's own");
    tripped_ = (halted & kRightArm) != 0;
    if (tripped_ && !sent_->trips) FAIL("a SAFETY rule of another program is in force");
  }

  const Programs& programs_;
  const Robot& robot_;
  const Sent* sent_ = nullptr;  // it runs
  kernel::Time began_ = 0;
  vm::Value visits_;
  bool tripped_ = false;
};

// One life of a robot, from a reset to the next one.
class Life {
public:
  Life(const Programs& programs, MemoryStore& memory, Books& books, Random& random)
      : programs_(programs),
        memory_(memory),
        books_(books),
        random_(random),
        robot_(boards::kMemory, &memory, link::ResetReason::power) {
    robot_.each_tick = [this] { look(); };
    robot_.run(kStartMs);
    REQUIRE(robot_.runtime.running());
  }

  void play() {
    draw_what_goes_wrong();
    try {
      upload();
      robot_.run(random_() % 600);
      if (one_in(random_, 4)) fail();
      if (one_in(random_, 4)) feed();
      if (one_in(random_, 4)) roll_back();
    } catch (const tool::Failure&) {
      // Mostly something with the line.
    }
    robot_.run(random_() % 600);
    end();
  }

  void end_well() {
    tool::Client client(robot_);
    next_ = &programs_.any(random_);
    REQUIRE(tool::upload(client, client.hello(), next_->program.bytes(), {}).activation.running ==
            1);
    REQUIRE(client.hello().program_hash == name_of(next_->program));
  }

private:
  // The host's program, while it is not the kept one.
  struct Trial {
    ProgramHash name;
    kernel::Time began;
    bool failed = false;
    bool doubtful = false;  // a fault when its time was over: it may have been kept just before
  };

  void draw_what_goes_wrong() {
    if (const unsigned rate = std::array{0U, 0U, 40U, 8U, 3U}[random_() % 5]; rate != 0) {
      robot_.to_board.set(damage(random_, rate));
      robot_.to_host.set(damage(random_, rate));
    }
    if (one_in(random_, 4)) line_.end_after(random_() % 900);
    if (one_in(random_, 4)) reset_at_ = robot_.kernel.now() / 1000 + random_() % 900;
    if (one_in(random_, 4)) memory_.power_for = random_() % 2500;
    memory_.writes_take = std::array{0U, 0U, 0U, 1U, 3U}[random_() % 5];
  }

  // Based on the running program or on another one: the host may be wrong about which one runs.
  void upload() {
    next_ = &programs_.any(random_);
    const Sent& base = programs_.any(random_);
    tool::Client client(line_, milliseconds(600), one_in(random_, 2));
    options_.timeout = milliseconds(1500);
    options_.trial = milliseconds(3 + random_() % 400);  // look() must see it begin before it ends
    options_.confirm = !one_in(random_, 5);
    if (!one_in(random_, 4)) options_.base = base.program.bytes();
    (void)tool::upload(client, client.hello(), next_->program.bytes(), options_);
  }
  void fail() {
    if (on_trial()) (time_is_over() ? trial_->doubtful : trial_->failed) = true;
    robot_.server.report({});
  }
  void feed() {
    tool::Client client(line_, milliseconds(600));
    client.feed({.channel = touch_level, .at_us = 0, .value = 7000});
  }
  void roll_back() {
    tool::Client client(line_, milliseconds(600));
    wish_ = client.kept().previous_hash;
    client.roll_back(*wish_);
  }

  // The board's report, when it has nothing left to do. A board without power has none.
  void end() {
    robot_.to_board.set({});
    robot_.to_host.set({});
    if (memory_.dead) return;
    robot_.run(4500);  // enough also after a host that left no program, or half of one
    tool::Client client(robot_);
    link::Kept kept = client.kept();
    // A trial may end while the reply that reports it is on its way, and a slow store may still be read.
    const auto comes_to_an_end = [&kept] {
      return kept.state == link::Keeping::on_trial || kept.state == link::Keeping::reading;
    };
    for (unsigned asked = 1; asked < 10 && comes_to_an_end(); ++asked) {
      robot_.run(kept.trial_ms + 500);
      kept = client.kept();
    }
    if (memory_.dead) return;
    REQUIRE(kept.state == link::Keeping::kept);
    REQUIRE(kept.kept_hash == books_.kept);
    REQUIRE(client.hello().program_hash == books_.kept);
    const bool stood = trial_ && !trial_->failed && !trial_->doubtful && !next_->trips;
    if (stood && options_.confirm && !wish_) REQUIRE(books_.kept == trial_->name);
  }

  // In each millisecond.
  void look() {
    if (reset_at_ && robot_.kernel.now() / 1000 >= *reset_at_) {
      memory_.dead = true;
      line_.cut();
    }
    if (!bookkeeper_.wrong().empty()) FAIL(bookkeeper_.wrong());
    if (!robot_.runtime.running()) {
      running_ = {};
      return;
    }
    // The same program may have been uploaded again, which starts it anew.
    if (const unsigned now = RuntimePeer::activations(robot_.runtime); now != activations_) {
      activations_ = now;
      begins();
    }
    watch_.look();
    if (on_trial() && watch_.has_tripped() && !time_is_over()) trial_->failed = true;
  }

  void begins() {
    const bool first = activations_ == 1;
    running_ = watch_.begin();
    if (running_ == books_.kept) {
      if (first && watch_.visits_now() != books_.visits)
        FAIL("a KEPT number is not the stored one");
    } else if (next_ != nullptr && running_ == name_of(next_->program)) {
      trial_ = {.name = running_, .began = robot_.kernel.now()};
    } else if (running_ != wish_) {
      FAIL("a program runs that is not the kept one, and that nobody wants");
    }
  }

  bool on_trial() const { return trial_ && running_ == trial_->name && running_ != books_.kept; }

  // look() sees a trial begin up to a tick late.
  bool time_is_over() const {
    return robot_.kernel.now() + kernel::kTick >=
           trial_->began + kernel::milliseconds(static_cast<std::uint32_t>(options_.trial.count()));
  }

  bool may_keep(const ProgramHash& name) const {
    if (name == wish_) return true;
    return trial_ && name == trial_->name && options_.confirm && !trial_->failed && time_is_over();
  }

  const Programs& programs_;
  MemoryStore& memory_;
  Books& books_;
  Random& random_;
  Robot robot_;
  Line line_{robot_};
  Bookkeeper bookkeeper_{programs_, memory_, books_,
                         [this](const ProgramHash& name) { return may_keep(name); }};
  Watch watch_{programs_, robot_, books_};
  std::optional<std::uint64_t> reset_at_;
  const Sent* next_ = nullptr;
  tool::UploadOptions options_;
  std::optional<Trial> trial_;
  std::optional<ProgramHash> wish_;  // somebody has asked for this one to come back
  ProgramHash running_{};
  unsigned activations_ = 0;
};

void run(const Programs& programs, const MemoryStore& first, const Books& first_books,
         std::uint64_t seed) {
  CAPTURE(seed);
  Random random(static_cast<Random::result_type>(seed));
  MemoryStore memory = first;
  Books books = first_books;
  for (auto lives = 1 + random() % 3; lives > 0; --lives) {
    Life(programs, memory, books, random).play();
    memory.switch_on();
  }
  Life(programs, memory, books, random).end_well();
}

}  // namespace

TEST_CASE("whatever happens to the line, the host and the power, a whole program runs") {
  const Programs programs;
  MemoryStore first(kCampaignStoreBytes);
  Books books;
  {
    Bookkeeper bookkeeper(programs, first, books, [](const ProgramHash&) { return true; });
    Robot robot(boards::kMemory, &first);
    test::run_on(robot, programs.all.front().program);
    robot.run(test::kTrialMs + 2000);
  }
  REQUIRE(books.kept == name_of(programs.all.front().program));
  REQUIRE(books.visits > 0);
  const std::uint64_t begin = setting("ROBOSYNC_LINK_SEED", 1);
  const std::uint64_t runs = setting("ROBOSYNC_LINK_RUNS", 200);
  for (std::uint64_t seed = begin; seed < begin + runs; ++seed)
    run(programs, first, books, seed);
}
