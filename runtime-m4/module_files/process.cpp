#include "runtime-m4/module_files/process.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <utility>

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "runtime-m4/module_files/confine.hpp"
#include "runtime-m4/module_files/worker.hpp"

namespace robosync::module_files {
namespace {

constexpr long kMostCpuMs = 1000;  // for one call, or for loading
constexpr long kMostMs = 30'000;   // … however busy the computer is
constexpr int kLookEveryMs = 50;
constexpr rlim_t kMostMemory = rlim_t{1} << 30;

// The same pages mapped twice, one process to write and the other to read.
template <class T>
struct Shared {
  T* written = nullptr;
  T* read = nullptr;
};

template <class T>
bool share(Shared<T>& shared) {
  const int file = memfd_create("robosync", MFD_CLOEXEC);
  if (file < 0) return false;
  const bool fits = ftruncate(file, sizeof(T)) == 0;
  void* const written = mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  void* const read = mmap(nullptr, sizeof(T), PROT_READ, MAP_SHARED, file, 0);
  close(file);
  shared = {static_cast<T*>(written), static_cast<T*>(read)};
  return fits && written != MAP_FAILED && read != MAP_FAILED;
}

long milliseconds(const timespec& time) {
  return time.tv_sec * 1000 + time.tv_nsec / 1'000'000;
}

long now_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return milliseconds(now);
}

long cpu_ms_of(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return milliseconds(time);
}

// Nothing of its parent's stays open, and it does not outlive its parent.
void settle_in(int line) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dup2(line, STDERR_FILENO + 1);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    close(standard);
  closefrom(STDERR_FILENO + 2);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
#if !defined(ROBOSYNC_SANITIZE)  // which reserves more than any computer has
  const rlimit memory{kMostMemory, kMostMemory};
  setrlimit(RLIMIT_AS, &memory);
#endif
}

std::string_view text_of(Doing doing) {
  switch (doing) {
    case Doing::loading:
      return "while it was loaded";
    case Doing::describing:
      return "while it described itself";
    case Doing::state_bytes:
      return "in state_bytes()";
    case Doing::scratch_bytes:
      return "in scratch_bytes()";
    case Doing::cost:
      return "in cost()";
    case Doing::init:
      return "in init()";
    case Doing::process:
      return "in process()";
  }
  return "";
}

std::string text_of(Came came, const std::string& name) {
  switch (came) {
    case Came::no_function:
      return "it has no function " + name + "_describe(); a module is called like its file";
    case Came::other_interface:
      return "it is made for another version of robosync_module.h than " +
             std::to_string(ROBOSYNC_ABI) + ": compile it again";
    case Came::incomplete:
      return "it does not describe itself completely: something is NULL that must not be";
    case Came::too_many:
      return "it has more inputs, outputs, parameters or words than a module may have";
    case Came::not_confined:
      return "this computer cannot confine it, so it was not run";
    default:
      return "";
  }
}

std::string text_of_fault(Came came) {
  switch (came) {
    case Came::beyond_state:
      return "it touched memory beyond its state";
    case Came::beyond_scratch:
      return "it touched memory beyond its scratch";
    case Came::beyond_outputs:
      return "it touched memory beyond its outputs";
    case Came::into_inputs:
      return "it wrote into its inputs or parameters";
    case Came::into_statics:
      return "it wrote to a static variable";
    case Came::elsewhere:
      return "it touched memory that is not its own";
    case Came::not_arithmetic:
      return "it divided by zero, overflowed, or did something else that C does not define";
    default:
      return "it ended its process";
  }
}

template <std::size_t kBytes>
std::string text_of(const std::array<char, kBytes>& text) {
  return {text.begin(), std::find(text.begin(), text.end(), '\0')};
}

}  // namespace

Process::Process(const std::string& path) : name_(std::filesystem::path(path).stem().string()) {
  start(std::filesystem::absolute(path).string());
  if (!trouble_.empty() || !await()) return;
  described_ = reply_->described;
  const auto end_text = [](Name& name) { name.back() = 0; };
  end_text(described_.name);
  std::ranges::for_each(described_.input_names, end_text);
  std::ranges::for_each(described_.words, end_text);
  std::ranges::for_each(described_.parameter_names, end_text);
  for (DescribedOutput& output : described_.output)
    end_text(output.name);
}

Process::~Process() {
  give_up("");
  if (request_ != nullptr) munmap(request_, sizeof *request_);
  if (reply_ != nullptr) munmap(const_cast<Reply*>(reply_), sizeof *reply_);
}

