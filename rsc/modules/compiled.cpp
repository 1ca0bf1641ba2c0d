#include "rsc/modules/compiled.hpp"

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rsc/device/programmer.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/modules/texts.hpp"
#include "rsc/output.hpp"

namespace robosync::tool {
namespace {

namespace fs = std::filesystem;
using Command = std::vector<std::string>;

const char* const kCrossCompiler = "arm-none-eabi-gcc";
const char* const kEmulator = "qemu-system-arm";

void write_text(const fs::path& path, std::string_view text) {
  write_output(path, std::as_bytes(std::span(text)));
}

// Lets a lone module find the interface; a copy next to the module comes first.
fs::path with_header(const WorkFolder& folder) {
  write_text(folder.path() / "robosync_module.h", module_header());
  return folder.path();
}

Command with(Command command, const Command& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

std::string compiler() {
  const char* const named = std::getenv("CC");
  return named != nullptr && *named != 0 ? named : "cc";
}

void run_compiler(const Command& command, const std::string& source, const char* for_what) {
  if (!is_installed(command.front()))
    throw Failure(Exit::outside,
                  fmt::format("there is no compiler {} to compile {}", command.front(), source));
  if (run_program(command) != 0)
    throw Failure(Exit::program, fmt::format("{} does not compile{}", source, for_what));
}

// --- the program that counts ---

void replace_all(std::string& text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

std::string counting_program_for(const std::string& name, const Try& one,
                                 const robosync_module& module) {
  std::vector<std::string> samples;
  for (const module_files::Inputs& inputs : one.samples)
    samples.push_back(
        fmt::format("{{{}}}", fmt::join(inputs.begin(), inputs.begin() + module.inputs, ", ")));
  std::string text(counting_program());
  replace_all(text, "@NAME@", name);
  replace_all(text, "@PERIOD@", std::to_string(one.period_ms));
  replace_all(text, "@INPUTS@", std::to_string(module.inputs));
  replace_all(text, "@SAMPLES@", std::to_string(one.samples.size()));
  replace_all(text, "@CONFIG@", fmt::format("{}", fmt::join(one.config, ", ")));
  replace_all(text, "@INPUT_VALUES@", fmt::format("{}", fmt::join(samples, ",\n    ")));
  return text;
}

// Flash and RAM of QEMU's mps2-an386.
constexpr std::string_view kLinkerScript = R"(ENTRY(count_all)
SECTIONS {
  . = 0;
  .text : { KEEP(*(.vectors)) *(.text*) *(.rodata*) *(.ARM.ex*) }
  . = 0x20000000;
  .bss : { *(.data*) *(.bss*) *(COMMON) }
}
)";

}  // namespace

WorkFolder::WorkFolder() {
  std::string pattern = (fs::temp_directory_path() / "rsc_module.XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr)
    throw Failure(Exit::outside, "cannot make a folder in " + fs::temp_directory_path().string());
  path_ = pattern;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

// Undefined arithmetic traps: overflow, shifts, division and array bounds. Null pointers are left to memory protection, which
// gives a better message.
std::string compile_for_here(const std::string& source, const WorkFolder& folder) {
  const fs::path library = folder.path() / fs::path(source).stem().concat(".so");
  run_compiler({compiler(), "-std=c11", "-O2", "-g", "-fPIC", "-shared", "-Wall", "-Wextra",
                "-fsanitize=undefined", "-fsanitize-undefined-trap-on-error", "-fno-sanitize=null",
                "-fno-delete-null-pointer-checks", "-I", with_header(folder).string(), source, "-o",
                library.string()},
               source, "");
  return library.string();
}

bool can_count() {
  return is_installed(kCrossCompiler) && is_installed(kEmulator) && is_installed("timeout");
}

// Without an FPU each floating-point operation calls a library function with an ABI name ("Run-time ABI for the Arm
// Architecture", 5.1.2).
bool uses_floating_point(const std::string& source, const WorkFolder& folder) {
  const fs::path object = folder.path() / "without_fpu.o";
  run_compiler({kCrossCompiler, "-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=soft", "-Os", "-std=c11",
                "-I", with_header(folder).string(), "-c", source, "-o", object.string()},
               source, " for a Cortex-M4");
  const std::vector<std::byte> bytes = read_bytes(object);
  const std::string_view names(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string_view kCalls[] = {"__aeabi_f",  "__aeabi_d",   "__aeabi_cf", "__aeabi_cd",
                                     "__aeabi_i2", "__aeabi_ui2", "__aeabi_l2", "__aeabi_ul2"};
  return std::ranges::any_of(kCalls, [&](auto call) { return names.find(call) != names.npos; });
}

std::uint32_t count_instructions(const std::string& source, const Try& one,
                                 const robosync_module& module, const WorkFolder& folder) {
  const fs::path program = folder.path() / "count_on_m4.c";
  const fs::path script = folder.path() / "count_on_m4.ld";
  const fs::path elf = folder.path() / "count_on_m4.elf";
  const fs::path out = folder.path() / "count_on_m4.out";
  write_text(program, counting_program_for(fs::path(source).stem().string(), one, module));
  write_text(script, kLinkerScript);
  const Command as_the_firmware = {kCrossCompiler,      "-mcpu=cortex-m4",     "-mthumb",
                                   "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard",    "-Os",
                                   "-std=c11",          "-ffunction-sections", "-fdata-sections"};
  run_compiler(with(as_the_firmware,
                    {"-I", with_header(folder).string(), "-nostartfiles", "-Wl,--gc-sections",
                     "-Wl,-T", script.string(), source, program.string(), "-o", elf.string()}),
               source, " for a Cortex-M4");
  const int exit = run_program(
      {"timeout", "60", kEmulator, "-M", "mps2-an386", "-icount", "shift=0", "-display", "none",
       "-monitor", "none", "-serial", "none", "-chardev", "file,id=said,path=" + out.string(),
       "-semihosting-config", "enable=on,target=native,chardev=said", "-kernel", elf.string()});
  if (exit != 0)
    throw Failure(Exit::program, fmt::format("{} does not end on an emulated Cortex-M4", source));
  return static_cast<std::uint32_t>(std::strtoul(read_text(out).c_str(), nullptr, 10));
}

}  // namespace robosync::tool
