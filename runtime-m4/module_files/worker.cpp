// The module's state, scratch and outputs end where a page ends, and nothing may touch the next page; what lies before them is
// checked after each call. Its static variables are closed as soon as it is loaded, as the MPU does on the board. A module that
// touches what is not its own ends in a signal, and `reply` says where that was.
#include "runtime-m4/module_files/worker.hpp"

#include <algorithm>
#include <bit>
#include <csignal>
#include <cstring>
#include <span>

#include <dlfcn.h>
#include <link.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "runtime-m4/module_files/confine.hpp"

namespace robosync::module_files {
namespace {

const std::size_t kPage = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
constexpr std::byte kUntouched{0x5a};

// Memory for the module between two inaccessible pages.
class Cell {
public:
  [[nodiscard]] bool make() {
    void* const pages = mmap(nullptr, 3 * kPage, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) return false;
    page_ = static_cast<std::byte*>(pages) + kPage;
    return mprotect(page_, kPage, PROT_READ | PROT_WRITE) == 0;
  }
  // `bytes` of it, aligned to 8, and as close to the second of these pages as that allows; at most a page.
  std::byte* place(std::size_t bytes, std::byte holds) {
    begin_ = kPage - (bytes + 7) / 8 * 8;
    end_ = begin_ + bytes;
    std::ranges::fill(whole(), kUntouched);
    std::ranges::fill(whole().subspan(begin_, bytes), holds);
    return page_ + begin_;
  }
  bool is_intact() const {
    const auto is_untouched = [](std::byte byte) { return byte == kUntouched; };
    return std::ranges::all_of(whole().first(begin_), is_untouched) &&
           std::ranges::all_of(whole().subspan(end_), is_untouched);
  }
  bool is_near(std::uintptr_t address) const {
    return address - (reinterpret_cast<std::uintptr_t>(page_) - kPage) < 3 * kPage;
  }

private:
  std::span<std::byte> whole() const { return {page_, kPage}; }

