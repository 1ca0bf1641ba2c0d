// The full screen of `rsc monitor`: shows what a watch sees, and has keys to control the robot.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <sstream>
#include <string>

#include "rsc/device/viewer.hpp"
#include "rsc/screen/model.hpp"
#include "rsc/screen/terminal.hpp"

namespace robosync::tool::screen {

class Screen final : public Viewer {
public:
  Screen(std::unique_ptr<Terminal> terminal, const std::string& port);
  ~Screen() override;

  void board(const link::HelloReply& board, const Past& past,
             const std::vector<OnBus>& silent) override;
  void program(const TraceNames& names, std::span<const std::byte> image) override;
  void current(const Current& current, const TraceNames& names) override;
  void event(const link::Event& event, const TraceNames& names) override;
  void log(const std::string& text) override;
  void fault(const link::Fault& fault) override;
  void threads(ThreadList now, ThreadList before) override;
  void status(const link::Status& status) override;
  void missed(const std::string& why) override;
  bool work(Session* session) override;

private:
  enum class Asks : std::uint8_t { nothing, filter, reading };

  bool take(int key, Session* session);
  bool take_command(int key, Session* session);
  void take_text(int key, Session* session);
  void force(const std::string& reading, Session* session);
  void act(Session* session, const std::string& done, const std::function<void(Client&)>& what);
  void say_errors();
  void draw();

  std::unique_ptr<Terminal> terminal_;
  Model model_;
  View view_;
  const vm::Image* image_ = nullptr;  // of the running program
  Asks asks_ = Asks::nothing;
  std::string typed_;
  std::ostringstream errors_;  // what is written to stderr meanwhile
  std::streambuf* stderr_before_;
  std::chrono::steady_clock::time_point next_draw_;
};

}  // namespace robosync::tool::screen
