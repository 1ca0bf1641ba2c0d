// The host's end of the link: requests and replies over a line that may lose anything.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "link/frame.hpp"
#include "link/messages.hpp"
#include "link/wire.hpp"
#include "rsc/device/orders.hpp"
#include "rsc/device/transport.hpp"

namespace robosync::tool {

struct Message {
  link::MessageType type{};
  std::uint8_t sequence = 0;
  std::vector<std::byte> payload;
};

class Client {
public:
  using Milliseconds = std::chrono::milliseconds;

  // `timeout`: how long a request is repeated before it fails. `take`: take the line even while another host is uploading.
  explicit Client(Transport& transport, Milliseconds timeout = Milliseconds(2000),
                  bool take = false);

  // These repeat the request until its reply comes, and throw Failure (outside) after the timeout. What needs many replies fails
  // when none has come for that long.
  link::HelloReply hello();  // opens a session; requests that need one do so themselves
  link::Status status();
  link::Fault last_fault();  // the latest one that the board has kept; no thread: none
  link::Devices devices();   // on the buses of the running program
  // Whether anything answers at an address of an I2C bus.
  link::Probed probe(std::uint8_t bus, std::uint8_t address);
  // What holds in the running program, with the values from input `first` on.
  link::State state(std::uint32_t first);
  link::Status clear(const link::ProgramHash& program);  // ends the program, if it runs
  link::Kept kept();
  // Only asks for it: the board then reads its store.
  link::Kept roll_back(const link::ProgramHash& to);
  link::Status set_trace(bool on);
  // Puts all outputs into their safe state until resume(). The board does so when the frame arrives and replies later: without a
  // reply it may have stopped all the same.
  link::Status stop();
  // Throws Failure (outside) if the board answers within that time, in another version of the protocol.
  void expect_protocol(Milliseconds within);
  link::Status resume();
  // The session is filled in here.
  link::FeedResult feed(link::Feed feed);
  link::ActivateResult activate(link::Activate what);
  std::vector<link::ThreadInfo> threads();
  // Empty: no program is running. `known` may give the image with a name, which is then not read from the board: it returns nothing
  // for a name that it does not know.
  using Known = std::function<std::vector<std::byte>(const link::ProgramHash&)>;
  std::vector<std::byte> running_image(const Known& known = {});

  // Orders to a robot with an owner are signed with this key, or with default_key_file() if `file` is empty.
  void use_key(const std::string& file) { orders_.use_key(file); }
  bool signs() const { return orders_.are_signed(); }
  link::Authority authority();  // who may give orders
  // Both repeat the request until it is done, and throw Failure (outside) with the reason if the board refuses.
  void pair(const link::Pair& owner);
  void unpair();
  // Authorises the upload of `image` that starts with the request `begin`, up to its activation. Does nothing for a robot without
  // an owner.
  void order_upload(std::span<const std::byte> begin, std::span<const std::byte> image,
                    const link::Activate& how);
  // hello() in two parts: what is sent in between does not wait for the answer.
  std::uint8_t send_hello();
  link::HelloReply hello_answer(std::uint8_t sequence);
  link::SessionId session() const { return session_; }

  // For transfers, which have several requests in flight: sends one frame, returns its sequence number.
  std::uint8_t send(link::MessageType type, std::span<const std::byte> payload = {});
  // The next reply. Events, logs and faults that arrive meanwhile are queued for next_unasked().
  std::optional<Message> next_reply(Milliseconds timeout);
  // Handles the reply `busy`, once for each request: says hello, because the board may have restarted, or the host that had the
  // line may be idle. If the board is still busy with a process of this computer that does not exist any more (host_name.hpp),
  // the line is taken over, once: a user who interrupts an upload may start another at once. Otherwise throws Refused: the board
  // gives the line free when nothing has come from its host for three seconds.
  void reopen(const Message& busy, bool& tried);
  // The next event, log line or fault record.
  std::optional<Message> next_unasked(Milliseconds timeout);
  // … if one has arrived already; reads nothing from the line.
  std::optional<Message> pending_unasked();

  Transport::Clock::time_point now() const { return transport_.now(); }
  // How long no valid frame has come, counted from `start` at the earliest.
  Milliseconds silent_for(Transport::Clock::time_point start) const;
  // Throws Failure (outside), which says what has come instead of an answer: nothing, or what.
  [[noreturn]] void no_answer() const;

private:
  template <typename Reply>
  Reply request(link::MessageType type, link::MessageType reply_type,
                std::span<const std::byte> payload = {});
  template <typename Reply>
  Reply order(link::MessageType type, link::MessageType reply_type,
              std::span<const std::byte> payload = {});
  std::optional<Message> reply_to(std::uint8_t sequence, link::MessageType type,
                                  Transport::Clock::time_point until);
  void heed(const link::Authority& authority, Transport::Clock::time_point give_up);
  void wait(Milliseconds time);
  bool receive(Transport::Clock::time_point until);
  std::optional<link::HelloReply> take_hello(std::uint8_t sequence,
                                             Transport::Clock::time_point until);
  std::optional<Message> reply_to_signed(std::uint8_t sequence, link::MessageType type,
                                         Transport::Clock::time_point quiet_since,
                                         Transport::Clock::time_point give_up);
  Transport::Clock::time_point limit_of_order(Transport::Clock::time_point start) const;
  [[noreturn]] void unanswered_order(link::MessageType type) const;

  Transport& transport_;
  Milliseconds timeout_;
  Orders orders_;
  link::Hello introduction_;
  link::SessionId session_ = introduction_.session;
  bool took_ = false;  // took over the session of a process that is gone
  link::FrameDecoder decoder_;
  std::optional<Transport::Clock::time_point> heard_;  // when the last valid frame came
  std::size_t stray_bytes_ = 0;                        // that came after it
  std::uint8_t sequence_ = 0;
  bool traces_ = false;  // the trace is wanted: each hello ends it, and so switches it on again
  std::deque<Message> replies_;
  std::deque<Message> unasked_;
};

}  // namespace robosync::tool