  std::byte* page_ = nullptr;
  std::size_t begin_ = 0, end_ = 0;
};

struct Area {
  std::uintptr_t begin = 0, end = 0;
  bool has(std::uintptr_t address) const { return begin <= address && address < end; }
};

// One per process: the signal handler must find it.
struct Worker {
  int line = -1;
  const Request* request = nullptr;
  Reply* reply = nullptr;
  const robosync_description* description = nullptr;
  const robosync_module* module = nullptr;
  Cell state, scratch, outputs;
  Area statics;
};
Worker self;

[[noreturn]] void end(Came came) {
  self.reply->came = came;
  while (true)
    syscall(SYS_exit_group, 0);
}

void answer() {
  const char done = 1;
  if (write(self.line, &done, 1) != 1) end(Came::nothing);
}

// --- faults ---

Came came_of(int signal, std::uintptr_t address) {
  if (signal == SIGFPE || signal == SIGILL) return Came::not_arithmetic;
  if (self.state.is_near(address)) return Came::beyond_state;
  if (self.scratch.is_near(address)) return Came::beyond_scratch;
  if (self.outputs.is_near(address)) return Came::beyond_outputs;
  if (self.statics.has(address)) return Came::into_statics;
  const auto request = reinterpret_cast<std::uintptr_t>(self.request);
  return address - request < sizeof(Request) ? Came::into_inputs : Came::elsewhere;
}

void on_fault(int signal, siginfo_t* what, void*) {
  end(came_of(signal, reinterpret_cast<std::uintptr_t>(what->si_addr)));
}

// On its own stack: the module's may have overflowed.
bool watch_faults() {
  alignas(16) static std::byte stack[16 * 1024];
  stack_t own{};
  own.ss_sp = stack;
  own.ss_size = sizeof stack;
  if (sigaltstack(&own, nullptr) != 0) return false;
  struct sigaction action {};
  action.sa_sigaction = on_fault;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  const auto watches = [&action](int signal) { return sigaction(signal, &action, nullptr) == 0; };
  return watches(SIGSEGV) && watches(SIGBUS) && watches(SIGFPE) && watches(SIGILL);
}

// --- what it says about itself ---

void copy_text(std::span<char> into, const char* text) {
  if (text == nullptr) end(Came::incomplete);
  const std::size_t length = strnlen(text, into.size() - 1);
  std::copy_n(text, length, into.begin());
  into[length] = 0;
}

void describe_inputs(Described& into) {
  for (std::size_t i = 0; i < into.inputs; ++i) {
    copy_text(into.input_names[i], self.description->inputs[i].name);
    into.input_units[i] = self.description->inputs[i].unit;
  }
}

void describe_outputs(Described& into) {
  std::size_t words = 0;
  for (std::size_t i = 0; i < into.outputs; ++i) {
    const robosync_output& output = self.description->outputs[i];
    DescribedOutput& copy = into.output[i];
    copy_text(copy.name, output.name);
    copy.unit = output.unit;
    copy.least = output.least;
    copy.most = output.most;
    copy.words = output.labels == nullptr ? std::uint8_t{0} : output.label_count;
    if (words + copy.words > kMostWords) end(Came::too_many);
    for (std::size_t w = 0; w < copy.words; ++w)
      copy_text(into.words[words++], output.labels[w]);
  }
}

void describe_parameters(Described& into) {
  for (std::size_t i = 0; i < into.parameters; ++i) {
    copy_text(into.parameter_names[i], self.description->parameters[i].name);
    into.parameter_units[i] = self.description->parameters[i].unit;
    into.ranges[i] = self.module->ranges[i];
  }
}

bool is_complete(const robosync_description& description) {
  const robosync_module& module = *description.module;
  return description.inputs != nullptr && description.outputs != nullptr &&
         (module.parameters == 0 ||
          (description.parameters != nullptr && module.ranges != nullptr)) &&
         module.state_bytes != nullptr && module.scratch_bytes != nullptr &&
         module.cost != nullptr && module.init != nullptr && module.process != nullptr;
}

void describe() {
  if (self.description->module == nullptr) end(Came::incomplete);
  self.module = self.description->module;
  if (!is_complete(*self.description)) end(Came::incomplete);
  const robosync_module& module = *self.module;
  if (module.inputs > ROBOSYNC_MOST_INPUTS || module.outputs > ROBOSYNC_MOST_OUTPUTS ||
      module.parameters > ROBOSYNC_MOST_PARAMETERS)
    end(Came::too_many);
  Described& into = self.reply->described;
  into.inputs = module.inputs;
  into.outputs = module.outputs;
  into.parameters = module.parameters;
  into.shortest_period_ms = module.shortest_period_ms;
  into.longest_period_ms = module.longest_period_ms;
  into.usual_period_ms = self.description->usual_period_ms;
  copy_text(into.name, self.description->name);
  describe_inputs(into);
  describe_outputs(into);
  describe_parameters(into);
}

// --- loading ---

// Closes the parts of a loaded file that can be written to, now that the loader is done with them.
int close_statics(dl_phdr_info* file, std::size_t, void* base) {
  if (file->dlpi_addr != *static_cast<const ElfW(Addr)*>(base)) return 0;
  for (std::size_t i = 0; i < file->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = file->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_W) == 0) continue;
    const std::uintptr_t begin = (file->dlpi_addr + part.p_vaddr) / kPage * kPage;
    const std::uintptr_t end = file->dlpi_addr + part.p_vaddr + part.p_memsz;
    self.statics = {begin, (end + kPage - 1) / kPage * kPage};
    if (mprotect(std::bit_cast<void*>(begin), self.statics.end - begin, PROT_READ) != 0) return -1;
  }
  return 1;
}

