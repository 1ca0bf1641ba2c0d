// A message that skips a layer does not compile: only its own layer can make it, and only
// the next layer can take it.
#include "runtime-m4/layers/messages.hpp"

#include <type_traits>

#include <catch2/catch.hpp>

#include "runtime-m4/layers/behavior.hpp"
#include "runtime-m4/layers/control.hpp"
#include "runtime-m4/layers/mailbox.hpp"

using namespace robosync;
using namespace robosync::layers;

namespace {

template <class Message>
concept Posted = requires(Mailboxes& boxes, const Message& message, const vm::Channel& channel) {
  boxes.post(message, channel);
};
template <class Message>
concept Evaluated = requires(BehaviorLayer& layer, const Message& message) {
  layer.begin_step(message);
};
template <class Message>
concept Staged = requires(ControlLayer& layer, const Message& message) {
  layer.stage(message, ActuatorMask{1});
};

static_assert(Posted<Reading> && !Posted<Snapshot> && !Posted<Command>);
static_assert(Evaluated<Snapshot> && !Evaluated<Reading> && !Evaluated<Command>);
static_assert(Staged<Command> && !Staged<Reading> && !Staged<Snapshot>);

static_assert(!std::is_default_constructible_v<Reading>);
static_assert(!std::is_constructible_v<Reading, std::uint8_t, vm::Value, kernel::Time>);
static_assert(!std::is_default_constructible_v<Snapshot>);
static_assert(!std::is_default_constructible_v<Command>);
static_assert(!std::is_constructible_v<Command, Reading>);
static_assert(!std::is_constructible_v<Snapshot, Reading>);

}  // namespace

TEST_CASE("each hop has a type of its own") {
  SUCCEED("checked by the compiler");
}
