// Payloads of the messages (messages.def), as on the wire: little-endian, every member at its natural
// alignment, no padding except members named `reserved` (checked by wire.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace robosync::link {

inline constexpr std::uint8_t kProtocolVersion = 13;
inline constexpr std::size_t kMaxPayload = 240;
inline constexpr std::size_t kNameLength = 16;  // NUL-padded
using Name = std::array<char, kNameLength>;
using ProgramHash = std::array<std::uint8_t, 8>;  // ImageHeader::program_hash: names a program
// A random number that a host chooses, not 0. Messages that change the robot begin with it.
using SessionId = std::uint32_t;

enum class MessageType : std::uint8_t {
#define MESSAGE(name, number, direction, doc) name = (number),
#include "link/messages.def"
#undef MESSAGE
};

// Whether only an owner may give the robot orders.
enum class Pairing : std::uint8_t {
  impossible,  // there is no store for a key, or the firmware cannot verify signatures
  unpaired,    // any host on the line may
  paired
};

struct Hello {
  SessionId session;
  std::uint8_t take;  // 1: even if another session has a transfer in progress
  std::array<std::uint8_t, 3> reserved{};
  Name host;  // told to hosts that get `busy` meanwhile
};

struct HelloReply {
  std::uint8_t protocol;
  std::uint8_t image_major;  // format that the firmware runs (vm/image.hpp)
  std::uint16_t opcode_set;
  Name board;
  Name firmware;              // version
  Name robot;                 // the name that the running program gives it; empty: none
  std::uint32_t arena_begin;  // address of the memory for programs
  std::uint32_t arena_bytes;
  std::uint32_t arena_used;    // by the running program, including its image
  std::uint32_t step_budget;   // M4 instructions of VM code in one step
  std::uint32_t drivers;       // bit d: driver d of vm/drivers.def is present
  std::uint32_t more_drivers;  // … bit d: driver 32 + d
  std::uint32_t image_bytes;   // of the running image
  ProgramHash program_hash;
  std::uint16_t receive_window;  // bytes of data the board can take before it must reply
  std::uint8_t running;          // 1: a program runs
  std::uint8_t stopped;          // 1: a person has stopped it
  Pairing pairing;
  std::array<std::uint8_t, 3> reserved{};
};

constexpr std::uint64_t drivers_of(const HelloReply& board) {
  return std::uint64_t{board.more_drivers} << 32 | board.drivers;
}

// The reply to a request that names a session, if another session has the line, or none has.
struct Busy {
  Name host;               // the host that has the line; empty: say hello first
  std::uint32_t since_ms;  // ms since its hello
};

struct Begin {
  SessionId session;
  std::uint32_t size;
  ProgramHash hash;  // names the transfer
  ProgramHash base;  // pieces copy from this running program; zeros: from none
};

struct Data {             // followed by the bytes
  std::uint16_t session;  // lower half of the session
  std::uint16_t offset;
};
inline constexpr std::size_t kMaxData = kMaxPayload - sizeof(Data);

// A message `pieces` begins like `data`. Pieces follow, each followed by its `count` bytes.
struct Piece {
  std::uint16_t from;    // offset in the base, continued by what this transfer has received so far
  std::uint16_t copied;  // bytes to copy from there
  std::uint16_t count;   // new bytes that follow the piece
};

enum class TransferState : std::uint8_t {
  idle,
  receiving,
  complete,
  too_large,
  no_transfer,
  other_base  // the base is not the running program; no transfer has begun
};

struct TransferStatus {
  std::uint32_t next_offset;  // too_large: the most bytes that can be received
  TransferState state;
  std::array<std::uint8_t, 3> reserved{};
};

inline constexpr std::uint8_t kNothingToActivate = 0xFF;

struct Activate {
  SessionId session;
  ProgramHash hash;        // as in Begin: another host may have sent another image meanwhile
  std::uint32_t trial_ms;  // length of the trial; 0: the default
  std::uint8_t goes_back;  // 1: back to the kept program after the trial, even if all went well
  std::uint8_t fresh;      // 1: all variables begin with the values written in the program
  std::array<std::uint8_t, 2> reserved{};
};

struct ActivateResult {
  std::uint8_t running;  // 1: it runs; 0: refused, the old program continues
  std::uint8_t refusal;  // vm::Refusal, or kNothingToActivate: no complete transfer of this image
  std::uint8_t section;  // vm::Section
  std::uint8_t reserved;
  std::uint16_t index;
  std::uint16_t reserved2;
  std::uint64_t uptime_us;  // time of the switch
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
  std::uint32_t safety_checks;   // periods that the safety thread has run since boot
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
  std::int8_t priority, base_priority;  // current, and as written
  std::uint16_t stack_bytes, stack_used;
  std::uint8_t state;         // 0 blocked, 1 ready, 2 stopped by a fault
  std::uint8_t missed;        // deadlines; saturates at 255
  std::uint32_t activations;  // times it was woken
  std::uint32_t run_time;     // in counts of the board's clock; wraps
  std::uint32_t clock;        // the board's clock now: two replies give the thread's share of time
  Name name;
};