void load(const std::string& path, const std::string& name) {
  void* const file = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (file == nullptr) {
    copy_text(self.reply->text, dlerror());
    end(Came::not_loaded);
  }
  const auto describe_it =
      reinterpret_cast<robosync_describe>(dlsym(file, (name + "_describe").c_str()));
  if (describe_it == nullptr) end(Came::no_function);
  link_map* map = nullptr;
  if (dlinfo(file, RTLD_DI_LINKMAP, &map) != 0 || dl_iterate_phdr(close_statics, &map->l_addr) != 1)
    end(Came::not_confined);
  if (!allow_answers()) end(Came::not_confined);
  self.reply->doing = Doing::describing;
  self.description = describe_it(ROBOSYNC_ABI);
  if (self.description == nullptr) end(Came::other_interface);
  describe();
}

// --- its work ---

void measure_sizes() {
  const std::int32_t* const config = self.request->config.data();
  Reply& reply = *self.reply;
  reply.doing = Doing::state_bytes;
  reply.sizes.state = self.module->state_bytes(config);
  reply.doing = Doing::scratch_bytes;
  reply.sizes.scratch = self.module->scratch_bytes(config);
  reply.doing = Doing::cost;
  reply.sizes.cost = self.module->cost(config);
}

// A module whose sizes exceed what the interface allows gets no further: rsc has refused it.
std::byte* place_state() {
  const std::size_t bytes = std::min<std::size_t>(self.reply->sizes.state, ROBOSYNC_MOST_BYTES);
  std::byte* const state = self.state.place(bytes, std::byte{0});
  std::copy_n(self.request->state.begin(), bytes, state);
  return state;
}

void take_state(const std::byte* state) {
  const std::size_t bytes = std::min<std::size_t>(self.reply->sizes.state, ROBOSYNC_MOST_BYTES);
  if (!self.state.is_intact()) end(Came::beyond_state);
  std::copy_n(state, bytes, self.reply->state.begin());
}

void init() {
  std::byte* const state = place_state();
  self.reply->doing = Doing::init;
  self.module->init(state, self.request->config.data(), self.request->period_ms);
  take_state(state);
}

void process() {
  const Request& request = *self.request;
  Reply& reply = *self.reply;
  std::byte* const state = place_state();
  const std::size_t scratch_bytes = std::min<std::size_t>(reply.sizes.scratch, ROBOSYNC_MOST_BYTES);
  std::byte* const scratch = self.scratch.place(scratch_bytes, std::byte{request.scratch_holds});
  const std::size_t bytes = self.module->outputs * sizeof(std::int32_t);
  auto* const outputs = reinterpret_cast<std::int32_t*>(self.outputs.place(bytes, std::byte{0}));
  std::copy_n(request.outputs.begin(), self.module->outputs, outputs);
  const robosync_block block = {request.inputs.data(), outputs, request.config.data()};
  reply.doing = Doing::process;
  reply.changed = self.module->process(state, scratch, &block);
  take_state(state);
  if (!self.scratch.is_intact()) end(Came::beyond_scratch);
  if (!self.outputs.is_intact()) end(Came::beyond_outputs);
  std::copy_n(outputs, self.module->outputs, reply.outputs.begin());
}

void do_work() {
  switch (self.request->call) {
    case Call::describe:
      return;
    case Call::sizes:
      return measure_sizes();
    case Call::init:
      return init();
    case Call::process:
      return process();
  }
}

}  // namespace

void work(const std::string& path, const std::string& name, int line, const Request& request,
          Reply& reply) {
  self.line = line;
  self.request = &request;
  self.reply = &reply;
  reply.doing = Doing::loading;
  if (!self.state.make() || !self.scratch.make() || !self.outputs.make() || !watch_faults() ||
      !allow_loading())
    end(Came::not_confined);
  load(path, name);
  for (char asked = 0;;) {
    self.reply->came = Came::fine;
    answer();
    if (read(line, &asked, 1) != 1) end(Came::nothing);
    self.reply->came = Came::nothing;
    do_work();
  }
}

}  // namespace robosync::module_files
