// Assumes nothing about the bytes from the line. Guarantees that a request has at most one reply, that no
// request touches the running image, and that each piece of work() is bounded: one frame's worth of
// bytes, and in activate() one verification.
#include "runtime-m4/update/server.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "link/wire.hpp"
#include "runtime-m4/layers/thread_info.hpp"
#include "vm/opcode.hpp"

namespace robosync::update {
namespace {

using link::MessageType;

// The offset, then as many bytes of `image` from there as fit.
std::size_t fill_image_data(std::span<const std::byte> image, std::uint32_t offset,
                            std::span<std::byte, link::kMaxPayload> payload) {
  const link::ImageData head{offset};
  std::memcpy(payload.data(), &head, sizeof head);
  if (offset >= image.size()) return sizeof head;
  const auto part = image.subspan(
      offset, std::min<std::size_t>(payload.size() - sizeof head, image.size() - offset));
  std::copy(part.begin(), part.end(), payload.begin() + sizeof head);
  return sizeof head + part.size();
}

}  // namespace

bool Server::start() {
  if (!kernel_.add(thread_, {.name = "link",
                             .category = kernel::Category::system,
                             .priority = 0,
                             .entry = [](void* self) { static_cast<Server*>(self)->run(); },
                             .argument = this,
                             .stack = stack_}))
    return false;
  runtime_.share_with(thread_);
  ring_.wake(thread_, kNews);
  const auto line_ready = [](void* self) {
    auto& server = *static_cast<Server*>(self);
    server.kernel_.signal(server.thread_, kLine);
  };
  const auto line_stop = [](void* self) {
    auto& server = *static_cast<Server*>(self);
    server.stops_seen_.fetch_add(1, std::memory_order_relaxed);
    server.runtime_.stop();
  };
  keeper_.boot(board_.reset_reason() != link::ResetReason::power);
  board_.link_start({.ready = line_ready, .stop = line_stop, .argument = this});
  return true;
}

void Server::run() {
  gate_.open(board_.reset_reason() == link::ResetReason::power);
  while (true) {
    while (work()) {
    }
    runtime_.rest_link(kLine | kNews, gate_.busy() ? gate_.due() : keeper_.due());
  }
}

bool Server::work() {
  const bool said =
      writer_.ready() && (read_line() || send_next_thread() || send_fault() || send_unasked());
  return said || (gate_.busy() ? gate_.work() : keeper_.work());
}

// Decodes until one request is handled. The bytes after it wait until its reply is written.
bool Server::read_line() {
  if (input_begin_ == input_end_) {
    const std::uint32_t seen = stops_seen_.load(std::memory_order_relaxed);
    input_begin_ = 0;
    input_end_ = static_cast<std::uint8_t>(board_.link_read(input_));
    if (input_end_ == 0) {
      stops_read_ = seen;  // some may have found no room in the receive buffer
      return false;
    }
  }
  while (input_begin_ < input_end_) {
    if (!decoder_.push(input_[input_begin_++])) continue;
    handle(decoder_.frame());
    break;
  }
  return true;
}

void Server::handle(const link::Frame& received) {
  link::Frame frame = received;
  if (!gate_.takes(frame)) return authority(frame.sequence);
  switch (frame.type) {
    case MessageType::get_authority:
      return authority(frame.sequence);
    case MessageType::pair:
      return pair(frame);
    case MessageType::unpair:
      gate_.unpair();
      return authority(frame.sequence);
    default:
      return session_.admits(frame) ? answer(frame) : busy(frame.sequence);
  }
}

void Server::busy(std::uint8_t sequence) {
  const link::Busy answer = session_.busy(kernel_.now());
  send(MessageType::busy, sequence, link::wire_bytes(answer));
}

void Server::answer(const link::Frame& frame) {
  switch (frame.type) {
    case MessageType::hello:
      return hello(frame);
    case MessageType::begin:
      return begin(frame);
    case MessageType::data:
    case MessageType::pieces:
      return data(frame);
    case MessageType::activate:
      return activate(frame);
    case MessageType::feed:
      return feed(frame);
    case MessageType::stop:
      return stop(frame.sequence);
    case MessageType::resume:
      return resume(frame);
    case MessageType::trace_on:
      return trace_on(frame);
    case MessageType::clear:
      return clear(frame);
    case MessageType::roll_back:
      return roll_back(frame);
    default:
      return inform(frame);
  }
}

void Server::inform(const link::Frame& frame) {
  switch (frame.type) {
    case MessageType::get_fault:
      return last_fault(frame.sequence);
    case MessageType::get_devices:
      return devices(frame.sequence);
    case MessageType::get_state:
      return state(frame);
    case MessageType::probe:
      return probe(frame);
    case MessageType::get_status:
      return status(frame.sequence);
    case MessageType::get_threads:
      return list_threads(frame.sequence);
    case MessageType::read_image:
      return read_image(frame);
    case MessageType::get_kept:
      return kept(frame.sequence);
    default:
      return;  // a message meant for a host, or from a later protocol
  }
}

// A host with another protocol version sends a different hello and gets no session; the reply tells it why.
void Server::hello(const link::Frame& frame) {
  ring_.listen(false);  // a new host says itself what it wants to hear
  link::Hello host{};
  if (link::read_payload(frame.payload, host)) session_.open(host, in_transfer(), kernel_.now());
  link::HelloReply answer{};
  answer.protocol = link::kProtocolVersion;
  answer.image_major = vm::kFormatMajor;
  answer.opcode_set = vm::opcode_set_id();
  answer.board = layers::padded(board_.name());
  answer.firmware = layers::padded(ROBOSYNC_VERSION);
  const policy::BoardMemory& memory = runtime_.board_memory();
  answer.arena_begin = memory.arena_begin;
  answer.arena_bytes = memory.arena_bytes;
  answer.arena_used = runtime_.needs().total;
  answer.step_budget = runtime_.limits().step_cost;
  const std::uint64_t drivers = runtime_.limits().drivers;
  answer.drivers = static_cast<std::uint32_t>(drivers);
  answer.more_drivers = static_cast<std::uint32_t>(drivers >> 32);
  answer.receive_window = link::kReceiveWindow;
  answer.stopped = runtime_.stopped() ? 1 : 0;
  answer.pairing = gate_.pairing();
  if (runtime_.running()) {
    const vm::ImageHeader& header = *runtime_.image().header;
    answer.running = 1;
    answer.program_hash = header.program_hash;
    answer.image_bytes = header.total_length;
    static_assert(vm::kMaxRobotName < link::kNameLength);
    answer.robot = layers::padded(runtime_.image().robot_name());
  }
  send(MessageType::hello_reply, frame.sequence, link::wire_bytes(answer));
}

// A host that has gone away does not keep the line.
bool Server::in_transfer() const {
  const link::TransferState state = receiver_.status().state;
  return state != link::TransferState::idle && kernel_.now() < keeper_.heard() + Keeper::kSilence;
}

// Usually the line's interrupt has stopped the robot already. It detects only kStopSequence, but another host may number its
// frames differently.
void Server::stop(std::uint8_t sequence) {
  if (sequence == link::kStopSequence) ++stops_read_;
  gate_.outdate();
  runtime_.stop();
  status(sequence);
}

// A resume that was sent before the last stop must not undo it. It gets no reply, so a host that means it asks again.
void Server::resume(const link::Frame& frame) {
  link::Resume request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  if (!resume_unless_stopped()) return;
  status(frame.sequence);
}

// With interrupts locked, no stop can come between the check and the resume.
bool Server::resume_unless_stopped() {
  const auto lock = kernel_.lock_interrupts();
  if (stops_read_ != stops_seen_.load(std::memory_order_relaxed)) return false;
  runtime_.resume();
  return true;
}

void Server::begin(const link::Frame& frame) {
  link::Begin request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  have_result_ = false;
  keeper_.host_sends();
  const bool takes_pieces = request.base != link::ProgramHash{};
  if (takes_pieces && vm::stated_name(running_image()) != request.base)
    return received(frame.sequence, {0, link::TransferState::other_base});
  received(frame.sequence,
           receiver_.begin(request, runtime_.room(),
                           takes_pieces ? running_image() : std::span<const std::byte>()));
}

void Server::data(const link::Frame& frame) {
  link::Data head{};
  if (!link::read_prefix(frame.payload, head)) {
    ++bad_requests_;
    return;
  }
  if (receiver_.status().state != link::TransferState::idle) keeper_.host_sends();
  const std::span<const std::byte> bytes = frame.payload.subspan(sizeof head);
  received(frame.sequence, frame.type == MessageType::data ? receiver_.data(head.offset, bytes)
                                                           : receiver_.pieces(head.offset, bytes));
}

// The board computes the image's name from the bytes that it has, while the rest is on its way.
void Server::received(std::uint8_t sequence, link::TransferStatus answer) {
  send(MessageType::transfer_status, sequence, link::wire_bytes(answer));
  if (answer.next_offset == 0) identity_ = {};
  identity_.follow(receiver_.bytes());
}

// If the reply gets lost, the host asks again: it then gets the same answer, and nothing is done
// twice.
void Server::activate(const link::Frame& frame) {
  link::Activate request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  const bool whole = receiver_.complete() && receiver_.hash() == request.hash;
  if (whole && !gate_.grants(receiver_.bytes(), request)) {
    receiver_.reset();  // the owner has not signed this image: the host must send it again
  } else if (whole) {
    keeper_.host_activates(request.fresh != 0);
    last_result_ = activate_received();
    last_activated_ = request.hash;
    have_result_ = true;
    receiver_.reset();
    if (last_result_.running != 0) keeper_.activated(request);
    if (!runtime_.running()) keeper_.ends();
  }
  link::ActivateResult answer{};
  answer.refusal = link::kNothingToActivate;
  if (have_result_ && last_activated_ == request.hash) answer = last_result_;
  send(MessageType::activate_result, frame.sequence, link::wire_bytes(answer));
}

link::ActivateResult Server::activate_received() {
  const std::span<const std::byte> bytes = receiver_.bytes();
  const bool named = vm::stated_name(bytes) == receiver_.hash() && vm::is_named(bytes, identity_);
  const vm::Verdict verdict = runtime_.activate(bytes, named);
  return {.running = static_cast<std::uint8_t>(verdict.ok()),
          .refusal = static_cast<std::uint8_t>(verdict.refusal),
          .section = static_cast<std::uint8_t>(verdict.section),
          .reserved = 0,
          .index = verdict.index,
          .reserved2 = 0,
          .uptime_us = kernel_.now()};
}

void Server::feed(const link::Frame& frame) {
  link::Feed request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  const link::FeedResult answer = runtime_.feed(request);
  send(MessageType::feed_result, frame.sequence, link::wire_bytes(answer));
}

void Server::status(std::uint8_t sequence) {
  link::Status answer{};
  runtime_.fill_status(answer);
  answer.bad_frames = decoder_.bad_frames() + bad_requests_;
  answer.lost_events = ring_.lost();
  send(MessageType::status, sequence, link::wire_bytes(answer));
}

void Server::devices(std::uint8_t sequence) {
  link::Devices answer{};
  runtime_.fill_devices(answer);
  send(MessageType::devices, sequence, link::wire_bytes(answer));
}

void Server::state(const link::Frame& frame) {
  link::GetState request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  link::State answer{};
  runtime_.fill_state(answer, request.first);
  send(MessageType::state, frame.sequence, link::wire_bytes(answer));
}

void Server::probe(const link::Frame& frame) {
  link::Probe request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  send(MessageType::probed, frame.sequence, link::wire_bytes(runtime_.probe(request)));
}

void Server::clear(const link::Frame& frame) {
  link::Clear request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  if (runtime_.running() && vm::stated_name(running_image()) == request.hash) {
    keeper_.ends();
    runtime_.clear();
    receiver_.reset();  // the room has moved
  }
  status(frame.sequence);
}

void Server::read_image(const link::Frame& frame) {
  link::ReadImage request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  std::array<std::byte, link::kMaxPayload> payload{};
  const std::size_t length = fill_image_data(running_image(), request.offset, payload);
  send(MessageType::image_data, frame.sequence, std::span(payload).first(length));
}

void Server::kept(std::uint8_t sequence) {
  link::Kept answer{};
  keeper_.fill(answer);
  send(MessageType::kept, sequence, link::wire_bytes(answer));
}

void Server::roll_back(const link::Frame& frame) {
  link::RollBack request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  keeper_.roll_back(request.hash);
  kept(frame.sequence);
}

void Server::authority(std::uint8_t sequence) {
  link::Authority answer{};
  gate_.fill(answer);
  send(MessageType::authority, sequence, link::wire_bytes(answer));
}

void Server::pair(const link::Frame& frame) {
  link::Pair owner{};
  if (!link::read_payload(frame.payload, owner)) {
    ++bad_requests_;
    return;
  }
  gate_.pair(owner);
  authority(frame.sequence);
}

void Server::trace_on(const link::Frame& frame) {
  link::TraceOn request{};
  if (!link::read_payload(frame.payload, request)) {
    ++bad_requests_;
    return;
  }
  ring_.listen(request.on != 0);
  status(frame.sequence);
}

std::span<const std::byte> Server::running_image() const {
  if (!runtime_.running()) return {};
  const vm::ImageHeader& header = *runtime_.image().header;
  return {reinterpret_cast<const std::byte*>(&header), header.total_length};
}

void Server::list_threads(std::uint8_t sequence) {
  listing_threads_ = true;
  next_thread_ = 0;
  threads_sequence_ = sequence;
}

bool Server::send_next_thread() {
  if (!listing_threads_) return false;
  const auto threads = kernel_.threads();
  if (next_thread_ >= threads.size()) {
    listing_threads_ = false;
    return false;
  }
  const link::ThreadInfo info = layers::thread_info(kernel_, *threads[next_thread_], next_thread_);
  send(MessageType::thread_info, threads_sequence_, link::wire_bytes(info));
  ++next_thread_;
  return true;
}

void Server::report(const link::Fault& fault) {
  const auto lock = kernel_.lock();
  if (fault_count_ < faults_.size()) faults_[fault_count_++] = fault;
  keeper_.fault();
  kernel_.signal(thread_, kNews);
}

// Before the first fault, the first entry is still all zero, which means none.
void Server::last_fault(std::uint8_t sequence) {
  const link::Fault& last = faults_[fault_count_ - (fault_count_ == 0 ? 0U : 1U)];
  send(MessageType::last_fault, sequence, link::wire_bytes(last));
}

bool Server::send_fault() {
  if (!ring_.listening() || faults_sent_ == fault_count_) return false;
  send(MessageType::fault, unasked_sequence_++, link::wire_bytes(faults_[faults_sent_++]));
  return true;
}

bool Server::send_unasked() {
  MessageType type{};
  std::array<std::byte, link::kMaxPayload> payload{};
  const std::size_t length = ring_.take(type, payload);
  if (length == 0) return false;
  send(type, unasked_sequence_++, std::span(payload).first(length));
  return true;
}

}  // namespace robosync::update
