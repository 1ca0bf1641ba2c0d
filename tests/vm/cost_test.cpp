// What the verifier finds a response to cost and to put out, against runs of drawn programs that
// take drawn ways: no run between two pauses may cost more, or put out more. And for most programs
// some run costs exactly that.
#include <algorithm>
#include <array>
#include <map>
#include <random>

#include <catch2/catch.hpp>

#include "tests/support/share.hpp"
#include "tests/vm/companion.hpp"
#include "vm/verifier.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
using namespace robosync::vm::test::companion;
using Op = Opcode;

namespace {

// The frame: r0 LEVEL | locals r1 … | watch | register.
constexpr unsigned kLocals = 60;
constexpr unsigned kWatchCell = 1 + kLocals;
constexpr unsigned kFirstRegister = kWatchCell + 1;
constexpr Value kMostRounds = 3;

// Draws the body of a response, blocks inside each other.
class Writer {
public:
  explicit Writer(std::uint32_t seed) : random_(seed) {}

  std::vector<Word> write() {
    block(3);
    code_.push_back(encode(Opcode::end));
    return code_;
  }

private:
  unsigned draw(unsigned below) { return static_cast<unsigned>(random_() % below); }
  void put(Word word) { code_.push_back(word); }
  // The words from `start` on, as an operand.
  [[nodiscard]] unsigned since(std::size_t start) const {
    return static_cast<unsigned>(code_.size() - start);
  }

  void block(unsigned depth) {
    for (unsigned left = draw(4); left > 0; --left)
      statement(depth);
  }
  void statement(unsigned depth) {
    switch (draw(depth > 0 ? 9 : 4)) {
      case 0:
        return put(encode(Opcode::add, kFirstRegister, 0, 0));
      case 1:
        return put(encode(Opcode::cmd, left_arm, move_verb, slowly));
      case 2:
        return wait();
      case 3:
        return poll();
      case 4:
      case 5:
        return choice(depth - 1);
      case 6:
      case 7:
        return counted(depth - 1);
      default:
        return endless(depth - 1);
    }
  }
  void wait() { put(draw(2) == 0 ? encode(Opcode::wait, 0) : encode(Opcode::wait_done)); }
  void poll() {
    put(encode(Opcode::poll));
    const std::size_t start = code_.size();
    for (unsigned left = draw(3); left > 0; --left)
      put(encode(Opcode::add, kFirstRegister, 0, 0));
    put(encode_wide(Opcode::until, kWatchCell, since(start) + 1));
  }
  void choice(unsigned depth) {
    const std::size_t begin = code_.size();
    put(0);
    block(depth);
    if (draw(2) == 0) {
      code_[begin] = encode_wide(Opcode::unless, kWatchCell, since(begin) - 1);
      return;
    }
    const std::size_t middle = code_.size();
    put(0);
    code_[begin] = encode_wide(Opcode::unless, kWatchCell, since(begin) - 1);
    block(depth);
    code_[middle] = encode_wide(Opcode::jump, 0, since(middle) - 1);
  }
  void counted(unsigned depth) {
    if (local_ > kLocals) return;
    const unsigned local = local_++;
    put(encode_wide(Opcode::times, local, draw(kMostRounds)));
    const std::size_t start = code_.size();
    block(depth);
    put(encode_wide(Opcode::again, local, since(start) + 1));
  }
  void endless(unsigned depth) {
    put(encode(Opcode::loop));
    const std::size_t start = code_.size();
    block(depth);
    put(encode(Opcode::wait, 0));
    block(depth);
    put(draw(2) == 0 ? encode_wide(Opcode::around_always, 0, since(start) + 1)
                     : encode_wide(Opcode::around, kWatchCell, since(start) + 1));
  }

