// Who may give the robot orders. Without an owner, any host on the line may. With an owner, only orders that the owner has
// signed count (link/order.hpp), each of them once. `stop` is not an order: everybody may send it.
//
// `begin` orders an upload and names the image by the hash of its bytes. The frames after it need no signature: only an image
// with that hash can be activated, once, within kGrant and before any other order or a stop.
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
  // A board that was switched on, not reset, accepts a key for this long: only a person next to it can switch it on.
  static constexpr kernel::Duration kWindow = kernel::milliseconds(60'000);
  static constexpr kernel::Duration kGrant = kernel::milliseconds(300'000);
  // After a bad signature no other is verified for this long. The pause doubles with each further one, up to kMostPause.
  static constexpr kernel::Duration kPause = kernel::milliseconds(250);
  static constexpr kernel::Duration kMostPause = kernel::milliseconds(8'000);
  // An order's number may be at most this far ahead, so that no order can exhaust the counter.
  static constexpr std::uint64_t kMostAhead = 1'000'000;

  OrderGate(kernel::Kernel& kernel, boards::Store* store) : kernel_(kernel), store_(store) {}

  // Only the link thread calls these. open() comes first, before sensors are measured or programs are read from the store:
  // it reads who the owner is, which takes a few milliseconds.
  void open(bool switched_on);

  // False when the frame is an order that does not count; fill() then says why. A signed order is replaced by the order in it.
  [[nodiscard]] bool takes(link::Frame& frame);
  // May the received image be activated in this way? Call it once for each image.
  [[nodiscard]] bool grants(std::span<const std::byte> image, const link::Activate& how);
  // After a stop: orders that were signed before it no longer count.
  void outdate() {
    ++next_;
    granted_.open = false;
  }

  void pair(const link::Pair& owner);
  void unpair();
  link::Pairing pairing() const;
  void fill(link::Authority& answer) const;  // with the reason, if the last request was refused

  // A record is being read or written; nothing else may use the store meanwhile.
  bool busy() const { return busy_; }
  bool work();  // does the next piece; false when there is none before due()
  kernel::Time due() const { return due_; }

private:
  // A signed `begin` of an upload.
  struct Granted {
    bool open = false;
    kernel::Time until = 0;
    link::Grant what{};
    std::array<std::byte, 64> begin{};  // the order's payload, without the grant
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
  unsigned bad_ = 0;  // consecutive bad signatures
  kernel::Time looks_again_ = 0;
  Granted granted_;
};

}  // namespace robosync::update
