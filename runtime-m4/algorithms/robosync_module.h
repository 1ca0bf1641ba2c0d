// The interface of algorithm modules, version 1. A module turns the readings of one sensor, sample by sample,
// into few channels that mean something to a program: touches instead of pressures. It is plain C; the same
// source runs in the firmware and in `rsc run`.
//
// A module is two constants: what the board needs of it (robosync_module), and its names for people
// (robosync_description), which only rsc has. Both are had by NAME_module and NAME_describe(), NAME being that of
// the module, and its file NAME.c.
//
// What a module may rely on
//   * All numbers are int32_t in thousandths: of the unit that the description names, or of the input's own.
//   * Its parameters lie in their ranges; `config` has all of them, in their order.
//   * State and scratch are its alone, aligned to 8 bytes. State is kept from call to call, scratch is not.
//   * init() comes before the first process(), and again whenever an input was unknown for a while.
//   * Between two calls of process() lies period_ms. A sample that the sensor could not take is left out.
// What it must keep to
//   * It writes to its state, its scratch and block->outputs. On the board the MPU closes everything else, reading
//     included, but for code and constants: who touches it is stopped, and the module's outputs become unknown.
//   * No heap, no floating point (what the board and the host make of it need not be the same), no static variables,
//     no recursion, no call of anything outside the module. Every loop is bounded.
//   * One call of process() executes at most cost() instructions on a Cortex-M4. Who takes much longer is given a rank
//     below all behaviours, and stopped when it happens again.
//   * Inputs may be any int32_t in the range of the sensor's channels.
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ROBOSYNC_ABI = 1 };

// Most inputs, outputs and parameters of a module.
enum { ROBOSYNC_MOST_INPUTS = 4, ROBOSYNC_MOST_OUTPUTS = 8, ROBOSYNC_MOST_PARAMETERS = 12 };

// Bytes that state_bytes(), rounded up to a multiple of 8, and scratch_bytes() may come to together.
enum { ROBOSYNC_MOST_BYTES = 96 };

// One, and what nobody knows: an output that is left at it has no new reading.
enum { ROBOSYNC_ONE = 1000 };
#define ROBOSYNC_UNKNOWN INT32_MIN

// What a number measures: the place of its dimension in vm/dimensions.def.
enum {
  ROBOSYNC_NUMBER = 0,
  ROBOSYNC_SECONDS = 1,
  ROBOSYNC_PERCENT = 6,
  ROBOSYNC_HERTZ = 9,
  ROBOSYNC_G = 12,
  ROBOSYNC_DECIBEL = 14,
  ROBOSYNC_AS_INPUT = 255
};

typedef struct robosync_range {
  int32_t usual;  // where robot.json says nothing
  int32_t least, most;
} robosync_range;

// What process() returns when it cannot go on: the module is stopped, its outputs become unknown.
#define ROBOSYNC_FAILED UINT32_MAX

// One sample.
typedef struct robosync_block {
  const int32_t* inputs;  // of each input, in their order; none is unknown
  int32_t* outputs;  // of each output: what process() left there last, at first ROBOSYNC_UNKNOWN
  const int32_t* config;  // the parameters
} robosync_block;

// Leaves a value at output `i`. Its bit in what process() returns, or 0 where it was that already.
static inline uint32_t robosync_put(const robosync_block* block, uint32_t i, int32_t value) {
  if (block->outputs[i] == value) return 0;
  block->outputs[i] = value;
  return 1u << i;
}

// scratch_bytes() of a module that needs none.
static inline uint32_t robosync_no_scratch(const int32_t* config) {
  (void)config;
  return 0;
}

typedef struct robosync_module {
  uint8_t inputs, outputs, parameters;  // how many
  uint16_t shortest_period_ms, longest_period_ms;
  const robosync_range* ranges;  // of the parameters

  // Of these parameters. Pure.
  uint32_t (*state_bytes)(const int32_t* config);
  uint32_t (*scratch_bytes)(const int32_t* config);
  uint32_t (*cost)(const int32_t* config);  // Cortex-M4 instructions of one process(), at most

  void (*init)(void* state, const int32_t* config, uint32_t period_ms);
  // Returns a mask: bit i, output i has changed. Outputs that have not are not read. Or ROBOSYNC_FAILED.
  uint32_t (*process)(void* state, void* scratch, const robosync_block* block);
} robosync_module;

typedef struct robosync_input {
  const char* name;
  uint8_t unit;  // ROBOSYNC_AS_INPUT: any
} robosync_input;

typedef struct robosync_output {
  const char* name;           // of the channel
  uint8_t unit;               // ROBOSYNC_NUMBER where there are labels
  int32_t least, most;        // readings are cut off there; with labels 0 and labels - 1
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
  uint16_t usual_period_ms;  // of an input that is fed, where robot.json says none
  const robosync_input* inputs;
  const robosync_output* outputs;
  const robosync_parameter* parameters;
} robosync_description;

// Of the module; NULL for another ROBOSYNC_ABI than its own.
typedef const robosync_description* (*robosync_describe)(uint32_t abi);

#ifdef __cplusplus
}
#endif
