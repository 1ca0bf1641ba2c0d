// outline_configuration().
#include <algorithm>
#include <array>
#include <utility>

#include "compiler/query/configuration.hpp"
#include "compiler/query/configuration_scan.hpp"

namespace robosync::compiler::query {
namespace {

OutlineKind kind_of(const Piece& piece) {
  if (piece.depth == 1) return OutlineKind::block;
  if (!piece.spot.shape.itself) return OutlineKind::list;
  switch (*piece.spot.shape.itself) {
    case Object::behavior:
      return OutlineKind::behavior;
    case Object::algorithm:
      return OutlineKind::define;
    case Object::channel:
      return OutlineKind::channel;
    default:
      return OutlineKind::part;
  }
}

OutlineItem item_of(const Piece& piece, std::string_view text, FileId file) {
  const auto place = [&](std::string_view part) {
    return static_cast<std::uint32_t>(part.data() - text.data());
  };
  std::string_view name = piece.outside.is_list ? piece.name : piece.outside.key;
  const auto begin =
      piece.outside.is_list ? static_cast<std::uint32_t>(piece.begin) : place(name) - 1;
  const bool has_name = name.find_first_not_of(' ') != std::string_view::npos;
  if (!has_name) name = text.substr(piece.begin, 1);
  return {has_name ? std::string(name) : "?",
          kind_of(piece),
          {file, begin, static_cast<std::uint32_t>(piece.end)},
          {file, place(name), place(name) + static_cast<std::uint32_t>(name.size())},
          {}};
}

}  // namespace

std::vector<OutlineItem> outline_configuration(const SourceFile& source, FileId file) {
  Scan scan(source.text(), std::string_view::npos);
  scan.run();
  constexpr std::size_t kDeepest = 3;                          // a channel
  std::array<std::vector<OutlineItem>, kDeepest + 2> waiting;  // by depth, for what they are in
  for (const Piece& piece : scan.pieces()) {
    const std::size_t depth = std::min(piece.depth, kDeepest);
    OutlineItem item = item_of(piece, source.text(), file);
    item.inside.swap(waiting.at(depth + 1));
    // What was in an object that is no item itself, before this one.
    std::erase_if(item.inside,
                  [&](const OutlineItem& one) { return one.span.begin < item.span.begin; });
    waiting.at(depth).push_back(std::move(item));
  }
  return std::move(waiting[1]);
}

}  // namespace robosync::compiler::query
