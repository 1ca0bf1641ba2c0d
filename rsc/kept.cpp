// See kept.hpp.
#include "rsc/kept.hpp"

#include <cstring>
#include <filesystem>
#include <iostream>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

#include "compiler/config/names.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/json.hpp"
#include "rsc/output.hpp"
#include "rsc/quantity.hpp"
#include "vm/identity.hpp"

namespace robosync::tool {
namespace {

constexpr const char* kKey = "kept";
constexpr std::size_t kNotInImage = static_cast<std::size_t>(-1);

[[noreturn]] void fail(const std::string& file, const std::string& message) {
  throw Failure(Exit::outside, fmt::format("{}: {}; nothing was changed", file, message));
}

// The entries of a file written by rsc, or by hand.
Json entries_of(const std::string& text, const std::string& file) {
  const Json whole = read_json(text);
  const bool good =
      whole.is_object() && whole.size() == 1 && whole.contains(kKey) && whole[kKey].is_object();
  bool texts = good;
  if (good)
    for (const auto& [name, value] : whole[kKey].items())
      texts = texts && (value.is_string() || value.is_number());
  if (!texts)
    fail(file, "this is not a file of kept numbers: move it away, or name another with --kept");
  return whole[kKey];
}

std::size_t find_kept(const vm::Image& image, const std::string& entry) {
  for (std::size_t v = 0; v < image.variables.size(); ++v)
    if (image.variables[v].kind == vm::VariableKind::kept &&
        compiler::same_name(image.string(image.variables[v].name), entry))
      return v;
  return kNotInImage;
}

}  // namespace

Kept::Kept(const Program& program, const std::string& name, const std::string& file, bool fresh)
    : program_(program),
      file_(file.empty() ? std::filesystem::path(name).replace_extension(".kept.json").string()
                         : file),
      fresh_(fresh) {
  const auto& variables = program.image().variables;
  for (std::size_t v = 0; v < variables.size(); ++v)
    if (variables[v].kind == vm::VariableKind::kept) values_[v] = variables[v].initial;
  if (values_.empty()) return;
  if (std::filesystem::exists(file_))
    read();
  else
    check_output({file_}, program.files());
}

void Kept::read() {
  text_ = read_text(file_);
  entries_ = entries_of(text_, file_);
  std::string others;
  for (const auto& [entry, value] : entries_.items()) {
    const std::size_t variable = find_kept(program_.image(), entry);
    if (variable == kNotInImage)
      others += (others.empty() ? "`" : ", `") + entry + "`";
    else if (!fresh_)
      begin(variable, entry, value.is_string() ? value.get<std::string>() : json_text(value));
  }
  if (!others.empty())
    std::cerr << fmt::format("note: {} also keeps {}, which the program does not; it stays there\n",
                             file_, others);
}

void Kept::begin(std::size_t variable, const std::string& entry, const std::string& text) {
  try {
    const compiler::Unit* const unit = unit_of(variable);
    values_[variable] = parse_quantity(text, program_.image().variables[variable].dimension,
                                       unit != nullptr ? unit->spelling : std::string_view());
  } catch (const std::invalid_argument& error) {
    fail(file_,
         fmt::format("`{}`: {}; give the REMEMBER another name, or start afresh with --fresh",
                     entry, error.what()));
  }
  std::cerr << fmt::format("note: {} starts at {}, from {}\n", entry,
                           shown(variable, values_[variable]), file_);
}

const compiler::Unit* Kept::unit_of(std::size_t variable) const {
  const auto& units = program_.origin().units.variables;
  const auto& name = program_.image().variables[variable].name;
  const auto written = units.find(std::string(program_.image().string(name)));
  return written == units.end() ? nullptr : written->second;
}

// In the program's unit, if that is exact.
std::string Kept::shown(std::size_t variable, vm::Value value) const {
  const vm::Variable& record = program_.image().variables[variable];
  if (const compiler::Unit* const unit = unit_of(variable); unit != nullptr) {
    std::string text = compiler::format_value(value, *unit);
    if (parse_quantity(text, record.dimension) == value) return text;
  }
  return format_quantity(value, record.dimension);
}

// Its name as written in the file, where the case may differ.
std::string Kept::entry_of(std::size_t variable) const {
  for (const auto& [entry, value] : entries_.items())
    if (find_kept(program_.image(), entry) == variable) return entry;
  return std::string(program_.image().string(program_.image().variables[variable].name));
}

void Kept::put_into(std::vector<std::byte>& image) const {
  if (values_.empty()) return;
  vm::Image view;
  if (!vm::view_image(image, view)) return;
  const auto* const first = reinterpret_cast<const std::byte*>(view.variables.data());
  const auto begin = static_cast<std::size_t>(first - image.data());
  for (const auto& [variable, value] : values_) {
    const std::size_t at =
        begin + variable * sizeof(vm::Variable) + offsetof(vm::Variable, initial);
    std::memcpy(image.data() + at, &value, sizeof value);
  }
  vm::seal(image);
}

void Kept::see(const link::Event& event) {
  if (event.kind != link::EventKind::set || event.value_count == 0) return;
  if (const auto found = values_.find(event.subject); found != values_.end())
    found->second = event.values[0];
}

void Kept::write() {
  if (values_.empty()) return;
  for (const auto& [variable, value] : values_)
    entries_[entry_of(variable)] = shown(variable, value);
  const std::string text = json_text({{kKey, entries_}}, 2) + "\n";
  if (text != text_) write_edited(file_, std::as_bytes(std::span(text)));
}

}  // namespace robosync::tool
