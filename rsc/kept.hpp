// What `rsc run` keeps of a program's KEPT numbers from one run to the next, in a file that a person can read:
//   {"kept": {"visits": "3", "nearest": "35.5cm"}}
// May assume nothing of the file. Promises that one that is not such a file is never written to, and that numbers of
// other programs stay in it.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "link/events.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

class Kept {
public:
  // `file`: empty: STEM.kept.json beside the program, which is called `name`. `fresh`: the numbers begin as
  // written. Reads nothing when nothing is KEPT. Throws Failure (outside) when the file is another one,
  // or keeps a number in another dimension.
  Kept(const Program& program, const std::string& name, const std::string& file, bool fresh);

  const std::string& file() const { return file_; }
  // Puts the numbers into an image of the program, as if they were what it begins with.
  void put_into(std::vector<std::byte>& image) const;
  // Looks at what the program does.
  void see(const link::Event& event);
  // Writes the numbers down. Throws Failure (outside).
  void write();

private:
  void read();
  void begin(std::size_t variable, const std::string& entry, const std::string& text);
  // In which the program writes the number; null: that is not known.
  [[nodiscard]] const compiler::Unit* unit_of(std::size_t variable) const;
  [[nodiscard]] std::string shown(std::size_t variable, vm::Value value) const;
  [[nodiscard]] std::string entry_of(std::size_t variable) const;

  const Program& program_;
  std::string file_;
  bool fresh_;
  nlohmann::ordered_json entries_ = nlohmann::ordered_json::object();  // of the file
  std::string text_;                                                   // of the file
  std::map<std::size_t, vm::Value> values_;  // of the KEPT numbers, by variable
};

}  // namespace robosync::tool
