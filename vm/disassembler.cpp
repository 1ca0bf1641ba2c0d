// Writes one instruction as text: `lt_k     r1, r0, 3`, `cmd      arms MOVE SLOWLY`.
//
// Assumes nothing about the word: an invalid instruction or reference is shown as numbers. Uses the
// caller's buffer only.
#include "vm/disassembler.hpp"

#include "vm/opcode.hpp"

namespace robosync::vm {
namespace {

constexpr std::size_t kMnemonicWidth = 9;  // longer ones are followed by one space

constexpr std::string_view kParamNames[] = {
#define PARAM(name, spelling, doc) #name,
#include "vm/params.def"
#undef PARAM
};

class Writer {
public:
  explicit Writer(std::span<char> buffer) : buffer_(buffer) {}

  void put(char c) {
    if (length_ + 1 < buffer_.size()) buffer_[length_++] = c;
  }
  void put(std::string_view text) {
    for (const char c : text)
      put(c);
  }
  // Names come from outside: they must not contain control characters for a terminal.
  void put_name(std::string_view name) {
    for (const char c : name) {
      const auto code = static_cast<unsigned char>(c);
      put(code < 0x20 || code == 0x7F ? '?' : c);
    }
  }
  // In the lists, a name that is a C++ keyword ends in an underscore.
  void put_identifier(std::string_view name) {
    if (!name.empty() && name.back() == '_') name.remove_suffix(1);
    put(name);
  }
  void put_number(std::uint32_t number) {
    char digits[10];
    std::size_t count = 0;
    do {
      digits[count++] = static_cast<char>('0' + number % 10);
      number /= 10;
    } while (number > 0);
    while (count > 0)
      put(digits[--count]);
  }
  // In canonical units, without trailing zeros: 2.5, -0.001, 3.
  void put_value(Value value) {
    if (value == kUnknown) return put("unknown");
    if (value < 0) put('-');
    const auto size = static_cast<std::uint32_t>(value < 0 ? -value : value);
    put_number(size / kScale);
    std::uint32_t fraction = size % kScale;
    if (fraction != 0) put('.');
    for (; fraction != 0; fraction = fraction * 10 % kScale)
      put(static_cast<char>('0' + fraction * 10 / kScale));
  }
  void put_hex(std::uint32_t number) {
    put("0x");
    for (int shift = 28; shift >= 0; shift -= 4)
      put("0123456789abcdef"[number >> shift & 0xF]);
  }
  void begin_operands() {
    do {
      put(' ');
    } while (length_ < kMnemonicWidth && length_ + 1 < buffer_.size());
  }
  std::size_t finish() {
    if (!buffer_.empty()) buffer_[length_] = 0;
    return length_;
  }

private:
  std::span<char> buffer_;
  std::size_t length_ = 0;
};

// The record's name, or if there is none, its kind and number: `verb?7`.
template <typename Record>
void put_record(Writer& out, const Image& image, std::span<const Record> records, std::size_t index,
                std::string_view kind) {
  if (index < records.size()) return out.put_name(image.string(records[index].name));
  out.put(kind);
  out.put('?');
  out.put_number(static_cast<std::uint32_t>(index));
}

void put_constant(Writer& out, const Image& image, Operand kind, std::size_t index) {
  if (index >= image.constants.size()) {
    out.put("constant?");
    return out.put_number(static_cast<std::uint32_t>(index));
  }
  const Value number = image.constants[index];
  if (!is_whole(kind)) return out.put_value(number);
  if (number < 0) out.put('-');
  const auto bits = static_cast<std::uint32_t>(number);
  out.put_number(number < 0 ? 0 - bits : bits);
}

void put_target(Writer& out, const Image& image, std::uint8_t target) {
  if (target == kAllActuators)
    out.put("ALL");
  else if ((target & kGroupBit) != 0)
    put_record(out, image, image.groups, target & ~unsigned{kGroupBit}, "group");
  else
    put_record(out, image, image.actuators, target, "actuator");
}

void put_param(Writer& out, std::uint8_t param) {
  if (param < std::size(kParamNames)) return out.put_identifier(kParamNames[param]);
  out.put("param?");
  out.put_number(param);
}

void put_string(Writer& out, const Image& image, std::uint16_t offset) {
  if (offset >= image.strings.size()) {
    out.put("string?");
    return out.put_number(offset);
  }
  out.put('"');
  out.put_name(image.string(offset));
  out.put('"');
}

void put_sign(Writer& out, char sign, std::uint32_t number) {
  out.put(sign);
  out.put_number(number);
}

// Operands of a command read like RSL; the others are separated by commas.
std::string_view separator(bool first, Operand operand) {
  if (first) return {};
  return operand == Operand::verb || operand == Operand::word ? " " : ", ";
}

// Is the operand omitted from the text?
bool is_empty(Operand operand, std::uint8_t byte) {
  return operand == Operand::none || (operand == Operand::word && byte == kNoWord);
}

void put_operand(Writer& out, const Image& image, Operand operand, std::uint16_t number) {
  const auto byte = static_cast<std::uint8_t>(number);
  switch (operand) {
    case Operand::write:
    case Operand::write_truth:
    case Operand::write_same:
    case Operand::update_truth:
    case Operand::local:
    case Operand::variable:
    case Operand::read:
    case Operand::read_truth:
      return put_sign(out, 'r', number);
    case Operand::timer:
      return put_sign(out, 't', number);
    case Operand::ahead:
    case Operand::ahead8:
      return put_sign(out, '+', number);
    case Operand::back:
      return put_sign(out, '-', number);
    case Operand::string:
      return put_string(out, image, number);
    case Operand::const8:
    case Operand::const16:
    case Operand::positive8:
    case Operand::whole8:
    case Operand::divisor8:
    case Operand::count16:
      return put_constant(out, image, operand, number);
    case Operand::param:
      return put_param(out, byte);
    case Operand::target:
      return put_target(out, image, byte);
    case Operand::verb:
      return put_record(out, image, image.verbs, number, "verb");
    case Operand::word:
      return put_record(out, image, image.words, number, "word");
    case Operand::none:
      return;
  }
}

}  // namespace

std::size_t disassemble(const Image& image, Word word, std::span<char> buffer) {
  Writer out(buffer);
  const auto number = static_cast<std::size_t>(opcode_of(word));
  if (number >= kOpcodes.size()) {
    out.put("?");
    out.begin_operands();
    out.put_hex(word);
    return out.finish();
  }
  const OpcodeInfo& info = kOpcodes[number];
  out.put_identifier(info.name);
  bool first = true;
  for (std::size_t place = 0; place < info.operands.size(); ++place) {
    const Operand operand = info.operands[place];
    const auto byte = static_cast<std::uint8_t>(word >> 8 * (place + 1));
    if (is_empty(operand, byte)) continue;
    if (first) out.begin_operands();
    out.put(separator(first, operand));
    put_operand(out, image, operand, is_wide(operand) ? operand_wide(word) : byte);
    first = false;
  }
  return out.finish();
}

}  // namespace robosync::vm
