// player PORT: plays programs and readings to a board, one after the other on one line.
//
// Each line of stdin is a job, IMAGE SCENARIO END_MS. Its answer is the board's trace up to that program time, as
// `rsc run --format json` writes it, and then a line {"played": …}: "whole", or why it is not: "late", a reading came when
// its time was over; "lost", events did not fit on the line; "refused" by the board.
//
// May assume that every job reads a channel that can be fed. The board's virtual time does not wait for this machine, and
// this program never waits for a clock: readings go out as many at a time as the line takes, and one behind END_MS says that
// all events before have come.
#include <algorithm>
#include <deque>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "link/wire.hpp"
#include "rsc/device/session.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/failure.hpp"
#include "rsc/trace/scenario.hpp"
#include "rsc/trace/trace_format.hpp"

namespace {

using namespace robosync;
using link::FeedError;
using std::chrono::milliseconds;

constexpr milliseconds kPatience{60'000};
constexpr milliseconds kSilence{300};  // of a board that has nothing to say
// So many silences, with an answer of the board before each, are the end of its trace. Beside other work a board may stand
// still for longer than one.
constexpr unsigned kSilences = 3;
constexpr milliseconds kFirst{10'000};  // for the first event of a program; later it is lost
constexpr std::size_t kFeedBytes = sizeof(link::Feed) + link::kFrameOverhead + 2;

struct Job {
  std::string image, scenario;
  std::uint64_t end_ms = 0;
  std::uint64_t end_us() const { return end_ms * 1000; }
};

// Feeds readings, several under way. True when each came in time. A frame that the line loses is sent again, behind others:
// of two readings of a channel for one instant, of which the board keeps what comes last, only one is ever under way.
class Feeding {
public:
  Feeding(tool::Session& session, std::vector<tool::Stimulus> readings)
      : client_(session.client),
        most_(session.board.receive_window / kFeedBytes),
        waiting_(readings.begin(), readings.end()) {}

  bool run() {
    while (!waiting_.empty() || !under_way_.empty()) {
      while (may_send_next())
        send_next();
      take_reply();
    }
    return in_time_;
  }

private:
  struct UnderWay {
    std::uint8_t sequence;
    tool::Stimulus reading;
  };

  bool may_send_next() const {
    return !waiting_.empty() && under_way_.size() < most_ &&
           std::ranges::none_of(under_way_, [&](const UnderWay& sent) {
             return sent.reading.channel == waiting_.front().channel &&
                    sent.reading.at_us == waiting_.front().at_us;
           });
  }

  void send_next() {
    const tool::Stimulus reading = waiting_.front();
    waiting_.pop_front();
    const link::Feed feed{.session = client_.session(),
                          .channel = reading.channel,
                          .at_us = reading.at_us,
                          .value = reading.value};
    under_way_.push_back({client_.send(link::MessageType::feed, link::wire_bytes(feed)), reading});
  }

  // Others are to requests that were sent twice.
  void take_reply() {
    const auto reply = client_.next_reply(kPatience);
    if (!reply) throw tool::Failure(tool::Exit::outside, "the line has lost a reading");
    link::FeedResult result{};
    if (reply->sequence != under_way_.front().sequence ||
        !link::read_payload(reply->payload, result))
      return;
    if (result.error == FeedError::queue_full)
      waiting_.push_front(under_way_.front().reading);  // there is room as time goes on
    else
      in_time_ = in_time_ && result.error == FeedError::none;
    under_way_.pop_front();
  }

  tool::Client& client_;
  std::size_t most_;
  std::deque<tool::Stimulus> waiting_;
  std::deque<UnderWay> under_way_;
  bool in_time_ = true;
};

// As a run on the host begins, and never kept: a board with a store would go back to the program that it keeps, when the one
// after it is over, and when it does not stand its trial because it trips at once.
tool::UploadOptions as_on_the_host() {
  tool::UploadOptions options;
  options.fresh = true;
  options.confirm = false;
  return options;
}

class Player {
public:
  explicit Player(const std::string& port)
      : session_(port), lost_(session_.client.set_trace(true).lost_events) {}

  // Why the trace is not whole; "whole" when it is.
  std::string play(const Job& job) {
    const tool::Program program = tool::load_program(job.image, {});
    const std::vector<tool::Stimulus> readings = tool::read_scenario(job.scenario, program).stimuli;
    const std::vector<std::byte> image = tool::without_source_lines(program);
    const link::ActivateResult begun =
        tool::upload(session_.client, session_.board, image, as_on_the_host()).activation;
    if (begun.running == 0) return "refused";
    ++begun_;
    const bool in_time = Feeding(session_, readings).run();
    const bool shown = in_time && show(job, program.image(), readings.back());
    const std::uint32_t before = lost_;
    lost_ = session_.client.clear(program.image().header->program_hash).lost_events;
    if (in_time && !shown) begin_anew();
    return !in_time ? "late" : shown && lost_ == before ? "whole" : "lost";
  }

private:
  // The last reading comes again behind the end, and another one, so that one of them is an event; but of a channel that
  // nothing depends on there is none. Then the board has nothing more to say, and is behind the end. False when the first
  // event is missing.
  bool show(const Job& job, const vm::Image& image, tool::Stimulus last) {
    last.at_us = job.end_us() + 1000;
    tool::Stimulus other = last;
    other.at_us += 1000;
    other.value = last.value == 0 ? 1000 : 0;
    Feeding(session_, {last, other}).run();
    const auto first_by = session_.client.now() + kFirst;
    auto give_up = session_.client.now() + kPatience;
    for (unsigned silences = 0; session_.client.now() < give_up;) {
      link::Event event;
      const Heard heard = hear(event);
      if (heard == Heard::event) {
        if (event.time_us > job.end_us()) return true;
        silences = 0;
        give_up = session_.client.now() + kPatience;  // it goes on, however slowly
        std::cout << tool::trace_json(event, {&image, {}, nullptr}) << '\n';
        continue;
      }
      const bool begun = seen_ == begun_;
      if (!begun && session_.client.now() > first_by) return false;
      if (heard == Heard::nothing && session_.client.status().program_us > other.at_us) ++silences;
      if (begun && silences >= kSilences) return true;
    }
    throw tool::Failure(tool::Exit::outside, "the program has come to no end");
  }

  // `event`: of the program that has begun last. `other`: of the one before, or no event.
  enum class Heard { nothing, event, other };
  Heard hear(link::Event& event) {
    const auto message = session_.client.next_unasked(kSilence);
    if (!message) return Heard::nothing;
    if (message->type != link::MessageType::event || !link::decode_event(message->payload, event))
      return Heard::other;
    if (event.kind == link::EventKind::activated) ++seen_;
    return seen_ == begun_ ? Heard::event : Heard::other;
  }

  // No program runs. What still comes is of one whose first event did not come, or came late.
  void begin_anew() {
    const auto until = session_.client.now() + kFirst;
    while (session_.client.now() < until && session_.client.next_unasked(kSilence)) {
    }
    seen_ = begun_;
  }

  tool::Session session_;
  std::uint32_t lost_;
  unsigned begun_ = 0;  // programs
  unsigned seen_ = 0;   // … whose first event has come
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: player PORT, and on stdin lines IMAGE SCENARIO END_MS\n";
    return 2;
  }
  try {
    Player player(argv[1]);
    for (std::string line; std::getline(std::cin, line);) {
      Job job;
      std::istringstream(line) >> job.image >> job.scenario >> job.end_ms;
      const std::string played = player.play(job);
      std::cout << R"({"played":")" << played << "\"}" << std::endl;
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
