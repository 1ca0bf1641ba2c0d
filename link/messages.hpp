// Payloads of the messages (messages.def), as they stand on the wire: little-endian, every member
// on its natural alignment, no padding but what is named `reserved` (wire.hpp checks).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace robosync::link {

inline constexpr std::uint8_t kProtocolVersion = 10;
inline constexpr std::size_t kMaxPayload = 240;
inline constexpr std::size_t kNameLength = 16;  // NUL-padded
using Name = std::array<char, kNameLength>;
using ProgramHash = std::array<std::uint8_t, 8>;  // ImageHeader::program_hash: names a program
// A number that a host draws, not 0. What changes the robot names it first of all.
using SessionId = std::uint32_t;

enum class MessageType : std::uint8_t {
#define MESSAGE(name, number, direction, doc) name = (number),
#include "link/messages.def"
#undef MESSAGE
};

// Whether only an owner gives the robot orders.
enum class Pairing : std::uint8_t {
  impossible,  // there is no store for a key, or the firmware cannot verify signatures
  unpaired,    // whoever has the line does
  paired
};

struct Hello {
  SessionId session;
  std::uint8_t take;  // 1: also when another one is in the midst of a transfer
  std::array<std::uint8_t, 3> reserved{};
  Name host;  // for whom the board keeps waiting
};

struct HelloReply {
  std::uint8_t protocol;
  std::uint8_t image_major;  // format the firmware runs (vm/image.hpp)
  std::uint16_t opcode_set;
  Name board;
  Name firmware;              // version
  std::uint32_t arena_begin;  // address of the memory for programs
  std::uint32_t arena_bytes;
  std::uint32_t arena_used;   // by the running program, its image included
  std::uint32_t step_budget;  // M4 instructions of VM code in one step
  std::uint32_t drivers;      // bit d: driver d of vm/drivers.def is present
  std::uint32_t image_bytes;  // of the running image
  ProgramHash program_hash;
  std::uint16_t receive_window;  // bytes of data the board can take before it must reply
  std::uint8_t running;          // 1: a program runs
  std::uint8_t stopped;          // 1: a person has stopped it
  Pairing pairing;
  std::array<std::uint8_t, 3> reserved{};
};

// A request that names a session has the reply `busy` when another one has the line, or none.
struct Busy {
  Name host;               // that has it; empty: say hello first
  std::uint32_t since_ms;  // it said hello
};

struct Begin {
  SessionId session;
  std::uint32_t size;
  ProgramHash hash;  // names the transfer
  ProgramHash base;  // pieces are taken from this one, which runs; zeros: from none
};

struct Data {             // followed by the bytes
  std::uint16_t session;  // its lower half
  std::uint16_t offset;
};
inline constexpr std::size_t kMaxData = kMaxPayload - sizeof(Data);

// A message `pieces` begins as `data` does. Pieces follow, each followed by its `count` bytes.
struct Piece {
  std::uint16_t from;    // byte of the base, or behind it of what has come of this image so far …
  std::uint16_t copied;  // … from which so many are the next ones
  std::uint16_t count;   // of bytes that come then
};

enum class TransferState : std::uint8_t {
  idle,
  receiving,
  complete,
  too_large,
  no_transfer,
  other_base  // it is not that one that runs: nothing has begun
};

struct TransferStatus {
  std::uint32_t next_offset;  // too_large: how many bytes could be received
  TransferState state;
  std::array<std::uint8_t, 3> reserved{};
};

inline constexpr std::uint8_t kNothingToActivate = 0xFF;

struct Activate {
  SessionId session;
  ProgramHash hash;        // as Begin: another host may have sent something else meanwhile
  std::uint32_t trial_ms;  // how long it is on trial; 0: as long as usual
  std::uint8_t goes_back;  // 1: after it back to the kept program, also when all went well
  std::uint8_t fresh;      // 1: KEPT numbers begin as the program says, not with what they were
  std::array<std::uint8_t, 2> reserved{};
};

struct ActivateResult {
  std::uint8_t running;  // 1: it runs; 0: refused, the old program goes on
  std::uint8_t refusal;  // vm::Refusal, or kNothingToActivate: no complete transfer of it
  std::uint8_t section;  // vm::Section
  std::uint8_t reserved;
  std::uint16_t index;
  std::uint16_t reserved2;
  std::uint64_t uptime_us;  // when it was switched to
};

struct Feed {
  SessionId session = 0;
  std::uint32_t channel;  // index in the running image
  std::uint64_t at_us;    // program time; 0: now
  std::int32_t value;     // thousandths
  std::uint32_t reserved = 0;
};

enum class FeedError : std::uint8_t {
  none,
  no_program,
  no_channel,
  not_virtual,
  queue_full,
  in_the_past
};

struct FeedResult {
  FeedError error;
  std::uint8_t free_places;  // in the board's queue of timed readings
};

enum class ResetReason : std::uint8_t { power, watchdog, software };

