// The signal for a panel of WS2812 lights, sent in the background by an SPI master with DMA. Several SPI bits form one bit of the
// panel, which is high for part of them. A light takes 24 bits: green first, most significant bit first. Silence of at least
// 280 us ends a picture (Worldsemi, WS2812B, "Data transfer time", "Composition of 24bit data").
//
// Hardware provides the SPI's rate kHz; kBitsOfBit, the number of SPI bits in one bit of the panel; kZero and kOne, their values;
// send(pin, bytes), which drops what is still being sent; and let_go().
//
// The silence is sent as bytes, before and after each picture. It ends a picture that was dropped midway; and no manual says
// which level the line has when the SPI has nothing to send.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "runtime-m4/boards/panel_output.hpp"

namespace robosync::boards {

template <typename Hardware>
class PanelSignal final : public PanelOutput {
public:
  void begin(const policy::Panel& panel) override {
    panel_ = panel;
    lit_ = signal_of(panel.color);
    shown_ = 0;
    bytes_ = {};
    for (unsigned place = 0; place < panel.lights(); ++place)
      put(place, kDark);
  }

  // Changes the buffer even while it is being sent. No mixed picture stays visible, because the whole picture is sent again.
  void show(std::uint32_t picture) override {
    panel_.strip != 0 ? light_all(signal_of(picture)) : draw(picture);
    std::atomic_signal_fence(std::memory_order_release);  // the SPI reads from memory
    const std::size_t count = 2 * kSilence + panel_.lights() * kLightBytes;
    Hardware::send(panel_.pin, std::span<const std::byte>(bytes_).first(count));
  }

  void end() override { Hardware::let_go(); }

private:
  static constexpr unsigned kSilenceUs = 300;
  static constexpr std::size_t kSilence =
      Hardware::kHz / 1000 * kSilenceUs / 1000 / 8 + 1;            // bytes
  static constexpr std::size_t kPartBytes = Hardware::kBitsOfBit;  // of 8 bits
  static constexpr std::size_t kLightBytes = 3 * kPartBytes;
  static constexpr std::uint32_t kAllLights = (1U << policy::kPictureLights) - 1;
  using Light = std::array<std::byte, kLightBytes>;

  static constexpr Light signal_of(std::uint32_t color) {
    Light light{};
    const std::array<std::uint32_t, 3> parts{color >> 8, color >> 16, color};
    for (std::size_t part = 0; part < parts.size(); ++part) {
      std::uint64_t bits = 0;
      for (unsigned bit = 8; bit-- > 0;)
        bits = bits << Hardware::kBitsOfBit |
               ((parts[part] >> bit & 1) != 0 ? Hardware::kOne : Hardware::kZero);
      for (std::size_t i = kPartBytes; i-- > 0; bits >>= 8)
        light[part * kPartBytes + i] = static_cast<std::byte>(bits & 0xFF);
    }
    return light;
  }
  static constexpr Light kDark = signal_of(0);

  void put(unsigned place, const Light& light) {
    std::memcpy(&bytes_[kSilence + place * kLightBytes], light.data(), kLightBytes);
  }

  void light_all(const Light& light) {
    for (unsigned place = 0; place < panel_.strip; ++place)
      put(place, light);
  }

  void draw(std::uint32_t picture) {
    for (std::uint32_t left = (picture ^ shown_) & kAllLights; left != 0; left &= left - 1) {
      const auto light = static_cast<unsigned>(std::countr_zero(left));
      put(panel_.place_of(light), (picture >> light & 1) != 0 ? lit_ : kDark);
    }
    shown_ = picture;
  }

  policy::Panel panel_{};
  Light lit_{};
  std::uint32_t shown_ = 0;
  // Static, so that it takes no flash: there is one panel for each Hardware.
  inline static std::array<std::byte, 2 * kSilence + vm::kMostPanelLights * kLightBytes> bytes_{};
};

}  // namespace robosync::boards
