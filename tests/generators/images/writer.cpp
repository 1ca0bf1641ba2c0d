#include "tests/generators/images/writer.hpp"

namespace robosync::fuzz {

using vm::Context;
using vm::Effect;
using vm::encode;
using vm::Flow;

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

// Parameters that it takes, then it.
void Writer::command() {
  const Opcode opcode = drawer_.opcode_with([](Opcode op) {
    return flow_of(op) == Flow::next && effect_of(op) != Effect::param &&
           vm::output_words(effect_of(op)) > 0;
  });
  const Word word = drawer_.instruction(opcode);
  const bool text = effect_of(opcode) == Effect::log || effect_of(opcode) == Effect::alert;
  unsigned takes = text ? 0xFFU : 0;
  const unsigned verb = vm::operand_b(word);
  if (effect_of(opcode) == Effect::command && verb < draft_.view().verbs.size())
    takes = draft_.view().verbs[verb].params;
  for (auto left = takes != 0 ? random_.below(3) : 0; left > 0; --left) {
    Word given = drawer_.instruction(
        drawer_.opcode_with([](Opcode op) { return effect_of(op) == Effect::param; }));
    unsigned param = vm::operand_a(given);
    while (param < 8 && (takes >> param & 1) == 0)
      param = (param + 1) % 8;
    given = with_operand(given, 0, param);
    put(given);
  }
  put(word);
}

// One of those with this flow.
template <Flow flow>
Word Writer::with_flow() {
  return drawer_.instruction(drawer_.opcode_with([](Opcode op) { return flow_of(op) == flow; }));
}

void Writer::pause() {
  put(with_flow<Flow::pause>());
}

void Writer::choice(unsigned depth) {
  const Word word = with_flow<Flow::if_begin>();
  const std::size_t place = distance_of(vm::opcode_of(word)).place;
  const std::size_t begin = code_.size();
  put(word);
  statements(depth);
  const std::size_t middle = code_.size();
  const bool has_else = random_.one_in(2);
  if (has_else) put(with_flow<Flow::if_else>());
  code_[begin] = with_operand(code_[begin], place, since(begin) - 1);
  if (!has_else) return drawer_.forget();
  statements(depth);
  const Distance distance = distance_of(vm::opcode_of(code_[middle]));
  code_[middle] = with_operand(code_[middle], distance.place, since(middle) - 1);
  drawer_.forget();
}

// Back to the word at `start`.
void Writer::close(Word word, std::size_t start) {
  put(with_operand(word, distance_of(vm::opcode_of(word)).place, since(start) + 1));
}

void Writer::counted(unsigned depth) {
  if (drawer_.locals() == 0) return put(drawer_.plain());
  if (random_.one_in(3)) put(drawer_.instruction(Opcode::set));  // to be changed in place
  const Word begin = with_flow<Flow::count_begin>();
  const bool constant = kind_of(begin, 1) == Operand::count16;
  put(begin);
  const std::size_t start = code_.size();
  statements(depth);
  if (!constant || random_.one_in(3)) pause();
  if (random_.one_in(2)) statements(depth);
  close(with_operand(with_flow<Flow::count_end>(), 0, vm::operand_a(begin)), start);
}

void Writer::loop(unsigned depth) {
  put(with_flow<Flow::loop_begin>());
  const std::size_t start = code_.size();
  statements(depth);
  pause();
  if (random_.one_in(2)) statements(depth);
  put(a_truth());
  close(with_flow<Flow::loop_end>(), start);
}

void Writer::poll() {
  put(with_flow<Flow::poll_begin>());
  const std::size_t start = code_.size();
  for (auto left = random_.below(3); left > 0; --left)
    put(drawer_.plain());
  put(a_truth());
  close(with_flow<Flow::poll_end>(), start);
}

// Something to end a loop with.
Word Writer::a_truth() {
  return drawer_.instruction(drawer_.opcode_with(
      [](Opcode op) { return vm::info_of(op).operands[0] == Operand::write_truth; }));
}

}  // namespace robosync::fuzz
