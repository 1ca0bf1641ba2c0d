// See own_words_speech.h.
#include "runtime-m4/algorithms/own_words_speech.h"

#include "runtime-m4/algorithms/own_words_differ.h"
#include "runtime-m4/algorithms/own_words_levels.h"

enum {
  NOISE_VARIES = 1,  // it was measured where it was softest
  DEEPEST = 24,      // levels below the loudest: inaudible
  SOFT = 30,         // … or no longer speech
  SPEECH = 27,       // above the noise, mean of all bands in parts: where speech begins and ends
  HALF = BANDS / 2
};

// Cepstrum 0 is the mean of the levels; the others are how much they rise and fall once, twice … over the bands. The second half of
// each wave mirrors the first one, with the other sign if its number is odd. In parts of a dB in 16 levels.
static const int8_t waves[OWN_WORDS_CEPSTRA][HALF] = {
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

uint8_t own_words_louder(const frame* from, uint8_t loudest) {
  uint8_t levels[BANDS];
  unpack(from, levels);
  for (uint32_t band = 0; band < BANDS; ++band)
    if (levels[band] > loudest) loudest = levels[band];
  return loudest;
}

void own_words_set_noise(own_words_hearer* self, const uint8_t* noise, uint8_t loudest) {
  self->loudest = loudest;
  self->deepest = (uint8_t)(loudest > DEEPEST ? loudest - DEEPEST : 0);
  for (uint32_t band = 0; band < BANDS; ++band)
    self->noise[band] = (uint8_t)(noise[band] + NOISE_VARIES);
}

void own_words_begin_speech(own_words_hearer* self, uint8_t is_sample, uint32_t count) {
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
void own_words_survey(own_words_hearer* self, const frame* from) {
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

void own_words_end_survey(own_words_hearer* self, own_words_speech* into) {
  into->count = (uint32_t)self->behind - self->first;
  into->liveliness = 0;
  self->at = self->first;
  self->end = self->behind;
  for (uint32_t band = 0; band < BANDS && into->count != 0; ++band)
    self->means[band] /= (int32_t)into->count;
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
void own_words_transform(own_words_hearer* self, const frame* from, own_words_speech* into) {
  int32_t levels[BANDS], halves[2][HALF];
  (void)in_noise(self, from, levels);
  for (uint32_t band = 0; band < HALF; ++band) {
    const int32_t low = levels[band] - self->means[band];
    const int32_t high = levels[BANDS - 1 - band] - self->means[BANDS - 1 - band];
    halves[0][band] = low + high;
    halves[1][band] = low - high;
  }
  uint32_t* const cepstra = into->frames[self->at++ - self->first];
  for (uint32_t i = 0; i < OWN_WORDS_CEPSTRA; i += 4) {
    uint32_t four = 0;
    for (uint32_t j = 0; j < 4; ++j)
      four |= byte_of(wave_of(halves[j % 2], waves[i + j])) << (8 * j);
    cepstra[i / 4] = four;
    into->liveliness = differ(four, 0x80808080u, into->liveliness);
  }
}
