// Verifies and runs a block of images (tests/fuzz/block.hpp) that QEMU's loader has put into RAM,
// each without privileges and behind the MPU, and compares what comes of it with what the host has
// found.
//
// Before that it steps outside of every zone on purpose, to see that the trap works.
#include <cstring>

#include "bench/firmware/mark.hpp"
#include "tests/fuzz/block.hpp"
#include "tests/fuzz/exercise.hpp"
#include "tests/fuzz/firmware/sandbox.hpp"

namespace robosync::fuzz {
namespace {

// run_qemu.py: -device loader,file=BLOCK,addr=0x21000000,force-raw=on
const auto* const kBlock = reinterpret_cast<const std::byte*>(0x21000000);

[[noreturn]] void give_up(const char* what, std::uint32_t image) {
  print(what);
  print(", image ");
  print(image);
  print("\n");
  bench::leave(false);
}

// What the unprivileged side reads and writes, besides the zones.
struct Job {
  std::span<const std::byte> bytes;
  vm::Limits limits;
  vm::Verdict verdict;
  vm::Image image;
  vm::Machine machine;
  const vm::Word* code;
  vm::Value value;
  vm::Progress progress;
};
Job& job = *reinterpret_cast<Job*>(kJobs);

void do_verify(void*) {
  job.verdict = vm::verify(job.bytes, job.limits, job.image);
}
void do_evaluate(void*) {
  job.value = vm::evaluate(job.machine, job.code);
}
void do_respond(void*) {
  job.progress = vm::respond(job.machine, job.code);
}

class BoardEngine final : public Engine {
public:
  explicit BoardEngine(std::uint32_t number) : number_(number) {}

  void begin(const vm::Image& image) override { image_ = &image; }
  vm::Value* frame(std::size_t cells) override {
    return reinterpret_cast<vm::Value*>(open_zone(Zone::frame, cells * sizeof(vm::Value)));
  }
  std::uint32_t* timer_memory(std::size_t words) override {
    return reinterpret_cast<std::uint32_t*>(open_zone(Zone::timer_memory, words * 4));
  }
  vm::Word* output(std::size_t words) override {
    return reinterpret_cast<vm::Word*>(open_zone(Zone::output, words * sizeof(vm::Word)));
  }
  vm::Value evaluate(vm::Machine& machine, const CodeObject& object, std::uint32_t&) override {
    run(machine, object, 0, do_evaluate);
    return job.value;
  }
  Run respond(vm::Machine& machine, const CodeObject& object, std::size_t from) override {
    run(machine, object, from, do_respond);
    Run run{job.progress.pause, 0, job.progress.wake, 0};
    if (job.progress.next != nullptr)
      run.next = static_cast<std::size_t>(job.progress.next - &image_->code[object.start]);
    return run;
  }
  void fail(const char* what) override { give_up(what, number_); }

private:
  void run(vm::Machine& machine, const CodeObject& object, std::size_t from,
           void (*function)(void*)) {
    machine.constants = image_->constants.data();
    machine.timers = image_->timers.data();
    job.machine = machine;
    job.code = &image_->code[object.start + from];
    run_unprivileged(function, nullptr);
    machine = job.machine;
  }

  std::uint32_t number_;
  const vm::Image* image_ = nullptr;
};

void require(bool holds, const char* what, std::uint32_t number) {
  if (!holds) give_up(what, number);
}

// The first and the last word of each zone may be written, what is around it not.
void test_zone(Zone zone, std::size_t size) {
  const auto begin = reinterpret_cast<std::uintptr_t>(open_zone(zone, size));
  const auto number = static_cast<std::uint32_t>(zone);
  const bool writable = zone != Zone::image;
  require(traps_write(begin) != writable, "the first word of a zone", number);
  require(traps_write(begin + size - 4) != writable, "the last word of a zone", number);
  require(!traps_read(begin) && !traps_read(begin + size - 4), "a zone is not read", number);
  require(traps_write(begin + size), "written behind a zone", number);
  require(traps_read(begin + size), "read behind a zone", number);
  require(traps_write(begin - 1024), "written before a zone", number);
}

void test_traps() {
  test_zone(Zone::frame, 10 * 4);
  test_zone(Zone::frame, 255 * 4);
  test_zone(Zone::timer_memory, 3 * 4);
  test_zone(Zone::output, 72 * 4);
  test_zone(Zone::image, 900);
  const std::uintptr_t elsewhere[] = {0x100,        // the firmware
                                      0x00100000,   // RAM nobody uses
                                      0x20004000,   // behind the stack
                                      0x21000000,   // the block
                                      0x40004000,   // a serial line
                                      0xE000ED08};  // the core's own registers
  for (const std::uintptr_t address : elsewhere)
    require(traps_write(address), "written to", address);
  require(traps_read(0x21000000) && traps_read(0x20004000), "read elsewhere", 0);
}

vm::Verdict verify(const Entry& entry, const std::byte* bytes) {
  std::byte* const zone = open_zone(Zone::image, (entry.size + 3) / 4 * 4);
  std::memcpy(zone, bytes, entry.size);
  job.bytes = {zone, entry.size};
  job.limits = limits(entry.tight != 0);
  run_unprivileged(do_verify, nullptr);
  return job.verdict;
}

// The image's number of runs; 0 when it is refused.
std::uint32_t test_image(std::uint32_t number, const Entry& entry, const std::byte* bytes) {
  const vm::Verdict verdict = verify(entry, bytes);
  require(verdict_word(verdict) == entry.verdict, "another verdict than the host's", number);
  if (!verdict.ok()) return 0;
  const vm::Image image = job.image;
  BoardEngine engine(number);
  const Facts facts = exercise(image, entry.seed, engine);
  require(facts.hash == entry.hash, "other results than the host's", number);
  return facts.runs;
}

void run_block(const BlockHeader& header) {
  std::uint32_t accepted = 0;
  std::uint32_t runs = 0;
  const std::byte* next = kBlock + sizeof header;
  for (std::uint32_t i = 0; i < header.images; ++i) {
    Entry entry;
    std::memcpy(&entry, next, sizeof entry);
    const std::uint32_t done = test_image(i, entry, next + sizeof entry);
    accepted += done > 0 ? 1 : 0;
    runs += done;
    next += sizeof entry + (entry.size + 3) / 4 * 4;
  }
  print(header.images);
  print(" images, ");
  print(accepted);
  print(" run, ");
  print(runs);
  print(" runs, no fault\n");
}

}  // namespace
}  // namespace robosync::fuzz

int main() {
  using namespace robosync::fuzz;
  BlockHeader header;
  std::memcpy(&header, kBlock, sizeof header);
  start_sandbox();
  if (header.magic != kBlockMagic) give_up("no block", 0);
  test_traps();
  if (header.mode == Mode::stray) stray_write(0x20123450);
  run_block(header);
  robosync::bench::leave(true);
}
