// A model of an SSD1306 on a module of 128 x 64 dots, written from Solomon Systech's data sheet (Rev. 1.1) and its application
// note on the charge pump, independent of the driver: control bytes (8.1.5.2), the memory and its three addressing modes (8.7,
// 10.1.3), commands (table 9-1), their values at a reset (8.5), the charge pump (application note, 3.1). Its panel is mounted as
// in common modules: it is upright with the columns remapped and the rows scanned from the last one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace robosync::test {

class Ssd1306 {
public:
  static constexpr unsigned kWidth = 128, kHeight = 64, kPages = 8;

  explicit Ssd1306(std::uint8_t address) : address_(address) { lose_power(); }

  // The contents of its memory at power-up are random.
  void lose_power() {
    settings_ = {};
    command_.clear();
    for (auto& page : memory_)
      for (std::uint8_t& byte : page)
        byte = static_cast<std::uint8_t>(noise_());
  }

  // START, the bytes, STOP. False: it did not acknowledge one of them.
  bool transfer(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in) {
    if (absent || address != address_ || !in.empty()) return false;
    ++transfers;
    bytes += out.size();
    Next next = Next::control;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (disturbed_byte != 0 && i + 1 == disturbed_byte) return false;
      const auto byte = std::to_integer<std::uint8_t>(out[i]);
      if (next == Next::control)
        next = control(byte);
      else
        next = take(next, byte);
    }
    return true;
  }

  // Is the dot lit? From the top left.
  bool lit(unsigned x, unsigned y) const {
    if (!settings_.on || !settings_.pump || settings_.multiplex != kHeight - 1) return false;
    if (settings_.all_on) return true;
    const unsigned scanned = settings_.from_last_row ? y : kHeight - 1 - y;
    // Other rows of the panel are at other pins.
    const unsigned wired = settings_.com_pins == 0x12 ? scanned : scanned * 2 % kHeight;
    const unsigned row = (wired + settings_.offset + settings_.start_line) % kHeight;
    const bool bit = (memory_[row / 8][kWidth - 1 - x] >> row % 8 & 1) != 0;
    return bit != settings_.inverse;
  }
  bool dark() const {
    for (unsigned y = 0; y < kHeight; ++y)
      for (unsigned x = 0; x < kWidth; ++x)
        if (lit(x, y)) return false;
    return true;
  }
  bool is_on() const { return settings_.on; }

  // Commands that another program may have sent.
  void tell(std::initializer_list<std::uint8_t> commands) {
    for (const std::uint8_t byte : commands)
      command(byte);
  }

  bool absent = false;             // it has no power, or is disconnected
  std::size_t disturbed_byte = 0;  // this byte of each transfer, from 1 on, is not acknowledged
  unsigned transfers = 0;
  std::size_t bytes = 0;  // without the address
  bool unknown = false;   // it got an unknown command

