// Go-back-N over the link: data frames up to the board's window are in flight, and every reply names the next offset wanted. The
// line is not trusted. Promises to end: with the board's answer, soon after the board has fallen silent, or by its timeout.
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
#include "rsc/device/pieces.hpp"
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
// A board from which no frame has come for so long is gone: ten windows in a row are not lost.
constexpr milliseconds kSilence{2300};
constexpr std::size_t kBeside = link::kFrameOverhead + 2;  // of a frame, besides its payload
// Frames shorter than this are not sent to fill a window.
constexpr std::size_t kWorthAFrame = 64;

enum class Until { sent, there };

class Transfer {
public:
  Transfer(Client& client, std::span<const std::byte> image, const UploadOptions& options)
      : client_(client), image_(image), options_(options), pieces_(options.base, image) {
    if (!options.base.empty()) base_ = vm::stated_name(options.base);
  }

  // The first window follows the `begin` request without waiting: if the board wants something else, its reply says so.
  // `before`: bytes of another request in flight.
  void begin(std::size_t before = 0) {
    send_begin(before);
    fill_window(true);
    bytes_under_way_ -= before;
  }

  // Returns when everything is sent, or when the board has it. After begin().
  void run(Until until, Transport::Clock::time_point give_up) {
    const auto start = client_.now();
    bool waits = false;  // for the answer to a `begin` alone
    while (!complete_ && (until == Until::there || next_ < image_.size())) {
      const std::optional<Message> reply = client_.next_reply(kWindowTimeout);
      if (reply) take(*reply);
      if (complete_) return;
      expect_life(start, give_up);
      if (!reply && waits) {
        send_begin();  // no data, which would fill a line that nobody reads
        continue;
      }
      if (!reply) begin();  // resumes
      waits = !reply;
      fill_window(false);
    }
  }

  // A robot with an owner accepts begin() only after this order; other robots need none.
  void order() { client_.order_upload(link::wire_bytes(request()), image_, wish()); }

  // How to activate it.
  link::Activate wish() const {
    return {.session = client_.session(),
            .hash = vm::stated_name(image_),
            .trial_ms = static_cast<std::uint32_t>(options_.trial.count()),
            .goes_back = static_cast<std::uint8_t>(!options_.confirm),
            .fresh = static_cast<std::uint8_t>(options_.fresh)};
  }

  // Called when the board does not run the base.
  void forget_base() {
    base_ = {};
    pieces_ = Pieces({}, image_);
    wanted_ = 0;
  }

  std::size_t frames_sent() const { return frames_sent_; }
  std::size_t bytes_sent() const { return bytes_sent_; }

private:
  void send_begin(std::size_t before = 0) {
    under_way_.clear();
    bytes_under_way_ = before;
    next_ = wanted_;
    begin_sequence_ = client_.send(MessageType::begin, link::wire_bytes(request()));
    note_sent(begin_sequence_, sizeof(link::Begin));
  }

  void expect_life(Transport::Clock::time_point start, Transport::Clock::time_point give_up) const {
    if (client_.silent_for(start) >= kSilence) client_.no_answer();
    if (client_.now() >= give_up)
      throw Failure(Exit::outside, fmt::format("the transfer timed out after {} of {} bytes",
                                               wanted_, image_.size()));
  }

  struct UnderWay {
    std::uint8_t sequence;
    std::size_t end;    // the next offset wanted, if it is accepted
    std::size_t bytes;  // on the wire
  };

  link::Begin request() const {
    return {client_.session(), static_cast<std::uint32_t>(image_.size()), vm::stated_name(image_),
            base_};
  }

  void note_sent(std::uint8_t sequence, std::size_t payload) {
    under_way_.push_back({sequence, next_, payload + kBeside});
    bytes_under_way_ += payload + kBeside;
    bytes_sent_ += payload + kBeside;
  }

  std::vector<std::byte> payload_of(std::size_t most_bytes, std::size_t& end) const {
    const link::Data head{static_cast<std::uint16_t>(client_.session()),
                          static_cast<std::uint16_t>(next_)};
    const auto bytes = link::wire_bytes(head);
    std::vector<std::byte> payload(bytes.begin(), bytes.end());
    end = pieces_.fill(next_, most_bytes, payload);
    return payload;
  }

  // Sends frames of maximum length, since each costs ten bytes more; but the first window is filled completely, because no reply
  // comes before the line is idle.
  void fill_window(bool to_the_brim) {
    while (!complete_ && next_ < image_.size()) {
      const std::size_t room = kWindow - std::min(kWindow, bytes_under_way_ + kBeside);
      std::size_t end = 0;
      std::vector<std::byte> payload = payload_of(link::kMaxPayload, end);
      if (payload.size() > room) {
        if (!to_the_brim || room < kWorthAFrame) return;
        payload = payload_of(room, end);
      }
      next_ = end;
      note_sent(client_.send(MessageType::pieces, payload), payload.size());
      ++frames_sent_;
    }
  }

