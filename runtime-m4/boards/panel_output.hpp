// The panel of lights of a board; without a panel, nothing happens. Only the output guard calls it.
#pragma once

#include <cstdint>

#include "runtime-m4/policy/panel.hpp"

namespace robosync::boards {

class PanelOutput {
public:
  // Begins with the program's panel, all dark; the panel itself learns this only with the first picture. Until end() the pin
  // belongs to the panel alone, and is low between two pictures.
  virtual void begin(const policy::Panel& /*panel*/) {}
  // Shows a picture, in the format of Board::show(), or the colour of a strip, 0xRRGGBB. It is sent in the background. The rest
  // of an unfinished picture is dropped, which nobody can see.
  virtual void show(std::uint32_t /*picture*/) {}
  // Returns the pin to its earlier use, immediately.
  virtual void end() {}

  constexpr PanelOutput() = default;
  PanelOutput(const PanelOutput&) = delete;
  PanelOutput& operator=(const PanelOutput&) = delete;

protected:
  ~PanelOutput() = default;
};

class NoPanel final : public PanelOutput {};
inline constinit NoPanel no_panel;

}  // namespace robosync::boards
