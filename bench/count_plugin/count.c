/* QEMU TCG plugin: counts executed instructions, and writes the count to a file at each marker.
 *
 *   -plugin libcount.so,out=FILE,mark=0xADDRESS[,mark=…][,apart=0xBEGIN-0xEND…][,profile=on]
 *
 * FILE gets one line "ADDRESS COUNT APART" each time the instruction at a marker is about to run;
 * COUNT is the number of instructions that ran before it, without those between a BEGIN and its
 * END, which are in APART. The difference of two lines is therefore exact. With profile=on the line continues with
 * " ADDRESS:COUNT" for each instruction that ran since the line before: its address, and how often it ran.
 * Assumes one CPU. An instruction that an exception aborts and that restarts counts twice.
 *
 * Debian does not package qemu-plugin.h, so the few functions used are declared here. QEMU 7.2 (API version 1) can add to any
 * number in memory; QEMU 9 and newer (API version 2 on) only to one on a scoreboard, which has one for each CPU. Functions
 * that a QEMU does not have stay null.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t plugin_id;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum callback_flags { NO_REGISTERS };
enum inline_operation { ADD_U64 };
void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id id,
                                           void (*callback)(plugin_id, struct qemu_plugin_tb*));
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* block);
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb* block, size_t index);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn* insn);
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn* insn,
                                            void (*callback)(unsigned cpu, void* data),
                                            enum callback_flags flags, void* data);
struct qemu_plugin_scoreboard;
struct on_scoreboard {
  struct qemu_plugin_scoreboard* board;
  size_t offset;
};
#define IF_THERE __attribute__((weak))
IF_THERE void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn* insn,
                                                         enum inline_operation operation,
                                                         void* counter, uint64_t amount);
IF_THERE void qemu_plugin_register_vcpu_insn_exec_inline_per_vcpu(struct qemu_plugin_insn* insn,
                                                                  enum inline_operation operation,
                                                                  struct on_scoreboard counter,
                                                                  uint64_t amount);
IF_THERE struct qemu_plugin_scoreboard* qemu_plugin_scoreboard_new(size_t bytes);
IF_THERE void* qemu_plugin_scoreboard_find(struct qemu_plugin_scoreboard* board, unsigned cpu);
void qemu_plugin_register_atexit_cb(plugin_id id, void (*callback)(plugin_id, void*), void* data);

#define EXPORT __attribute__((visibility("default")))
EXPORT int qemu_plugin_version = 1;

// QEMU reads the version before it calls anything here.
__attribute__((constructor)) static void choose_version(void) {
  if (qemu_plugin_scoreboard_new) qemu_plugin_version = 2;
}

enum { MAX_MARKERS = 256, MAX_RANGES = 32, MAX_PLACES = 1 << 18 };
static uint64_t markers[MAX_MARKERS];
static size_t marker_count;
static struct range { uint64_t begin, end; } ranges[MAX_RANGES];
static size_t range_count;
static FILE* out;
static bool profiles;
static uint64_t places[MAX_PLACES];  // addresses
static size_t place_count;
static struct qemu_plugin_scoreboard* board;
static struct counters { uint64_t executed, apart, at_place[]; } * counters;

// Must run after the CPU exists.
static void make_counters(void) {
  size_t bytes = sizeof(struct counters) + (profiles ? sizeof places : 0);
  if (qemu_plugin_scoreboard_new) {
    board = qemu_plugin_scoreboard_new(bytes);
    counters = qemu_plugin_scoreboard_find(board, 0);
  } else {
    counters = calloc(1, bytes);
  }
}

static void add_one(struct qemu_plugin_insn* insn, uint64_t* counter) {
  if (!board) return qemu_plugin_register_vcpu_insn_exec_inline(insn, ADD_U64, counter, 1);
  struct on_scoreboard place = {board, (size_t)((char*)counter - (char*)counters)};
  qemu_plugin_register_vcpu_insn_exec_inline_per_vcpu(insn, ADD_U64, place, 1);
}

static void write_profile(void) {
  for (size_t i = 0; i < place_count; i++) {
    if (counters->at_place[i] == 0) continue;
    fprintf(out, " %" PRIx64 ":%" PRIu64, places[i], counters->at_place[i]);
    counters->at_place[i] = 0;
  }
}

static void at_marker(unsigned cpu, void* marker) {
  (void)cpu;
  fprintf(out, "%" PRIx64 " %" PRIu64 " %" PRIu64, *(uint64_t*)marker, counters->executed,
          counters->apart);
  write_profile();
  fputc('\n', out);
  fflush(out);  // the bench waits for this line
}

/* An instruction may be translated more than once; it gets a new place each time. */
static uint64_t* new_place(uint64_t address) {
  if (!profiles || place_count == MAX_PLACES) return NULL;
  places[place_count] = address;
  return &counters->at_place[place_count++];
}

static uint64_t* find_marker(uint64_t address) {
  for (size_t i = 0; i < marker_count; i++) {
    if (markers[i] == address) return &markers[i];
  }
  return NULL;
}

static uint64_t* counter_of(uint64_t address) {
  for (size_t i = 0; i < range_count; i++) {
    if (ranges[i].begin <= address && address < ranges[i].end) return &counters->apart;
  }
  return &counters->executed;
}

static void translate(plugin_id id, struct qemu_plugin_tb* block) {
  (void)id;
  if (!counters) make_counters();
  size_t count = qemu_plugin_tb_n_insns(block);
  for (size_t i = 0; i < count; i++) {
    struct qemu_plugin_insn* insn = qemu_plugin_tb_get_insn(block, i);
    uint64_t address = qemu_plugin_insn_vaddr(insn);
    uint64_t* marker = find_marker(address);
    if (marker) qemu_plugin_register_vcpu_insn_exec_cb(insn, at_marker, NO_REGISTERS, marker);
    add_one(insn, counter_of(address));
    uint64_t* place = new_place(address);
    if (place) add_one(insn, place);
  }
}

static void finish(plugin_id id, void* data) {
  (void)id;
  (void)data;
  fclose(out);
}

static int take_argument(const char* argument) {
  if (strncmp(argument, "out=", 4) == 0) {
    out = fopen(argument + 4, "w");
    return out ? 0 : -1;
  }
  if (strncmp(argument, "mark=", 5) == 0 && marker_count < MAX_MARKERS) {
    markers[marker_count++] = strtoull(argument + 5, NULL, 0);
    return 0;
  }
  if (strncmp(argument, "apart=", 6) == 0 && range_count < MAX_RANGES) {
    char* dash;
    ranges[range_count].begin = strtoull(argument + 6, &dash, 0);
    if (*dash != '-') return -1;
    ranges[range_count++].end = strtoull(dash + 1, NULL, 0);
    return 0;
  }
  if (strcmp(argument, "profile=on") == 0) {
    profiles = true;
    return 0;
  }
  return -1;
}

EXPORT int qemu_plugin_install(plugin_id id, const void* info, int argc, char** argv) {
  (void)info;
  for (int i = 0; i < argc; i++) {
    if (take_argument(argv[i]) != 0) {
      fprintf(stderr, "count: cannot use the argument %s\n", argv[i]);
      return -1;
    }
  }
  if (!out) return -1;
  qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
  qemu_plugin_register_atexit_cb(id, finish, NULL);
  return 0;
}
