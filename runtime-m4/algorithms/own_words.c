// own_words: which of the words that it was taught is said, in any language, from the spectrum that a microphone hears
// (stdlib/devices/microphone.json: BANDS_1 …).
//
// What is said, and each sample of a word, becomes cepstra (S. Davis and P. Mermelstein, IEEE Trans. ASSP 28 (1980), section II).
// Two of these are aligned for the best fit (dynamic time warping: H. Sakoe and S. Chiba, "Dynamic programming algorithm
// optimization for spoken word recognition", IEEE Trans. ASSP 26 (1978), the symmetric form with slopes from 1/2 to 2). Samples
// were taken in a quiet room, so the noise of the moment is added to them first. The work is spread over the blocks of sound.
#include "runtime-m4/algorithms/own_words.h"

#include <stddef.h>

#if defined(__ARM_FEATURE_SIMD32)
#include <arm_acle.h>
#endif

#include "runtime-m4/algorithms/microphone.h"

enum { WORD, OUTPUTS };
enum { STRICT, SHOWN_FOR, PARAMETERS };
enum { BANDS = OWN_WORDS_BANDS, VALUES = OWN_WORDS_VALUES, IN_VALUE = BANDS / VALUES };
enum { LEVEL_BITS = 6, TOP = OWN_WORDS_MOST_LEVEL, MOST_FRAMES = OWN_WORDS_MOST_FRAMES };
enum { CEPSTRA = OWN_WORDS_CEPSTRA, MOST_WORDS = 24 };

typedef own_words_frame frame;

// ---- levels

enum { PARTS = 16 };  // of a level
// Two sounds together have the level of the louder one and, by how many quarters of a level the other is softer, these parts more.
static const uint8_t more[(TOP + 1) * 4] = {32, 30, 28, 26, 25, 23, 22, 20, 19, 17, 16, 15, 14, 13,
                                            12, 11, 10, 10, 9,  8,  8,  7,  6,  6,  5,  5,  5,  4,
                                            4,  4,  3,  3,  3,  3,  2,  2,  2,  2,  2,  2,  1,  1,
                                            1,  1,  1,  1,  1,  1,  1,  1,  1,  1,  1};

static int32_t together(int32_t a, int32_t b) {
  const uint32_t apart = (uint32_t)(a < b ? b - a : a - b);
  return (a < b ? b : a) + more[apart / 4 % sizeof more];
}

static void unpack(const frame* from, uint8_t* levels) {
  for (uint32_t v = 0; v < VALUES; ++v) {
    uint32_t rest = from->values[v];
    for (uint32_t i = 0; i < IN_VALUE; ++i, rest >>= LEVEL_BITS)
      *levels++ = (uint8_t)(rest & TOP);
  }
}

static void pack(const uint8_t* levels, frame* into) {
  for (uint32_t v = 0; v < VALUES; ++v) {
    uint32_t value = 0;
    for (uint32_t i = 0; i < IN_VALUE; ++i)
      value |= (uint32_t)levels[v * IN_VALUE + i] << (i * LEVEL_BITS);
    into->values[v] = value;
  }
}

// ---- what is said

enum {
  SMOOTH = 3,         // frames whose power is averaged …
  SMOOTH_PARTS = 51,  // … which is the level of three sounds less this
  FIRST_LOOK = 13,    // frames until the background is known
  SOFTEST = 5,        // the softest fifth is noise
  LEAST_NOISE = 2,    // softer is the effect of a sample's last bit
  MARGIN = 21,        // noise varies: a band counts from this above it, in parts
  LOUD = PARTS,       // the mean of all bands above that: the frame is loud
  IN_A_ROW = 2,       // loud frames: somebody talks
  PAUSE = 15,         // frames that are not loud end it
  LEADING = 3         // frames before the first loud one that belong to it
};

void own_words_begin(own_words_ear* ear) {
  *ear = (own_words_ear){0};
  for (uint32_t band = 0; band < BANDS; ++band)
    ear->noise[band] = LEAST_NOISE;
}

static const frame* ago(const own_words_ear* ear, uint32_t frames) {
  return &ear->before[(ear->heard - 1 - frames) % OWN_WORDS_BEFORE];
}

// In parts of a level. Only if there are enough frames.
static void smooth(const own_words_ear* ear, int32_t* into) {
  uint8_t levels[SMOOTH][BANDS];
  for (uint32_t i = 0; i < SMOOTH; ++i)
    unpack(ago(ear, i), levels[i]);
  for (uint32_t band = 0; band < BANDS; ++band) {
    const int32_t two = together(levels[0][band] * PARTS, levels[1][band] * PARTS);
    const int32_t all = together(two, levels[2][band] * PARTS) - SMOOTH_PARTS;
    into[band] = all < 0 ? 0 : all;
  }
}

