/* QEMU TCG plugin: counts executed instructions, and writes the count down at each marker.
 *
 *   -plugin libcount.so,out=FILE,mark=0xADDRESS[,mark=…][,apart=0xBEGIN-0xEND…][,profile=on]
 *
 * FILE gets one line "ADDRESS COUNT APART" each time the instruction at a marker is about to run;
 * COUNT is the number of instructions that ran before it, without those that stand between a BEGIN
 * and its END: these are APART. The difference of two lines is therefore exact. With profile=on the line goes on with
 * " ADDRESS:COUNT" for each instruction that ran since the line before: where it stands, and how often it did.
 * Assumes one CPU. An instruction that an exception breaks off and that starts again counts twice.
 *
 * Debian does not package qemu-plugin.h, so the few functions used are declared here (API version
 * 1, QEMU 7.2).
 */
#include <inttypes.h>
#include <stdbool.h>
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
void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn* insn,
                                                enum inline_operation operation, void* counter,
                                                uint64_t amount);
void qemu_plugin_register_atexit_cb(plugin_id id, void (*callback)(plugin_id, void*), void* data);

#define EXPORT __attribute__((visibility("default")))
EXPORT int qemu_plugin_version = 1;

enum { MAX_MARKERS = 256, MAX_RANGES = 32, MAX_PLACES = 1 << 18 };
static uint64_t markers[MAX_MARKERS];
static size_t marker_count;
static struct range { uint64_t begin, end; } ranges[MAX_RANGES];
static size_t range_count;
static uint64_t executed;
static uint64_t executed_apart;
static FILE* out;
static bool profiles;
static struct place { uint64_t address, executed; } places[MAX_PLACES];
static size_t place_count;

static void write_profile(void) {
  for (size_t i = 0; i < place_count; i++) {
    if (places[i].executed == 0) continue;
    fprintf(out, " %" PRIx64 ":%" PRIu64, places[i].address, places[i].executed);
    places[i].executed = 0;
  }
}

static void at_marker(unsigned cpu, void* marker) {
  (void)cpu;
  fprintf(out, "%" PRIx64 " %" PRIu64 " %" PRIu64, *(uint64_t*)marker, executed, executed_apart);
  write_profile();
  fputc('\n', out);
  fflush(out);  // the bench waits for what it says
}

/* An instruction may be translated more than once: each time it has another place. */
static uint64_t* new_place(uint64_t address) {
  if (!profiles || place_count == MAX_PLACES) return NULL;
  places[place_count] = (struct place){address, 0};
  return &places[place_count++].executed;
}

static uint64_t* find_marker(uint64_t address) {
  for (size_t i = 0; i < marker_count; i++) {
    if (markers[i] == address) return &markers[i];
  }
  return NULL;
}

static uint64_t* counter_of(uint64_t address) {
  for (size_t i = 0; i < range_count; i++) {
    if (ranges[i].begin <= address && address < ranges[i].end) return &executed_apart;
  }
  return &executed;
}

static void translate(plugin_id id, struct qemu_plugin_tb* block) {
  (void)id;
  size_t count = qemu_plugin_tb_n_insns(block);
  for (size_t i = 0; i < count; i++) {
    struct qemu_plugin_insn* insn = qemu_plugin_tb_get_insn(block, i);
    uint64_t address = qemu_plugin_insn_vaddr(insn);
    uint64_t* marker = find_marker(address);
    if (marker) qemu_plugin_register_vcpu_insn_exec_cb(insn, at_marker, NO_REGISTERS, marker);
    qemu_plugin_register_vcpu_insn_exec_inline(insn, ADD_U64, counter_of(address), 1);
    uint64_t* place = new_place(address);
    if (place) qemu_plugin_register_vcpu_insn_exec_inline(insn, ADD_U64, place, 1);
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
