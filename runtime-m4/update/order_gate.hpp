// Who may give the robot orders. Without an owner whoever has the line does; with one, an order counts that the owner has
// signed (link/order.hpp), and each counts once. `stop` does not come here: it is for everybody.
//
// An upload is ordered by `begin`, which names the image by the hash of its bytes: what follows needs no signature, since
// nothing else can be activated than an image of that hash, once, within kGrant and before any other order or a stop.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/frame.hpp"
#include "link/messages.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/update/key_store.hpp"

namespace robosync::update {

class OrderGate {
public:
  // A board that was switched on, not reset, takes a key for so long: who can do that is beside it.
  static constexpr kernel::Duration kWindow = kernel::milliseconds(60'000);
  static constexpr kernel::Duration kGrant = kernel::milliseconds(300'000);
  // After a bad signature none is looked at for so long; after each further one for twice as long, up to kMostPause.
  static constexpr kernel::Duration kPause = kernel::milliseconds(250);
  static constexpr kernel::Duration kMostPause = kernel::milliseconds(8'000);
  // The number of an order is at most so far ahead, so that none ends the counting.
  static constexpr std::uint64_t kMostAhead = 1'000'000;

  OrderGate(kernel::Kernel& kernel, boards::Store* store) : kernel_(kernel), store_(store) {}

  // All by the link thread. First of all, before anybody measures or reads programs from the store: it reads who the owner
  // is, and takes some milliseconds.
  void open(bool switched_on);

  // False when the frame is an order that does not count; fill() then says why. A signed order becomes the order itself.
  [[nodiscard]] bool takes(link::Frame& frame);
  // May the image that was received be activated so? To be asked once for each.
  [[nodiscard]] bool grants(std::span<const std::byte> image, const link::Activate& how);
  // What was signed before this does not count any more: a stop.
  void outdate() {
    ++next_;
    granted_.open = false;
  }

  void pair(const link::Pair& owner);
  void unpair();
  link::Pairing pairing() const;
  void fill(link::Authority& answer)
      const;  // with the reason of what was refused last, if it was the last request

  // A record is being written; nobody else uses the store meanwhile.
  bool busy() const { return busy_; }
  bool work();  // the next piece; false when there is none before due()
  kernel::Time due() const { return due_; }

private:
  // A signed `begin` of an upload.
  struct Granted {
    bool open = false;
    kernel::Time until = 0;
    link::Grant what{};
    std::array<std::byte, 64> begin{};  // what the order was, without the grant
    std::size_t begin_bytes = 0;
  };

  bool deny(link::Denial why);
  bool paired() const { return store_.there() && store_.record().paired != 0; }
  bool verify(const link::SignedOrder& order, std::span<const std::byte> payload);
  bool grant(link::Frame& begin);
  bool goes_on(const link::Frame& begin) const;
  void write(bool paired, const link::Pair& owner);
  void written();
  std::uint32_t window_ms() const;

  kernel::Kernel& kernel_;
  KeyStore store_;
  bool switched_on_ = false;
  bool busy_ = false;
  kernel::Time due_ = kernel::kForever;

  link::BootId boot_{};
  std::uint64_t next_ = 0;  // the smallest number of an order that counts
  link::Denial denial_ = link::Denial::none;
  unsigned bad_ = 0;  // signatures, one after the other
  kernel::Time looks_again_ = 0;
  Granted granted_;
};

}  // namespace robosync::update