static uint8_t softest(const uint8_t* counts, uint32_t all) {
  uint32_t softer = 0, level = 0;
  while (level < TOP && (softer += counts[level]) <= all / SOFTEST)
    ++level;
  return (uint8_t)(level < LEAST_NOISE ? LEAST_NOISE : level);
}

// Each third frame follows on smoothed ones that have nothing in common with it.
static void learn_noise(own_words_ear* ear, const int32_t* smoothed) {
  const uint32_t known = ear->heard / SMOOTH;
  frame* const place = &ear->noises[known % OWN_WORDS_NOISES];
  uint8_t old[BANDS], levels[BANDS];
  unpack(place, old);
  for (uint32_t band = 0; band < BANDS; ++band) {
    const int32_t level = (smoothed[band] + PARTS / 2) / PARTS;
    levels[band] = (uint8_t)(level > TOP ? TOP : level);
    if (known > OWN_WORDS_NOISES) --ear->levels_of_noise[band][old[band]];
    ++ear->levels_of_noise[band][levels[band]];
  }
  pack(levels, place);
  if (ear->heard < FIRST_LOOK) return;
  for (uint32_t band = 0; band < BANDS; ++band)
    ear->noise[band] =
        softest(ear->levels_of_noise[band], known < OWN_WORDS_NOISES ? known : OWN_WORDS_NOISES);
}

// Whether the latest frames are loud.
static int listen(own_words_ear* ear, const frame* heard) {
  ear->before[ear->heard++ % OWN_WORDS_BEFORE] = *heard;
  if (ear->heard < SMOOTH) return 0;
  int32_t smoothed[BANDS];
  smooth(ear, smoothed);
  if (ear->heard % SMOOTH == 0) learn_noise(ear, smoothed);
  int32_t above = 0;
  for (uint32_t band = 0; band < BANDS; ++band) {
    const int32_t more_than = smoothed[band] - ear->noise[band] * PARTS - MARGIN;
    above += more_than > 0 ? more_than : 0;
  }
  return ear->heard >= FIRST_LOOK && above >= LOUD * BANDS;
}

void own_words_learn(own_words_ear* ear, const frame* heard) {
  (void)listen(ear, heard);
}

static void begin_to_talk(own_words_ear* ear) {
  ear->talks = 1;
  for (uint32_t band = 0; band < BANDS; ++band)
    ear->said_noise[band] = ear->noise[band];
  for (uint32_t i = 0; i < LEADING + IN_A_ROW; ++i)
    ear->said[i] = *ago(ear, LEADING + IN_A_ROW - 1 - i);
  ear->length = ear->loud_until = LEADING + IN_A_ROW;
}

// The last frames may be loud only because they are averaged with those before them.
static uint32_t end_of_talk(own_words_ear* ear) {
  ear->talks = 0;
  const uint32_t frames = ear->loud_until - (SMOOTH - 2u);
  ear->was_too_long = frames > MOST_FRAMES;
  return ear->was_too_long || frames < LEADING + OWN_WORDS_LEAST_FRAMES ? 0 : frames;
}

uint32_t own_words_hear(own_words_ear* ear, const frame* heard) {
  const int loud = listen(ear, heard);
  ear->loud_in_a_row =
      (uint8_t)(loud ? (ear->loud_in_a_row < IN_A_ROW ? ear->loud_in_a_row + 1 : IN_A_ROW + 1) : 0);
  if (!ear->talks) {
    if (ear->loud_in_a_row == IN_A_ROW) begin_to_talk(ear);
    return 0;
  }
  if (ear->length < MOST_FRAMES) ear->said[ear->length] = *heard;
  if (ear->length < UINT16_MAX) ++ear->length;
  if (loud) ear->loud_until = ear->length;
  return ear->length - ear->loud_until >= PAUSE ? end_of_talk(ear) : 0;
}

// ---- cepstra

enum {
  NOISE_VARIES = 1,  // it was measured where it was softest
  DEEPEST = 24,      // levels below the loudest: inaudible
  SOFT = 30,         // … or no longer speech
  SPEECH = 27,       // above the noise, mean of all bands in parts: where speech begins and ends
  LOUDEST = 53,      // of a sample in a quiet room
  HALF = BANDS / 2
};