struct Status {
  std::uint64_t uptime_us;
  std::uint64_t program_us;      // since activation
  std::uint32_t steps;           // of the running program
  std::uint32_t safety_checks;   // periods the safety thread has run since boot
  std::uint32_t safety_late_us;  // worst lateness of a safety period since boot
  std::uint32_t bad_frames;      // frames dropped by the board for a wrong CRC or length
  std::uint32_t lost_events;     // trace events that did not fit in the ring
  std::uint16_t activations;     // programs activated since boot
  std::uint8_t faults;           // threads stopped by a fault since boot
  ResetReason reset_reason;      // of the last start
};

struct ThreadInfo {
  std::uint8_t index, total;
  std::uint8_t category;  // kernel::Category
  std::uint8_t rank;
  std::int8_t priority, base_priority;  // now, and as it is written
  std::uint16_t stack_bytes, stack_used;
  std::uint8_t state;         // 0 blocked, 1 ready, 2 stopped by a fault
  std::uint8_t missed;        // deadlines; 255: that many or more
  std::uint32_t activations;  // times it was woken
  std::uint32_t run_time;     // in counts of the board's clock; wraps
  std::uint32_t clock;        // … which stands here now: two replies tell its share of the time
  Name name;
};

struct Fault {
  Name thread;
  std::uint32_t cause;    // CFSR
  std::uint32_t address;  // MMFAR/BFAR, 0 when not valid
  std::uint32_t pc, lr, sp, xpsr;
  std::array<std::uint32_t, 13> r;  // r0–r12
};

// How it stands on the buses, since the running program began.
struct Devices {
  std::uint32_t asked;   // bit s: sensor s of the program has been measured on its bus
  std::uint32_t silent;  // bit s: … and does not answer
  std::uint16_t
      bus_clears;  // since start-up: a device held the data line down, and was given clocks to let go
  std::uint8_t held;  // bit b: a line of bus b is held down, so that nobody on it can answer
  std::uint8_t reserved;
  std::array<std::uint16_t, 32> failed;  // by sensor: transfers; 65535: that many or more
};

enum class Keeping : std::uint8_t {
#define KEEPING(name, doc) name,
#include "link/keeping.def"
#undef KEEPING
};

struct Kept {
  std::uint32_t kept_bytes;  // of the program with which the robot starts; 0: none
  ProgramHash kept_hash;
  std::uint32_t previous_bytes;  // … and of the one that was kept before
  ProgramHash previous_hash;
  std::uint32_t most_bytes;  // of an image, that can be kept
  std::uint32_t trial_ms;    // on_trial: left of it; then it is kept as soon as it is written
  ProgramHash
      given_up_hash;  // the last one since start-up that did not stand its trial; zeros: none
  Keeping state;
  std::uint8_t
      goes_back;  // on_trial: 1: after it back to the kept program, also when all goes well
  std::array<std::uint8_t, 2> reserved;
};

struct RollBack {
  SessionId session;
  ProgramHash hash;  // to this program: the previous one, or in a trial the kept one
};

struct Resume {
  SessionId session;
};

// Keys and signatures as in RFC 8032; an image's hash is the first half of the SHA-512 of its bytes.
using PublicKey = std::array<std::uint8_t, 32>;
using Signature = std::array<std::uint8_t, 64>;
using BootId = std::array<std::uint8_t, 16>;
using ImageHash = std::array<std::uint8_t, 32>;

enum class Denial : std::uint8_t {
#define DENIAL(name, doc) name,
#include "link/denials.def"
#undef DENIAL
};

struct Authority {
  PublicKey key;            // the owner's; zeros: there is none
  BootId boot;              // names this start of this board, and no other ever
  std::uint64_t next;       // an order's number must be this or more; each is taken once
  std::uint32_t window_ms;  // so long yet a key is taken by an unpaired board
  std::uint32_t wait_ms;    // too_soon: so long yet no order is looked at
  Pairing pairing;
  Denial denial;
  std::array<std::uint8_t, 6> reserved{};
};

struct Pair {
  PublicKey key;
  std::array<std::uint8_t, 16> seed;  // random, drawn by the host: what boot ids are made of
};

struct SignedOrder {    // followed by the payload of the order
  Signature signature;  // of OrderText (order.hpp) and that payload
  BootId boot;
  std::uint64_t number;
  std::uint8_t type;  // MessageType of the order
  std::array<std::uint8_t, 7> reserved{};
};
inline constexpr std::size_t kMaxOrder = kMaxPayload - sizeof(SignedOrder);

struct Grant {  // what a signed `begin` ends with
  ImageHash image;
  std::uint32_t trial_ms;  // these as Activate's
  std::uint8_t goes_back;
  std::uint8_t fresh;
  std::array<std::uint8_t, 2> reserved{};
};

struct TraceOn {
  std::uint8_t on;
};

struct Clear {
  SessionId session;
  ProgramHash hash;  // of the program that is to end: a stray frame ends none
};

struct ReadImage {
  std::uint32_t offset;
};

struct ImageData {  // followed by the bytes
  std::uint32_t offset;
};

}  // namespace robosync::link
