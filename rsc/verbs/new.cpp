// rsc new FOLDER [--template NAME]
#include <filesystem>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/output.hpp"
#include "rsc/templates.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string folder;
  std::size_t robot = 0;  // in templates()
};

void refuse_what_is_there(const fs::path& folder, const Template& robot) {
  std::error_code error;
  for (const TemplateFile& file : robot.files) {
    const fs::path path = folder / file.name;
    if (fs::symlink_status(path, error).type() == fs::file_type::not_found || error) continue;
    throw Failure(
        Exit::outside,
        fmt::format("{} is there already, and `rsc new` writes over nothing: name a new folder",
                    path.string()));
  }
}

// All of it, or nothing: what was written goes again where the rest cannot be.
void write_robot(const fs::path& folder, const Template& robot) {
  std::error_code error;
  const bool made = fs::create_directories(folder, error);
  if (error)
    throw Failure(Exit::outside,
                  fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
  std::vector<fs::path> written;
  try {
    for (const TemplateFile& file : robot.files) {
      const fs::path path = folder / file.name;
      write_output(path, std::as_bytes(std::span(file.text)));
      written.push_back(path);
    }
  } catch (const Failure&) {
    for (const fs::path& path : written)
      fs::remove(path, error);
    if (made) fs::remove(folder, error);
    throw;
  }
}

std::string_view purpose_of(const TemplateFile& file, const Template& robot) {
  if (file.name == "robot.rsl") return "what it does, and tests of that";
  if (file.name == "robot.json") return "what it is made of, and how that is wired";
  return file.name == robot.scenario ? "what happens to it in `rsc run`" : "recorded readings";
}

void report(const std::string& folder, const Template& robot) {
  std::cout << fmt::format("{} is a robot that {}.\n", folder, robot.summary);
  for (const TemplateFile& file : robot.files)
    std::cout << fmt::format("  {:<16}{}\n", file.name, purpose_of(file, robot));
  std::cout << "Go on with\n";
  if (fs::path(folder).lexically_normal() != ".") std::cout << fmt::format("  cd {}\n", folder);
  std::cout << fmt::format(
      "  rsc check robot.rsl\n  rsc run robot.rsl --scenario {}\n  rsc test robot.rsl\n",
      robot.scenario);
}

void make_robot(const NewOptions& options) {
  const Template& robot = templates()[options.robot];
  refuse_what_is_there(options.folder, robot);
  write_robot(options.folder, robot);
  report(options.folder, robot);
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
  options.argument("FOLDER", asked->folder, "where its files go; it is made when it is not there",
                   Options::Need::required);
  std::vector<std::string> names;
  for (const Template& robot : templates())
    names.emplace_back(robot.name);
  options.choice(
      "--template", names, [asked](std::size_t index) { asked->robot = index; },
      list_of_templates());
  options.runs([asked] { make_robot(*asked); });
}

}  // namespace robosync::tool
