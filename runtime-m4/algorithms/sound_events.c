// sound_events: what a microphone hears (stdlib/devices/microphone.json): a clap, somebody speaking, another sound, or nothing.
//
// BACKGROUND is what is always there: it follows softer sound within QUIETER_MS, and rises by a decibel in LOUDER_MS. LEVEL is
// how far the sound is above it.
// EVENT is the first of these that applies:
//   clap    after QUIET_MS without anything loud it became louder by `clap` within RISE_MS, with high tones as strong as in
//           noise, and softer again by `fall` within FALL_MS, without a voice; shown for `shown_for`
//   speech  above the background by `loud`, with the clear pitch of a voice for `speech_time` in total; pauses count against it
//   sound   above the background by `loud`
#include <stddef.h>

#include "runtime-m4/algorithms/microphone.h"

enum { EVENT, LEVEL, OUTPUTS };
enum { CLAP, FALL, LOUD, CLEAR, SPEECH_TIME, SHOWN_FOR, PARAMETERS };
enum { NONE, CLAPPED, SPEECH, SOUND };

enum { RISE_MS = 40, FALL_MS = 140, QUIET_MS = 160, QUIETER_MS = 100, LOUDER_MS = 500 };
enum { LOUDEST = 100000 };
enum { HIGH_ENOUGH = -6000 };  // dB above the loudness: noise has +3, a voice -10
enum { LOWEST_VOICE = 80000, HIGHEST_VOICE = 400000 };  // Hz
enum { LONGEST_MS = 60000, MOST_SPEECH_MS = 600 };

typedef struct state {
  int32_t background;
  int32_t before[2];    // the loudness in the last two samples
  int32_t peak, highs;  // of what may be a clap
  uint32_t rising_ms;   // since that began; 0: there is none
  uint32_t speech_ms, shown_ms, quiet_ms;
  uint8_t begun, speaks, shown;
} state;

static uint32_t state_bytes(const int32_t* config) {
  (void)config;
  return sizeof(state);
}

static uint32_t cost(const int32_t* config) {
  (void)config;
  return 160;
}

static void init(void* memory, const int32_t* config, uint32_t period_ms) {
  (void)config;
  (void)period_ms;
  state* self = memory;
  *self = (state){.shown_ms = LONGEST_MS, .quiet_ms = LONGEST_MS};
}

static int32_t decibels(int32_t value) {
  if (value < 0) return 0;
  return value < LOUDEST ? value : LOUDEST;
}

static uint32_t later(uint32_t since_ms) {
  return since_ms < LONGEST_MS ? since_ms + MICROPHONE_PERIOD_MS : since_ms;
}

static void follow_background(state* self, int32_t loudness) {
  if (!self->begun) {
    self->background = loudness;
    self->before[0] = self->before[1] = loudness;
  }
  self->begun = 1;
  const int32_t change = loudness - self->background;
  const int32_t most = ROBOSYNC_ONE * MICROPHONE_PERIOD_MS / LOUDER_MS;
  if (change < 0)
    self->background += change * MICROPHONE_PERIOD_MS / QUIETER_MS;
  else
    self->background += change < most ? change : most;
}

static int is_voice(const int32_t* inputs, const int32_t* config) {
  return inputs[MICROPHONE_CLARITY] >= config[CLEAR] && inputs[MICROPHONE_PITCH] >= LOWEST_VOICE &&
         inputs[MICROPHONE_PITCH] <= HIGHEST_VOICE;
}

static int begins(const state* self, int32_t loudness, int32_t clap) {
  const int32_t before = self->before[0] < self->before[1] ? self->before[0] : self->before[1];
  return self->quiet_ms >= QUIET_MS && loudness - before >= clap &&
         loudness - self->background >= clap;
}

// A clap is recognised when it is over.
static int is_clap(state* self, const int32_t* inputs, const int32_t* config) {
  const int32_t loudness = decibels(inputs[MICROPHONE_LOUDNESS]);
  if (self->rising_ms == 0 && !begins(self, loudness, config[CLAP])) return 0;
  if (self->rising_ms == 0 || (loudness > self->peak && self->rising_ms < RISE_MS)) {
    self->peak = loudness;
    self->highs = decibels(inputs[MICROPHONE_HIGHS]);
  }
  self->rising_ms += MICROPHONE_PERIOD_MS;
  const int is_over = self->peak - loudness >= config[FALL];
  const int speaks = self->rising_ms > RISE_MS && !is_over && is_voice(inputs, config);
  if (!is_over && !speaks && self->rising_ms <= FALL_MS) return 0;
  self->rising_ms = 0;
  return is_over && self->highs - self->peak >= HIGH_ENOUGH;
}

