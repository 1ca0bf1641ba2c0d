// What is said: from the first loud frame to the last one before a pause. A frame is loud if it is above the background, which is
// the level of the softest fifth of the last three seconds, in each band.
#pragma once

#include "runtime-m4/algorithms/own_words.h"

#ifdef __cplusplus
extern "C" {
#endif

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

#ifdef __cplusplus
}
#endif