  std::mt19937 random_;
  std::vector<Word> code_;
  unsigned local_ = 1;
};

Bytes image_of(const std::vector<Word>& code) {
  ImageBuilder image;
  add_robot(image);
  for (Value times = 1; times <= kMostRounds; ++times)
    image.constants.push_back(times * kScale);
  image.inputs = {touch_level};
  const auto truth = {encode(Opcode::lt_k, kFirstRegister, 0, 0),
                      encode(Opcode::ret, kFirstRegister)};
  image.rule(0, kNoIndex, truth);
  image.rule_of(RuleKind::watch, kNoIndex, truth);
  const bool commands = std::any_of(code.begin(), code.end(),
                                    [](Word word) { return opcode_of(word) == Opcode::cmd; });
  const std::uint32_t mask = commands ? 1 << left_arm : 0;
  image.responses.push_back({static_cast<std::uint16_t>(image.code.size()),
                             static_cast<std::uint16_t>(code.size()), mask});
  image.code.insert(image.code.end(), code.begin(), code.end());
  image.behaviors.push_back({1, kNoIndex, mask, 0, 1, 2, 0, kLocals, kFirstRegister + 1});
  return image.build();
}

std::uint32_t cost_of(Op op) {
  return kOpcodes[static_cast<std::size_t>(op)].cost;
}

struct Worst {
  std::uint32_t cost = 0;
  std::uint32_t output = 0;
};

// Follows the code on a drawn way, as the interpreter would; what its costliest run takes.
class Walk {
public:
  Walk(const std::vector<Word>& code, std::mt19937& random) : code_(code), random_(random) {}

  Worst go() {
    constexpr int kEnough = 3000;
    for (int words = 0; words < kEnough && at_ < code_.size(); ++words)
      step(code_[at_]);
    pause();
    return worst_;
  }

private:
  bool draw_truth() { return random_() % 2 == 0; }
  void pause() {
    worst_.cost = std::max(worst_.cost, run_.cost);
    worst_.output = std::max(worst_.output, run_.output);
    run_ = {};
  }
  void step(Word word) {
    const Op op = opcode_of(word);
    run_.cost += cost_of(op);
    ++at_;
    switch (op) {
      case Opcode::cmd:
        ++run_.output;
        break;
      case Opcode::jump:
        at_ += operand_wide(word);
        break;
      case Opcode::unless:
        if (!draw_truth()) at_ += operand_wide(word);
        break;
      case Opcode::times:
        rounds_[operand_a(word)] = operand_wide(word) + 1U;  // the constants are 1, 2, 3
        break;
      case Opcode::again:
        if (--rounds_[operand_a(word)] > 0) at_ -= operand_wide(word);
        break;
      case Opcode::around:
        if (draw_truth()) at_ -= operand_wide(word);
        break;
      case Opcode::around_always:
        at_ -= operand_wide(word);
        break;
      case Opcode::wait:
      case Opcode::wait_done:
      case Opcode::poll:
        pause();
        break;
      case Opcode::until:
        if (draw_truth()) break;
        at_ -= operand_wide(word);
        pause();
        break;
      case Opcode::end:
        at_ = code_.size();
        break;
      default:
        break;
    }
  }

  const std::vector<Word>& code_;
  std::mt19937& random_;
  std::size_t at_ = 0;
  Worst run_, worst_;
  std::map<unsigned, unsigned> rounds_;
};

}  // namespace

TEST_CASE("no way through a drawn response is costlier than what the verifier has found") {
  const std::uint32_t conditions = 2 * (cost_of(Opcode::lt_k) + cost_of(Opcode::ret));
  const auto programs = robosync::test::share_of<std::uint32_t>(1500);
  unsigned accepted = 0;
  unsigned exact = 0;
  for (std::uint32_t seed = 0; seed < programs; ++seed) {
    const std::vector<Word> code = Writer(seed).write();
    const Bytes bytes = image_of(code);
    Image image;
    const Verdict verdict = verify(bytes, {}, image);
    CAPTURE(seed, describe(verdict.refusal), verdict.index);
    // Well-formed, but it may put out too much.
    REQUIRE((verdict.ok() || verdict.refusal == Refusal::too_much_output));
    if (!verdict.ok()) continue;
    ++accepted;
    const std::uint32_t found = image.header->step_cost - conditions;
    std::mt19937 random(seed);
    std::uint32_t worst = 0;
    for (int way = 0; way < 200; ++way) {
      const Worst walked = Walk(code, random).go();
      REQUIRE(walked.cost <= found);
      REQUIRE(walked.output <= kMaxResponseOutput);
      worst = std::max(worst, walked.cost);
    }
    exact += worst == found ? 1 : 0;
  }
  CHECK(accepted > programs * 9 / 10);
  CAPTURE(accepted, exact);
  CHECK(exact > accepted * 7 / 10);
}
