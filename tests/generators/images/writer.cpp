#include "tests/generators/images/writer.hpp"

namespace robosync::fuzz {

using vm::Context;
using vm::encode;
using vm::encode_wide;

namespace {

constexpr unsigned kMostDepth = 4;
constexpr std::size_t kMostWords = 60;

}  // namespace

std::span<const Word> Writer::grow() {
  code_.clear();
  drawer_.set_odds(random_.one_in(2) ? 0 : 200);
  if (object_.context == Context::condition) {
    for (auto left = 1 + random_.below(6); left > 0; --left)
      put(drawer_.plain());
    const bool period = draft_.view().rules[object_.rule].kind == vm::RuleKind::every;
    put(drawer_.instruction(period ? Opcode::ret_number : Opcode::ret));
    return code_;
  }
  if (random_.one_in(50)) {  // as deep as it goes
    for (unsigned left = 14 + random_.below(4); left > 0; --left)
      put(encode(Opcode::loop));
  }
  statements(1 + random_.below(kMostDepth));
  put(encode(Opcode::end));
  return code_;
}

void Writer::put(Word word) {
  code_.push_back(word);
  drawer_.learn(word);
}

void Writer::statements(unsigned depth) {
  for (auto left = random_.below(5); left > 0 && code_.size() < kMostWords; --left)
    statement(depth);
}

void Writer::statement(unsigned depth) {
  const std::uint32_t draw = random_.below(12);
  if (object_.context == Context::safety || draw < 5) {
    if (random_.one_in(2)) return put(drawer_.plain());
    return command();
  }
  if (draw < 6) return pause();
  if (draw < 7) return poll();
  if (depth == 0) return put(drawer_.plain());
  if (draw < 10) return choice(depth - 1);
  if (draw < 11) return counted(depth - 1);
  loop(depth - 1);
}

// Parameters that its verb takes, then it.
void Writer::command() {
  const Opcode opcode = drawer_.opcode_with([](Opcode op) {
    return op == Opcode::cmd || op == Opcode::log || op == Opcode::alert || op == Opcode::halt;
  });
  const Word word = drawer_.instruction(opcode);
  unsigned takes = opcode == Opcode::log ? 0xFFU : 0;
  const unsigned verb = vm::operand_b(word);
  if (opcode == Opcode::cmd && verb < draft_.view().verbs.size())
    takes = draft_.view().verbs[verb].params;
  for (auto left = takes != 0 ? random_.below(3) : 0; left > 0; --left) {
    const Opcode arg = random_.one_in(2) ? Opcode::arg : Opcode::arg_k;
    Word given = drawer_.instruction(arg);
    unsigned param = vm::operand_a(given);
    while (param < 8 && (takes >> param & 1) == 0)
      param = (param + 1) % 8;
    given = with_operand(given, 0, param);
    put(given);
  }
  put(word);
}

void Writer::pause() {
  put(drawer_.instruction(random_.one_in(2) ? Opcode::wait : Opcode::wait_done));
}

void Writer::choice(unsigned depth) {
  const Opcode opcode = drawer_.opcode_with(begins_if);
  const std::size_t place = distance_of(opcode).place;
  const std::size_t begin = code_.size();
  put(drawer_.instruction(opcode));
  statements(depth);
  const std::size_t middle = code_.size();
  const bool has_else = random_.one_in(2);
  if (has_else) put(encode(Opcode::jump));
  code_[begin] = with_operand(code_[begin], place, since(begin) - 1);
  if (!has_else) return drawer_.forget();
  statements(depth);
  code_[middle] = with_operand(code_[middle], distance_of(Opcode::jump).place, since(middle) - 1);
  drawer_.forget();
}

// Back to the word at `start`.
void Writer::close(Opcode opcode, unsigned a, std::size_t start) {
  put(encode_wide(opcode, a, since(start) + 1));
}

void Writer::counted(unsigned depth) {
  if (drawer_.locals() == 0) return put(drawer_.plain());
  if (random_.one_in(3)) put(drawer_.instruction(Opcode::set));  // to be changed in place
  const bool constant = random_.below(3) != 0;
  Word begin = drawer_.instruction(constant ? Opcode::times : Opcode::times_v);
  const unsigned local = vm::operand_a(begin);
  put(begin);
  const std::size_t start = code_.size();
  statements(depth);
  if (!constant || random_.one_in(3)) pause();
  if (random_.one_in(2)) statements(depth);
  close(Opcode::again, local, start);
}

void Writer::loop(unsigned depth) {
  put(encode(Opcode::loop));
  const std::size_t start = code_.size();
  statements(depth);
  pause();
  if (random_.one_in(2)) statements(depth);
  put(drawer_.instruction(drawer_.opcode_with(
      [](Opcode op) { return op == Opcode::lt_k || op == Opcode::not_ || op == Opcode::gt_k; })));
  if (random_.one_in(2)) return close(Opcode::around_always, 0, start);
  close(Opcode::around, drawer_.truth(), start);
}

void Writer::poll() {
  put(encode(Opcode::poll));
  const std::size_t start = code_.size();
  for (auto left = random_.below(3); left > 0; --left)
    put(drawer_.plain());
  put(drawer_.instruction(drawer_.opcode_with([](Opcode op) {
    return vm::kOpcodes[static_cast<unsigned>(op)].operands[0] == Operand::write_truth;
  })));
  close(Opcode::until, drawer_.truth(), start);
}

}  // namespace robosync::fuzz
