// The passes in their order. Each collects what is wrong; the next runs if its input is usable.
#include "compiler/compiler.hpp"

#include <algorithm>
#include <array>

#include <sodium.h>

#include "compiler/codegen/image_writer.hpp"
#include "compiler/config/robot_reader.hpp"
#include "compiler/modules.hpp"
#include "compiler/sema/analyze.hpp"
#include "compiler/syntax/parser.hpp"

namespace robosync::compiler {
namespace {

// Names the program: the same source, configuration and modules, the same hash.
ProgramHash hash_of(std::string_view program, std::string_view configuration,
                    const std::vector<std::string_view>& modules) {
  const auto add = [](crypto_hash_sha256_state& state, std::string_view text) {
    crypto_hash_sha256_update(&state, reinterpret_cast<const unsigned char*>(text.data()),
                              text.size());
  };
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  add(state, program);
  constexpr std::string_view kBetween("\0", 1);  // so that text cannot move from one to the other
  add(state, kBetween);
  add(state, configuration);
  for (const std::string_view module : modules) {
    add(state, kBetween);
    add(state, module);
  }
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256_final(&state, digest.data());
  ProgramHash hash{};
  std::copy_n(digest.begin(), hash.size(), hash.begin());
  return hash;
}

// What robot.json says about lints: allow drops them, warn and deny set their level.
Diagnostics apply_lints(const Diagnostics& diagnostics, const Robot& robot) {
  Diagnostics result;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    const auto lint = robot.lints.find(diagnostic.code);
    const bool configured = lint != robot.lints.end();
    if (configured && lint->second == LintLevel::allow) continue;
    Diagnostic& copy = result.report(diagnostic.code, diagnostic.message);
    copy = diagnostic;
    if (configured) copy.level = lint->second == LintLevel::deny ? Level::error : Level::warning;
  }
  return result;
}

}  // namespace

Result compile(Input program, Input configuration, const Options& options) {
  Result result;
  const FileId program_file = result.sources.add(std::move(program.name), std::move(program.text));
  const FileId configuration_file =
      result.sources.add(std::move(configuration.name), std::move(configuration.text));
  Diagnostics& diagnostics = result.diagnostics;
  const ast::Program tree = parse(result.sources, program_file, diagnostics);
  const std::vector<Module> modules =
      load_modules(tree, result.sources, options.read_module, diagnostics);
  // What the readers had to leave out would be missed by name: better one true message than ten.
  const bool whole_tree = diagnostics.errors() == 0;
  const auto robot = read_robot(result.sources, configuration_file, diagnostics);
  std::optional<Program> resolved;
  if (robot && robot->complete && whole_tree) {
    Trees trees{&tree};
    for (const Module& module : modules)
      trees.push_back(module.tree.get());
    resolved = analyze(trees, *robot, result.sources, diagnostics);
    if (diagnostics.errors() == 0) result.tests = testing::plan_tests(trees, *robot, diagnostics);
  }
  if (robot) diagnostics = apply_lints(diagnostics, *robot);
  if (resolved && diagnostics.errors() == 0) {
    std::vector<std::string_view> texts;
    texts.reserve(modules.size());
    for (const Module& module : modules)
      texts.push_back(result.sources.file(module.file).text());
    const ProgramHash hash = hash_of(result.sources.file(program_file).text(),
                                     result.sources.file(configuration_file).text(), texts);
    result.image = write_image(*resolved, *robot, hash,
                               {.source_lines = options.source_lines, .optimize = options.optimize},
                               diagnostics);
  }
  diagnostics.finish();
  return result;
}

}  // namespace robosync::compiler
