// CHECKs: which band the value of a channel or variable is in.
//
// SMOOTH takes the median of the samples in a window. A sample is the input's value at an instant
// of a fixed raster, which begins with the first known value; between two readings the input keeps
// its value. A new value at an instant is sampled immediately. A kept value is sampled when that millisecond
// is over: a reading may still come in it, after a step that time alone caused, and until
// then the previous value would count twice.
//
// So the median goes on changing after the last reading, until the window holds only that value;
// next() says when. Until the window is full, the median is that of the samples so far; of an
// even number of samples it is the lower middle one. An unknown value empties the window, and its
// band is unknown.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/layers/median.hpp"
#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "vm/interpreter.hpp"

namespace robosync::layers {

class Checks {
public:
  void start(const vm::Image& image, Memory& memory);

  // Puts the band of `check` at `now` (milliseconds of program time) into `values`, the values of
  // all inputs. Returns whether it changed. Several calls at one time make one sample.
  bool update(unsigned check, std::uint32_t now, vm::Value* values);
  // In how many milliseconds a band may change although no input does; kNever for never.
  std::uint32_t next(std::uint32_t now) const;

private:
  struct Window {
    vm::Value held = vm::kUnknown;    // the input since the last step
    vm::Value median = vm::kUnknown;  // of its samples
    std::uint32_t newest = 0;         // when the newest one was taken
    MedianWindow samples;

    void forget() {
      held = median = vm::kUnknown;
      samples.clear();
    }
  };

  vm::Value smoothed(unsigned check, std::uint32_t now, vm::Value value);
  vm::Value smoothed_otherwise(unsigned check, std::uint32_t now, vm::Value value);
  vm::Value take(unsigned check, std::uint32_t at, vm::Value sample);
  vm::Value band_of(const vm::Check& check, vm::Value value, vm::Value before) const;

  std::span<const vm::Check> wiring_;
  std::span<const vm::Band> bands_;
  std::size_t channels_ = 0;
  std::span<Window> windows_;
  MedianWindow::Room room_;
};

}  // namespace robosync::layers