// Cepstrum 0 is the mean of the levels; the others are how much they rise and fall once, twice … over the bands. The second half of
// each wave mirrors the first one, with the other sign if its number is odd. In parts of a dB in 16 levels.
static const int8_t waves[CEPSTRA][HALF] = {
    {8, 8, 8, 8, 8, 8, 8, 8, 8, 8},
    {30, 30, 28, 26, 23, 20, 16, 12, 7, 2},
    {30, 27, 21, 14, 5, -5, -14, -21, -27, -30},
    {30, 23, 12, -2, -16, -26, -30, -28, -20, -7},
    {29, 18, 0, -18, -29, -29, -18, 0, 18, 29},
    {28, 12, -12, -28, -28, -12, 12, 28, 28, 12},
    {27, 5, -21, -30, -14, 14, 30, 21, -5, -27},
    {26, -2, -28, -23, 7, 30, 20, -12, -30, -16},
    {25, -9, -30, -9, 25, 25, -9, -30, -9, 25},
    {23, -16, -28, 7, 30, 2, -30, -12, 26, 20},
    {21, -21, -21, 21, 21, -21, -21, 21, 21, -21},
    {20, -26, -12, 30, 2, -30, 7, 28, -16, -23},
};
enum { WAVE_BITS = 10, ZERO = 128 };  // a cepstrum of 0

static uint8_t louder(const frame* from, uint8_t loudest) {
  uint8_t levels[BANDS];
  unpack(from, levels);
  for (uint32_t band = 0; band < BANDS; ++band)
    if (levels[band] > loudest) loudest = levels[band];
  return loudest;
}

static void set_noise(own_words_hearer* self, const uint8_t* noise, uint8_t loudest) {
  self->loudest = loudest;
  self->deepest = (uint8_t)(loudest > DEEPEST ? loudest - DEEPEST : 0);
  for (uint32_t band = 0; band < BANDS; ++band)
    self->noise[band] = (uint8_t)(noise[band] + NOISE_VARIES);
}

static void begin_speech(own_words_hearer* self, uint8_t is_sample, uint32_t count) {
  self->is_sample = is_sample;
  self->at = self->first = self->behind = 0;
  self->end = (uint8_t)count;
  for (uint32_t band = 0; band < BANDS; ++band)
    self->sums[band] = 0;
}

// In parts: a sample as it would be in this noise, or what was said, raised to the noise; what can hardly be heard beside the loudest
// counts less and less. Returns how far it is above the noise, summed over the bands.
static int32_t in_noise(const own_words_hearer* self, const frame* from, int32_t* into) {
  int32_t above = 0;
  const int32_t floor = (self->loudest - SOFT) * PARTS;
  uint8_t levels[BANDS];
  unpack(from, levels);
  for (uint32_t band = 0; band < BANDS; ++band) {
    const int32_t noise = self->noise[band] * PARTS;
    int32_t level = levels[band] * PARTS;
    if (self->is_sample)
      level = together(self->loudest * PARTS - level, noise);
    else if (level < noise)
      level = noise;
    above += level > floor ? level - (noise > floor ? noise : floor) : 0;
    into[band] = together(level, self->deepest * PARTS);
  }
  return above;
}

// The first time: where the speech begins and ends, and its mean: what all frames have in common comes from the microphone and the
// speaker's distance.
static void survey(own_words_hearer* self, const frame* from) {
  int32_t levels[BANDS];
  const int loud = in_noise(self, from, levels) >= SPEECH * BANDS;
  if (loud || self->behind != 0)
    for (uint32_t band = 0; band < BANDS; ++band)
      self->sums[band] += levels[band];
  if (loud && self->behind == 0) self->first = self->at;
  ++self->at;
  if (!loud) return;
  self->behind = self->at;
  for (uint32_t band = 0; band < BANDS; ++band)
    self->means[band] = self->sums[band];
}

static void end_survey(own_words_hearer* self, own_words_speech* into) {
  into->count = (uint32_t)self->behind - self->first;
  into->liveliness = 0;
  self->at = self->first;
  self->end = self->behind;
  for (uint32_t band = 0; band < BANDS && into->count != 0; ++band)
    self->means[band] /= (int32_t)into->count;
}

// The sum of the differences of four bytes.
static inline uint32_t differ(uint32_t a, uint32_t b, uint32_t sum) {
#if defined(__ARM_FEATURE_SIMD32)
  return __usada8(a, b, sum);
#else
  for (uint32_t i = 0; i < 32; i += 8) {
    const uint32_t one = a >> i & 0xFF, other = b >> i & 0xFF;
    sum += one > other ? one - other : other - one;
  }
  return sum;
#endif
}

