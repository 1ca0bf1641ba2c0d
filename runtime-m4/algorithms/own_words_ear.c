// See own_words_ear.h.
#include "runtime-m4/algorithms/own_words_ear.h"

#include "runtime-m4/algorithms/own_words_levels.h"

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
  ear->was_too_long = frames > OWN_WORDS_MOST_FRAMES;
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
  if (ear->length < OWN_WORDS_MOST_FRAMES) ear->said[ear->length] = *heard;
  if (ear->length < UINT16_MAX)
    ++ear->length;
  else
    --ear->loud_until;  // as long ago as it would be
  if (loud) ear->loud_until = ear->length;
  return ear->length - ear->loud_until >= PAUSE ? end_of_talk(ear) : 0;
}
