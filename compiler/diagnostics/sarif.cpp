// See sarif.hpp.
#include "compiler/diagnostics/sarif.hpp"

#include "compiler/source/ascii.hpp"
#include "compiler/source/json.hpp"

namespace robosync::compiler {

namespace {

// A path as a relative or absolute URI reference; other characters than letters, digits and "-._~/" become %XX.
std::string uri_of(std::string_view path) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  constexpr std::string_view plain = "-._~/";
  std::string uri = path.starts_with('/') ? "file://" : "";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (ascii::is_letter(c) || ('0' <= c && c <= '9') || plain.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      uri += '%';
      uri += digits[byte / 16];
      uri += digits[byte % 16];
    }
  }
  return uri;
}

Json region(Span span, const SourceFile& file) {
  const Position begin = file.position(span.begin);
  const Position end = file.position(std::max(span.begin, span.end));
  return {{"startLine", begin.line},
          {"startColumn", begin.column},
          {"endLine", end.line},
          {"endColumn", end.column}};
}

Json artifact(const SourceFile& file) {
  return {{"uri", uri_of(file.name())}};
}

Json location(const Label& label, const SourceMap& sources) {
  const SourceFile& file = sources.file(label.span.file);
  Json place = {{"physicalLocation",
                 {{"artifactLocation", artifact(file)}, {"region", region(label.span, file)}}}};
  if (!label.text.empty()) place["message"] = {{"text", label.text}};
  return place;
}

Json to_json(const Fix& fix, const SourceMap& sources) {
  const SourceFile& file = sources.file(fix.span.file);
  const Json replacement = {{"deletedRegion", region(fix.span, file)},
                            {"insertedContent", {{"text", fix.replacement}}}};
  return {{"description", {{"text", std::string(applicability_name(fix.applicability))}}},
          {"artifactChanges", Json::array({{{"artifactLocation", artifact(file)},
                                            {"replacements", Json::array({replacement})}}})}};
}

// The message followed by its help: SARIF has no field for help that is not a fix.
std::string message_of(const Diagnostic& diagnostic) {
  std::string text = diagnostic.message;
  for (const std::string& help : diagnostic.help)
    text += "\n" + help;
  return text;
}

Json result_of(const Diagnostic& diagnostic, const SourceMap& sources) {
  Json result = {{"ruleId", code_name(diagnostic.code)},
                 {"ruleIndex", static_cast<std::size_t>(diagnostic.code)},
                 {"level", level_name(diagnostic.level)},
                 {"message", {{"text", message_of(diagnostic)}}},
                 {"locations", Json::array()}};
  for (const Label& label : diagnostic.labels)
    result[label.primary ? "locations" : "relatedLocations"].push_back(location(label, sources));
  for (const Fix& fix : diagnostic.fixes)
    result["fixes"].push_back(to_json(fix, sources));
  return result;
}

Json rules() {
  Json all = Json::array();
  for (const Code code : all_codes())
    all.push_back({{"id", code_name(code)},
                   {"shortDescription", {{"text", code_title(code)}}},
                   {"help", {{"text", "rsc explain " + std::string(code_name(code))}}},
                   {"defaultConfiguration", {{"level", level_name(default_level(code))}}}});
  return all;
}

// Of rsc, where it could not do all of its work.
Json invocation(const std::vector<std::string>& notifications) {
  Json all = Json::array();
  for (const std::string& notification : notifications)
    all.push_back(read_json(notification));
  return {{"executionSuccessful", false}, {"toolExecutionNotifications", all}};
}

}  // namespace

void SarifLog::add(const Diagnostics& diagnostics, const SourceMap& sources) {
  for (const Diagnostic& diagnostic : diagnostics.all())
    results_.push_back(json_text(result_of(diagnostic, sources)));
}

void SarifLog::add_unchecked(std::string_view path, std::string_view why) {
  const Json place = {{"physicalLocation", {{"artifactLocation", {{"uri", uri_of(path)}}}}}};
  unchecked_.push_back(json_text(Json{{"level", "error"},
                                      {"message", {{"text", std::string(why)}}},
                                      {"locations", Json::array({place})}}));
}

std::string SarifLog::text() const {
  Json run = {{"tool", {{"driver", {{"name", "rsc"}, {"version", version_}, {"rules", rules()}}}}},
              {"columnKind", "unicodeCodePoints"},
              {"results", Json::array()}};
  for (const std::string& result : results_)
    run["results"].push_back(read_json(result));
  if (!unchecked_.empty()) run["invocations"] = Json::array({invocation(unchecked_)});
  const Json log = {{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                    {"version", "2.1.0"},
                    {"runs", Json::array({run})}};
  return json_text(log) + "\n";
}

}  // namespace robosync::compiler
