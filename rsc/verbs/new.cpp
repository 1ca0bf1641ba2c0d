// rsc new FOLDER [--template NAME] [--board NAME] | --module
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "compiler/config/boards.hpp"
#include "rsc/escaped.hpp"
#include "rsc/failure.hpp"
#include "rsc/fitted_template.hpp"
#include "rsc/modules/texts.hpp"
#include "rsc/output.hpp"
#include "rsc/templates.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string folder;
  std::optional<std::size_t> robot;  // in templates()
  std::string board;
  bool module = false;
};

struct NewFile {
  std::string name, text;
};
using NewFiles = std::vector<NewFile>;

NewFiles files_of(const Template& robot, const std::string& board) {
  NewFiles files;
  for (const TemplateFile& file : robot.files)
    files.push_back({std::string(file.name), text_on(board, file)});
  return files;
}

void refuse_what_is_there(const fs::path& folder, const NewFiles& files) {
  std::error_code error;
  for (const NewFile& file : files) {
    const fs::path path = folder / file.name;
    if (fs::symlink_status(path, error).type() == fs::file_type::not_found || error) continue;
    throw Failure(
        Exit::outside,
        fmt::format("{} already exists, and `rsc new` overwrites nothing: name a new folder",
                    path.string()));
  }
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Failure(Exit::outside,
                  fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
}

// All or nothing: if a file cannot be written, the others are removed.
void write_files(const fs::path& folder, const NewFiles& files) {
  std::error_code error;
  const bool is_new = !fs::exists(folder, error);
  make_folder(folder);
  std::vector<fs::path> written;
  try {
    for (const NewFile& file : files) {
      const fs::path path = folder / file.name;
      make_folder(path.parent_path());
      write_output(path, std::as_bytes(std::span(file.text)));
      written.push_back(path);
    }
  } catch (const Failure&) {
    for (const fs::path& path : written)
      fs::remove(path, error);
    if (is_new) fs::remove_all(folder, error);
    throw;
  }
}

std::string_view purpose_of(const TemplateFile& file, const Template& robot) {
  if (file.name == "robot.rsl") return "what it does, and its tests";
  if (file.name == "robot.json") return "its parts, and how they are wired";
  return file.name == robot.scenario ? "what happens to it in `rsc run`" : "recorded readings";
}

// Quoted so that a shell reads it as one word.
std::string in_shell(const std::string& folder) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+,:@%-";
  const std::string dash = folder.starts_with('-') ? "-- " : "";
  if (folder.find_first_not_of(kPlain) == std::string::npos) return dash + folder;
  return dash + "'" + escaped(folder, {{'\'', "'\\''"}}) + "'";
}

void report(const std::string& folder, const Template& robot) {
  std::cout << fmt::format("{} is a robot that {}.\n", folder, robot.summary);
  for (const TemplateFile& file : robot.files)
    std::cout << fmt::format("  {:<16}{}\n", file.name, purpose_of(file, robot));
  std::cout << "Next:\n";
  if (fs::path(folder).lexically_normal() != ".")
    std::cout << fmt::format("  cd {}\n", in_shell(folder));
  std::cout << fmt::format(
      "  rsc check robot.rsl\n  rsc run robot.rsl --scenario {}\n  rsc test robot.rsl\n",
      robot.scenario);
}

const Template& template_of(const NewOptions& options) {
  if (!options.robot && !options.board.empty()) return template_for(options.board);
  const Template& robot = templates()[options.robot.value_or(0)];
  if (!options.board.empty()) refuse_misfit(options.board, robot);
  return robot;
}

void make_robot(const NewOptions& options) {
  const Template& robot = template_of(options);
  const NewFiles files = files_of(robot, options.board);
  refuse_what_is_there(options.folder, files);
  write_files(options.folder, files);
  report(options.folder, robot);
}

// --- a module ---

// The module's name, which is also the prefix of its functions and its file name.
std::string module_name(const std::string& folder) {
  std::string name = fs::absolute(folder).lexically_normal().filename().string();
  if (name.empty())
    name = fs::absolute(folder).lexically_normal().parent_path().filename().string();
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  constexpr std::size_t kLongest = 40;
  if (name.front() < 'a' || name.front() > 'z' || name.size() > kLongest ||
      !std::ranges::all_of(name, fits))
    throw Failure(Exit::usage, fmt::format("a module is named after its folder, so `{}` must be a "
                                           "C name: lower-case letters, digits and _, {} at most",
                                           name, kLongest));
  return name;
}

NewFiles files_of_module(const std::string& name) {
  constexpr std::string_view kIts = "heartbeat";
  const auto named = [&](std::string text) {
    for (std::size_t at = text.find(kIts); at != std::string::npos;
         at = text.find(kIts, at + name.size()))
      text.replace(at, kIts.size(), name);
    return text;
  };
  NewFiles files;
  for (const TemplateFile& file : new_module_files())
    files.push_back({named(std::string(file.name)), named(std::string(file.text()))});
  return files;
}

void report_module(const std::string& folder, const std::string& name) {
  std::cout << fmt::format(
      "{0} is a robot with its own module, {1}, which for now counts the beats of a pulse sensor.\n"
      "  modules/{1}.c    the module: its inputs, its outputs, and how it describes itself\n"
      "  CMakeLists.txt   compiles it to modules/{1}.so\n"
      "  robot.json       names that file\n"
      "  robot.rsl        uses its output, and tests it\n"
      "  pulse.json       a made-up recording of a pulse, in pulse.csv\n"
      "Next:\n"
      "  cd {2}\n"
      "  rsc module check modules/{1}.c\n"
      "  cmake -B build && cmake --build build\n"
      "  rsc run robot.rsl --scenario pulse.json\n"
      "  rsc test robot.rsl\n",
      folder, name, in_shell(folder));
}

void make_module(const NewOptions& options) {
  if (options.robot || !options.board.empty())
    throw Failure(Exit::usage,
                  "a module comes with its own robot: give --module, or --template and --board");
  const std::string name = module_name(options.folder);
  const NewFiles files = files_of_module(name);
  refuse_what_is_there(options.folder, files);
  write_files(options.folder, files);
  report_module(options.folder, name);
}

std::string list_of_templates() {
  std::string text = "what the robot does:";
  for (const Template& robot : templates())
    text += fmt::format("\n{}: {}", robot.name, robot.summary);
  return text;
}

}  // namespace

void add_new(Options& options) {
  auto asked = std::make_shared<NewOptions>();
  options.argument("FOLDER", asked->folder, "where its files go; created if missing",
                   Options::Need::required);
  std::vector<std::string> names;
  for (const Template& robot : templates())
    names.emplace_back(robot.name);
  options.choice(
      "--template", names, [asked](std::size_t index) { asked->robot = index; },
      list_of_templates());
  const auto known = compiler::board_names();
  options.choice(
      "--board", {known.begin(), known.end()},
      [asked, known](std::size_t index) { asked->board = known[index]; },
      "the robot's board; without --template, a robot for it");
  options.flag("--module", asked->module,
               "a robot with its own algorithm module, named after the folder");
  options.runs([asked] { asked->module ? make_module(*asked) : make_robot(*asked); });
}

}  // namespace robosync::tool
