// The language server without I/O: messages in, messages out, in order. It has no clock: what waits until the editor is
// quiet is done in idle().
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "rsc/lsp/convert.hpp"
#include "rsc/lsp/workspace.hpp"

namespace robosync::tool::lsp {

// Error codes of JSON-RPC and of the protocol.
namespace error {
inline constexpr int parse_error = -32700;
inline constexpr int invalid_request = -32600;
inline constexpr int method_not_found = -32601;
inline constexpr int invalid_params = -32602;
inline constexpr int internal_error = -32603;
inline constexpr int not_initialized = -32002;
inline constexpr int request_failed = -32803;
inline constexpr int request_cancelled = -32800;
}  // namespace error

class Server {
public:
  using Send = std::function<void(const std::string& message)>;
  explicit Server(Send send) : send_(std::move(send)) {}

  // Queues a message for step(). A cancellation is handled immediately.
  void receive(const std::string& message);
  // Reports a message that could not be read, and why.
  void complain(int code, const std::string& why);
  // The number of messages that wait for step().
  [[nodiscard]] std::size_t waiting() const { return queue_.size(); }
  // Answers the oldest message. False if there is none.
  bool step();
  // True if idle() has something to do.
  [[nodiscard]] bool is_dirty() const { return dirty_; }
  // Checks all programs again, and tells the editor what changed.
  void idle();
  // Set once the editor has asked the server to exit.
  [[nodiscard]] std::optional<int> exit_code() const { return exit_code_; }
  // The exit code if the line is closed instead; that is not an error before `initialize` and after `shutdown`.
  [[nodiscard]] int exit_code_at_end() const { return phase_ == Phase::up ? 1 : 0; }

  [[nodiscard]] const Workspace& workspace() const { return workspace_; }

private:
  enum class Phase { starting, up, down };
  using Handler = Json (*)(Server&, const Json& params);

  static const std::map<std::string_view, Handler>& requests();
  static const std::map<std::string_view, Handler>& notifications();
  void answer(const Json& message);
  void notify(const std::string& method, const Json& params);
  [[nodiscard]] std::optional<std::string> refuse(const std::string& method, const Json& id);
  bool take_back(const Json& message);
  void send(const Json& message);
  void send_error(const Json& id, int code, const std::string& why);

  Json initialize(const Json& params);
  void initialized();
  void did_open(const Json& params);
  void did_change(const Json& params);
  void did_close(const Json& params);
  void publish(const std::string& uri, const std::vector<Json>& diagnostics);

  Send send_;
  Workspace workspace_;
  Client client_;
  Phase phase_ = Phase::starting;
  std::deque<Json> queue_;
  bool dirty_ = false;
  std::optional<int> exit_code_;
  struct Shown {
    std::vector<Json> diagnostics;
    std::optional<std::int64_t> version;
  };
  std::map<std::string, Shown> shown_;  // by URI
};

}  // namespace robosync::tool::lsp
