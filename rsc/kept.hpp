// Stores a program's KEPT numbers between runs of `rsc run`, in a file that people can read:
//   {"kept": {"visits": "3", "nearest": "35.5cm"}}
// The file is not trusted. A file of another kind is never written to, and numbers of other programs stay in the
// file.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "link/events.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

class Kept {
public:
  // `file`: if empty, STEM.kept.json next to the program `name`. `fresh`: the numbers start as written in the
  // program. Does not read the file if the program keeps nothing. Throws Failure (outside) if the file is of another
  // kind, or has a number in another dimension.
  Kept(const Program& program, const std::string& name, const std::string& file, bool fresh);

  const std::string& file() const { return file_; }
  // Writes the numbers into an image of the program as its initial values.
  void put_into(std::vector<std::byte>& image) const;
  // Follows the values as the program runs.
  void see(const link::Event& event);
  // Writes the numbers to the file. Throws Failure (outside).
  void write();

private:
  void read();
  void begin(std::size_t variable, const std::string& entry, const std::string& text);
  // The unit in which the program writes the number; null: not known.
  [[nodiscard]] const compiler::Unit* unit_of(std::size_t variable) const;
  [[nodiscard]] std::string shown(std::size_t variable, vm::Value value) const;
  [[nodiscard]] std::string entry_of(std::size_t variable) const;

  const Program& program_;
  std::string file_;
  bool fresh_;
  Json entries_ = Json::object();            // of the file
  std::string text_;                         // of the file
  std::map<std::size_t, vm::Value> values_;  // of the KEPT numbers, by variable
};

}  // namespace robosync::tool
