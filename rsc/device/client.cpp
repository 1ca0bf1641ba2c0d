// The line is not trusted. Promises that a reply belongs to its request: type, sequence and length are compared.
#include "rsc/device/client.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <random>

#include <fmt/format.h>
#include <unistd.h>

#include "rsc/device/host_name.hpp"
#include "rsc/failure.hpp"
#include "vm/identity.hpp"

namespace robosync::tool {
namespace {

using link::MessageType;
using std::chrono::milliseconds;

// A reply takes at most 45 ms on the wire; the board verifies an image in a few.
constexpr milliseconds kRepeatAfter{250};
// … but an order's signature may take it half a second, in emulation one and a half. Meanwhile it answers nothing.
constexpr milliseconds kRepeatOrderAfter{1500};
constexpr milliseconds kChecksFor{2500};
// Bytes that arrived while this machine was busy are still read after the timeout, but not for longer than this.
constexpr milliseconds kHearsOut{300};
// A board from which a frame has come within this time before the failure is there.
constexpr milliseconds kThere{1000};
constexpr std::size_t kNoise = 4;            // bytes; fewer come when a plug is pulled
constexpr std::size_t kMostImage = 1 << 16;  // offsets have 16 bits
constexpr milliseconds kStarts{20};
constexpr std::size_t kMaxKept = 4096;  // unsolicited messages not yet fetched

bool is_unasked(MessageType type) {
  return type == MessageType::event || type == MessageType::log || type == MessageType::fault;
}

link::Hello introduction(bool take) {
  link::Hello hello{};
  std::random_device random;
  hello.session = std::max(random(), 1U);
  hello.take = static_cast<std::uint8_t>(take);
  hello.host = host_name(getpid());
  return hello;
}

std::optional<Message> pop(std::deque<Message>& queue) {
  if (queue.empty()) return std::nullopt;
  Message message = std::move(queue.front());
  queue.pop_front();
  return message;
}

}  // namespace

Client::Client(Transport& transport, milliseconds timeout, bool take)
    : transport_(transport), timeout_(timeout), introduction_(introduction(take)) {
  // Ends a partial frame that the last host left in the board's decoder.
  transport_.write(std::array{std::byte{0}});
}

std::uint8_t Client::send(MessageType type, std::span<const std::byte> payload) {
  std::array<std::byte, link::kMaxEncodedFrame> frame{};
  const std::uint8_t sequence = type == MessageType::stop ? link::kStopSequence : sequence_++;
  const std::size_t length = link::encode_frame(type, sequence, payload, frame);
  transport_.write(std::span(frame).first(length));
  return sequence;
}

// Reads once. False if it is too late.
bool Client::receive(Transport::Clock::time_point until) {
  const auto left = std::chrono::duration_cast<milliseconds>(until - transport_.now());
  std::array<std::byte, 512> bytes{};
  const std::size_t count = transport_.read(bytes, std::max(left, milliseconds(0)));
  for (const std::byte byte : std::span(bytes).first(count)) {
    ++stray_bytes_;
    if (!decoder_.push(byte)) continue;
    heard_ = transport_.now();
    stray_bytes_ = 0;
    const link::Frame& frame = decoder_.frame();
    std::deque<Message>& queue = is_unasked(frame.type) ? unasked_ : replies_;
    if (queue.size() == kMaxKept) queue.pop_front();
    queue.push_back({frame.type, frame.sequence, {frame.payload.begin(), frame.payload.end()}});
  }
  return transport_.now() < until + (count > 0 ? kHearsOut : milliseconds(0));
}

std::optional<Message> Client::next_reply(milliseconds timeout) {
  const auto until = transport_.now() + timeout;
  while (replies_.empty() && receive(until)) {
  }
  return pop(replies_);
}

std::optional<Message> Client::next_unasked(milliseconds timeout) {
  const auto until = transport_.now() + timeout;
  while (unasked_.empty() && receive(until)) {
  }
  return pop(unasked_);
}

std::optional<Message> Client::pending_unasked() {
  return pop(unasked_);
}

// Late replies to earlier requests are dropped. `busy` or a denial may come instead of the reply. What has arrived is read even
// after the time, in which this process may have been stopped.
std::optional<Message> Client::reply_to(std::uint8_t sequence, MessageType type,
                                        Transport::Clock::time_point until) {
  for (bool in_time = true;; in_time = receive(until)) {
    while (std::optional<Message> reply = pop(replies_)) {
      const bool fits = reply->type == type || reply->type == MessageType::authority ||  // denied
                        reply->type == MessageType::busy;
      if (fits && reply->sequence == sequence) return reply;
    }
    if (!in_time) return std::nullopt;
  }
}

template <typename Reply>
Reply Client::request(MessageType type, MessageType reply_type,
                      std::span<const std::byte> payload) {
  const auto give_up = transport_.now() + timeout_;
  bool reopened = false;
  while (transport_.now() < give_up) {
    const std::uint8_t sequence = send(type, payload);
    const auto until = std::min(give_up, transport_.now() + kRepeatAfter);
    const std::optional<Message> answer = reply_to(sequence, reply_type, until);
    Reply reply{};
    if (answer && answer->type == MessageType::busy) {
      reopen(*answer, reopened);
    } else if (answer && answer->type == reply_type && link::read_payload(answer->payload, reply)) {
      return reply;
    }
  }
  no_answer();
}

// Signed or unsigned, as the board wants: otherwise it denies the order and says how.
template <typename Reply>
Reply Client::order(MessageType type, MessageType reply_type, std::span<const std::byte> payload) {
  const auto start = transport_.now();
  auto quiet_since = start;
  bool reopened = false;
  while (transport_.now() < limit_of_order(start) && silent_for(quiet_since) < kChecksFor) {
    if (orders_.are_signed() && !orders_.know_how()) orders_.learn(authority());
    const auto give_up = limit_of_order(start);
    const auto soon = std::min(give_up, transport_.now() + kRepeatAfter);
    const std::optional<Message> answer =
        orders_.are_signed()
            ? reply_to_signed(send(MessageType::signed_order, orders_.sign(type, payload)),
                              reply_type, quiet_since, give_up)
            : reply_to(send(type, payload), reply_type, soon);
    if (answer && answer->type == MessageType::busy) {
      reopen(*answer, reopened);
      continue;
    }
    Reply reply{};
    link::Authority authority{};
    if (answer && answer->type == reply_type && link::read_payload(answer->payload, reply))
      return reply;
    if (!answer || !link::read_payload(answer->payload, authority)) continue;
    heed(authority, give_up);  // may wait
    quiet_since = transport_.now();
  }
  unanswered_order(type);
}

// A signed order is repeated late, since each one costs the board a check, so it has more time.
Transport::Clock::time_point Client::limit_of_order(Transport::Clock::time_point start) const {
  return start + timeout_ + (orders_.are_signed() ? 2 * kRepeatOrderAfter : milliseconds(0));
}

// Meanwhile asks for what costs the board nothing: if no answer to that comes either, for longer than a check takes, the line
// is dead.
std::optional<Message> Client::reply_to_signed(std::uint8_t sequence, MessageType type,
                                               Transport::Clock::time_point quiet_since,
                                               Transport::Clock::time_point give_up) {
  const auto until = std::min(give_up, transport_.now() + kRepeatOrderAfter);
  while (transport_.now() < until && silent_for(quiet_since) < kChecksFor) {
    const auto soon = std::min(until, transport_.now() + kRepeatAfter);
    if (auto reply = reply_to(sequence, type, soon)) return reply;
    (void)send(MessageType::get_authority);
  }
  return std::nullopt;
}

// Without its reply nobody knows whether the order arrived. What `begin` orders is harmless.
void Client::unanswered_order(MessageType type) const {
  if (type == MessageType::begin) no_answer();
  try {
    no_answer();
  } catch (const Failure& failure) {
    throw Failure(failure.exit(),
                  followed_by(failure.what(),
                              "It may have done it all the same: `rsc info` shows its state"));
  }
}

// Throws Failure if repeating the order before `give_up` is of no use.
void Client::heed(const link::Authority& authority, Transport::Clock::time_point give_up) {
  orders_.learn(authority);
  if (const std::string why = denial_text(authority); !why.empty()) throw Refused(why);
  if (authority.denial == link::Denial::starting) wait(kStarts);
  if (authority.denial != link::Denial::too_soon) return;
  const milliseconds left(authority.wait_ms);
  if (transport_.now() + left >= give_up)
    throw Refused(
        "somebody has tried to sign orders without the owner's key: the robot ignores "
        "signed orders for " +
        std::to_string(left.count() / 1000 + 1) + " s; try again then");
  wait(left);
}

void Client::wait(milliseconds time) {
  const auto until = transport_.now() + time;
  while (receive(until)) {
  }
}

milliseconds Client::silent_for(Transport::Clock::time_point start) const {
  const auto since = std::max(start, heard_.value_or(start));
  return std::chrono::duration_cast<milliseconds>(transport_.now() - since);
}

void Client::no_answer() const {
  const std::string name = transport_.name();
  if (stray_bytes_ >= kNoise)
    throw Failure(
        Exit::outside,
        fmt::format("something on {} sends bytes, but not RoboSync's frames ({} bytes): is it the "
                    "right port, does the board run the RoboSync firmware, and does it send at "
                    "115,200 baud?",
                    name, stray_bytes_));
  if (!heard_)
    throw Failure(Exit::outside,
                  name +
                      ": the board does not answer: is it on, does it run the RoboSync firmware, "
                      "and is no other program using the port?");
  if (transport_.now() - *heard_ < kThere)
    throw Failure(Exit::outside,
                  name +
                      ": the board sends, but does not answer this: is the line very bad, or is "
                      "its firmware of another release than this rsc?");
  throw Failure(Exit::outside,
                name +
                    ": the board has fallen silent after it had answered: is it still on, and is "
                    "its cable still plugged in?");
}

void Client::reopen(const Message& busy, bool& tried) {
  link::Busy by{};
  if (!link::read_payload(busy.payload, by)) return;
  if (tried && is_gone(by.host) && !took_) {
    took_ = true;
    link::Hello taking = introduction_;
    taking.take = 1;
    (void)hello_answer(send(MessageType::hello, link::wire_bytes(taking)));
    return;
  }
  if (tried) {
    throw Refused(
        fmt::format("{}: busy: {} is uploading a program, and has had the line for {} s; "
                    "try again in a few seconds, or take it with rsc upload --take",
                    transport_.name(), host_text(by.host), by.since_ms / 1000));
  }
  tried = true;
  (void)hello();
}

std::uint8_t Client::send_hello() {
  return send(MessageType::hello, link::wire_bytes(introduction_));
}

link::HelloReply Client::hello() {
  return hello_answer(send_hello());
}

link::HelloReply Client::hello_answer(std::uint8_t sequence) {
  const auto give_up = transport_.now() + timeout_;
  while (true) {
    const auto until = std::min(give_up, transport_.now() + kRepeatAfter);
    if (const auto reply = take_hello(sequence, until)) {
      // Does not wait for the reply: a board that answers `busy` to everything would be asked without end.
      if (traces_) (void)send(MessageType::trace_on, link::wire_bytes(link::TraceOn{1}));
      return *reply;
    }
    if (transport_.now() >= give_up) no_answer();
    sequence = send_hello();
  }
}

// The reply may be of another protocol version: only its first byte has a fixed meaning.
std::optional<link::HelloReply> Client::take_hello(std::uint8_t sequence,
                                                   Transport::Clock::time_point until) {
  const auto answer = reply_to(sequence, MessageType::hello_reply, until);
  link::HelloReply reply{};
  if (!answer || answer->payload.empty()) return std::nullopt;
  const auto protocol = std::to_integer<unsigned>(answer->payload.front());
  if (protocol != link::kProtocolVersion) {
    throw Failure(Exit::outside, "the firmware speaks version " + std::to_string(protocol) +
                                     " of the protocol, this rsc version " +
                                     std::to_string(link::kProtocolVersion) +
                                     ": flash the firmware of this release");
  }
  if (!link::read_payload(answer->payload, reply)) return std::nullopt;
  orders_.learn(reply.pairing);
  introduction_.take = 0;  // whoever takes the line from now on keeps it
  return reply;
}

link::Authority Client::authority() {
  return request<link::Authority>(MessageType::get_authority, MessageType::authority);
}

link::Status Client::status() {
  return request<link::Status>(MessageType::get_status, MessageType::status);
}

link::Fault Client::last_fault() {
  return request<link::Fault>(MessageType::get_fault, MessageType::last_fault);
}

link::Devices Client::devices() {
  return request<link::Devices>(MessageType::get_devices, MessageType::devices);
}

link::Probed Client::probe(std::uint8_t bus, std::uint8_t address) {
  return request<link::Probed>(MessageType::probe, MessageType::probed,
                               link::wire_bytes(link::Probe{bus, address, {}}));
}

link::State Client::state(std::uint32_t first) {
  return request<link::State>(MessageType::get_state, MessageType::state,
                              link::wire_bytes(link::GetState{first}));
}

link::Status Client::clear(const link::ProgramHash& program) {
  return order<link::Status>(MessageType::clear, MessageType::status,
                             link::wire_bytes(link::Clear{session_, program}));
}

link::Kept Client::kept() {
  return request<link::Kept>(MessageType::get_kept, MessageType::kept);
}

link::Kept Client::roll_back(const link::ProgramHash& to) {
  return order<link::Kept>(MessageType::roll_back, MessageType::kept,
                           link::wire_bytes(link::RollBack{session_, to}));
}

link::Status Client::stop() {
  return request<link::Status>(MessageType::stop, MessageType::status);
}

// Without a session, which a hello of this length does not open, so that no other host's is closed.
void Client::expect_protocol(milliseconds within) {
  const auto until = transport_.now() + within;
  while (transport_.now() < until) {
    const std::uint8_t sequence = send(MessageType::hello);
    if (take_hello(sequence, std::min(until, transport_.now() + kRepeatAfter))) return;
  }
}

link::Status Client::resume() {
  return order<link::Status>(MessageType::resume, MessageType::status,
                             link::wire_bytes(link::Resume{session_}));
}

void Client::pair(const link::Pair& owner) {
  const auto give_up = transport_.now() + timeout_;
  while (transport_.now() < give_up) {
    const auto said = request<link::Authority>(MessageType::pair, MessageType::authority,
                                               link::wire_bytes(owner));
    if (said.pairing == link::Pairing::paired && said.key == owner.key) return orders_.learn(said);
    heed(said, give_up);
  }
  throw Failure(Exit::outside, "the board does not store the key: does its store work?");
}

void Client::unpair() {
  const auto give_up = transport_.now() + timeout_ + kRepeatOrderAfter;
  while (transport_.now() < give_up) {
    const auto said = orders_.are_signed()
                          ? order<link::Authority>(MessageType::unpair, MessageType::authority)
                          : authority();
    if (said.pairing != link::Pairing::paired) return orders_.learn(said);
    heed(said, give_up);
  }
  throw Failure(Exit::outside,
                "the board does not record that it has no owner: does its store work?");
}

// The rest of the upload needs no signature, so a lost frame costs none.
void Client::order_upload(std::span<const std::byte> begin, std::span<const std::byte> image,
                          const link::Activate& how) {
  if (!orders_.are_signed()) return;
  std::vector<std::byte> payload(begin.begin(), begin.end());
  const link::Grant grant = grant_of(image, how);
  std::ranges::copy(link::wire_bytes(grant), std::back_inserter(payload));
  (void)order<link::TransferStatus>(MessageType::begin, MessageType::transfer_status, payload);
}

link::Status Client::set_trace(bool on) {
  traces_ = on;
  const link::TraceOn wish{static_cast<std::uint8_t>(on)};
  return request<link::Status>(MessageType::trace_on, MessageType::status, link::wire_bytes(wish));
}

link::FeedResult Client::feed(link::Feed feed) {
  feed.session = session_;
  return order<link::FeedResult>(MessageType::feed, MessageType::feed_result,
                                 link::wire_bytes(feed));
}

link::ActivateResult Client::activate(link::Activate what) {
  what.session = session_;
  return request<link::ActivateResult>(MessageType::activate, MessageType::activate_result,
                                       link::wire_bytes(what));
}

std::vector<link::ThreadInfo> Client::threads() {
  const auto give_up = transport_.now() + timeout_;
  while (transport_.now() < give_up) {
    std::vector<link::ThreadInfo> threads;
    const std::uint8_t sequence = send(MessageType::get_threads);
    while (true) {
      const auto until = std::min(give_up, transport_.now() + kRepeatAfter);
      const auto answer = reply_to(sequence, MessageType::thread_info, until);
      link::ThreadInfo info{};
      if (!answer || !link::read_payload(answer->payload, info)) break;
      if (info.index != threads.size()) break;  // one got lost: start over
      threads.push_back(info);
      if (threads.size() == info.total) return threads;
    }
  }
  no_answer();
}

std::vector<std::byte> Client::running_image(const Known& known) {
  auto give_up = transport_.now() + timeout_;
  std::vector<std::byte> image;
  while (transport_.now() < give_up && image.size() <= kMostImage) {
    const link::ReadImage wish{static_cast<std::uint32_t>(image.size())};
    const std::uint8_t sequence = send(MessageType::read_image, link::wire_bytes(wish));
    const auto until = std::min(give_up, transport_.now() + kRepeatAfter);
    const auto answer = reply_to(sequence, MessageType::image_data, until);
    link::ImageData head{};
    if (!answer || !link::read_prefix(answer->payload, head) || head.offset != image.size()) {
      continue;
    }
    const auto bytes = std::span(answer->payload).subspan(sizeof head);
    if (bytes.empty()) return image;
    if (known && image.empty())
      if (std::vector<std::byte> whole = known(vm::stated_name(bytes)); !whole.empty())
        return whole;
    image.insert(image.end(), bytes.begin(), bytes.end());
    give_up = transport_.now() + timeout_;
  }
  no_answer();
}

}  // namespace robosync::tool
