// Who may give the robot orders: the board's gate alone and in the whole robot, with signatures from libsodium, against an
// attacker who has recorded everything that was ever sent and can send anything.
#include "runtime-m4/update/order_gate.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include <catch2/catch.hpp>

#include "link/order.hpp"
#include "rsc/device/keeping.hpp"
#include "rsc/device/orders.hpp"
#include "rsc/failure.hpp"
#include "tests/runtime-m4/update/kept.hpp"
#include "tests/support/folder.hpp"

using namespace robosync;
using Catch::Contains;
using link::Denial;
using link::MessageType;
using link::Pairing;
using link::ResetReason;
using test::Bytes;
using test::kStoreBytes;
using test::MemoryStore;
using test::Robot;
using tool::OwnerKey;
using update::OrderGate;

namespace {

struct Keys {
  test::Folder folder;
  std::string file = folder.path("key"), other_file = folder.path("other");
  std::unique_ptr<const OwnerKey> owner = OwnerKey::make(file),
                                  stranger = OwnerKey::make(other_file);
};

link::Pair owner_of(const Keys& keys, std::uint8_t seed = 1) {
  link::Pair owner{};
  owner.key = keys.owner->public_key();
  owner.seed.fill(seed);
  return owner;
}

// The gate of a board that was just switched on, without a robot.
struct Alone {
  explicit Alone(MemoryStore& memory, bool switched_on = true) : gate(robot.kernel, &memory) {
    memory.switch_on();
    gate.open(switched_on);
    finish();
  }
  void finish() {
    while (gate.busy())
      (void)gate.work();
  }
  void pair(const link::Pair& owner) {
    gate.pair(owner);
    finish();
  }
  link::Authority said() const {
    link::Authority answer{};
    gate.fill(answer);
    return answer;
  }
  // The type of the order that the gate takes from a message; nothing if it refuses it.
  std::optional<MessageType> takes(MessageType type, std::span<const std::byte> payload) {
    link::Frame frame{type, 0, payload};
    if (!gate.takes(frame)) return std::nullopt;
    return frame.type;
  }
  Denial denies(MessageType type, std::span<const std::byte> payload) {
    REQUIRE(takes(type, payload) == std::nullopt);
    return said().denial;
  }

  Robot robot;
  OrderGate gate;
};

// A signed order to that board, like the tool's.
Bytes order(const Alone& board, const OwnerKey& key, MessageType type,
            std::span<const std::byte> payload, std::uint64_t ahead = 0) {
  link::SignedOrder order{};
  order.boot = board.said().boot;
  order.number = board.said().next + ahead;
  order.type = static_cast<std::uint8_t>(type);
  std::array<std::byte, link::kMaxOrderText> text{};
  order.signature = key.sign(link::order_text(order, payload, text));
  const auto head = link::wire_bytes(order);
  Bytes whole(head.begin(), head.end());
  whole.insert(whole.end(), payload.begin(), payload.end());
  return whole;
}

const link::Clear kClear{1, {0x12}};

Bytes clear_order(const Alone& board, const OwnerKey& key, std::uint64_t ahead = 0) {
  return order(board, key, MessageType::clear, link::wire_bytes(kClear), ahead);
}

struct Paired {
  Paired() { board.pair(owner_of(keys)); }
  Denial denies(std::span<const std::byte> payload) {
    return board.denies(MessageType::signed_order, payload);
  }
  bool takes(std::span<const std::byte> payload) {
    return board.takes(MessageType::signed_order, payload).has_value();
  }

  Keys keys;
  MemoryStore memory{kStoreBytes};
  Alone board{memory};
};

constexpr std::array kOrders = {MessageType::begin,  MessageType::feed,      MessageType::clear,
                                MessageType::resume, MessageType::roll_back, MessageType::unpair};

}  // namespace

TEST_CASE("these are orders, and stop is none") {
  for (unsigned number = 0; number < 256; ++number) {
    const auto type = static_cast<MessageType>(number);
    CHECK(link::is_order(type) == (std::ranges::find(kOrders, type) != kOrders.end()));
  }
}

