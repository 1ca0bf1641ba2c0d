// A module that violates its contract. It is compiled once for each way of doing so, HOW, into HOW.so; `well` keeps the contract.
#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <sys/mman.h>
#include <unistd.h>

#include "runtime-m4/algorithms/robosync_module.h"

enum how {
  well,
  crashes,
  hangs,
  hangs_while_loaded,
  crashes_while_loaded,
  writes_a_file_while_loaded,
  forks_while_loaded,
  takes_all_memory_while_loaded,
  beyond_state,
  below_state,
  reads_beyond_state,
  beyond_an_odd_state,
  beyond_scratch,
  below_scratch,
  beyond_outputs,
  below_outputs,
  into_inputs,
  into_config,
  keeps_a_static,
  into_a_constant,
  calls_the_system,
  calls_as_another_machine,
  opens_a_file,
  writes_to_what_is_open,
  ends_its_process,
  answers_and_ends,
  waits,
  divides_by_zero,
  traps,
  overflows_its_stack,
  other_abi,
  no_module,
  incomplete,
  too_many_inputs,
  too_many_outputs,
  too_many_parameters,
  wild_name,
  null_name,
  no_name,
  unordered_range,
  two_alike,
  many_words,
  too_large,
  boundless,
  free_of_cost,
  crashes_in_cost,
  crashes_when_firm,  // with a parameter that is not the default
  out_of_range,
  untrue_mask,
  reads_its_scratch,
  lies_about_its_cost,
  gives_up,
};
static const enum how how = HOW;

enum { STATE_BYTES = 8, SCRATCH_BYTES = 8 };

typedef struct state {
  int32_t last, count;
} state;

static int32_t kept;
static const int32_t constant = 1;

// Tries each way separately, with a file that exists.
static void write_a_file(void) {
  static const int ways[] = {O_WRONLY, O_RDWR, O_RDONLY | O_CREAT, O_RDONLY | O_TRUNC,
                             O_WRONLY | O_APPEND};
  for (unsigned i = 0; i < sizeof ways / sizeof *ways; ++i)
    if (open("hostile.out", ways[i], 0600) >= 0 || errno != EACCES) *(volatile int*)8 = 1;
}

