// The panel of lights of a board; of one that has none, nothing happens. Nobody but the output guard calls it.
#pragma once

#include <cstdint>

#include "runtime-m4/policy/panel.hpp"

namespace robosync::boards {

class PanelOutput {
public:
  // The panel that the program has, from now on: all dark, which it is told with the first picture. Its pin is driven by it alone
  // until end(), and low between two pictures; nobody else drives it.
  virtual void begin(const policy::Panel& /*panel*/) {}
  // The picture on it from now on, which is as those of Board::show(). It goes out while the processor does something else; what
  // has not left of the one before is given up, and that is seen by nobody.
  virtual void show(std::uint32_t /*picture*/) {}
  // Its pin is as it was before. At once.
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