static int32_t wave_of(const int32_t* halves, const int8_t* wave) {
  int32_t sum = 0;
  for (uint32_t i = 0; i < HALF; ++i)
    sum += halves[i] * wave[i];
  return sum;
}

static uint32_t byte_of(int32_t wave) {
  const int32_t value = ((wave + (1 << (WAVE_BITS - 1))) >> WAVE_BITS) + ZERO;
  return (uint32_t)(value < 0 ? 0 : value > UINT8_MAX ? UINT8_MAX : value);
}

// The second time.
static void transform(own_words_hearer* self, const frame* from, own_words_speech* into) {
  int32_t levels[BANDS], halves[2][HALF];
  (void)in_noise(self, from, levels);
  for (uint32_t band = 0; band < HALF; ++band) {
    const int32_t low = levels[band] - self->means[band];
    const int32_t high = levels[BANDS - 1 - band] - self->means[BANDS - 1 - band];
    halves[0][band] = low + high;
    halves[1][band] = low - high;
  }
  uint32_t* const cepstra = into->frames[self->at++ - self->first];
  for (uint32_t i = 0; i < CEPSTRA; i += 4) {
    uint32_t four = 0;
    for (uint32_t j = 0; j < 4; ++j)
      four |= byte_of(wave_of(halves[j % 2], waves[i + j])) << (8 * j);
    cepstra[i / 4] = four;
    into->liveliness = differ(four, 0x80808080u, into->liveliness);
  }
}

// ---- warping

enum { NEVER = 1 << 28, FAR = 1 << 14, AHEAD = 4, BESIDE = 2, BEFORE_FIRST = 16 };

// Can they be aligned at all?
static int can_align(uint32_t a, uint32_t b) {
  return a != 0 && b != 0 && a <= 2 * b && b <= 2 * a;
}

static void begin_warp(own_words_warp* self, uint32_t limit) {
  self->at = 0;
  self->limit = limit;
  self->least = NEVER;
  for (uint32_t i = 0; i < BEFORE_FIRST; ++i) {
    self->costs[0][i] = self->costs[1][i] = self->costs[2][i] = NEVER;
    self->local[0][i] = self->local[1][i] = FAR;
  }
  self->costs[2][AHEAD - 1] = 0;  // before the first place
}

// The columns of row `i` that a path with these slopes from corner to corner can pass, and two on either side, so that the places
// reached from there have been computed, too.
static void reach_of(uint32_t i, uint32_t rows, uint32_t columns, uint32_t* from, uint32_t* to) {
  const uint32_t behind = rows - 1 - i, last = columns - 1;
  const uint32_t left = last - (last < 2 * behind ? last : 2 * behind);
  const uint32_t right = last - (last < behind / 2 ? last : behind / 2);
  const uint32_t first = i / 2 > left ? i / 2 : left;
  const uint32_t end = (2 * i < right ? 2 * i : right) + BESIDE;
  *from = first > BESIDE ? first - BESIDE : 0;
  *to = (end < last ? end : last) + 1;
}

static uint32_t smaller(uint32_t a, uint32_t b) {
  return a < b ? a : b;
}

static void begin_in_corner(own_words_warp* self, uint32_t end) {
  for (uint32_t j = 1; j < end; ++j)
    self->costs[0][AHEAD + j] = NEVER;
  self->costs[2][AHEAD - 1] = NEVER;
}

// Computes a row. Returns the columns that it computed, 0 if no path from here can stay below the limit.
static uint32_t warp_row(own_words_warp* self, const own_words_speech* a,
                         const own_words_speech* b) {
  const uint32_t i = self->at++;
  uint32_t first = 0, end = 0;
  reach_of(i, a->count, b->count, &first, &end);
  uint32_t* now = self->costs[i % 3] + AHEAD + first;
  const uint32_t* before = self->costs[(i + 2) % 3] + AHEAD + first;
  const uint32_t* twice = self->costs[(i + 1) % 3] + AHEAD + first;
  uint16_t* here = self->local[i % 2] + AHEAD + first;
  const uint16_t* there = self->local[(i + 1) % 2] + AHEAD + first;
  const uint32_t one = a->frames[i][0], two = a->frames[i][1], three = a->frames[i][2];
  uint32_t least = NEVER, last = FAR;
  uint32_t before_two = before[-2], before_one = before[-1], twice_one = twice[-1];
  now[-2] = now[-1] = NEVER;
  for (uint32_t j = first; j < end; ++j) {
    const uint32_t* const from = b->frames[j];
    const uint32_t apart = differ(three, from[2], differ(two, from[1], differ(one, from[0], 0)));
    const uint32_t wide = before_two + 2 * last, steep = twice_one + 2u * *there++;
    const uint32_t cost = smaller(before_one + apart, smaller(wide, steep)) + apart;
    before_two = before_one;
    before_one = *before++;
    twice_one = *twice++;
    *here++ = (uint16_t)(last = apart);
    *now++ = cost;
    least = smaller(least, cost);
  }
  if (i == 0) begin_in_corner(self, end);
  now[0] = now[1] = now[2] = NEVER;
  here[0] = here[1] = FAR;
  const uint32_t of_two = smaller(least, self->least);  // every path passes one of any two rows
  self->least = least;
  return of_two <= self->limit ? end - first : 0;
}

