// The interface of algorithm modules, version 1. A module turns the readings of one sensor, sample by sample,
// into a few channels that mean something to a program: touches instead of pressures. It is plain C; the same
// source runs in the firmware and in `rsc run`.
//
// A module is two constants: what the board needs of it (robosync_module), and its names for people
// (robosync_description), which only rsc has. They are reached by NAME_module and NAME_describe(), where NAME is the
// module's name, and its file is NAME.c.
//
// What a module may rely on
//   * All numbers are int32_t in thousandths: of the unit that the description names, or of the input's own unit.
//   * Its parameters are in their ranges; `config` has all of them, in order.
//   * State and scratch belong to it alone, aligned to 8 bytes. State is kept from call to call, scratch is not.
//   * init() comes before the first process(), and again whenever an input was unknown for a while.
//   * Two calls of process() are period_ms apart. A sample that the sensor could not take is left out.
// What it must keep to
//   * It writes only to its state, its scratch and block->outputs. On the board the MPU closes everything else, even for
//     reading, except code and constants: a module that touches it is stopped, and its outputs become unknown.
//   * No heap, no floating point (results on the board and on the host may differ), no static variables,
//     no recursion, no calls outside the module. Every loop is bounded.
//   * One call of process() executes at most cost() instructions on a Cortex-M4. A module that takes much longer is given a
//     rank below all behaviours, and is stopped if it happens again.
//   * It accepts as input any int32_t in the range of the sensor's channels.
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ROBOSYNC_ABI = 1 };

// The largest numbers of inputs, outputs and parameters of a module.
enum { ROBOSYNC_MOST_INPUTS = 4, ROBOSYNC_MOST_OUTPUTS = 8, ROBOSYNC_MOST_PARAMETERS = 12 };

// The most bytes that state_bytes(), rounded up to a multiple of 8, and scratch_bytes() may add up to; in the firmware a module may
// have more, in steps of ROBOSYNC_ROOM.
enum { ROBOSYNC_MOST_BYTES = 96, ROBOSYNC_ROOM = 1024 };

// A module that learns gets constants from a file that robot.json names. It sees so many of them at a time: its state begins with
// robosync_taught. Whenever process() is called, `constants` are those from `shown` on. `first`, which init() sets to 0, is where
// they shall begin in the next call. init() leaves the rest as it is.
enum { ROBOSYNC_VIEW = 372 };
typedef struct robosync_taught {
  uint32_t first, shown;
  uint32_t count;  // of all constants
  int32_t constants[ROBOSYNC_VIEW];
} robosync_taught;

// The most that an image may hold for one module.
enum { ROBOSYNC_MOST_CONSTANTS = 8192 };

// Brings the constants into view that a module wants to see.
static inline void robosync_show(robosync_taught* taught, const int32_t* constants,
                                 uint32_t count) {
  const uint32_t first = taught->first < count ? taught->first : count;
  uint32_t shown = count - first;
  if (shown > ROBOSYNC_VIEW) shown = ROBOSYNC_VIEW;
  if (taught->shown == first && taught->count == count) return;
  for (uint32_t i = 0; i < shown; ++i)
    taught->constants[i] = constants[first + i];
  taught->shown = first;
  taught->count = count;
}

// One, and the value that means unknown: an output that is left at it has no new reading.
enum { ROBOSYNC_ONE = 1000 };
#define ROBOSYNC_UNKNOWN INT32_MIN

// What a number measures: the index of its dimension in vm/dimensions.def.
enum {
  ROBOSYNC_NUMBER = 0,
  ROBOSYNC_SECONDS = 1,
  ROBOSYNC_PERCENT = 6,
  ROBOSYNC_HERTZ = 9,
  ROBOSYNC_G = 12,
  ROBOSYNC_DECIBEL = 14,
  ROBOSYNC_MICROTESLA = 15,
  ROBOSYNC_COUNT = 254,  // of a parameter: a number without decimals
  ROBOSYNC_AS_INPUT = 255
};

typedef struct robosync_range {
  int32_t usual;  // if robot.json says nothing
  int32_t least, most;
} robosync_range;

// What process() returns if it cannot go on: the module is stopped, and its outputs become unknown.
#define ROBOSYNC_FAILED UINT32_MAX

// One sample.
typedef struct robosync_block {
  const int32_t* inputs;  // of each input, in order; none is unknown
  int32_t* outputs;  // of each output: what process() last left there, at first ROBOSYNC_UNKNOWN
  const int32_t* config;  // the parameters
} robosync_block;

// Sets output `i` to a value. Returns its bit in the result of process(), or 0 if that was its value already.
static inline uint32_t robosync_put(const robosync_block* block, uint32_t i, int32_t value) {
  if (block->outputs[i] == value) return 0;
  block->outputs[i] = value;
  return 1u << i;
}

// scratch_bytes() for a module that needs none.
static inline uint32_t robosync_no_scratch(const int32_t* config) {
  (void)config;
  return 0;
}

typedef struct robosync_module {
  uint8_t inputs, outputs, parameters;  // how many
  uint8_t learns;                       // 1: it has constants (robosync_taught)
  uint16_t shortest_period_ms, longest_period_ms;
  const robosync_range* ranges;  // of the parameters

  // For these parameters. Pure.
  uint32_t (*state_bytes)(const int32_t* config);
  uint32_t (*scratch_bytes)(const int32_t* config);
  uint32_t (*cost)(const int32_t* config);  // maximum Cortex-M4 instructions of one process()

  void (*init)(void* state, const int32_t* config, uint32_t period_ms);
  // Returns a mask: bit i, output i has changed. Outputs that have not changed are not read. Or ROBOSYNC_FAILED.
  uint32_t (*process)(void* state, void* scratch, const robosync_block* block);
} robosync_module;

typedef struct robosync_input {
  const char* name;
  uint8_t unit;  // ROBOSYNC_AS_INPUT: any
} robosync_input;

typedef struct robosync_output {
  const char* name;           // of the channel
  uint8_t unit;               // ROBOSYNC_NUMBER if there are labels
  int32_t least, most;        // readings are clamped to these; with labels 0 and labels - 1
  const char* const* labels;  // NULL, or the words for 0, 1000, 2000 …
  uint8_t label_count;
} robosync_output;

typedef struct robosync_parameter {
  const char* name;
  uint8_t unit;
} robosync_parameter;

typedef struct robosync_description {
  const char* name;
  const robosync_module* module;
  uint16_t usual_period_ms;  // for an input that is fed, if robot.json gives none
  const robosync_input* inputs;
  const robosync_output* outputs;
  const robosync_parameter* parameters;
} robosync_description;

// The module's description; NULL for any ROBOSYNC_ABI other than its own.
typedef const robosync_description* (*robosync_describe)(uint32_t abi);

// Defines that function, at the end of a module; the arguments are those of robosync_description.
#define ROBOSYNC_DESCRIBE(name, period_ms, inputs, outputs, parameters)                 \
  static const robosync_description description = {#name,  &name##_module, period_ms,   \
                                                   inputs, outputs,        parameters}; \
  const robosync_description* name##_describe(uint32_t abi);                            \
  const robosync_description* name##_describe(uint32_t abi) {                           \
    return abi == ROBOSYNC_ABI ? &description : 0;                                      \
  }

#ifdef __cplusplus
}
#endif