private:
  enum class Next : std::uint8_t { control, one_command, commands, one_datum, data };
  enum class Addressing : std::uint8_t { horizontal, vertical, page };

  struct Settings {
    Addressing addressing = Addressing::page;
    bool on = false, pump = false, all_on = false, inverse = false;
    bool remapped = false, from_last_row = false;
    unsigned multiplex = 63, offset = 0, start_line = 0, com_pins = 0x12;
    unsigned page = 0, column = 0;  // where the next datum goes
    unsigned first_page = 0, last_page = 7, first_column = 0, last_column = 127;
  };

  // Co: another control byte follows the next byte. D/C#: the next byte is a datum.
  Next control(std::uint8_t byte) {
    if ((byte & 0x3F) != 0) unknown = true;
    const bool data = (byte & 0x40) != 0;
    if ((byte & 0x80) != 0) return data ? Next::one_datum : Next::one_command;
    return data ? Next::data : Next::commands;
  }
  Next take(Next as, std::uint8_t byte) {
    const bool data = as == Next::one_datum || as == Next::data;
    data ? datum(byte) : command(byte);
    return as == Next::data || as == Next::commands ? as : Next::control;
  }

  // The place of a column's dots is determined when they are written (10.1.8).
  void datum(std::uint8_t byte) {
    Settings& s = settings_;
    memory_[s.page][s.remapped ? kWidth - 1 - s.column : s.column] = byte;
    switch (s.addressing) {
      case Addressing::page:
        s.column = (s.column + 1) % kWidth;
        break;
      case Addressing::horizontal:
        if (step(s.column, s.first_column, s.last_column)) step(s.page, s.first_page, s.last_page);
        break;
      case Addressing::vertical:
        if (step(s.page, s.first_page, s.last_page)) step(s.column, s.first_column, s.last_column);
        break;
    }
  }
  static bool step(unsigned& at, unsigned first, unsigned last) {
    const bool over = at == last;
    at = over ? first : (at + 1) % kWidth;
    return over;
  }

  static unsigned arguments_of(std::uint8_t code) {
    switch (code) {
      case 0x20:
      case 0x81:
      case 0x8D:
      case 0xA8:
      case 0xD3:
      case 0xD5:
      case 0xD9:
      case 0xDA:
      case 0xDB:
        return 1;
      case 0x21:
      case 0x22:
        return 2;
      default:
        return 0;
    }
  }
  void command(std::uint8_t byte) {
    command_.push_back(byte);
    if (command_.size() <= arguments_of(command_[0])) return;
    const std::vector<std::uint8_t> whole = std::move(command_);
    command_.clear();
    whole.size() == 1 ? alone(whole[0]) : with_arguments(whole);
  }
  void with_arguments(std::span<const std::uint8_t> c) {
    Settings& s = settings_;
    switch (c[0]) {
      case 0x20:
        if ((c[1] & 3) < 3) s.addressing = static_cast<Addressing>(c[1] & 3);
        break;
      case 0x21:
        s.column = s.first_column = c[1] & 0x7F;
        s.last_column = c[2] & 0x7F;
        break;
      case 0x22:
        s.page = s.first_page = c[1] & 7;
        s.last_page = c[2] & 7;
        break;
      case 0x8D:
        s.pump = (c[1] & 0x3F) == 0x14;
        break;
      case 0xA8:
        s.multiplex = c[1] & 0x3F;
        break;
      case 0xD3:
        s.offset = c[1] & 0x3F;
        break;
      case 0xDA:
        s.com_pins = c[1];
        break;
      default:
        break;  // contrast, clock, pre-charge period, VCOMH level
    }
  }
  void alone(std::uint8_t code) {
    Settings& s = settings_;
    const bool by_page = s.addressing == Addressing::page;
    if (code <= 0x0F) {
      if (by_page) s.column = (s.column & 0x70) | (code & 0x0Fu);
    } else if (code <= 0x1F) {
      if (by_page) s.column = (s.column & 0x0F) | (code & 0x07u) << 4;
    } else if (code >= 0x40 && code <= 0x7F) {
      s.start_line = code & 0x3F;
    } else if ((code & 0xFE) == 0xA0) {
      s.remapped = (code & 1) != 0;
    } else if ((code & 0xFE) == 0xA4) {
      s.all_on = (code & 1) != 0;
    } else if ((code & 0xFE) == 0xA6) {
      s.inverse = (code & 1) != 0;
    } else if ((code & 0xFE) == 0xAE) {
      s.on = (code & 1) != 0;
    } else if (code >= 0xB0 && code <= 0xB7) {
      if (by_page) s.page = code & 7;
    } else if ((code & 0xF0) == 0xC0) {
      s.from_last_row = (code & 8) != 0;
    } else if (code != 0xE3) {
      unknown = true;
    }
  }

  std::uint8_t address_;
  Settings settings_;
  std::vector<std::uint8_t> command_;  // not complete yet
  std::array<std::array<std::uint8_t, kWidth>, kPages> memory_{};
  std::mt19937 noise_{1306};
};

}  // namespace robosync::test