TEST_CASE("a board takes a key for a minute after it was switched on, and one only") {
  const Keys keys;
  SECTION("in time") {
    MemoryStore memory(kStoreBytes);
    Alone board(memory);
    CHECK(board.said().pairing == Pairing::unpaired);
    CHECK(board.said().window_ms > 59'000);
    board.pair(owner_of(keys));
    CHECK(board.said().pairing == Pairing::paired);
    CHECK(board.said().key == keys.owner->public_key());
    link::Pair other = owner_of(keys);
    other.key = keys.stranger->public_key();
    board.pair(other);
    CHECK(board.said().denial == Denial::has_owner);
    CHECK(board.said().key == keys.owner->public_key());
  }
  SECTION("too late") {
    MemoryStore memory(kStoreBytes);
    Alone board(memory);
    board.robot.run(OrderGate::kWindow / 1000);
    board.pair(owner_of(keys));
    CHECK(board.said().denial == Denial::nobody_there);
    CHECK(Alone(memory).said().pairing == Pairing::unpaired);
  }
  SECTION("after a reset that nobody beside it has caused") {
    MemoryStore memory(kStoreBytes);
    Alone board(memory, false);
    board.pair(owner_of(keys));
    CHECK(board.said().denial == Denial::nobody_there);
  }
  SECTION("without a store that answers") {
    Robot robot(boards::kMemory, nullptr, ResetReason::power);
    tool::Client client(robot);
    CHECK(client.hello().pairing == Pairing::impossible);
    CHECK_THROWS_WITH(client.pair(owner_of(keys)), Contains("cannot be paired"));
  }
}

TEST_CASE("an order of somebody else, unsigned or signed by another key, does not count") {
  Paired at;
  for (const MessageType type : kOrders)
    CHECK(at.board.denies(type, link::wire_bytes(kClear)) == Denial::unsigned_order);
  CHECK(at.denies(clear_order(at.board, *at.keys.stranger)) == Denial::bad_signature);
  CHECK(at.board.takes(MessageType::stop, {}) == MessageType::stop);
  CHECK(at.board.takes(MessageType::get_status, {}) == MessageType::get_status);
}

TEST_CASE("each order counts once, and none from before another one, a stop or a start") {
  Paired at;
  const Bytes first = clear_order(at.board, *at.keys.owner);
  const Bytes second = clear_order(at.board, *at.keys.owner, 1);
  CHECK(at.takes(second));
  CHECK(at.denies(second) == Denial::stale);
  CHECK(at.denies(first) == Denial::stale);
  const Bytes third = clear_order(at.board, *at.keys.owner);
  at.board.gate.outdate();  // a stop
  CHECK(at.denies(third) == Denial::stale);
  const Bytes fourth = clear_order(at.board, *at.keys.owner, 5);
  Alone again(at.memory);
  CHECK(again.said().boot != at.board.said().boot);
  CHECK(again.denies(MessageType::signed_order, fourth) == Denial::stale);
}

TEST_CASE("no number ends the counting") {
  Paired at;
  CHECK(at.denies(clear_order(at.board, *at.keys.owner, OrderGate::kMostAhead + 1)) ==
        Denial::stale);
  CHECK(at.denies(clear_order(at.board, *at.keys.owner, ~std::uint64_t{0} - 1)) == Denial::stale);
  CHECK(at.takes(clear_order(at.board, *at.keys.owner, OrderGate::kMostAhead)));
  CHECK(at.takes(clear_order(at.board, *at.keys.owner)));
}

TEST_CASE("an order to one board is none to another one of the same owner") {
  Paired at;
  MemoryStore memory(kStoreBytes);
  Alone other(memory);
  other.pair(owner_of(at.keys, 2));
  CHECK(other.denies(MessageType::signed_order, clear_order(at.board, *at.keys.owner)) ==
        Denial::stale);
}

// With changes of every byte of an order, and every length.
TEST_CASE("an order that was changed or cut anywhere does not count") {
  Keys keys;
  MemoryStore memory(kStoreBytes);
  Alone(memory).pair(owner_of(keys));
  const Bytes kept = memory.bytes;
  const Bytes payload(40, std::byte{7});
  // A board that has not seen a bad signature yet.
  const auto takes = [&](auto&& change) {
    memory.bytes = kept;
    Alone board(memory);
    Bytes whole = order(board, *keys.owner, MessageType::feed, payload);
    change(whole);
    return board.takes(MessageType::signed_order, whole).has_value();
  };
  CHECK(takes([](Bytes&) {}));
  for (std::size_t at = 0; at < sizeof(link::SignedOrder) + payload.size(); ++at) {
    CHECK_FALSE(takes([&](Bytes& whole) { whole.resize(at); }));
    CHECK_FALSE(takes([&](Bytes& whole) { whole[at] ^= std::byte{1}; }));
  }
  CHECK_FALSE(takes([](Bytes& whole) { whole.push_back({}); }));
}

TEST_CASE("the signature of one order is none of another order, nor of anything else") {
  Paired at;
  for (const MessageType type : kOrders) {
    if (type == MessageType::clear) continue;
    Bytes swapped = clear_order(at.board, *at.keys.owner);
    swapped[offsetof(link::SignedOrder, type)] = static_cast<std::byte>(type);
    CHECK(at.denies(swapped) == Denial::bad_signature);
    at.board.robot.run(OrderGate::kMostPause / 1000);
  }
  // A signature does not turn other messages into orders: neither stop, nor an order in an order.
  for (const MessageType type : {MessageType::stop, MessageType::pair, MessageType::signed_order})
    CHECK(at.denies(order(at.board, *at.keys.owner, type, {})) == Denial::bad_signature);
  // Signatures of an older text, and of the payload alone.
  link::SignedOrder old{};
  old.boot = at.board.said().boot;
  old.number = at.board.said().next;
  old.type = static_cast<std::uint8_t>(MessageType::resume);
  std::array<std::byte, link::kMaxOrderText> text{};
  const auto whole = link::order_text(old, {}, text);
  text[15] = std::byte{'0'};
  old.signature = at.keys.owner->sign(whole);
  CHECK(at.denies(link::wire_bytes(old)) == Denial::bad_signature);
}

TEST_CASE("after a bad signature none is looked at for a while, twice as long each time") {
  Paired at;
  kernel::Duration pause = OrderGate::kPause;
  for (unsigned i = 0; i < 8; ++i) {
    REQUIRE(at.denies(clear_order(at.board, *at.keys.stranger)) == Denial::bad_signature);
    REQUIRE(at.denies(clear_order(at.board, *at.keys.owner)) == Denial::too_soon);
    CHECK(at.board.said().wait_ms >= pause / 1000);
    at.board.robot.run(pause / 1000 - 1);
    REQUIRE(at.denies(clear_order(at.board, *at.keys.owner)) == Denial::too_soon);
    at.board.robot.run(2);
    pause = std::min(2 * pause, OrderGate::kMostPause);
  }
  CHECK(at.takes(clear_order(at.board, *at.keys.owner)));
  CHECK(at.denies(clear_order(at.board, *at.keys.stranger)) == Denial::bad_signature);
  CHECK(at.board.said().wait_ms <= OrderGate::kPause / 1000 + 1);
}

TEST_CASE("whatever is sent, nothing counts that was not signed") {
  Paired at;
  std::mt19937 random(1);
  Bytes garbage;
  for (unsigned round = 0; round < 3000; ++round) {
    garbage = clear_order(at.board, *at.keys.stranger);
    garbage.resize(random() % (link::kMaxPayload + 1));
    const std::size_t from = random() % (garbage.size() + 1);
    std::generate(garbage.begin() + static_cast<std::ptrdiff_t>(from), garbage.end(),
                  [&] { return static_cast<std::byte>(random()); });
    const auto type =
        round % 2 == 0 ? MessageType::signed_order : kOrders[random() % kOrders.size()];
    REQUIRE(at.board.takes(type, garbage) == std::nullopt);
    if (round % 100 == 0) at.board.robot.run(OrderGate::kMostPause / 1000);
  }
}

TEST_CASE("an upload is let through once, of the image that was signed, as it was signed") {
  Paired at;
  Bytes image(100, std::byte{5});
  const link::Begin begin{1, 100, {1}, {}};
  const auto how = [](bool fresh) {
    return link::Activate{.session = 1,
                          .hash = {1},
                          .trial_ms = 500,
                          .goes_back = 0,
                          .fresh = fresh ? std::uint8_t{1} : std::uint8_t{0}};
  };
  const auto granted = [&](bool fresh) {
    const auto head = link::wire_bytes(begin);
    const link::Grant grant = tool::grant_of(image, how(fresh));
    Bytes payload(head.begin(), head.end());
    std::ranges::copy(link::wire_bytes(grant), std::back_inserter(payload));
    link::Frame frame{MessageType::signed_order, 0, {}};
    const Bytes whole = order(at.board, *at.keys.owner, MessageType::begin, payload);
    frame.payload = whole;
    REQUIRE(at.board.gate.takes(frame));
    CHECK(std::ranges::equal(frame.payload, head));
  };
  CHECK_FALSE(at.board.gate.grants(image, how(false)));
  granted(false);
  CHECK(at.board.gate.grants(image, how(false)));
  CHECK_FALSE(at.board.gate.grants(image, how(false)));
  granted(false);
  CHECK_FALSE(at.board.gate.grants(image, how(true)));
  granted(true);
  CHECK(at.board.gate.grants(image, how(true)));
  granted(false);
  link::Activate otherwise = how(false);
  otherwise.trial_ms = 1;
  CHECK_FALSE(at.board.gate.grants(image, otherwise));
  granted(false);
  otherwise = how(false);
  otherwise.goes_back = 1;
  CHECK_FALSE(at.board.gate.grants(image, otherwise));
  granted(false);
  at.board.gate.outdate();  // a stop
  CHECK_FALSE(at.board.gate.grants(image, how(false)));
  granted(false);
  REQUIRE(at.takes(clear_order(at.board, *at.keys.owner)));
  CHECK_FALSE(at.board.gate.grants(image, how(false)));
  // Only the same `begin` continues the upload.
  granted(false);
  CHECK(at.board.takes(MessageType::begin, link::wire_bytes(begin)) == MessageType::begin);
  CHECK(at.board.denies(MessageType::begin, link::wire_bytes(link::Begin{1, 101, {1}, {}})) ==
        Denial::unsigned_order);
  Bytes other = image;
  other.back() ^= std::byte{1};
  CHECK_FALSE(at.board.gate.grants(other, how(false)));
  granted(false);
  at.board.robot.run(OrderGate::kGrant / 1000);
  CHECK(at.board.denies(MessageType::begin, link::wire_bytes(begin)) == Denial::unsigned_order);
  CHECK_FALSE(at.board.gate.grants(image, how(false)));
}

TEST_CASE(
    "a cut of the power at any byte leaves the owner of before or the new one, and no start "
    "twice") {
  const Keys keys;
  const std::size_t record = sizeof(update::KeyStore::Record);
  std::set<link::BootId> seen;
  for (std::size_t cut = 0; cut <= 3 * record; ++cut) {
    MemoryStore memory(kStoreBytes);
    const auto live = [&](auto&& what, std::size_t power) {
      Alone board(memory);
      memory.power_for = power;
      what(board);
      memory.switch_on();
    };
    live([&](Alone& board) { board.pair(owner_of(keys, static_cast<std::uint8_t>(cut))); }, cut);
    Alone second(memory);
    const bool paired = second.said().pairing == Pairing::paired;
    CHECK(paired == (cut >= record));
    if (!paired) continue;
    REQUIRE(seen.insert(second.said().boot).second);
    memory.power_for = cut - record;  // at the next start
    {
      OrderGate gate(second.robot.kernel, &memory);
      gate.open(true);
      while (gate.busy())
        if (!gate.work() && memory.dead) break;
    }
    Alone third(memory);
    REQUIRE(third.said().key == keys.owner->public_key());
    REQUIRE(seen.insert(third.said().boot).second);
  }
}

TEST_CASE("orders of an owner reach the robot, and those of others do not") {
  Keys keys;
  MemoryStore memory(kStoreBytes);
  const tool::Program program = test::program(3);
  Robot robot(boards::kMemory, &memory, ResetReason::power);
  tool::Client client(robot), stranger(robot);
  client.use_key(keys.file);
  stranger.use_key(keys.other_file);
  run_on(robot, program);  // it has no owner yet
  client.pair(owner_of(keys));
  CHECK(client.hello().pairing == Pairing::paired);
  stranger.hello();

  std::vector<Bytes> heard;
  robot.to_board.set([&](const Bytes& frame, std::size_t) {
    heard.push_back(frame);
    return frame;
  });
  CHECK(client.feed({.channel = 0, .at_us = 0, .value = 2000}).error == link::FeedError::none);
  client.stop();
  client.resume();
  CHECK(client.hello().stopped == 0);
  CHECK(tool::upload(client, client.hello(), program.bytes(), {}).activation.running == 1);
  client.clear(test::name_of(program));
  CHECK(client.hello().running == 0);
  CHECK(tool::upload(client, client.hello(), program.bytes(), {}).activation.running == 1);
  robot.to_board.set({});

  // Replays everything, in the same order and in another.
  const auto again = [&] {
    const auto activations = client.status().activations;
    for (const Bytes& frame : heard) {
      robot.write(frame);
      robot.run(20);
    }
    client.hello();
    CHECK(client.status().activations == activations);
    CHECK(client.hello().running == 1);
  };
  again();
  std::ranges::reverse(heard);
  again();

  // The stranger's rsc reports why it is refused; his stop works nevertheless.
  const auto foreign = [&](auto&& what) {
    CHECK_THROWS_WITH(what(), Contains("name the right file"));
  };
  foreign([&] { (void)stranger.feed({.channel = 0, .at_us = 0, .value = 2000}); });
  foreign([&] { stranger.clear(test::name_of(program)); });
  foreign([&] { (void)tool::upload(stranger, stranger.hello(), program.bytes(), {}); });
  foreign([&] { stranger.roll_back({1}); });
  foreign([&] { stranger.unpair(); });
  stranger.stop();
  CHECK(stranger.hello().stopped == 1);
  foreign([&] { stranger.resume(); });
  client.resume();
  CHECK(client.hello().stopped == 0);

  client.unpair();
  CHECK(stranger.hello().pairing == Pairing::unpaired);
  CHECK(stranger.feed({.channel = 0, .at_us = 0, .value = 2000}).error == link::FeedError::none);
}

TEST_CASE("what a stranger sends into the owner's upload is not run") {
  Keys keys;
  MemoryStore memory(kStoreBytes);
  Robot robot(boards::kMemory, &memory, ResetReason::power);
  tool::Client client(robot);
  client.use_key(keys.file);
  client.pair(owner_of(keys));
  const tool::Program program = test::program(3);
  // The stranger's own transfer, before and without the owner's order.
  const auto foreign = [&] {
    for (std::uint32_t at = 0; at < program.bytes().size(); at += 100) {
      const link::Data head{static_cast<std::uint16_t>(client.session()),
                            static_cast<std::uint16_t>(at)};
      Bytes payload(sizeof head);
      std::memcpy(payload.data(), &head, sizeof head);
      const auto part =
          program.bytes().subspan(at, std::min<std::size_t>(100, program.bytes().size() - at));
      payload.insert(payload.end(), part.begin(), part.end());
      payload.back() ^= std::byte{1};
      client.send(MessageType::data, payload);
      robot.run(30);
    }
  };
  const link::Begin begin{client.session(),
                          static_cast<std::uint32_t>(program.bytes().size()),
                          test::name_of(program),
                          {}};
  const link::Activate how{
      .session = 0, .hash = begin.hash, .trial_ms = 0, .goes_back = 0, .fresh = 0};
  client.send(MessageType::begin, link::wire_bytes(begin));
  foreign();
  CHECK(client.activate(how).refusal == link::kNothingToActivate);
  // … and instead of the owner's.
  client.order_upload(link::wire_bytes(begin), program.bytes(), how);
  foreign();
  CHECK(client.activate(how).refusal == link::kNothingToActivate);
  CHECK(client.hello().running == 0);
  CHECK(tool::upload(client, client.hello(), program.bytes(), {}).activation.running == 1);
}

TEST_CASE("pairing outlasts a loss of power, and so does giving it up") {
  Keys keys;
  MemoryStore memory(kStoreBytes);
  memory.writes_take = 3;
  const auto pairing_after = [&](auto&& what) {
    {
      Robot robot(boards::kMemory, &memory, ResetReason::power);
      tool::Client client(robot);
      client.use_key(keys.file);
      what(client);
    }
    Robot robot(boards::kMemory, &memory, ResetReason::power);
    tool::Client client(robot);
    return client.hello().pairing;
  };
  CHECK(pairing_after([&](tool::Client& client) { client.pair(owner_of(keys)); }) ==
        Pairing::paired);
  CHECK(pairing_after([](tool::Client&) {}) == Pairing::paired);
  CHECK(pairing_after([](tool::Client& client) { client.unpair(); }) == Pairing::unpaired);
}

TEST_CASE("a key that cannot be used is said to be so") {
  Keys keys;
  MemoryStore memory(kStoreBytes);
  Robot robot(boards::kMemory, &memory, ResetReason::power);
  tool::Client client(robot);
  client.pair(owner_of(keys));
  client.use_key(keys.folder.path("none"));
  CHECK_THROWS_WITH(client.resume(), Contains("there is no key: make one with rsc keygen"));
  std::ofstream(keys.folder.path("text")) << "not a key\n";
  std::filesystem::permissions(keys.folder.path("text"), std::filesystem::perms::owner_read);
  client.use_key(keys.folder.path("text"));
  CHECK_THROWS_WITH(client.resume(), Contains("not a key from rsc keygen"));
  std::filesystem::permissions(keys.file, std::filesystem::perms::group_read,
                               std::filesystem::perm_options::add);
  client.use_key(keys.file);
  CHECK_THROWS_WITH(client.resume(), Contains("chmod 600"));
  CHECK_THROWS_WITH(OwnerKey::make(keys.file), Contains("the file already exists"));
}
