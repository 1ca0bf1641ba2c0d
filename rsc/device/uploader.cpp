// Go-back-N over the link: data frames up to the board's window are under way, every reply names
// the offset that is wanted next. May assume nothing of the line. Promises that it ends: with the
// board's answer, or by its timeout.
#include "rsc/device/uploader.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "compiler/config/boards.hpp"
#include "link/frame.hpp"
#include "link/wire.hpp"
#include "rsc/failure.hpp"
#include "rsc/names.hpp"
#include "rsc/timing.hpp"
#include "runtime-m4/algorithms/modules.hpp"
#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {
namespace {

using link::MessageType;
using std::chrono::milliseconds;

// A window of data takes 45 ms on the wire.
constexpr milliseconds kWindowTimeout{200};

link::Begin begin_of(std::span<const std::byte> image) {
  return {static_cast<std::uint32_t>(image.size()), vm::stated_crc32(image)};
}

class Transfer {
public:
  Transfer(Client& client, std::uint16_t window, std::span<const std::byte> image,
           const UploadOptions& options, Transport::Clock::time_point give_up)
      : client_(client),
        window_(std::max<std::size_t>(window, link::kMaxEncodedFrame)),
        image_(image),
        options_(options),
        give_up_(give_up) {}

  // Returns when the board has all of it. The first window goes out with the request to begin:
  // if the board wants something else, its reply says so.
  void run() {
    begin();
    while (!complete_) {
      if (client_.now() >= give_up_) {
        throw Failure(Exit::outside,
                      fmt::format("the transfer timed out after {} of {} bytes; the old program "
                                  "goes on",
                                  wanted_, image_.size()));
      }
      fill_window();
      const std::optional<Message> reply = client_.next_reply(kWindowTimeout);
      if (!reply) {
        begin();  // resumes
      } else {
        take(*reply);
      }
    }
  }

  std::size_t frames_sent() const { return frames_sent_; }

private:
  struct UnderWay {
    std::uint8_t sequence;
    std::size_t end;    // the offset wanted next, if it is taken
    std::size_t bytes;  // on the wire
  };

  void begin() {
    under_way_.clear();
    bytes_under_way_ = 0;
    next_ = wanted_;
    begin_sequence_ = client_.send(MessageType::begin, link::wire_bytes(begin_of(image_)));
  }

  void fill_window() {
    while (next_ < image_.size()) {
      const std::size_t length = std::min(link::kMaxData, image_.size() - next_);
      const std::size_t on_wire = length + sizeof(link::Data) + link::kFrameOverhead + 2;
      if (bytes_under_way_ + on_wire > window_) return;
      send_data(length, on_wire);
    }
  }

  void send_data(std::size_t length, std::size_t on_wire) {
    std::array<std::byte, link::kMaxPayload> payload{};
    const link::Data head{static_cast<std::uint32_t>(next_)};
    std::memcpy(payload.data(), &head, sizeof head);
    std::memcpy(payload.data() + sizeof head, image_.data() + next_, length);
    const std::uint8_t sequence =
        client_.send(MessageType::data, std::span(payload).first(sizeof head + length));
    next_ += length;
    under_way_.push_back({sequence, next_, on_wire});
    bytes_under_way_ += on_wire;
    ++frames_sent_;
  }

  void take(const Message& reply) {
    link::TransferStatus status{};
    if (reply.type != MessageType::transfer_status || !link::read_payload(reply.payload, status) ||
        status.next_offset > image_.size()) {
      return;
    }
    if (reply.sequence == begin_sequence_) return take_begin(status);
    // Frames before the one answered have been answered as well, or that got lost.
    const auto answered = std::ranges::find(under_way_, reply.sequence, &UnderWay::sequence);
    if (answered == under_way_.end()) return;  // from before we went back
    const std::size_t end = answered->end;
    for (auto at = under_way_.begin(); at != answered + 1; ++at)
      bytes_under_way_ -= at->bytes;
    under_way_.erase(under_way_.begin(), answered + 1);
    note(status);
    if (status.state == link::TransferState::no_transfer) {
      wanted_ = 0;  // the board has been reset
      begin();
    } else if (status.next_offset != end && !complete_) {
      go_back();
    }
  }

  void take_begin(const link::TransferStatus& status) {
    if (status.state == link::TransferState::too_large) {
      throw Failure(
          Exit::program,
          fmt::format(
              "beside the running program the board has {} bytes free, and the image has {}: "
              "rsc upload --replace ends the running program first",
              status.next_offset, image_.size()));
    }
    const std::size_t assumed = wanted_;
    note(status);
    if (wanted_ != assumed && !complete_) go_back();
  }

  void note(const link::TransferStatus& status) {
    wanted_ = status.next_offset;
    complete_ = status.state == link::TransferState::complete;
    if (options_.progress) options_.progress(wanted_, image_.size());
  }

  // A frame got lost, so what was sent after it is not taken: again from what is wanted.
  void go_back() {
    under_way_.clear();
    bytes_under_way_ = 0;
    next_ = wanted_;
  }

