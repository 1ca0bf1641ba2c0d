// Board profiles, from their JSON.
#include "compiler/config/boards.hpp"

#include <algorithm>

#include "compiler/config/fields.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/config/values.hpp"

namespace robosync::compiler {
namespace {

std::uint32_t read_number(Fields& fields, std::string_view key, std::string_view what,
                          Diagnostics& diagnostics) {
  const auto* value = fields.require(key, what);
  if (value == nullptr) return 0;
  return static_cast<std::uint32_t>(read_whole(*value, 0, UINT32_MAX, diagnostics).value_or(0));
}

}  // namespace

Board read_board(const BoardText& text, Diagnostics& diagnostics) {
  SourceMap sources;
  const FileId file = sources.add(std::string(text.name), std::string(text.json));
  Board board;
  board.name = text.name;
  const auto tree = json::read(sources, file, diagnostics);
  if (!tree) return board;
  Fields fields(*tree, Object::board, diagnostics);
  board.step_budget = read_number(fields, "step_budget", "a board", diagnostics);
  const auto* arena = fields.require("arena", "a board");
  if (arena == nullptr) return board;
  Fields of_arena(*arena, Object::arena, diagnostics);
  board.arena_begin = read_number(of_arena, "begin", "an arena", diagnostics);
  board.arena_bytes = read_number(of_arena, "bytes", "an arena", diagnostics);
  return board;
}

std::vector<std::string_view> board_names() {
  std::vector<std::string_view> names;
  names.reserve(board_texts().size());
  for (const BoardText& text : board_texts())
    names.push_back(text.name);
  return names;
}

Board board_at(std::size_t place) {
  Diagnostics diagnostics;  // the tests hold the built-in ones to none
  return read_board(board_texts()[place], diagnostics);
}

Board default_board() {
  const auto names = board_names();
  return board_at(
      static_cast<std::size_t>(std::ranges::find(names, kDefaultBoard) - names.begin()));
}

}  // namespace robosync::compiler
