// Diagnostics for programs: one JSON object for `--format json`. See render.hpp.

#include "compiler/diagnostics/render.hpp"
#include "compiler/source/json.hpp"

namespace robosync::compiler {

namespace {

Json place(Span span, const SourceMap& sources) {
  const SourceFile& file = sources.file(span.file);
  const Position begin = file.position(span.begin);
  const Position end = file.position(span.end < span.begin ? span.begin : span.end);
  return {{"file", file.name()},
          {"line", begin.line},
          {"column", begin.column},
          {"end_line", end.line},
          {"end_column", end.column}};
}

Json to_json(const Diagnostic& diagnostic, const SourceMap& sources) {
  Json labels = Json::array();
  for (const Label& label : diagnostic.labels) {
    Json entry = place(label.span, sources);
    entry["text"] = label.text;
    entry["primary"] = label.primary;
    labels.push_back(std::move(entry));
  }
  Json fixes = Json::array();
  for (const Fix& fix : diagnostic.fixes) {
    Json entry = place(fix.span, sources);
    entry["replacement"] = fix.replacement;
    entry["applicability"] = applicability_name(fix.applicability);
    fixes.push_back(std::move(entry));
  }
  return {{"code", code_name(diagnostic.code)},
          {"level", level_name(diagnostic.level)},
          {"message", diagnostic.message},
          {"labels", std::move(labels)},
          {"help", diagnostic.help},
          {"fixes", std::move(fixes)}};
}

}  // namespace

std::string render_json(const Diagnostics& diagnostics, const SourceMap& sources) {
  Json all = Json::array();
  for (const Diagnostic& diagnostic : diagnostics.all())
    all.push_back(to_json(diagnostic, sources));
  const Json result = {{"diagnostics", std::move(all)},
                       {"errors", diagnostics.errors()},
                       {"warnings", diagnostics.warnings()}};
  // Messages quote the source, which may not be valid UTF-8.
  return json_text(result) + "\n";
}

}  // namespace robosync::compiler
