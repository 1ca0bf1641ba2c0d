// own_words: which of the words that it was taught is said, in any language, from the spectrum that a microphone hears
// (stdlib/devices/microphone.json: BANDS_1 …).
//
// What is said (own_words_ear.h), and each sample of a word, becomes cepstra (own_words_speech.h), and each sample is aligned with
// what was said (own_words_warp.h). That work is spread over the blocks of sound.
#include "runtime-m4/algorithms/own_words.h"

#include <stddef.h>

#include "runtime-m4/algorithms/microphone.h"
#include "runtime-m4/algorithms/own_words_ear.h"
#include "runtime-m4/algorithms/own_words_warp.h"

enum { WORD, OUTPUTS };
enum { STRICT, SHOWN_FOR, PARAMETERS };
enum { VALUES = OWN_WORDS_VALUES, MOST_FRAMES = OWN_WORDS_MOST_FRAMES, MOST_WORDS = 24 };

typedef own_words_frame frame;

// Instructions, at most.
enum {
  HEARING = 4200,  // a block, besides its work on a word
  MEASURED = 290,
  SURVEYED = 1230,
  TRANSFORMED = 1975,
  ROW = 130,
  COLUMN = 37,
  OTHER = 420,
  LAST = ROW + MOST_FRAMES * COLUMN,
  FUEL = 119000,  // in each block, besides the last step
};

enum { IDLE, MEASURE, SURVEY_HEARD, TRANSFORM_HEARD, NEXT, SURVEY, TRANSFORM, WARP };

typedef struct state {
  robosync_taught taught;
  own_words_ear ear;
  own_words_hearer hearer;
  own_words_speech heard, sample;
  own_words_warp warp;
  uint32_t at;      // the constant with which the present sample begins
  uint32_t header;  // … and it
  uint32_t best;    // the distance of the nearest word until now
  uint8_t nearest;  // the number of that word; 0: even that is too far away
  uint8_t word;     // that is shown
  uint8_t phase;
  uint8_t waiting;  // frames that were said and are not worked on
  uint8_t loudest;
  uint16_t shown_ms;  // since a word was heard
} state;

static uint32_t state_bytes(const int32_t* config) {
  (void)config;
  return sizeof(state);
}

static uint32_t cost(const int32_t* config) {
  (void)config;
  _Static_assert(HEARING + FUEL + LAST <= 127000, "the steps of a block");
  return 127000;
}

// What it was taught stays.
static void init(void* memory, const int32_t* config, uint32_t period_ms) {
  (void)config;
  (void)period_ms;
  state* self = memory;
  self->taught.first = 0;
  own_words_begin(&self->ear);
  self->phase = IDLE;
  self->waiting = self->word = 0;
  self->shown_ms = UINT16_MAX;
}

// The next so many constants from `at` on, or NULL if they are not in view, or not there.
static const int32_t* constants_at(const state* self, uint32_t at, uint32_t count) {
  const uint32_t shown = self->taught.shown;
  if (at < shown || at + count > shown + ROBOSYNC_VIEW || at + count > self->taught.count)
    return NULL;
  return &self->taught.constants[at - shown];
}

static uint32_t frames_in(uint32_t header) {
  return header >> 8 & 0xFF;
}

// Of a distance, at this strictness.
static uint32_t allowed(uint32_t distance, const int32_t* config) {
  const uint32_t most = distance < OWN_WORDS_MOST_DISTANCE ? distance : OWN_WORDS_MOST_DISTANCE;
  return most * (OWN_WORDS_USUAL_STRICT * ROBOSYNC_ONE) / (uint32_t)config[STRICT];
}

static uint32_t begin_match(state* self) {
  self->phase = MEASURE;
  self->loudest = self->hearer.at = 0;
  self->hearer.end = self->waiting;
  self->waiting = 0;
  return OTHER;
}

static uint32_t measure(state* self) {
  if (self->hearer.at < self->hearer.end) {
    self->loudest = own_words_louder(&self->ear.said[self->hearer.at++], self->loudest);
    return MEASURED;
  }
  own_words_set_noise(&self->hearer, self->ear.said_noise, self->loudest);
  own_words_begin_speech(&self->hearer, 0, self->hearer.end);
  self->phase = SURVEY_HEARD;
  return OTHER;
}

// The frames of what was said, or of the sample.
static const frame* source_of(const state* self) {
  if (!self->hearer.is_sample) return self->ear.said;
  return (const frame*)&self->taught.constants[self->at + 1 - self->taught.shown];
}

static uint32_t survey_next(state* self) {
  own_words_hearer* const hearer = &self->hearer;
  if (hearer->at < hearer->end) {
    own_words_survey(hearer, &source_of(self)[hearer->at]);
    return SURVEYED;
  }
  if (!hearer->is_sample) {
    own_words_end_survey(hearer, &self->heard);
    self->phase = TRANSFORM_HEARD;
    return OTHER;
  }
  own_words_end_survey(hearer, &self->sample);
  self->phase = own_words_can_align(self->heard.count, self->sample.count) ? TRANSFORM : NEXT;
  return OTHER;
}

static uint32_t transform_next(state* self, const int32_t* config) {
  own_words_hearer* const hearer = &self->hearer;
  own_words_speech* const into = hearer->is_sample ? &self->sample : &self->heard;
  if (hearer->at < hearer->end) {
    own_words_transform(hearer, &source_of(self)[hearer->at], into);
    return TRANSFORMED;
  }
  if (!hearer->is_sample) {
    self->at = self->header = 0;
    self->best = allowed(OWN_WORDS_MOST_DISTANCE, config) + 1;
    self->nearest = 0;
    self->phase = NEXT;
    return OTHER;
  }
  own_words_begin_warp(&self->warp, own_words_cost_of(self->best, &self->heard, &self->sample));
  self->phase = WARP;
  return OTHER;
}

