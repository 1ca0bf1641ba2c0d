// Programs as verbs take them: source, which is compiled, or an image (.rsb), which is verified.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/compiler.hpp"
#include "rsc/board.hpp"
#include "rsc/files.hpp"
#include "runtime-m4/policy/memory.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {

// Which limits of the board in robot.json a program must meet; a violation is an error.
enum class Judged : std::uint8_t {
  not_at_all,  // the board may be a different one
  by_memory,   // too large
  by_time,     // … or a step too long, or more load than the board can keep up with
};

struct CompileOptions {
  std::string config;  // empty: the program's own
  bool optimize = true;
  std::uint32_t seed = 0;  // 0: the configuration's
  bool source_lines = true;
  bool json = false;  // if there are errors, diagnostics also go to stdout as JSON
  compiler::LintLevels lints;
  Judged judged = Judged::by_memory;
};

// The memory that a program needs on a board, counted without the debug section, which the board does not use. `image` is
// verified.
[[nodiscard]] policy::Needs needs_on_board(const vm::Image& image,
                                           const policy::BoardMemory& board);
// Why a program is too large for any board (policy::judge()).
[[nodiscard]] std::string too_many_text(const policy::Needs& needs, const vm::Verdict& verdict);
// Why it does not fit this board: both sizes, and what takes most.
[[nodiscard]] std::string no_room_text(const policy::Needs& needs,
                                       const policy::BoardMemory& board);
// "behaviours", and so on.
[[nodiscard]] std::string_view name_of(policy::Whose whose);

// The text of the module that `user` USEs as `file` (a path relative to `user`); nothing if it cannot be read. Different
// spellings of one path give the same name.
[[nodiscard]] std::optional<compiler::Input> read_module(const Texts& texts,
                                                         const std::string& user,
                                                         const std::string& file);

// The first of these options that the user gave: of no use where nothing is compiled. Null: none.
[[nodiscard]] const char* given_option(const CompileOptions& options);
// `given`, an option that is for compiling, came with an image: throws Failure (usage).
[[noreturn]] void refuse_with_image(const char* given, const std::string& file);

// Compiles `file` with its configuration. Throws Failure (outside) when one cannot be read.
[[nodiscard]] compiler::Result compile_file(const std::string& file, const CompileOptions& options,
                                            const Texts& texts = Texts());

// Throws Failure (program) if this is an image, which has no text.
void refuse_image(const std::string& file, std::string_view text);

// On stderr, for a person. `quiet`: only if there is an error.
void show_diagnostics(const compiler::Result& result, bool quiet = false);

// "0 errors, 1 warning, 2 notes".
[[nodiscard]] std::string summary(const compiler::Diagnostics& diagnostics);

// The sources of a program, as far as they are known.
struct Origin {
  std::vector<std::string> files;  // that were read for it
  compiler::WrittenUnits units;
  // For each rule of the image: "file:line" if it is not in the first file, else empty.
  std::vector<std::string> rules;
  // The lines that the image's line numbers refer to, if all are of one file.
  std::vector<std::string> lines;
  // For each rule of the image: what names it in the source if it is a SAFETY rule, "pinched" or "LIMIT arms"; else empty.
  std::vector<std::string> safety;

  // Empty: it is no SAFETY rule, or there is no source.
  [[nodiscard]] std::string safety_name(std::size_t rule) const {
    return rule < safety.size() ? safety[rule] : std::string();
  }
};
// The names of all files of a compilation.
[[nodiscard]] std::vector<std::string> names_of(const compiler::SourceMap& sources);

// The origin of a compilation that produced an image.
[[nodiscard]] Origin origin_of(const compiler::Result& result);

// A verified image: the bytes and the view of them. Not copied, because the view points inside.
class Program {
public:
  // Throws Failure (program) with the verifier's reason. The message contains `name`.
  Program(std::vector<std::byte> bytes, const std::string& name,
          const policy::BoardMemory& board = board_memory(), Origin origin = {});
  Program(Program&&) = default;
  Program& operator=(Program&&) = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }
  const vm::Image& image() const { return image_; }
  // Its board's memory for programs.
  const policy::BoardMemory& board() const { return board_; }
  // The lines that the image's line numbers refer to; empty if not known.
  const std::vector<std::string>& source() const { return origin_.lines; }
  const Origin& origin() const { return origin_; }
  // All files that were read for the program.
  const std::vector<std::string>& files() const { return origin_.files; }

private:
  std::vector<std::byte> bytes_;
  vm::Image image_;
  policy::BoardMemory board_;
  Origin origin_;
};

// `file` is source or an image. Diagnostics go to stderr. Throws Failure (program) if it has errors, and Failure (usage) for an
// image with options for the compiler.
[[nodiscard]] Program load_program(const std::string& file, const CompileOptions& options);

// The program without its debug section, which the board does not use.
[[nodiscard]] std::vector<std::byte> without_source_lines(const Program& program);

// Source line of what the verifier refused; 0: not known. `image` may be an unverified view.
[[nodiscard]] std::uint16_t source_line(const vm::Image& image, vm::Section section,
                                        std::uint16_t index);
// Prints what `rsc check --format json` prints, if `options` ask for it and there are errors.
void print_json_errors(const compiler::Result& result, const CompileOptions& options);

// "an operand is out of range (code, word 12, source line 4)".
[[nodiscard]] std::string describe_refusal(const vm::Verdict& verdict, std::uint16_t line);

struct SectionSize {
  vm::Section section;
  std::size_t records = 0;
  std::size_t bytes = 0;  // padding included
};

// The sections that are not empty, in image order; together they make up the image.
[[nodiscard]] std::vector<SectionSize> section_sizes(const vm::Image& image);

}  // namespace robosync::tool