  Client& client_;
  std::size_t window_;
  std::span<const std::byte> image_;
  const UploadOptions& options_;
  Transport::Clock::time_point give_up_;
  std::deque<UnderWay> under_way_;
  std::size_t bytes_under_way_ = 0;
  std::size_t next_ = 0;    // first byte not sent
  std::size_t wanted_ = 0;  // as the board said last
  std::uint8_t begin_sequence_ = 0;
  bool complete_ = false;
  std::size_t frames_sent_ = 0;
};

void check_driver(const link::HelloReply& board, vm::DriverId id, std::string_view what,
                  std::string_view name, std::vector<std::string>& found) {
  const auto driver = static_cast<unsigned>(id);
  if (driver < 32 && (board.drivers >> driver & 1) != 0) return;
  found.push_back(fmt::format("the firmware does not have the driver `{}`, which {} {} needs",
                              driver_name(id), what, name));
}

}  // namespace

milliseconds patience(std::size_t image_bytes) {
  return milliseconds(10000) + milliseconds(1) * image_bytes;
}

// Of another board everything may be different, so nothing else is said then.
std::vector<std::string> obstacles(const link::HelloReply& board, const vm::Image& image) {
  std::vector<std::string> found;
  const vm::ImageHeader& header = *image.header;
  const std::string name = text_of(board.board);
  if (header.board != 0 && header.board != compiler::board_id(name)) {
    const auto meant = board_of(header);
    return {fmt::format(
        "it is for {}, and this is {}: say \"board\": \"{}\" in robot.json, and compile it again",
        meant ? meant->name : "a board that this rsc does not know", name, name)};
  }
  if (board.image_major != header.format_major) {
    found.push_back(
        fmt::format("the firmware runs images of format {}, this one is format {}: "
                    "flash the firmware of this release",
                    board.image_major, header.format_major));
  }
  if (board.opcode_set != header.opcode_set) {
    found.push_back(
        fmt::format("the firmware has another set of opcodes ({:04x}) than the image "
                    "({:04x}): compile it again, or flash the firmware of this release",
                    board.opcode_set, header.opcode_set));
  }
  const policy::BoardMemory memory{board.arena_begin, board.arena_bytes, board.step_budget};
  const policy::Needs needs = needs_on_board(image, memory);
  const vm::Verdict verdict = policy::judge(needs, memory);
  if (!verdict.ok()) {
    found.push_back(verdict.refusal == vm::Refusal::no_room ? no_room_text(needs, memory)
                                                            : too_many_text(needs, verdict));
  }
  if (header.step_cost > board.step_budget) {
    found.push_back(too_costly_text(image, board.step_budget));
  }
  for (const vm::Sensor& sensor : image.sensors)
    check_driver(board, sensor.driver, "sensor", image.string(sensor.name), found);
  for (const vm::Actuator& actuator : image.actuators)
    check_driver(board, actuator.driver, "actuator", image.string(actuator.name), found);
  return found;
}

// A board that was reset, or that another host began a transfer with, has nothing to activate: it
// is sent again.
UploadResult upload(Client& client, const link::HelloReply& hello, std::span<const std::byte> image,
                    const UploadOptions& options) {
  const auto start = client.now();
  const auto give_up = start + options.timeout.value_or(patience(image.size()));
  UploadResult result;
  result.bytes = image.size();
  do {
    client.order_upload(link::wire_bytes(begin_of(image)), image, options.fresh);
    Transfer transfer(client, hello.receive_window, image, options, give_up);
    transfer.run();
    result.frames_sent += transfer.frames_sent();
    result.activation =
        client.activate({vm::stated_crc32(image), static_cast<std::uint8_t>(options.fresh), {}});
  } while (result.activation.refusal == link::kNothingToActivate && client.now() < give_up);
  result.time = std::chrono::duration_cast<std::chrono::microseconds>(client.now() - start);
  return result;
}

namespace {

void check_board(const Session& session, const Program& program) {
  const std::vector<std::string> found = obstacles(session.board, program.image());
  if (found.empty()) return;
  throw Failure(Exit::program,
                fmt::format("the board ({}, firmware {}) cannot run this program:\n  {}",
                            text_of(session.board.board), text_of(session.board.firmware),
                            fmt::join(found, "\n  ")));
}

void check_result(const link::ActivateResult& result, const Program& program) {
  if (result.running != 0) return;
  if (result.refusal == link::kNothingToActivate) {
    throw Failure(Exit::outside, "the board lost the transfer again and again; is it being reset?");
  }
  const vm::Verdict verdict{static_cast<vm::Refusal>(result.refusal),
                            static_cast<vm::Section>(result.section), result.index};
  const std::uint16_t line = source_line(program.image(), verdict.section, verdict.index);
  throw Failure(Exit::program, fmt::format("the board refused the program: {}; the old one goes on",
                                           describe_refusal(verdict, line)));
}

// No firmware has it: better said here than by the board, in fewer words.
void refuse_modules_in_files(const vm::Image& image) {
  for (const vm::Sensor& sensor : image.sensors)
    if (policy::is_algorithm(sensor) && sensor.bus >= algorithms::kFirstInFile)
      throw Failure(
          Exit::program,
          fmt::format("the algorithm {} is a module in a file, which runs on a computer only; "
                      "docs/algorithms.md says how the firmware gets it",
                      image.string(sensor.name)));
}

}  // namespace

UploadResult upload_program(Session& session, const Program& program,
                            const UploadOptions& options) {
  refuse_modules_in_files(program.image());
  check_board(session, program);
  if (options.replace && session.board.running != 0)
    (void)session.client.clear(session.board.image_crc);
  const UploadResult result =
      upload(session.client, session.board, without_source_lines(program), options);
  check_result(result.activation, program);
  return result;
}

}  // namespace robosync::tool
