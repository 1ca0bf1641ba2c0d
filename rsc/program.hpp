// Programs as verbs take them: source that is compiled, or an image (.rsb) that is verified.
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

// What a program must not be for the board that robot.json names; what it is has an error.
enum class Judged : std::uint8_t {
  not_at_all,  // the board may be another
  by_memory,   // too large
  by_time,     // … or a step of it too long, or all together more than the board can keep up with
};

struct CompileOptions {
  std::string config;  // empty: the one that belongs to the program
  bool optimize = true;
  std::uint32_t seed = 0;  // 0: as the configuration says
  bool source_lines = true;
  bool json = false;  // mistakes of the program go to stdout as JSON, too, when there are errors
  compiler::LintLevels lints;
  Judged judged = Judged::by_memory;
};

// What a program needs of the memory of a board: of its image without the debug section, which the
// board has no use for. `image` is verified.
[[nodiscard]] policy::Needs needs_on_board(const vm::Image& image,
                                           const policy::BoardMemory& board);
// What is wrong with a program of which there is too much for any board (policy::judge()).
[[nodiscard]] std::string too_many_text(const policy::Needs& needs, const vm::Verdict& verdict);
// … with one that does not fit: both numbers, and what takes most.
[[nodiscard]] std::string no_room_text(const policy::Needs& needs,
                                       const policy::BoardMemory& board);
// "behaviours", and so on.
[[nodiscard]] std::string_view name_of(policy::Whose whose);

// The text of a module that `user` USEs as `file`, which is relative to it; nothing when it cannot be read. Two ways to write one
// path give one name.
[[nodiscard]] std::optional<compiler::Input> read_module(const Texts& texts,
                                                         const std::string& user,
                                                         const std::string& file);

// Compiles `file` with its configuration. Throws Failure (outside) when one cannot be read.
[[nodiscard]] compiler::Result compile_file(const std::string& file, const CompileOptions& options,
                                            const Texts& texts = Texts());

// "0 errors, 1 warning, 2 notes".
[[nodiscard]] std::string summary(const compiler::Diagnostics& diagnostics);

// What a program was made of, as far as that is known.
struct Origin {
  std::vector<std::string> files;  // that were read for it
  compiler::WrittenUnits units;
  // "file:line" of each rule of the image that stands in another file than the first; else empty.
  std::vector<std::string> rules;
  // That the image's line numbers mean, where these are of one file.
  std::vector<std::string> lines;
};
// Every file of a compilation, by its name.
[[nodiscard]] std::vector<std::string> names_of(const compiler::SourceMap& sources);

// Of a compilation that has an image.
[[nodiscard]] Origin origin_of(const compiler::Result& result);

// A verified image: the bytes and the view of them. Not copied, because the view points inside.
class Program {
public:
  // Throws Failure (program) with the verifier's reason. `name` stands in the message.
  Program(std::vector<std::byte> bytes, const std::string& name,
          const policy::BoardMemory& board = board_memory(), Origin origin = {});
  Program(Program&&) = default;
  Program& operator=(Program&&) = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }
  const vm::Image& image() const { return image_; }
  // What the board that it is for has for programs.
  const policy::BoardMemory& board() const { return board_; }
  // The lines that the image's line numbers mean; none when that is not known.
  const std::vector<std::string>& source() const { return origin_.lines; }
  const Origin& origin() const { return origin_; }
  // The files that were read for it.
  const std::vector<std::string>& files() const { return origin_.files; }

private:
  std::vector<std::byte> bytes_;
  vm::Image image_;
  policy::BoardMemory board_;
  Origin origin_;
};

// Source or image, whichever `file` is. Diagnostics go to stderr. Throws Failure (program) when it
// is wrong.
[[nodiscard]] Program load_program(const std::string& file, const CompileOptions& options);

// The same program without its debug section, which the board has no use for.
[[nodiscard]] std::vector<std::byte> without_source_lines(const Program& program);

// Source line of the place a verifier refused; 0 when it is not known. `image` may be a view that
// is not verified.
[[nodiscard]] std::uint16_t source_line(const vm::Image& image, vm::Section section,
                                        std::uint16_t index);
// What `rsc check --format json` says, on stdout, where `options` ask for it and there are errors.
void print_json_errors(const compiler::Result& result, const CompileOptions& options);

// "an operand is out of range (code, word 12, source line 4)".
[[nodiscard]] std::string describe_refusal(const vm::Verdict& verdict, std::uint16_t line);

struct SectionSize {
  vm::Section section;
  std::size_t records = 0;
  std::size_t bytes = 0;  // padding included
};

// Those that are not empty, in the order they stand in the image; together they are the image.
[[nodiscard]] std::vector<SectionSize> section_sizes(const vm::Image& image);

}  // namespace robosync::tool
