// The host's end of the link: requests and their replies over a line that may lose anything.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
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

  // `timeout`: how long a request is repeated before it fails. `take`: the line is wanted also where another host is in the
  // midst of a transfer.
  explicit Client(Transport& transport, Milliseconds timeout = Milliseconds(2000),
                  bool take = false);

  // Each sends its request again until its reply comes. Throw Failure (outside) after the timeout.
  link::HelloReply hello();  // opens a session, as requests that need one do by themselves
  link::Status status();
  link::Fault last_fault();  // of those the board has kept; no thread: there was none
  link::Devices devices();   // that the running program measures
  link::Status clear(const link::ProgramHash& program);  // ends the program, if it runs
  link::Kept kept();
  // Asks for it only: the board then reads its store.
  link::Kept roll_back(const link::ProgramHash& to);
  link::Status set_trace(bool on);
  // All outputs to their safe state, until resume(). The board does it when the frame has come, and replies when it
  // finds the time: no reply does not mean that it has not stopped.
  link::Status stop();
  link::Status resume();
  // Their session is filled in.
  link::FeedResult feed(link::Feed feed);
  link::ActivateResult activate(link::Activate what);
  std::vector<link::ThreadInfo> threads();
  std::vector<std::byte> running_image();  // empty when no program runs

  // Orders to a robot with an owner are signed, by this key or, when none is named, that of default_key_file().
  void use_key(const std::string& file) { orders_.use_key(file); }
  bool signs() const { return orders_.are_signed(); }
  link::Authority authority();  // who may give orders
  // Both ask until it is done. Throw Failure (outside) with the reason when the board does not do it.
  void pair(const link::Pair& owner);
  void unpair();
  // Lets an upload of `image`, which says `begin`, through to its activation; for a robot without an owner nothing.
  void order_upload(std::span<const std::byte> begin, std::span<const std::byte> image,
                    const link::Activate& how);
  // hello() in two parts: what is sent between them does not wait for the answer.
  std::uint8_t send_hello();
  link::HelloReply hello_answer(std::uint8_t sequence);
  link::SessionId session() const { return session_; }

  // For transfers, which have several requests under way: sends one frame, returns its sequence.
  std::uint8_t send(link::MessageType type, std::span<const std::byte> payload = {});
  // The next reply. Events, logs and faults that come meanwhile are kept for next_unasked().
  std::optional<Message> next_reply(Milliseconds timeout);
  // What to do about the reply `busy`, once for each request: says hello, for the board may have started again, or a host that is
  // idle may have had the line. When it is busy all the same: one rsc at a time uses a line (line_lock.hpp), so what
  // another one of this computer has left behind is taken, once; else throws Failure (outside).
  void reopen(const Message& busy, bool& tried);
  // The next event, log line or fault record.
  std::optional<Message> next_unasked(Milliseconds timeout);

  Transport::Clock::time_point now() const { return transport_.now(); }

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
  [[noreturn]] void no_answer() const;

  Transport& transport_;
  Milliseconds timeout_;
  Orders orders_;
  link::Hello introduction_;
  link::SessionId session_ = introduction_.session;
  bool took_ = false;  // the line from another rsc of this computer
  link::FrameDecoder decoder_;
  std::uint8_t sequence_ = 0;
  std::deque<Message> replies_;
  std::deque<Message> unasked_;
};

}  // namespace robosync::tool
