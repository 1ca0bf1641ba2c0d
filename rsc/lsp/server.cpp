#include "rsc/lsp/server.hpp"

#include <algorithm>
#include <utility>

#include "rsc/json.hpp"
#include "rsc/lsp/answers.hpp"

namespace robosync::tool::lsp {
namespace {

const Json kNone = nullptr;

const Json& member(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? kNone : *found;
}

bool is_id(const Json& id) {
  return id.is_string() || id.is_number_integer();
}

// Is the value at this path of keys true?
bool says(const Json& capabilities, std::initializer_list<const char*> keys) {
  const Json* value = &capabilities;
  for (const char* const key : keys) {
    if (!value->is_object()) return false;
    value = &member(*value, key);
  }
  return value->is_boolean() && value->get<bool>();
}

// Not the words of the JSON library, which nobody who wrote the message knows.
std::string wrong_parameters(const std::string& method) {
  return "the parameters of `" + method +
         "` lack something, or something in them is of a wrong kind";
}

bool lists(const Json& list, std::string_view word) {
  return list.is_array() && std::ranges::any_of(list, [&](const Json& one) { return one == word; });
}

}  // namespace

// ---- messages

void Server::send(const Json& message) {
  // Text quoted from a file on disk may not be UTF-8.
  send_(json_text(message));
}

void Server::send_error(const Json& id, int code, const std::string& why) {
  send({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", why}}}});
}

void Server::complain(int code, const std::string& why) {
  send_error(nullptr, code, why);
}

void Server::receive(const std::string& message) {
  Json read = read_json(message);
  if (read.is_discarded()) return complain(error::parse_error, "this is not JSON");
  if (!read.is_object()) return complain(error::invalid_request, "a message is an object");
  if (!take_back(read)) queue_.push_back(std::move(read));
}

// `$/cancelRequest`: a request that is still queued is dropped. True for every such message.
bool Server::take_back(const Json& message) {
  if (member(message, "method") != "$/cancelRequest") return false;
  const Json& params = member(message, "params");
  const Json& id = params.is_object() ? member(params, "id") : kNone;
  const auto found = std::ranges::find_if(queue_, [&](const Json& waiting) {
    return is_id(id) && member(waiting, "id") == id && waiting.contains("method");
  });
  if (found == queue_.end()) return true;
  queue_.erase(found);
  send_error(id, error::request_cancelled, "the request was cancelled");
  return true;
}

bool Server::step() {
  if (queue_.empty()) return false;
  const Json message = std::move(queue_.front());
  queue_.pop_front();
  const Json& method = member(message, "method");
  if (message.contains("id") && method.is_string()) {
    answer(message);
  } else if (method.is_string()) {
    notify(method.get<std::string>(), member(message, "params"));
  } else if (!message.contains("result") && !message.contains("error")) {
    const Json& id = member(message, "id");
    send_error(is_id(id) ? id : kNone, error::invalid_request, "a message has a method");
  }
  return true;
}

// Answers a request that cannot be handled now with an error, and returns the reason.
std::optional<std::string> Server::refuse(const std::string& method, const Json& id) {
  const auto no = [&](int code, std::string why) {
    send_error(id, code, why);
    return std::optional(std::move(why));
  };
  if (phase_ == Phase::starting && method != "initialize")
    return no(error::not_initialized, "`initialize` comes first");
  if (phase_ == Phase::up && method == "initialize")
    return no(error::invalid_request, "`initialize` comes once");
  if (phase_ == Phase::down) return no(error::invalid_request, "the server has been shut down");
  if (!requests().contains(method))
    return no(error::method_not_found, "there is no request `" + method + "`");
  return std::nullopt;
}

void Server::answer(const Json& message) {
  const std::string method = member(message, "method").get<std::string>();
  const Json& id = member(message, "id");
  if (!is_id(id))
    return complain(error::invalid_request, "the id of a request is a number or a text");
  if (refuse(method, id)) return;
  try {
    Json result = requests().at(method)(*this, member(message, "params"));
    send({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
  } catch (const Refusal& refusal) {
    send_error(id, error::request_failed, refusal.what());
  } catch (const Json::exception&) {
    send_error(id, error::invalid_params, wrong_parameters(method));
  } catch (const std::exception& failure) {
    send_error(id, error::internal_error, failure.what());
  }
}

void Server::notify(const std::string& method, const Json& params) {
  if (method == "exit") {
    exit_code_ = phase_ == Phase::down ? 0 : 1;
    return;
  }
  const auto found = notifications().find(method);
  if (phase_ != Phase::up || found == notifications().end()) return;
  try {
    (void)found->second(*this, params);
  } catch (const Json::exception&) {
    send({{"jsonrpc", "2.0"},
          {"method", "window/logMessage"},
          {"params", {{"type", 1}, {"message", wrong_parameters(method)}}}});
  }
}

const std::map<std::string_view, Server::Handler>& Server::requests() {
  static const auto desk = [](Server& server) { return Desk{server.workspace_, server.client_}; };
  static const std::map<std::string_view, Handler> all = {
      {"initialize", [](Server& s, const Json& p) { return s.initialize(p); }},
      {"shutdown",
       [](Server& s, const Json&) {
         s.phase_ = Phase::down;
         return Json();
       }},
      {"textDocument/formatting", [](Server& s, const Json& p) { return formatting(desk(s), p); }},
      {"textDocument/codeAction",
       [](Server& s, const Json& p) { return code_actions(desk(s), p); }},
      {"textDocument/completion", [](Server& s, const Json& p) { return completion(desk(s), p); }},
      {"textDocument/hover", [](Server& s, const Json& p) { return hover(desk(s), p); }},
      {"textDocument/definition", [](Server& s, const Json& p) { return definition(desk(s), p); }},
      {"textDocument/references", [](Server& s, const Json& p) { return references(desk(s), p); }},
      {"textDocument/documentHighlight",
       [](Server& s, const Json& p) { return highlights(desk(s), p); }},
      {"textDocument/prepareRename",
       [](Server& s, const Json& p) { return prepare_rename(desk(s), p); }},
      {"textDocument/rename", [](Server& s, const Json& p) { return rename(desk(s), p); }},
      {"textDocument/documentSymbol",
       [](Server& s, const Json& p) { return document_symbols(desk(s), p); }},
      {"textDocument/semanticTokens/full",
       [](Server& s, const Json& p) { return semantic_tokens(desk(s), p); }},
      {"textDocument/foldingRange",
       [](Server& s, const Json& p) { return folding_ranges(desk(s), p); }},
      {"textDocument/inlayHint", [](Server& s, const Json& p) { return inlay_hints(desk(s), p); }},
      {"textDocument/signatureHelp",
       [](Server& s, const Json& p) { return signature_help(desk(s), p); }},
  };
  return all;
}

const std::map<std::string_view, Server::Handler>& Server::notifications() {
  static const std::map<std::string_view, Handler> all = {
      {"initialized", [](Server& s, const Json&) { return s.initialized(), Json(); }},
      {"textDocument/didOpen", [](Server& s, const Json& p) { return s.did_open(p), Json(); }},
      {"textDocument/didChange", [](Server& s, const Json& p) { return s.did_change(p), Json(); }},
      {"textDocument/didClose", [](Server& s, const Json& p) { return s.did_close(p), Json(); }},
      {"workspace/didChangeWatchedFiles",
       [](Server& s, const Json&) {
         s.workspace_.forget();
         s.dirty_ = true;
         return Json();
       }},
  };
  return all;
}

// ---- the beginning

Json Server::initialize(const Json& params) {
  const Json& can = member(params, "capabilities");
  client_.related_information =
      says(can, {"textDocument", "publishDiagnostics", "relatedInformation"});
  client_.watches_files = says(can, {"workspace", "didChangeWatchedFiles", "dynamicRegistration"});
  client_.nested_symbols =
      says(can, {"textDocument", "documentSymbol", "hierarchicalDocumentSymbolSupport"});
  const Json empty = Json::object();
  const Json known = can.is_object() ? can : empty;
  const auto list = [&](const char* pointer) {
    return known.value(Json::json_pointer(pointer), Json());
  };
  client_.markdown = lists(list("/textDocument/hover/contentFormat"), "markdown");
  const bool utf8 = lists(list("/general/positionEncodings"), "utf-8");
  workspace_.set_encoding(utf8 ? Encoding::utf8 : Encoding::utf16);
  phase_ = Phase::up;
  return {{"serverInfo", {{"name", "rsc"}, {"version", ROBOSYNC_VERSION}}},
          {"capabilities",
           {{"positionEncoding", utf8 ? "utf-8" : "utf-16"},
            {"textDocumentSync", {{"openClose", true}, {"change", 2}}},
            {"documentFormattingProvider", true},
            {"codeActionProvider", {{"codeActionKinds", {"quickfix", "source.fixAll"}}}},
            {"completionProvider", {{"triggerCharacters", {" ", "\""}}}},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"referencesProvider", true},
            {"documentHighlightProvider", true},
            {"renameProvider", {{"prepareProvider", true}}},
            {"documentSymbolProvider", true},
            {"semanticTokensProvider", {{"legend", colour_legend()}, {"full", true}}},
            {"foldingRangeProvider", true},
            {"inlayHintProvider", true},
            {"signatureHelpProvider", {{"triggerCharacters", {" "}}}}}}};
}

// Files that change outside the editor, such as a robot.json written by another program.
void Server::initialized() {
  if (!client_.watches_files) return;
  Json watchers = Json::array({{{"globPattern", "**/*.rsl"}}, {{"globPattern", "**/*.json"}}});
  send({{"jsonrpc", "2.0"},
        {"id", "watch files"},
        {"method", "client/registerCapability"},
        {"params",
         {{"registrations",
           {{{"id", "files"},
             {"method", "workspace/didChangeWatchedFiles"},
             {"registerOptions", {{"watchers", std::move(watchers)}}}}}}}}});
}

// ---- documents

void Server::did_open(const Json& params) {
  const Json& document = params.at("textDocument");
  workspace_.open(document.at("uri").get<std::string>(), document.at("version").get<std::int64_t>(),
                  document.at("text").get<std::string>());
  dirty_ = true;
}

void Server::did_change(const Json& params) {
  const Json& document = params.at("textDocument");
  std::vector<Change> changes;
  for (const Json& one : params.at("contentChanges")) {
    Change change;
    change.text = one.at("text").get<std::string>();
    if (const Json& range = member(one, "range"); range.is_object()) {
      change.whole = false;
      change.begin = place_in(range.at("start"));
      change.end = place_in(range.at("end"));
    }
    changes.push_back(std::move(change));
  }
  dirty_ = workspace_.change(document.at("uri").get<std::string>(),
                             document.at("version").get<std::int64_t>(), changes) ||
           dirty_;
}

void Server::did_close(const Json& params) {
  dirty_ = workspace_.close(address_in(params)) || dirty_;
}

// ---- diagnostics

void Server::idle() {
  dirty_ = false;
  Findings findings;
  for (const auto& [name, document] : workspace_.documents())
    findings[document.uri];
  for (const Checked* const checked : workspace_.checked_programs())
    add_findings(*checked, workspace_, client_, findings);
  for (const auto& [uri, shown] : shown_)
    findings[uri];  // an empty list clears old diagnostics
  for (const auto& [uri, diagnostics] : findings)
    publish(uri, diagnostics);
}

void Server::publish(const std::string& uri, const std::vector<Json>& diagnostics) {
  const Document* const document = workspace_.find(uri);
  Shown now{diagnostics, document != nullptr ? std::optional(document->version) : std::nullopt};
  const auto known = shown_.find(uri);
  if (known != shown_.end() && known->second.diagnostics == now.diagnostics &&
      known->second.version == now.version)
    return;
  Json params = {{"uri", uri}, {"diagnostics", diagnostics}};
  if (now.version) params["version"] = *now.version;
  send({{"jsonrpc", "2.0"},
        {"method", "textDocument/publishDiagnostics"},
        {"params", std::move(params)}});
  if (document == nullptr && diagnostics.empty())
    shown_.erase(uri);
  else
    shown_.insert_or_assign(uri, std::move(now));
}

}  // namespace robosync::tool::lsp
