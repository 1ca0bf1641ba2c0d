#include "compiler/config/fields.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>

#include "compiler/config/entries.hpp"
#include "compiler/config/names.hpp"
#include "compiler/diagnostics/nearest.hpp"

namespace robosync::compiler {
namespace {

const Key* find_key(Object object, std::string_view name) {
  const auto& keys = known_keys();
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& key) {
    return key.object == object && key.name == name;
  });
  return found == keys.end() ? nullptr : &*found;
}

void report_unknown(const json::Member& member, Object object, const Fields& fields,
                    Diagnostics& diagnostics) {
  const bool is_sensor = object == Object::sensor;
  const bool is_part = is_sensor || object == Object::actuator;
  std::vector<std::string> candidates;
  for (const Key& key : known_keys())
    if (key.object == object && (!is_part || may_have(fields, is_sensor, key.name)))
      candidates.emplace_back(key.name);
  Diagnostic& d = diagnostics.report(Code::E0202, "robot.json has no key `" + member.key + "` here")
                      .label(member.key_span);
  if (object == Object::sensor && find_key(Object::channel, member.key) != nullptr) {
    d.helps("it belongs to a channel of the sensor: `\"channels\": {\"LEVEL\": {\"" + member.key +
            "\": …}}`");
    return;
  }
  if (object == Object::actuator && member.key == "channels")
    d.helps("only sensors have channels");
  else if (!did_you_mean(d, member.key_span, member.key, candidates, "\""))
    d.helps("it can be " + list_names(candidates, "or"));
}

// For a value that should be such an object and is none: how it begins, for those that have a name.
std::string example_of(Object object, const json::Value& value) {
  const bool named = object == Object::sensor || object == Object::actuator ||
                     object == Object::behavior || object == Object::algorithm;
  if (!named || value.kind == json::Kind::object) return {};
  return "{\"name\": \"" + (value.kind == json::Kind::string ? value.text : "…") + "\"}";
}

}  // namespace

const std::vector<Key>& known_keys() {
  static const std::vector<Key> keys = {
#define KEY(object, name, use) {Object::object, name, KeyUse::use},
#include "compiler/config/keys.def"
#undef KEY
  };
  return keys;
}

Fields::Fields(const json::Value& value, Object object, Diagnostics& diagnostics)
    : value_(value), diagnostics_(diagnostics) {
  if (!expect_kind(value, json::Kind::object, diagnostics, example_of(object, value))) return;
  report_repeated_keys(value, diagnostics);
  for (const json::Member& member : value.members)
    check_key(member, object);
}

void Fields::check_key(const json::Member& member, Object object) {
  const Key* key = find_key(object, member.key);
  if (key == nullptr) {
    has_unknown_key_ = true;
    report_unknown(member, object, *this, diagnostics_);
  } else if (key->use == KeyUse::later) {
    diagnostics_.report(Code::W0213, "`" + member.key + "` is not used by this version of rsc yet")
        .label(member.key_span, "this has no effect");
  }
}

const json::Value* Fields::find(std::string_view key) const {
  if (const json::Value* const found = json::find(value_, key)) return found;
  return assumed_ && assumed_->key == key ? &assumed_->value : nullptr;
}

const json::Value* Fields::require(std::string_view key, std::string_view what) {
  const json::Value* found = find(key);
  if (found == nullptr && value_.kind == json::Kind::object && !has_unknown_key_) {
    diagnostics_
        .report(Code::E0206, std::string(what) + " needs the key `" + std::string(key) + "`")
        .label({value_.span.file, value_.span.begin, value_.span.begin + 1});
  }
  return found;
}

const json::Value& Fields::assume(std::string_view key, std::string text, Span span) {
  if (const json::Value* const said = find(key)) return *said;
  assumed_ = {std::string(key), span, {json::Kind::string, span, std::move(text), false, {}, {}}};
  return assumed_->value;
}

void report_repeated_keys(const json::Value& object, Diagnostics& diagnostics) {
  std::unordered_map<std::string_view, const json::Member*> known;
  for (const json::Member& member : object.members) {
    const auto [first, added] = known.emplace(member.key, &member);
    if (added) continue;
    diagnostics.report(Code::E0203, "the key `" + member.key + "` is given twice")
        .label(member.key_span)
        .label(first->second->key_span, "first given here", false);
  }
}

bool expect_kind(const json::Value& value, json::Kind kind, Diagnostics& diagnostics,
                 std::string_view example) {
  if (value.kind == kind) return true;
  Diagnostic& d =
      diagnostics
          .report(Code::E0204, "this must be " + std::string(json::kind_phrase(kind)) + ", not " +
                                   std::string(json::kind_phrase(value.kind)))
          .label(value.span);
  if (!example.empty()) d.helps("such as `" + std::string(example) + "`");
  return false;
}

}  // namespace robosync::compiler
