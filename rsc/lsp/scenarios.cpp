// See scenarios.hpp. The texts are not trusted: what is no scenario, or no recording, says nothing.
#include "rsc/lsp/scenarios.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "compiler/config/json_reader.hpp"
#include "compiler/source/ascii.hpp"
#include "rsc/failure.hpp"
#include "rsc/file_kind.hpp"
#include "rsc/files.hpp"

namespace robosync::tool::lsp {
namespace fs = std::filesystem;
namespace json = compiler::json;
using compiler::FileId, compiler::Span;

namespace {

constexpr std::size_t kMostFiles = 200;  // scenarios and recordings
constexpr std::string_view kSeparators = ",;\t";
constexpr std::string_view kAroundNames = " \"\r";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

FileKind kind_of(const fs::path& path, const Workspace& workspace) {
  const Document* const open = workspace.find(path);
  return open != nullptr ? kind_of_text(open->source.text()) : kind_of_file(path);
}

}  // namespace

class ScenarioReader {
public:
  ScenarioReader(const Workspace& workspace, Scenarios& into)
      : workspace_(workspace), sources_(into.sources_), said_(into.said_) {}

  void read(const fs::path& scenario) {
    const auto file = add(scenario);
    if (!file) return;
    compiler::Diagnostics ignored;
    const auto root = json::read(sources_, *file, ignored);
    const json::Value* const stimuli = root ? json::find(*root, "stimuli") : nullptr;
    if (stimuli == nullptr) return;
    for (const json::Value& stimulus : stimuli->items)
      read_stimulus(stimulus, scenario.parent_path());
  }

private:
  std::optional<FileId> add(const fs::path& path) {
    if (sources_.size() == kMostFiles) return std::nullopt;
    try {
      std::string text = workspace_.read(path);
      if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());  // as editors do
      return sources_.add(path.string(), std::move(text));
    } catch (const Failure&) {
      return std::nullopt;
    }
  }

  // Of a string: what is between its quotes. Empty if it is written with escapes, as no name is.
  [[nodiscard]] Span inside(const json::Value* value) const {
    if (value == nullptr || value->kind != json::Kind::string) return {};
    const Span span{value->span.file, value->span.begin + 1, value->span.end - 1};
    return sources_.text(span) == value->text ? span : Span{};
  }

  void read_stimulus(const json::Value& stimulus, const fs::path& folder) {
    const Span sensor = inside(json::find(stimulus, "sensor"));
    const Span channel = inside(json::find(stimulus, "channel"));
    const json::Value* const csv = json::find(stimulus, "csv");
    if (channel.end > 0)
      said_.push_back({sources_.text(sensor), sensor, channel});
    else
      add_dotted(sensor);
    if (csv != nullptr && csv->kind == json::Kind::string) read_columns(folder / csv->text, sensor);
  }

  // `touch`, `touch.LEVEL` or `touch LEVEL`
  void add_dotted(Span name) {
    const std::string_view text = sources_.text(name);
    const auto parted = static_cast<std::uint32_t>(std::min(text.find_first_of(". "), text.size()));
    Span sensor = name, channel = name;
    sensor.end = name.begin + parted;
    channel.begin = std::min(sensor.end + 1, name.end);
    said_.push_back({sources_.text(sensor), sensor, channel});
  }

  // The first line names the columns: channels of the sensor, or both if it is none.
  void read_columns(const fs::path& recording, Span sensor) {
    const auto file = add(recording.lexically_normal());
    if (!file) return;
    const std::string_view text = sources_.file(*file).text();
    const std::size_t last = std::min(text.find('\n'), text.size());
    for (std::size_t begin = 0; begin < last;) {
      const std::size_t end = std::min(text.find_first_of(kSeparators, begin), last);
      const Span name = name_in(*file, begin, end);
      if (sensor.end == 0)
        add_dotted(name);
      else
        said_.push_back({sources_.text(sensor), {}, name});
      begin = end + 1;
    }
  }

  // Without the unit, as in `LEVEL (cm)`.
  [[nodiscard]] Span name_in(FileId file, std::size_t begin, std::size_t end) const {
    const std::string_view cell = sources_.file(file).text().substr(begin, end - begin);
    const std::string_view name = cell.substr(0, cell.find('('));
    const std::size_t first = name.find_first_not_of(kAroundNames);
    if (first == std::string_view::npos) return {};
    const std::size_t last = name.find_last_not_of(kAroundNames) + 1;
    return {file, static_cast<std::uint32_t>(begin + first),
            static_cast<std::uint32_t>(begin + last)};
  }

  const Workspace& workspace_;
  compiler::SourceMap& sources_;
  std::vector<Scenarios::Said>& said_;
};

Scenarios::Scenarios(const Workspace& workspace, const fs::path& robot) {
  std::vector<fs::path> scenarios;
  for (const fs::path& file : files_in(robot.parent_path(), ".json")) {
    const FileKind kind = kind_of(file, workspace);
    if (kind == FileKind::configuration && file != robot) return;
    if (kind == FileKind::scenario) scenarios.push_back(file);
  }
  ScenarioReader reader(workspace, *this);
  for (const fs::path& scenario : scenarios)
    reader.read(scenario);
}

std::vector<Span> Scenarios::sensor(std::string_view name) const {
  std::vector<Span> places;
  for (const Said& said : said_)
    if (said.sensor.end > 0 && compiler::ascii::same(said.sensor_name, name))
      places.push_back(said.sensor);
  return places;
}

std::vector<Span> Scenarios::channel(std::string_view sensor, std::string_view name) const {
  std::vector<Span> places;
  for (const Said& said : said_)
    if (compiler::ascii::same(said.sensor_name, sensor) &&
        compiler::ascii::same(sources_.text(said.channel), name))
      places.push_back(said.channel);
  return places;
}

}  // namespace robosync::tool::lsp
