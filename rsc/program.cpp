// The files are not trusted. Promises that every image it returns is verified.
#include "rsc/program.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "compiler/diagnostics/render.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/source/sorting.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/file_kind.hpp"
#include "rsc/files.hpp"
#include "rsc/judge.hpp"
#include "runtime-m4/algorithms/judge.hpp"
#include "vm/identity.hpp"

namespace robosync::tool {
namespace {

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// By name or by content, so that a damaged image is rejected as an image and not read as a program.
bool is_image(const std::string& file, std::span<const std::byte> bytes) {
  const std::string extension = std::filesystem::path(file).extension().string();
  std::uint32_t magic = 0;
  if (bytes.size() >= sizeof magic) std::memcpy(&magic, bytes.data(), sizeof magic);
  return compiler::ascii::same(extension, ".rsb") || magic == vm::kMagic;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string program_beside(const std::string& file) {
  return std::filesystem::path(file).replace_extension(".rsl").string();
}

// Read as a program, JSON would have errors, and even fixes, that damage it.
void refuse_json(const std::string& file, const std::string& text) {
  constexpr std::string_view kJson = ".json";
  if (file.size() < kJson.size() ||
      !compiler::ascii::same(std::string_view(file).substr(file.size() - kJson.size()), kJson))
    return;
  FileKind kind = kind_of_text(text);
  if (kind == FileKind::other) kind = FileKind::configuration;
  throw Failure(
      Exit::program,
      fmt::format("{} is {}, not a program: name the program{}", file, describe(kind),
                  kind == FileKind::configuration
                      ? ", such as " + program_beside(file) + "; its configuration is read with it"
                      : std::string()));
}

// Its errors as a configuration would be misleading.
std::string read_configuration(const std::filesystem::path& path, const Texts& texts) {
  std::string text = texts.read(path);
  const FileKind kind = kind_of_text(text);
  if (kind != FileKind::other && kind != FileKind::configuration)
    throw Failure(Exit::program, fmt::format("{} is {}, not the configuration of a robot",
                                             path.string(), describe(kind)));
  return text;
}

compiler::Result compile(const std::string& file, const CompileOptions& options,
                         const compiler::ModuleReader& modules, const Texts& texts) {
  std::string text = texts.read(file);
  refuse_image(file, text);
  refuse_json(file, text);
  const std::filesystem::path path = find_configuration(file, options.config, texts);
  compiler::Result result = compiler::compile({file == "-" ? "stdin" : file, std::move(text)},
                                              {path.string(), read_configuration(path, texts)},
                                              {.source_lines = options.source_lines,
                                               .optimize = options.optimize,
                                               .seed = options.seed,
                                               .lints = options.lints,
                                               .read_module = modules,
                                               .algorithms = algorithm_modules()});
  judge(result, options.judged);
  return result;
}

// A SAFETY has a name; a LIMIT that is one begins with its actuator.
std::string name_of_safety(std::string_view text, compiler::Span span) {
  constexpr std::string_view kSafety = "SAFETY";
  const std::size_t line = text.rfind('\n', span.begin) + 1;  // 0 in the first line
  const std::size_t begin = text.find_first_not_of(" \t", line);
  const bool has_name = compiler::ascii::same(text.substr(begin, kSafety.size()), kSafety);
  const std::size_t from = has_name ? span.begin : begin;
  return std::string(text.substr(from, span.end - from));
}

constexpr std::array<std::string_view, policy::kWhose> kWhose = {
    "runtime",   "sensors",    "actuators", "behaviours", "rules",
    "variables", "algorithms", "image",     "borders"};

}  // namespace

void refuse_image(const std::string& file, std::string_view text) {
  if (is_image(file, std::as_bytes(std::span(text))))
    throw Failure(Exit::program, file + " is an image already, not a program: name the program, " +
                                     "such as " + program_beside(file));
}

std::optional<compiler::Input> read_module(const Texts& texts, const std::string& user,
                                           const std::string& file) {
  const std::filesystem::path path =
      (std::filesystem::path(user).parent_path() / file).lexically_normal();
  std::error_code error;
  if (!texts.has(path) || std::filesystem::is_directory(path, error)) return std::nullopt;
  return compiler::Input{path.string(), texts.read(path)};
}

std::string_view name_of(policy::Whose whose) {
  return kWhose[static_cast<std::size_t>(whose)];
}

policy::Needs needs_on_board(const vm::Image& image, const policy::BoardMemory& board) {
  vm::ImageHeader header = *image.header;
  header.total_length -= static_cast<std::uint32_t>(image.source_lines.size_bytes());
  vm::Image uploaded = image;
  uploaded.header = &header;
  return policy::needs_of(uploaded, board);
}

std::string too_many_text(const policy::Needs& needs, const vm::Verdict& verdict) {
  using policy::Count;
  const auto& counts = needs.counts;
  const auto text = [&](std::uint32_t count, std::string_view what) {
    return fmt::format("the program has {} {}, a board holds at most {}", count, what,
                       verdict.index);
  };
  switch (verdict.section) {
    case vm::Section::channels:
      return text(counts[Count::channels], "channels that it reads");
    case vm::Section::variables:
      return text(counts[Count::variables], "variables");
    case vm::Section::rules:
      return text(counts[Count::rules], "rules");
    default:
      return text(counts.threads(),
                  "threads (one for each behaviour, actuator and sensor, and three more)");
  }
}

std::string no_room_text(const policy::Needs& needs, const policy::BoardMemory& board) {
  const auto shares = policy::shares_of(needs);
  const std::vector<std::size_t> order = compiler::sorted_places(
      shares.size(), [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  const auto part = [&](std::size_t place) {
    return fmt::format("{} ({})", kWhose[order[place]], shares[order[place]]);
  };
  return fmt::format(
      "the program needs {} bytes of memory, the board has {} for programs; most of it is for {}, "
      "{} "
      "and {}",
      needs.total, board.arena_bytes, part(0), part(1), part(2));
}

compiler::Result compile_file(const std::string& file, const CompileOptions& options,
                              const Texts& texts) {
  const auto modules = [&texts](const std::string& user, const std::string& name) {
    return read_module(texts, user, name);
  };
  return compile(file, options, modules, texts);
}

std::vector<std::string> names_of(const compiler::SourceMap& sources) {
  std::vector<std::string> names;
  names.reserve(sources.size());
  for (std::size_t id = 0; id < sources.size(); ++id)
    names.push_back(sources.file(static_cast<compiler::FileId>(id)).name());
  return names;
}

Origin origin_of(const compiler::Result& result) {
  Origin origin{names_of(result.sources), result.units, {}, {}, {}};
  vm::Image image;
  const bool there = vm::view_image(result.image, image);
  for (const compiler::Span& span : result.rules) {
    const compiler::SourceFile& file = result.sources.file(span.file);
    const std::size_t rule = origin.rules.size();
    const bool safety = there && image.rules[rule].kind == vm::RuleKind::safety;
    origin.safety.push_back(safety ? name_of_safety(file.text(), span) : std::string());
    origin.rules.push_back(span.file == 0
                               ? std::string()
                               : fmt::format("{}:{}", file.name(), file.position(span.begin).line));
  }
  return origin;
}

void show_diagnostics(const compiler::Result& result, bool quiet) {
  if (!quiet || result.diagnostics.errors() > 0)
    std::cerr << compiler::render_human(result.diagnostics, result.sources, color_on_stderr());
}

std::string summary(const compiler::Diagnostics& diagnostics) {
  const std::size_t notes =
      diagnostics.all().size() - diagnostics.errors() - diagnostics.warnings();
  return fmt::format("{}, {}, {}", counted(diagnostics.errors(), "error"),
                     counted(diagnostics.warnings(), "warning"), counted(notes, "note"));
}

Program::Program(std::vector<std::byte> bytes, const std::string& name,
                 const policy::BoardMemory& board, Origin origin)
    : bytes_(std::move(bytes)), board_(board), origin_(std::move(origin)) {
  vm::Verdict verdict = vm::verify(bytes_, vm::Limits{}, image_);
  if (verdict.ok() && !vm::is_named(bytes_, {}))
    verdict = {vm::Refusal::wrong_name, vm::Section::header, 0};
  if (verdict.ok()) verdict = algorithms::judge(image_);
  if (verdict.ok()) return;
  vm::Image view;  // an unverified image may still have valid source lines
  const bool sections_fit = vm::view_image(bytes_, view);
  const std::uint16_t line = sections_fit ? source_line(view, verdict.section, verdict.index) : 0;
  throw Failure(Exit::program, fmt::format("{}: {}", name, describe_refusal(verdict, line)));
}

void print_json_errors(const compiler::Result& result, const CompileOptions& options) {
  if (options.json && result.diagnostics.errors() > 0)
    std::cout << compiler::render_json(result.diagnostics, result.sources);
}

// The memory of the board that an image is for; of the default board if it names none, or one that this rsc does not know.
policy::BoardMemory memory_for(std::span<const std::byte> bytes) {
  vm::Image view;
  if (!vm::view_image(bytes, view)) return board_memory();
  const auto board = board_of(*view.header);
  return board ? memory_of(*board) : board_memory();
}

const char* given_option(const CompileOptions& options) {
  if (!options.config.empty()) return "--config";
  if (!options.optimize) return "-O0";
  const bool lints = !options.lints.levels.empty() || options.lints.deny_warnings;
  return lints ? "--allow, --warn or --deny" : nullptr;
}

void refuse_with_image(const char* given, const std::string& file) {
  throw Failure(Exit::usage,
                fmt::format("{} says how to compile a program, but {} is an image already: "
                            "name the program, such as {}",
                            given, file, program_beside(file)));
}

Program load_program(const std::string& file, const CompileOptions& options) {
  std::vector<std::byte> bytes = read_bytes(file);
  if (is_image(file, bytes)) {
    if (const char* const given = given_option(options)) refuse_with_image(given, file);
    const policy::BoardMemory memory = memory_for(bytes);
    Program program(std::move(bytes), file, memory, {{file}, {}, {}, {}, {}});
    if (options.judged == Judged::by_time) judge_time(program, file);  // the board checks memory
    return program;
  }
  bool has_modules = false;  // then a line number may refer to another file
  const Texts texts;
  const auto modules = [&](const std::string& user, const std::string& name) {
    has_modules = true;
    return read_module(texts, user, name);
  };
  compiler::Result result = compile(file, options, modules, texts);
  show_diagnostics(result);
  print_json_errors(result, options);
  if (result.diagnostics.errors() > 0) {
    throw Failure(Exit::program, fmt::format("{}: {}", file, summary(result.diagnostics)));
  }
  Origin origin = origin_of(result);
  if (!has_modules) origin.lines = lines_of(result.sources.file(0).text());
  return {std::move(result.image), file, memory_of(result.board), std::move(origin)};
}

// It is the last section, so the image is cut there and the header updated.
std::vector<std::byte> without_source_lines(const Program& program) {
  vm::ImageHeader header = *program.image().header;
  const std::size_t length = program.bytes().size() - program.image().source_lines.size_bytes();
  header.source_lines = 0;
  header.total_length = static_cast<std::uint32_t>(length);
  std::vector<std::byte> bytes(program.bytes().begin(),
                               program.bytes().begin() + static_cast<std::ptrdiff_t>(length));
  std::memcpy(bytes.data(), &header, sizeof header);
  vm::seal(bytes);
  return bytes;
}

std::uint16_t source_line(const vm::Image& image, vm::Section section, std::uint16_t index) {
  if (section == vm::Section::rules && index < image.rules.size()) return image.rules[index].line;
  if (section != vm::Section::code) return 0;
  std::uint16_t line = 0;
  for (const vm::SourceLine& entry : image.source_lines) {
    if (entry.word <= index) line = entry.line;
  }
  return line;
}

std::string describe_refusal(const vm::Verdict& verdict, std::uint16_t line) {
  std::string place;
  if (verdict.section != vm::Section::header) {
    place = fmt::format(" ({}, {} {}", vm::describe(verdict.section),
                        verdict.section == vm::Section::code ? "word" : "record", verdict.index);
    if (line != 0) place += fmt::format(", source line {}", line);
    place += ')';
  }
  return fmt::format("{}{}", vm::describe(verdict.refusal), place);
}

std::vector<SectionSize> section_sizes(const vm::Image& image) {
  std::vector<SectionSize> sizes{{vm::Section::header, 1, sizeof(vm::ImageHeader)}};
  const auto add = [&](vm::Section section, const auto& records) {
    if (records.empty()) return;
    const std::size_t padded = (records.size_bytes() + 3) / 4 * 4;
    sizes.push_back({section, records.size(), padded});
  };
#define IMAGE_SECTION(records, Record, Count, check, name) add(vm::Section::records, image.records);
#include "vm/sections.def"
#undef IMAGE_SECTION
  return sizes;
}

}  // namespace robosync::tool
