// The parts of own_words.c, for a computer that teaches it words (companion/). The firmware uses only own_words_module.
//
// A frame is what a microphone heard in 20 ms: the levels of 20 bands in steps of 1.5 dB (drivers/spectrum.hpp), five in a value.
#pragma once

#include "runtime-m4/algorithms/robosync_module.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  OWN_WORDS_BANDS = 20,
  OWN_WORDS_VALUES = 4,  // of a frame
  OWN_WORDS_MOST_LEVEL = 63,
  OWN_WORDS_MOST_FRAMES = 92,  // of a word
  OWN_WORDS_LEAST_FRAMES = 7,
  OWN_WORDS_CEPSTRA = 12,
  OWN_WORDS_APART = 1000000,      // the distance of words that cannot be aligned
  OWN_WORDS_MOST_DISTANCE = 550,  // at which anything is still a word
  OWN_WORDS_USUAL_STRICT = 50
};

typedef struct own_words_frame {
  uint32_t values[OWN_WORDS_VALUES];
} own_words_frame;

// A sample of a word begins with this in the module's constants; its frames follow, each level as far below the sample's loudest.
// `word`: its number, 0 to 23; `most`: the largest distance in thousandths at which something is still that word.
static inline int32_t own_words_header(uint32_t word, uint32_t frames, uint32_t most) {
  return (int32_t)(word | frames << 8 | most << 16);
}

// What is said: from the first loud frame to the last one before a pause. A frame is loud if it is above the background, which is
// the level of the softest fifth of the last three seconds, in each band.
enum { OWN_WORDS_NOISES = 50, OWN_WORDS_BEFORE = 5 };
typedef struct own_words_ear {
  uint8_t levels_of_noise[OWN_WORDS_BANDS]
                         [OWN_WORDS_MOST_LEVEL + 1];  // how often each is in `noises`
  own_words_frame noises[OWN_WORDS_NOISES];           // every third frame, smoothed, in a ring
  own_words_frame before[OWN_WORDS_BEFORE];           // the latest frames, in a ring
  own_words_frame said[OWN_WORDS_MOST_FRAMES];
  uint8_t noise[OWN_WORDS_BANDS];       // the background
  uint8_t said_noise[OWN_WORDS_BANDS];  // … before it was said
  uint32_t heard;                       // frames
  uint16_t length, loud_until;          // of what is said, in frames
  uint8_t loud_in_a_row, talks, was_too_long;
} own_words_ear;

void own_words_begin(own_words_ear* ear);
// Only learns the background. For the beginning of a recording.
void own_words_learn(own_words_ear* ear, const own_words_frame* frame);
// Not 0: something has ended with this frame, and is in `said`: so many frames. What is shorter or longer than a word is ignored.
uint32_t own_words_hear(own_words_ear* ear, const own_words_frame* frame);

// Speech as cepstra, without the frames at its ends that noise covers.
typedef struct own_words_speech {
  uint32_t frames[OWN_WORDS_MOST_FRAMES]
                 [OWN_WORDS_CEPSTRA / 4];  // a cepstrum in each byte, in dB, 128 is 0
  uint32_t liveliness;                     // the distance of all frames from their mean
  uint32_t count;
} own_words_speech;

// Turns frames into that, one by one.
typedef struct own_words_hearer {
  int32_t sums[OWN_WORDS_BANDS], means[OWN_WORDS_BANDS];
  uint8_t noise[OWN_WORDS_BANDS];  // as loud as it may be
  uint8_t loudest,
      deepest;  // of what was said: its loudest level, and the softest that is audible beside it
  uint8_t is_sample;      // its levels are below the loudest, and it was taken in a quiet room
  uint8_t at, end;        // frames
  uint8_t first, behind;  // … above the noise
} own_words_hearer;

enum { OWN_WORDS_ROW = OWN_WORDS_MOST_FRAMES + 8 };
typedef struct own_words_warp {
  uint32_t costs[3][OWN_WORDS_ROW];
  uint16_t local[2][OWN_WORDS_ROW];
  uint32_t at;     // the next row
  uint32_t least;  // the cost of the cheapest place in the last one
  uint32_t limit;  // what costs more is too far away
} own_words_warp;

// The distance of two samples in a quiet room, in thousandths of that of sounds that have nothing in common.
uint32_t own_words_distance(const own_words_frame* a, uint32_t a_count, const own_words_frame* b,
                            uint32_t b_count);

// A computer that has the time goes on with the module's work at once: while it is busy, after robosync_show(). Returns the number of
// the word that is heard then; 0: none.
int own_words_is_busy(const void* state);
uint32_t own_words_go_on(void* state, const robosync_block* block);

#ifdef __cplusplus
}
#endif
