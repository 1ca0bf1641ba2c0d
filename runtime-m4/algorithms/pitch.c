// pitch: the tone that somebody sings, whistles or plays, from what a microphone hears (stdlib/devices/microphone.json).
//
// A tone begins when STEADY_SAMPLES samples have a pitch, each less than a whole tone from the one before, and ends when that
// many have none. Until another pitch has lasted as long, the tone stays what it was: an octave misheard for a moment does not
// show.
//   PITCH  in whole Hz, a mean in which the latest sample counts half; no reading without a tone, so it becomes unknown
//   NOTE   the nearest one; it is kept until the tone is STAY cents away from it
//   CENTS  how far the tone is above the note
//   TONE   rising or falling if it is higher or lower by `slide` than SLIDE_SAMPLES before, or than when it began
#include <stddef.h>

#include "runtime-m4/algorithms/microphone.h"

enum { PITCH, NOTE, CENTS, TONE, OUTPUTS };
enum { CLEAR, LOUD, LOWEST, HIGHEST, TUNING, SLIDE, PARAMETERS };
enum { NO_TONE, STEADY, RISING, FALLING };

enum { STEADY_SAMPLES = 3, SLIDE_SAMPLES = 10 };
enum { TENTH = 100, PER_HZ = 10 };  // the state counts in tenths of a Hz; inputs in thousandths
enum { NOTES = 12, C_ABOVE_A = 3, SEMITONE = 100, OCTAVE = 1200, STAY = 60 };  // cents
enum { ALIKE = 1 << 14 };

// The ratios of the notes from A to the next A to that first A, in parts of ALIKE.
static const uint16_t ratios[NOTES + 1] = {16384, 17358, 18390, 19484, 20643, 21870, 23170,
                                           24548, 26008, 27554, 29193, 30929, 32768};

typedef struct state {
  uint16_t tone;                   // 0: none
  uint16_t candidate;              // a pitch that may become the tone
  uint16_t before[SLIDE_SAMPLES];  // the tone in the latest samples, in a ring buffer
  uint8_t agreeing, missing;       // samples
  uint8_t next, kept;              // in `before`: where the next one goes, how many there are
  uint8_t note;                    // 0: none, 1: c
} state;

static uint32_t state_bytes(const int32_t* config) {
  (void)config;
  return sizeof(state);
}

static uint32_t cost(const int32_t* config) {
  (void)config;
  return 410;
}

static void init(void* memory, const int32_t* config, uint32_t period_ms) {
  (void)config;
  (void)period_ms;
  state* self = memory;
  *self = (state){0};
}

// In tenths of a Hz, or 0 if nothing is heard that may be a tone.
static uint32_t heard(const int32_t* inputs, const int32_t* config) {
  const int is_tone =
      inputs[MICROPHONE_CLARITY] >= config[CLEAR] && inputs[MICROPHONE_LOUDNESS] >= config[LOUD] &&
      inputs[MICROPHONE_PITCH] >= config[LOWEST] && inputs[MICROPHONE_PITCH] <= config[HIGHEST];
  return is_tone ? (uint32_t)inputs[MICROPHONE_PITCH] / TENTH : 0;
}

// Less than a whole tone apart.
static int is_near(uint32_t a, uint32_t b) {
  return a * 8 < b * 9 && b * 8 < a * 9;
}

// The tone may go on, or another may begin.
static void follow(state* self, uint32_t pitch) {
  self->missing = 0;
  if (is_near(self->tone, pitch)) {
    self->tone = (uint16_t)((self->tone + pitch + 1) / 2);
    self->agreeing = 0;
    return;
  }
  self->agreeing = is_near(self->candidate, pitch) ? (uint8_t)(self->agreeing + 1) : 1;
  self->candidate = (uint16_t)pitch;
  if (self->agreeing < STEADY_SAMPLES) return;
  init(self, NULL, 0);
  self->tone = (uint16_t)pitch;
}

static void follow_silence(state* self) {
  self->agreeing = 0;
  if (++self->missing == STEADY_SAMPLES) init(self, NULL, 0);
}

// Cents above the next A below the tone.
static int32_t cents_above_a(uint32_t tone, uint32_t a) {
  while (tone < a)
    tone *= 2;
  while (tone >= a * 2)
    a *= 2;
  const uint32_t ratio = tone * ALIKE / a;
  uint32_t note = 0;
  while (ratio >= ratios[note + 1])
    ++note;
  const uint32_t step = ratios[note + 1] - ratios[note];
  return (int32_t)(note * SEMITONE + (ratio - ratios[note]) * SEMITONE / step);
}