static uint32_t all_apart(const own_words_speech* a, const own_words_speech* b) {
  return a->liveliness + b->liveliness + 1;
}

// When all rows are computed.
static uint32_t distance_of(const own_words_warp* self, const own_words_speech* a,
                            const own_words_speech* b) {
  const uint32_t cost = self->costs[(a->count - 1) % 3][AHEAD + b->count - 1];
  if (cost >= NEVER) return OWN_WORDS_APART;
  return smaller((uint32_t)((uint64_t)cost * 1000 / all_apart(a, b)), OWN_WORDS_APART);
}

static void hear_speech(own_words_hearer* self, const frame* frames, uint32_t count,
                        own_words_speech* into) {
  const uint8_t noise[BANDS] = {0};
  set_noise(self, noise, LOUDEST);
  begin_speech(self, 1, count);
  while (self->at < self->end)
    survey(self, &frames[self->at]);
  end_survey(self, into);
  while (self->at < self->end)
    transform(self, &frames[self->at], into);
}

uint32_t own_words_distance(const frame* a, uint32_t a_count, const frame* b, uint32_t b_count) {
  own_words_hearer hearer;
  own_words_speech one, other;
  own_words_warp warp;
  hear_speech(&hearer, a, a_count, &one);
  hear_speech(&hearer, b, b_count, &other);
  if (!can_align(one.count, other.count)) return OWN_WORDS_APART;
  begin_warp(&warp, NEVER);
  while (warp.at < one.count)
    (void)warp_row(&warp, &one, &other);
  return distance_of(&warp, &one, &other);
}

// ---- the module

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
  const uint32_t most = smaller(distance, OWN_WORDS_MOST_DISTANCE);
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
    self->loudest = louder(&self->ear.said[self->hearer.at++], self->loudest);
    return MEASURED;
  }
  set_noise(&self->hearer, self->ear.said_noise, self->loudest);
  begin_speech(&self->hearer, 0, self->hearer.end);
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
    survey(hearer, &source_of(self)[hearer->at]);
    return SURVEYED;
  }
  if (!hearer->is_sample) {
    end_survey(hearer, &self->heard);
    self->phase = TRANSFORM_HEARD;
    return OTHER;
  }
  end_survey(hearer, &self->sample);
  self->phase = can_align(self->heard.count, self->sample.count) ? TRANSFORM : NEXT;
  return OTHER;
}

static uint32_t transform_next(state* self, const int32_t* config) {
  own_words_hearer* const hearer = &self->hearer;
  own_words_speech* const into = hearer->is_sample ? &self->sample : &self->heard;
  if (hearer->at < hearer->end) {
    transform(hearer, &source_of(self)[hearer->at], into);
    return TRANSFORMED;
  }
  if (!hearer->is_sample) {
    self->at = self->header = 0;
    self->best = allowed(OWN_WORDS_MOST_DISTANCE, config) + 1;
    self->nearest = 0;
    self->phase = NEXT;
    return OTHER;
  }
  begin_warp(&self->warp, self->best * (all_apart(&self->heard, &self->sample) / 1000 + 1));
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
  begin_speech(&self->hearer, 1, frames_in(header));
  self->phase = SURVEY;
  return OTHER;
}

static uint32_t warp_next(state* self, const int32_t* config) {
  own_words_warp* const warp = &self->warp;
  if (warp->at < self->heard.count) {
    const uint32_t columns = warp_row(warp, &self->heard, &self->sample);
    if (columns == 0) self->phase = NEXT;
    return ROW + COLUMN * (columns == 0 ? MOST_FRAMES : columns);
  }
  const uint32_t distance = distance_of(warp, &self->heard, &self->sample);
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

static const robosync_description description = {
    "own_words", &own_words_module, MICROPHONE_PERIOD_MS, inputs, outputs, parameters,
};

const robosync_description* own_words_describe(uint32_t abi);
const robosync_description* own_words_describe(uint32_t abi) {
  return abi == ROBOSYNC_ABI ? &description : NULL;
}