static void note_speech(state* self, int speaks, uint32_t speech_time) {
  if (speaks && self->speech_ms < MOST_SPEECH_MS)
    self->speech_ms += MICROPHONE_PERIOD_MS;
  else if (!speaks && self->speech_ms >= MICROPHONE_PERIOD_MS / 2)
    self->speech_ms -= MICROPHONE_PERIOD_MS / 2;
  if (self->speech_ms >= speech_time) self->speaks = 1;
  if (self->speech_ms < MICROPHONE_PERIOD_MS) self->speaks = 0;
}

static uint32_t sound_events_process(void* memory, void* scratch, const robosync_block* block) {
  (void)scratch;
  state* self = memory;
  const int32_t loudness = decibels(block->inputs[MICROPHONE_LOUDNESS]);
  follow_background(self, loudness);
  const int is_loud = loudness - self->background >= block->config[LOUD];
  const int clapped = is_clap(self, block->inputs, block->config);
  note_speech(self, is_loud && is_voice(block->inputs, block->config),
              (uint32_t)block->config[SPEECH_TIME]);
  self->quiet_ms = is_loud ? 0 : later(self->quiet_ms);
  self->before[1] = self->before[0];
  self->before[0] = loudness;
  self->shown_ms = clapped ? 0 : later(self->shown_ms);
  uint8_t event = NONE;
  if (self->shown_ms < (uint32_t)block->config[SHOWN_FOR])
    event = CLAPPED;
  else if (self->speaks)
    event = SPEECH;
  else if (is_loud)
    event = SOUND;
  const int32_t level = loudness > self->background ? loudness - self->background : 0;
  return robosync_put(block, EVENT, event * ROBOSYNC_ONE) |
         robosync_put(block, LEVEL, level / ROBOSYNC_ONE * ROBOSYNC_ONE);
}

static const robosync_range ranges[PARAMETERS] = {
    [CLAP] = {9000, 6000, 60000},   [FALL] = {8000, 3000, 40000},
    [LOUD] = {6000, 3000, 60000},   [CLEAR] = {60000, 20000, 100000},
    [SPEECH_TIME] = {200, 40, 600}, [SHOWN_FOR] = {300, 20, 60000},
};

const robosync_module sound_events_module = {
    .inputs = MICROPHONE_INPUTS,
    .outputs = OUTPUTS,
    .parameters = PARAMETERS,
    .shortest_period_ms = MICROPHONE_PERIOD_MS,
    .longest_period_ms = MICROPHONE_PERIOD_MS,
    .ranges = ranges,
    .state_bytes = state_bytes,
    .scratch_bytes = robosync_no_scratch,
    .cost = cost,
    .init = init,
    .process = sound_events_process,
};

static const char* const events[] = {"none", "clap", "speech", "sound"};

static const robosync_output outputs[OUTPUTS] = {
    [EVENT] = {"EVENT", ROBOSYNC_NUMBER, 0, 3000, events, 4},
    [LEVEL] = {"LEVEL", ROBOSYNC_DECIBEL, 0, 100000, NULL, 0},
};

static const robosync_parameter parameters[PARAMETERS] = {
    [CLAP] = {"clap", ROBOSYNC_DECIBEL},
    [FALL] = {"fall", ROBOSYNC_DECIBEL},
    [LOUD] = {"loud", ROBOSYNC_DECIBEL},
    [CLEAR] = {"clear", ROBOSYNC_PERCENT},
    [SPEECH_TIME] = {"speech_time", ROBOSYNC_SECONDS},
    [SHOWN_FOR] = {"shown_for", ROBOSYNC_SECONDS},
};

ROBOSYNC_DESCRIBE(sound_events, MICROPHONE_PERIOD_MS, microphone_inputs, outputs, parameters)