struct Fault {
  Name thread;
  std::uint32_t cause;    // CFSR
  std::uint32_t address;  // MMFAR/BFAR, 0 if not valid
  std::uint32_t pc, lr, sp, xpsr;
  std::array<std::uint32_t, 13> r;  // r0–r12
};

// The state of the devices on buses, since the running program began.
struct Devices {
  std::uint32_t asked;   // bit s: sensor s of the program has been measured on its bus
  std::uint32_t silent;  // bit s: sensor s does not answer
  std::uint16_t
      bus_clears;     // since start-up: clocks were sent because a device held the data line low
  std::uint8_t held;  // bit b: a line of bus b is held low, so that no device on it can answer
  std::uint8_t reserved;
  std::array<std::uint16_t, 32> failed;  // by sensor: failed transfers; saturates at 65535
};

struct Probe {
  std::uint8_t bus;
  std::uint8_t address;  // 0x08 to 0x77; at any other, nothing answers
  std::array<std::uint8_t, 2> reserved;
};

struct Probed {
  std::uint8_t bus;
  std::uint8_t address;
  std::uint8_t answers;  // 1: it does
  std::uint8_t held;     // 1: a line of that bus is held low, so that nothing on it can answer
};

struct GetState {
  std::uint32_t first;  // the values from this one on: the program's channels, then its variables
};

// Of the running program, now.
struct State {
  std::uint64_t program_us;              // since activation
  std::array<std::uint32_t, 8> tripped;  // bit r % 32 of word r / 32: SAFETY rule r is tripped
  std::uint32_t halted;                  // bit a: SAFETY or a person halts actuator a
  std::uint8_t count;                    // of values
  std::uint8_t stopped;                  // 1: a person has stopped the robot
  std::array<std::uint8_t, 2> reserved;
  std::array<std::int32_t, 32> values;  // thousandths; -2147483648: unknown
};

enum class Keeping : std::uint8_t {
#define KEEPING(name, doc) name,
#include "link/keeping.def"
#undef KEEPING
};

struct Kept {
  std::uint32_t kept_bytes;  // of the program that the robot starts with; 0: none
  ProgramHash kept_hash;
  std::uint32_t previous_bytes;  // of the program that was kept before it
  ProgramHash previous_hash;
  std::uint32_t most_bytes;   // of an image that can be kept
  std::uint32_t trial_ms;     // on_trial: time left; then it is kept as soon as it is written
  ProgramHash given_up_hash;  // the latest program since start-up to fail its trial; zeros: none
  Keeping state;
  std::uint8_t
      goes_back;  // on_trial: 1: back to the kept program after the trial, even if all goes well
  std::array<std::uint8_t, 2> reserved;
};

struct RollBack {
  SessionId session;
  ProgramHash hash;  // the program to go back to: the previous one, or in a trial the kept one
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
  PublicKey key;            // the owner's; zeros: none
  BootId boot;              // unique to this start of this board
  std::uint64_t next;       // lowest number of the next order; each number is accepted once
  std::uint32_t window_ms;  // time left in which an unpaired board accepts a key
  std::uint32_t wait_ms;    // too_soon: time left in which no order is checked
  Pairing pairing;
  Denial denial;
  std::array<std::uint8_t, 6> reserved{};
};

struct Pair {
  PublicKey key;
  std::array<std::uint8_t, 16> seed;  // random, from the host; boot ids are derived from it
};

struct SignedOrder {    // followed by the payload of the order
  Signature signature;  // of OrderText (order.hpp) and the payload
  BootId boot;
  std::uint64_t number;
  std::uint8_t type;  // MessageType of the order
  std::array<std::uint8_t, 7> reserved{};
};
inline constexpr std::size_t kMaxOrder = kMaxPayload - sizeof(SignedOrder);

struct Grant {             // the end of a signed `begin`
  ImageHash image;         // the first half of the SHA-512 of its bytes
  std::uint32_t trial_ms;  // this and the next two as in Activate
  std::uint8_t goes_back;
  std::uint8_t fresh;
  std::array<std::uint8_t, 2> reserved{};
};

struct TraceOn {
  std::uint8_t on;
};

struct Clear {
  SessionId session;
  ProgramHash hash;  // of the program to end, so that a stray frame ends no other
};

struct ReadImage {
  std::uint32_t offset;
};

struct ImageData {  // followed by the bytes
  std::uint32_t offset;
};

}  // namespace robosync::link