  void take(const Message& reply) {
    if (reply.type == MessageType::busy) {
      client_.reopen(reply, reopened_);
      return begin();
    }
    link::TransferStatus status{};
    if (reply.type != MessageType::transfer_status || !link::read_payload(reply.payload, status) ||
        status.next_offset > image_.size()) {
      return;
    }
    // Earlier frames have been answered too, or their reply was lost.
    const auto answered = std::ranges::find(under_way_, reply.sequence, &UnderWay::sequence);
    if (answered == under_way_.end()) return take_late(status);
    const std::size_t end = answered->end;
    for (auto at = under_way_.begin(); at != answered + 1; ++at)
      bytes_under_way_ -= at->bytes;
    under_way_.erase(under_way_.begin(), answered + 1);
    if (reply.sequence == begin_sequence_) return take_begin(status, end);
    note(status);
    if (status.state == link::TransferState::no_transfer) {
      wanted_ = 0;  // the board has been reset
      begin();
    } else if (status.next_offset != end && !complete_) {
      go_back();
    }
  }

  // A reply from before go_back(): it acknowledges less than what is in flight, unless the line or this computer is very slow.
  void take_late(const link::TransferStatus& status) {
    const bool comes = status.state == link::TransferState::receiving ||
                       status.state == link::TransferState::complete;
    if (!comes || status.next_offset <= wanted_) return;
    note(status);
    next_ = std::max(next_, wanted_);
  }

  void take_begin(const link::TransferStatus& status, std::size_t assumed) {
    if (status.state == link::TransferState::too_large) {
      throw Refused(
          fmt::format("next to the running program the board has {} bytes free, and the "
                      "image has {}: rsc upload --replace ends the running program first",
                      status.next_offset, image_.size()));
    }
    if (status.state == link::TransferState::other_base) {
      forget_base();
      return begin();
    }
    note(status);
    if (wanted_ != assumed && !complete_) go_back();
  }

  void note(const link::TransferStatus& status) {
    wanted_ = status.next_offset;
    complete_ = status.state == link::TransferState::complete;
    if (options_.progress) options_.progress(wanted_, image_.size());
  }

  // A frame was lost, so the board drops what was sent after it: resend from the offset that it wants.
  void go_back() {
    under_way_.clear();
    bytes_under_way_ = 0;
    next_ = wanted_;
  }

  static constexpr std::size_t kWindow = link::kReceiveWindow;

  Client& client_;
  std::span<const std::byte> image_;
  const UploadOptions& options_;
  Pieces pieces_;
  link::ProgramHash base_{};
  std::deque<UnderWay> under_way_;
  std::size_t bytes_under_way_ = 0;
  std::size_t next_ = 0;    // first byte not sent
  std::size_t wanted_ = 0;  // the board's latest report
  std::uint8_t begin_sequence_ = 0;
  bool complete_ = false;
  bool reopened_ = false;
  std::size_t frames_sent_ = 0;
  std::size_t bytes_sent_ = 0;
};

// Not the bytes that were sent: a frame was changed in spite of its checksum.
bool is_damaged(const link::ActivateResult& result) {
  const auto refusal = static_cast<vm::Refusal>(result.refusal);
  return refusal == vm::Refusal::bad_crc || refusal == vm::Refusal::wrong_name;
}

// How far an upload has come: what the robot runs if the line fails now.
struct Course {
  std::string old = "the old program keeps running";
  bool starts = false;  // the robot was told to start the new program, and has not answered

  // The failure, with what runs and what to do.
  Failure explain(const Failure& failure, const link::ProgramHash& hash) const {
    const std::string news =
        starts ? fmt::format(
                     "Program {} may run: the robot was told to start it, and its answer "
                     "is missing; `rsc info` shows what runs",
                     text_of(hash))
               : fmt::format(
                     "The new program was not started: {}; upload again when the line works", old);
    return {failure.exit(), followed_by(failure.what(), news)};
  }
};

link::ActivateResult activate(Client& client, const Transfer& transfer, Course& course) {
  course.starts = true;
  const link::ActivateResult result = client.activate(transfer.wish());
  course.starts = false;
  return result;
}

// Finishes a started transfer. The activation request follows the last piece without waiting; the board reports what was lost
// before it. A board that was reset, or that started another host's transfer, has nothing to activate: then the rest is sent
// again. A damaged image is sent again once.
UploadResult finish(Client& client, Transfer& transfer, std::span<const std::byte> image,
                    const UploadOptions& options, Transport::Clock::time_point start,
                    Course& course) {
  const auto give_up = start + options.timeout.value_or(patience(image.size()));
  UploadResult result;
  result.bytes = image.size();
  transfer.run(Until::sent, give_up);
  result.activation = activate(client, transfer, course);
  bool repeats = true;
  while (client.now() < give_up) {
    const bool nothing = result.activation.refusal == link::kNothingToActivate;
    if (!nothing && !(repeats && is_damaged(result.activation))) break;
    repeats = repeats && nothing;
    transfer.order();
    transfer.begin();
    transfer.run(Until::there, give_up);
    result.activation = activate(client, transfer, course);
  }
  result.frames_sent = transfer.frames_sent();
  result.bytes_sent = transfer.bytes_sent();
  result.time = std::chrono::duration_cast<std::chrono::microseconds>(client.now() - start);
  return result;
}