__attribute__((constructor)) static void loaded(void) {
  if (how == hangs_while_loaded)
    for (;;) {
    }
  if (how == crashes_while_loaded) *(volatile int*)8 = 1;
  if (how == writes_a_file_while_loaded) write_a_file();
  if (how == forks_while_loaded) (void)fork();
  if (how == takes_all_memory_while_loaded &&
      mmap(NULL, (size_t)4 << 30, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED)
    *(volatile int*)8 = 1;
}

static uint32_t state_bytes(const int32_t* config) {
  (void)config;
  if (how == boundless) return UINT32_MAX - 7;
  if (how == beyond_an_odd_state) return STATE_BYTES + 1;
  return how == too_large ? ROBOSYNC_MOST_BYTES + 1 : STATE_BYTES;
}

static uint32_t scratch_bytes(const int32_t* config) {
  (void)config;
  if (how == boundless) return UINT32_MAX - 7;
  return how == too_large ? 0 : SCRATCH_BYTES;
}

static uint32_t cost(const int32_t* config) {
  if (how == crashes_in_cost || (how == crashes_when_firm && config[0] > 1000))
    *(volatile int*)8 = 1;
  return how == free_of_cost ? 0 : 60;
}

static void init(void* memory, const int32_t* config, uint32_t period_ms) {
  (void)config;
  (void)period_ms;
  *(state*)memory = (state){0, 0};
}

static int deeper(volatile int* depth) {
  volatile int here[256] = {*depth + 1};
  return here[0] > 0 ? deeper(here) + here[1] : 0;
}

// File descriptor 3 is the line to the parent process; any other open one would belong to somebody.
enum { LINE = 3, LAST = 63 };

static void call_the_system(void) {
  const char byte = 1;
  if (how == calls_the_system) (void)getppid();
#if defined(__x86_64__)
  // 15 is chmod() on a 32-bit machine; on x86-64 it is rt_sigreturn, which is allowed.
  if (how == calls_as_another_machine) __asm__ volatile("int $0x80" ::"a"(15), "b"(0), "c"(0));
#endif
  if (how == opens_a_file) (void)open("/dev/null", O_RDONLY);
  for (int file = 0; how == writes_to_what_is_open && file <= LAST; ++file)
    if (file != LINE && write(file, &byte, 1) >= 0) *(volatile int*)8 = 1;
  if (how == ends_its_process) _exit(0);
  if (how == answers_and_ends && write(LINE, &byte, 1) == 1) _exit(0);
  char answer = 0;
  if (how == waits) (void)!read(LINE, &answer, 1);
}

static void misbehave(char* own, char* scratch, const robosync_block* block) {
  volatile int goes_on = how == hangs;
  while (goes_on) {
  }
  volatile int zero = 0;
  if (how == crashes) *(volatile int*)8 = 1;
  if (how == beyond_state) own[STATE_BYTES] = 1;
  if (how == below_state) own[-1] = 1;
  if (how == reads_beyond_state) zero = ((volatile char*)own)[STATE_BYTES];
  if (how == beyond_an_odd_state) own[STATE_BYTES + 1] = 1;
  if (how == beyond_scratch) scratch[SCRATCH_BYTES] = 1;
  if (how == below_scratch) scratch[-1] = 1;
  if (how == beyond_outputs) block->outputs[2] = 1;
  if (how == below_outputs) block->outputs[-1] = 1;
  if (how == into_inputs) ((int32_t*)(uintptr_t)block->inputs)[0] = 1;
  if (how == into_config) ((int32_t*)(uintptr_t)block->config)[0] = 1;
  if (how == keeps_a_static) ++kept;
  if (how == into_a_constant) *(volatile int32_t*)(uintptr_t)&constant = 2;
  call_the_system();
  if (how == traps) __builtin_trap();
  if (how == divides_by_zero) zero = 7 / zero;
  if (how == overflows_its_stack) zero = deeper(&zero);
  for (volatile int i = 0; how == lies_about_its_cost && i < 1000; ++i) {
  }
}

static uint32_t process(void* memory, void* scratch, const robosync_block* block) {
  state* self = memory;
  misbehave(memory, scratch, block);
  const int32_t firm = block->inputs[0] > block->config[0];
  self->last = firm;
  if (how == gives_up) return ROBOSYNC_FAILED;
  if (how == untrue_mask) {
    block->outputs[0] = firm * ROBOSYNC_ONE;
    return 0;
  }
  const int32_t more = how == out_of_range        ? 7
                       : how == reads_its_scratch ? *(char*)scratch != 0
                                                  : firm;
  return robosync_put(block, 0, firm * ROBOSYNC_ONE) | robosync_put(block, 1, more * ROBOSYNC_ONE);
}

static const robosync_range ranges[] = {
    {how == unordered_range ? -1 : 1000, 0, 10000},
};
static const robosync_module module = {
    .inputs = how == too_many_inputs ? 200 : 1,
    .outputs = how == too_many_outputs ? 200 : 2,
    .parameters = how == too_many_parameters ? 200 : 1,
    .shortest_period_ms = 5,
    .longest_period_ms = 50,
    .ranges = ranges,
    .state_bytes = state_bytes,
    .scratch_bytes = scratch_bytes,
    .cost = cost,
    .init = init,
    .process = how == incomplete ? NULL : process,
};

static const char* const words[] = {"no", "yes"};
static const robosync_input inputs[] = {{how == null_name ? NULL : "FORCE", ROBOSYNC_AS_INPUT}};
static const robosync_output outputs[] = {
    {how == no_name ? "two words" : "FIRM", ROBOSYNC_NUMBER, 0, 1000, words, 2},
    {how == two_alike ? "FIRM" : "MORE", ROBOSYNC_NUMBER, 0, 1000, words,
     how == many_words ? 255 : 2},
};
static const robosync_parameter parameters[] = {{"firm", ROBOSYNC_AS_INPUT}};
static const robosync_description description = {
    how == wild_name ? (const char*)8 : "hostile",
    how == no_module ? NULL : &module,
    20,
    inputs,
    outputs,
    parameters,
};

#define JOINED(how) how##_describe
#define DESCRIBE(how) JOINED(how)
const robosync_description* DESCRIBE(HOW)(uint32_t abi);
const robosync_description* DESCRIBE(HOW)(uint32_t abi) {
  return abi == ROBOSYNC_ABI && how != other_abi ? &description : NULL;
}
