// What the sensor layer measures with: drivers on the board, fed values in the simulator.
#pragma once

#include <type_traits>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/features.hpp"
#include "runtime-m4/drivers/encoder.hpp"
#include "runtime-m4/drivers/microphone.hpp"
#include "runtime-m4/guard/output_guard.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "vm/image.hpp"

namespace robosync::drivers {
struct ServedBus;
}

namespace robosync::layers {

class Sampler {
public:
  // One sample of a channel in thousandths of its unit. False if there is none.
  virtual bool sample(const vm::Image& image, std::uint8_t channel, vm::Value& value) = 0;
  // Sends a frame to the servo chip (drivers/servo_chip.hpp) or display (drivers/screen.hpp) that is this sensor of the image.
  // False if it did not answer.
  virtual bool serve_chip(const vm::Image& /*image*/, unsigned /*sensor*/) { return true; }
  // The chip is silent: what it shows or drives is no longer known.
  virtual void lose_chip(unsigned /*sensor*/) {}
  // How long before its sample a sensor must be asked; 0: it is not asked. Its channels are then asked for, and sampled once
  // nothing is awaited any more.
  virtual kernel::Duration asks_ahead(const vm::Sensor& /*sensor*/) const { return 0; }
  virtual void ask(const vm::Image& /*image*/, std::uint8_t /*channel*/) {}
  virtual bool awaits() const { return false; }

protected:
  ~Sampler() = default;
};

// Reads through the channel's driver and scales the raw count. Only one thread at a time holds the board's
// buses: a driver may need several transfers that belong together.
class DriverSampler final : public Sampler {
public:
  DriverSampler(kernel::Kernel& kernel, boards::Board& board, guard::OutputGuard& outputs)
      : kernel_(kernel), board_(board), outputs_(outputs) {}
  bool sample(const vm::Image& image, std::uint8_t channel, vm::Value& value) override;
  kernel::Duration asks_ahead(const vm::Sensor& sensor) const override;
  void ask(const vm::Image& image, std::uint8_t channel) override;
  bool awaits() const override { return board_.buses_busy(); }
  bool serve_chip(const vm::Image& image, unsigned sensor) override;
  void lose_chip(unsigned sensor) override { outputs_.lose_chip(sensor); }
  // Does anything answer at this address of an I2C bus? Takes a few milliseconds.  [thread]
  bool probe(std::uint8_t bus, std::uint8_t address);

private:
  drivers::ServedBus bus_of(const vm::Sensor& sensor);
  bool sample_encoder(const vm::Image& image, std::uint8_t channel, vm::Value& value);
  bool serve_display(const vm::Image& image, unsigned sensor);

  kernel::Kernel& kernel_;
  boards::Board& board_;
  guard::OutputGuard& outputs_;
  kernel::Mutex buses_{kernel::Category::sensor};
  struct None {
    static bool sample(boards::Board&, bool, const vm::Channel&, vm::Value&) { return false; }
  };
  [[no_unique_address]] std::conditional_t<boards::kHasMicrophone, drivers::Microphone, None>
      microphone_;
  drivers::Encoders encoders_;
};

// raw * scale_num / scale_den + offset, rounded half away from zero, saturating.
[[nodiscard]] vm::Value scaled(std::int32_t raw, const vm::Channel& channel);

}  // namespace robosync::layers
