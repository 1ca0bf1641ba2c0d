// The members of one JSON object, checked against keys.def: unknown and repeated keys are errors, keys that this version does not
// use yet get a warning.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/config/json_reader.hpp"
#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

// The kinds of objects in robot.json, in device descriptors and in board profiles.
enum class Object : std::uint8_t {
  robot,
  sensor,
  channel,
  actuator,
  trim,
  sound,
  limits,
  behavior,
  scheduler,
  safety,
  algorithm,
  device,
  device_to,
  device_at,
  model,
  verb,
  board,
  arena,
  outputs,
  reserved,
  inputs,
  part,
  flash,
  drive
};

enum class KeyUse : std::uint8_t { used, later, editor };

struct Key {
  Object object;
  std::string_view name;
  KeyUse use;
};
[[nodiscard]] const std::vector<Key>& known_keys();

class Fields {
public:
  // Immediately reports what is wrong with the keys. A `value` that is not an object is reported too and has no fields. `value`
  // must outlive this.
  Fields(const json::Value& value, Object object, Diagnostics& diagnostics);

  [[nodiscard]] const json::Value* find(std::string_view key) const;  // nullptr if it is missing
  // As find(), but reports E0206 if the key is missing. If some key is unknown, it may be this one misspelt: then nothing is
  // reported. `what` names the object: "a sensor".
  [[nodiscard]] const json::Value* require(std::string_view key, std::string_view what);
  // If the key is missing, it has this text from now on, at `span`. One key at most.
  const json::Value& assume(std::string_view key, std::string text, Span span);

private:
  void check_key(const json::Member& member, Object object);

  const json::Value& value_;
  Diagnostics& diagnostics_;
  bool has_unknown_key_ = false;
  std::optional<json::Member> assumed_;
};

// Reports keys that appear twice in `object`, whose keys can be any names (channels, groups, speeds).
void report_repeated_keys(const json::Value& object, Diagnostics& diagnostics);
// True if `value` has the kind; otherwise reports E0204.
[[nodiscard]] bool expect_kind(const json::Value& value, json::Kind kind, Diagnostics& diagnostics,
                               std::string_view example = {});

}  // namespace robosync::compiler