void Process::start(const std::string& path) {
  Shared<Request> request;
  Shared<Reply> reply;
  int lines[2] = {-1, -1};
  if (!share(request) || !share(reply) ||
      socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, lines) != 0)
    return give_up("this computer has no memory left for it");
  request_ = request.written;
  reply_ = reply.read;
  child_ = fork();
  if (child_ == 0) {
    settle_in(lines[1]);
    munmap(request.written, sizeof(Request));
    work(path, name_, STDERR_FILENO + 1, *request.read, *reply.written);
  }
  close(lines[1]);
  line_ = lines[0];
  munmap(request.read, sizeof(Request));
  munmap(reply.written, sizeof(Reply));
  if (child_ < 0) give_up("this computer has no process left for it");
}

void Process::give_up(std::string why) {
  trouble_ = std::move(why);
  if (line_ >= 0) close(line_);
  line_ = -1;
  if (child_ <= 0) return;
  kill(child_, SIGKILL);
  while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
}

bool Process::takes_too_long(long began_ms) const {
  return cpu_ms_of(child_) - cpu_ms_ > kMostCpuMs || now_ms() - began_ms > kMostMs;
}

// Waits for the answer. The process cannot sleep, so one that does not end uses up its time.
bool Process::await() {
  const long began_ms = now_ms();
  pollfd line{line_, POLLIN, 0};
  while (true) {
    const int ready = poll(&line, 1, kLookEveryMs);
    if (ready == 0 && takes_too_long(began_ms)) {
      const std::string where(text_of(reply_->doing));
      give_up("it did not come to an end within a second, " + where);
      return false;
    }
    if (ready <= 0) continue;
    char answer = 0;
    if (read(line_, &answer, 1) == 1) return true;
    say_what_happened();
    return false;
  }
}

// Its line is closed, so it ends now. If it does not, it is killed.
int Process::status_of_ended() {
  int status = 0;
  for (long waited = 0; waited < kMostCpuMs; waited += kLookEveryMs) {
    if (waitpid(child_, &status, WNOHANG) == child_) {
      child_ = -1;
      return status;
    }
    poll(nullptr, 0, kLookEveryMs / 10);
  }
  return status;
}

void Process::say_what_happened() {
  const int status = status_of_ended();
  const Came came = reply_->came;
  std::string why = text_of(came, name_);
  if (came == Came::not_loaded) why = "it cannot be loaded: " + text_of(reply_->text);
  if (!why.empty()) return give_up(std::move(why));
  const bool forbidden = WIFSIGNALED(status) && WTERMSIG(status) == kForbidden;
  why = forbidden ? "it called the operating system" : text_of_fault(came);
  give_up(why + ", " + std::string(text_of(reply_->doing)));
}

bool Process::ask(Call call) {
  if (!trouble_.empty()) return false;
  request_->call = call;
  cpu_ms_ = cpu_ms_of(child_);
  const char asked = 1;
  if (send(line_, &asked, 1, MSG_NOSIGNAL) == 1) return await();
  say_what_happened();
  return false;
}

bool Process::measure(const Config& config, Sizes& sizes) {
  has_measured_ = false;
  if (!know_sizes(config)) return false;
  sizes = sizes_;
  return true;
}

bool Process::know_sizes(const Config& config) {
  if (has_measured_ && measured_ == config) return trouble_.empty();
  request_->config = config;
  if (!ask(Call::sizes)) return false;
  measured_ = config;
  sizes_ = reply_->sizes;
  has_measured_ = true;
  return true;
}

bool Process::init(const Config& config, std::uint32_t period_ms, State& state) {
  if (!know_sizes(config)) return false;
  request_->config = config;
  request_->period_ms = period_ms;
  request_->state = state;
  if (!ask(Call::init)) return false;
  state = reply_->state;
  return true;
}

bool Process::process(const Config& config, const Inputs& inputs, State& state, Outputs& outputs,
                      std::uint32_t& changed, std::uint8_t scratch_holds) {
  if (!know_sizes(config)) return false;
  request_->config = config;
  request_->inputs = inputs;
  request_->outputs = outputs;
  request_->state = state;
  request_->scratch_holds = scratch_holds;
  if (!ask(Call::process)) return false;
  state = reply_->state;
  outputs = reply_->outputs;
  changed = reply_->changed;
  return true;
}

}  // namespace robosync::module_files