// Cents above the note. If the tone is too far from it, the nearest note becomes the note.
static int32_t cents_above_note(state* self, int32_t tuning) {
  const int32_t cents = cents_above_a(self->tone, (uint32_t)tuning / TENTH);
  const int32_t above_c = (cents + OCTAVE - C_ABOVE_A * SEMITONE) % OCTAVE;
  int32_t above = (above_c - (self->note - 1) * SEMITONE + OCTAVE) % OCTAVE;
  if (above >= OCTAVE / 2) above -= OCTAVE;
  if (self->note != 0 && above <= STAY && above >= -STAY) return above;
  const int32_t nearest = (above_c + SEMITONE / 2) / SEMITONE;
  self->note = (uint8_t)(nearest % NOTES + 1);
  return above_c - nearest * SEMITONE;
}

// The tone SLIDE_SAMPLES before, or when it began.
static uint32_t earlier(state* self) {
  uint32_t oldest = self->tone;
  if (self->kept != 0) oldest = self->before[self->kept == SLIDE_SAMPLES ? self->next : 0];
  self->before[self->next] = self->tone;
  self->next = (uint8_t)((self->next + 1) % SLIDE_SAMPLES);
  if (self->kept < SLIDE_SAMPLES) ++self->kept;
  return oldest;
}

static int32_t slides(state* self, int32_t slide) {
  const uint32_t same = 100 * ROBOSYNC_ONE, more = same + (uint32_t)slide;
  const uint32_t before = earlier(self);
  if (self->tone * same > before * more) return RISING;
  return self->tone * more < before * same ? FALLING : STEADY;
}

static uint32_t pitch_process(void* memory, void* scratch, const robosync_block* block) {
  (void)scratch;
  state* self = memory;
  const uint32_t pitch = heard(block->inputs, block->config);
  if (pitch == 0)
    follow_silence(self);
  else
    follow(self, pitch);
  if (self->tone == 0)
    return robosync_put(block, PITCH, ROBOSYNC_UNKNOWN) |
           robosync_put(block, CENTS, ROBOSYNC_UNKNOWN) | robosync_put(block, NOTE, 0) |
           robosync_put(block, TONE, NO_TONE);
  const int32_t cents = cents_above_note(self, block->config[TUNING]);
  return robosync_put(block, PITCH, (self->tone + PER_HZ / 2) / PER_HZ * ROBOSYNC_ONE) |
         robosync_put(block, CENTS, cents * ROBOSYNC_ONE) |
         robosync_put(block, NOTE, self->note * ROBOSYNC_ONE) |
         robosync_put(block, TONE, slides(self, block->config[SLIDE]) * ROBOSYNC_ONE);
}

static const robosync_range ranges[PARAMETERS] = {
    [CLEAR] = {60000, 20000, 100000},    [LOUD] = {40000, 0, 100000},
    [LOWEST] = {80000, 80000, 2000000},  [HIGHEST] = {2000000, 80000, 2000000},
    [TUNING] = {440000, 400000, 480000}, [SLIDE] = {6000, 2000, 100000},
};

const robosync_module pitch_module = {
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
    .process = pitch_process,
};

static const char* const notes[] = {"none",    "c", "c_sharp", "d", "d_sharp", "e", "f",
                                    "f_sharp", "g", "g_sharp", "a", "a_sharp", "b"};
static const char* const tones[] = {"none", "steady", "rising", "falling"};

static const robosync_output outputs[OUTPUTS] = {
    [PITCH] = {"PITCH", ROBOSYNC_HERTZ, 80000, 2000000, NULL, 0},
    [NOTE] = {"NOTE", ROBOSYNC_NUMBER, 0, NOTES* ROBOSYNC_ONE, notes, NOTES + 1},
    [CENTS] = {"CENTS", ROBOSYNC_NUMBER, -STAY* ROBOSYNC_ONE, STAY* ROBOSYNC_ONE, NULL, 0},
    [TONE] = {"TONE", ROBOSYNC_NUMBER, 0, 3000, tones, 4},
};

static const robosync_parameter parameters[PARAMETERS] = {
    [CLEAR] = {"clear", ROBOSYNC_PERCENT}, [LOUD] = {"loud", ROBOSYNC_DECIBEL},
    [LOWEST] = {"lowest", ROBOSYNC_HERTZ}, [HIGHEST] = {"highest", ROBOSYNC_HERTZ},
    [TUNING] = {"tuning", ROBOSYNC_HERTZ}, [SLIDE] = {"slide", ROBOSYNC_PERCENT},
};

ROBOSYNC_DESCRIBE(pitch, MICROPHONE_PERIOD_MS, microphone_inputs, outputs, parameters)