// A sample in the constants; 0: there is none, or it is broken.
static uint32_t header_at(const state* self, uint32_t at) {
  const int32_t* const first = constants_at(self, at, 1);
  const uint32_t header = first != NULL ? (uint32_t)*first : 0, frames = frames_in(header);
  const int fits = frames <= MOST_FRAMES && at + 1 + VALUES * frames <= self->taught.count;
  return fits && (header & 0xFF) < MOST_WORDS && frames != 0 ? header : 0;
}

static uint32_t next_sample(state* self) {
  if (self->header != 0) self->at += 1 + VALUES * frames_in(self->header);
  self->header = 0;
  const int in_view = constants_at(self, self->at, 1) != NULL;
  const uint32_t header = header_at(self, self->at);
  if (self->at >= self->taught.count || (in_view && header == 0)) {
    self->phase = IDLE;
    return OTHER;
  }
  if (!in_view || constants_at(self, self->at, 1 + VALUES * frames_in(header)) == NULL) {
    self->taught.first = self->at;  // in the next block
    return FUEL;
  }
  self->header = header;
  own_words_begin_speech(&self->hearer, 1, frames_in(header));
  self->phase = SURVEY;
  return OTHER;
}

static uint32_t warp_next(state* self, const int32_t* config) {
  own_words_warp* const warp = &self->warp;
  if (warp->at < self->heard.count) {
    const uint32_t columns = own_words_warp_row(warp, &self->heard, &self->sample);
    if (columns == 0) self->phase = NEXT;
    return ROW + COLUMN * (columns == 0 ? MOST_FRAMES : columns);
  }
  const uint32_t distance = own_words_warped(warp, &self->heard, &self->sample);
  if (distance < self->best) {
    self->best = distance;
    self->nearest =
        distance <= allowed(self->header >> 16, config) ? (uint8_t)(self->header % 256 + 1) : 0;
  }
  self->phase = NEXT;
  return OTHER;
}

// Does a part of the work on what was said. Returns about how many instructions that took.
static uint32_t work(state* self, const int32_t* config) {
  switch (self->phase) {
    case MEASURE:
      return measure(self);
    case SURVEY_HEARD:
    case SURVEY:
      return survey_next(self);
    case TRANSFORM_HEARD:
    case TRANSFORM:
      return transform_next(self, config);
    case NEXT:
      return next_sample(self);
    default:
      return warp_next(self, config);
  }
}

// The number of a word if that is known now, else 0.
static uint32_t work_on(state* self, const int32_t* config) {
  if (self->phase == IDLE) {
    if (self->waiting == 0) return 0;
    (void)begin_match(self);
  }
  for (uint32_t done = 0; done < FUEL && self->phase != IDLE;)
    done += work(self, config);
  return self->phase == IDLE ? self->nearest : 0;
}

int own_words_is_busy(const void* memory) {
  return ((const state*)memory)->phase != IDLE;
}

uint32_t own_words_go_on(void* memory, const robosync_block* block) {
  state* self = memory;
  const uint32_t word = work_on(self, block->config);
  if (word != 0) self->shown_ms = 0;
  return word != 0 ? self->word = (uint8_t)word : self->word;
}

static uint32_t own_words_process(void* memory, void* scratch, const robosync_block* block) {
  (void)scratch;
  state* self = memory;
  frame heard;
  for (uint32_t i = 0; i < VALUES; ++i)
    heard.values[i] = (uint32_t)block->inputs[i];
  const uint32_t said = own_words_hear(&self->ear, &heard);
  if (said != 0 || self->ear.talks) self->waiting = (uint8_t)said;
  if (self->shown_ms < UINT16_MAX - MICROPHONE_PERIOD_MS) self->shown_ms += MICROPHONE_PERIOD_MS;
  if (self->shown_ms >= block->config[SHOWN_FOR]) self->word = 0;
  return robosync_put(block, WORD, (int32_t)own_words_go_on(self, block) * ROBOSYNC_ONE);
}

static const robosync_range ranges[PARAMETERS] = {
    [STRICT] = {OWN_WORDS_USUAL_STRICT * ROBOSYNC_ONE, 10000, 200000},
    [SHOWN_FOR] = {500, 100, 10000},
};

const robosync_module own_words_module = {
    .inputs = VALUES,
    .outputs = OUTPUTS,
    .parameters = PARAMETERS,
    .learns = 1,
    .shortest_period_ms = MICROPHONE_PERIOD_MS,
    .longest_period_ms = MICROPHONE_PERIOD_MS,
    .ranges = ranges,
    .state_bytes = state_bytes,
    .scratch_bytes = robosync_no_scratch,
    .cost = cost,
    .init = init,
    .process = own_words_process,
};

static const robosync_input inputs[VALUES] = {{"BANDS_1", ROBOSYNC_NUMBER},
                                              {"BANDS_2", ROBOSYNC_NUMBER},
                                              {"BANDS_3", ROBOSYNC_NUMBER},
                                              {"BANDS_4", ROBOSYNC_NUMBER}};

static const char* const no_word[] = {"none"};
static const robosync_output outputs[OUTPUTS] = {
    [WORD] = {"WORD", ROBOSYNC_NUMBER, 0, MOST_WORDS* ROBOSYNC_ONE, no_word, 1},
};

static const robosync_parameter parameters[PARAMETERS] = {
    [STRICT] = {"strict", ROBOSYNC_NUMBER},
    [SHOWN_FOR] = {"shown_for", ROBOSYNC_SECONDS},
};

ROBOSYNC_DESCRIBE(own_words, MICROPHONE_PERIOD_MS, inputs, outputs, parameters)