// A failure of the line says what runs; what the robot refuses is complete.
template <typename Work>
UploadResult explained(const Course& course, const link::ProgramHash& hash, const Work& work) {
  try {
    return work();
  } catch (const Refused&) {
    throw;
  } catch (const Failure& failure) {
    throw course.explain(failure, hash);
  }
}

void check_driver(const link::HelloReply& board, vm::DriverId id, std::string_view what,
                  std::string_view name, std::vector<std::string>& found) {
  const auto driver = static_cast<unsigned>(id);
  if (driver < 64 && (link::drivers_of(board) >> driver & 1) != 0) return;
  found.push_back(fmt::format("the firmware does not have the driver `{}`, which {} {} needs",
                              driver_name(id), what, name));
}

}  // namespace

milliseconds patience(std::size_t image_bytes) {
  return milliseconds(10000) + milliseconds(1) * image_bytes;
}

// On another board everything may differ, so no other reason is given.
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
        fmt::format("the firmware has another opcode set ({:04x}) than the image ({:04x}): compile "
                    "it again, or flash the firmware of this release",
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

UploadResult upload(Client& client, const link::HelloReply& /*hello*/,
                    std::span<const std::byte> image, const UploadOptions& options) {
  const auto start = client.now();
  Course course;
  return explained(course, vm::stated_name(image), [&] {
    Transfer transfer(client, image, options);
    transfer.order();
    transfer.begin();
    return finish(client, transfer, image, options, start, course);
  });
}

namespace {

// One without a name may be any.
void check_robot(const link::HelloReply& board, const vm::Image& image) {
  const std::string here = text_of(board.robot);
  const std::string_view meant = image.robot_name();
  if (meant.empty() || here.empty() || meant == here) return;
  throw Refused(
      fmt::format("this robot is \"{}\", and the program is for \"{}\", says its robot.json "
                  "(`name`): choose another --port; "
                  "`rsc upload --anyway` gives this robot the name \"{}\"",
                  here, meant, meant));
}

void check_board(const Session& session, const Program& program) {
  const std::vector<std::string> found = obstacles(session.board, program.image());
  if (found.empty()) return;
  throw Refused(fmt::format("the board ({}, firmware {}) cannot run this program:\n  {}",
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
  throw Refused(fmt::format("the board refused the program: {}; the old one keeps running",
                            describe_refusal(verdict, line)));
}

// No firmware has it: the message here is clearer than the board's.
void refuse_modules_in_files(const vm::Image& image) {
  for (const vm::Sensor& sensor : image.sensors)
    if (policy::is_algorithm(sensor) && sensor.bus >= algorithms::kFirstInFile)
      throw Failure(
          Exit::program,
          fmt::format("the algorithm {} is a module in a file, which runs on a computer only; "
                      "docs/algorithms.md says how the firmware gets it",
                      image.string(sensor.name)));
}

// What certainly runs until the activation. A session that has been open for long may know an earlier program.
std::string still_running(const link::HelloReply& board, bool is_news) {
  if (!is_news) return "the old program keeps running";
  if (board.running == 0) return "no program runs";
  return fmt::format("program {} keeps running", text_of(board.program_hash));
}

void end_running(Session& session, Course& course) {
  course.old = "the program before may have been ended (--replace)";
  (void)session.client.clear(session.board.program_hash);
  course.old = "no program runs, or the kept one in a few seconds";
}

UploadResult send(Session& session, const Program& program, std::span<const std::byte> image,
                  const UploadOptions& options, Course& course) {
  Client& client = session.client;
  const auto start = client.now();
  const bool is_news = !session.greeted();
  Transfer transfer(client, image, options);
  const bool at_once = is_news && !options.replace;
  if (at_once) transfer.begin(sizeof(link::Hello) + kBeside);
  session.greet();
  course.old = still_running(session.board, is_news);
  if (!options.to_any_robot) check_robot(session.board, program.image());
  check_board(session, program);
  if (options.replace && session.board.running != 0) end_running(session, course);
  if (!options.base.empty() && vm::stated_name(options.base) != session.board.program_hash)
    transfer.forget_base();
  transfer.order();
  if (!at_once || client.signs()) transfer.begin();
  return finish(client, transfer, image, options, start, course);
}

}  // namespace

UploadResult upload_program(Session& session, const Program& program,
                            const UploadOptions& options) {
  refuse_modules_in_files(program.image());
  const std::vector<std::byte> image = without_source_lines(program);
  Course course;
  const UploadResult result = explained(course, vm::stated_name(image), [&] {
    return send(session, program, image, options, course);
  });
  check_result(result.activation, program);
  return result;
}

}  // namespace robosync::tool
