// Speech as cepstra (S. Davis and P. Mermelstein, IEEE Trans. ASSP 28 (1980), section II). Samples were taken in a quiet room, so the
// noise of the moment is added to them first.
#pragma once

#include "runtime-m4/algorithms/own_words.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { OWN_WORDS_CEPSTRA = 12 };

// Without the frames at its ends that noise covers.
typedef struct own_words_speech {
  uint32_t frames[OWN_WORDS_MOST_FRAMES]
                 [OWN_WORDS_CEPSTRA / 4];  // a cepstrum in each byte, in dB, 128 is 0
  uint32_t liveliness;                     // the distance of all frames from their mean
  uint32_t count;
} own_words_speech;

// Turns frames into speech, one by one.
typedef struct own_words_hearer {
  int32_t sums[OWN_WORDS_BANDS], means[OWN_WORDS_BANDS];
  uint8_t noise[OWN_WORDS_BANDS];  // as loud as it may be
  uint8_t loudest,
      deepest;  // of what was said: its loudest level, and the softest that is audible beside it
  uint8_t is_sample;      // its levels are below the loudest, and it was taken in a quiet room
  uint8_t at, end;        // frames
  uint8_t first, behind;  // … above the noise
} own_words_hearer;

// The loudest level of the frame, or that one if it is louder.
uint8_t own_words_louder(const own_words_frame* from, uint8_t loudest);
// For all speech from now on: the background, and the loudest level of what was said.
void own_words_set_noise(own_words_hearer* self, const uint8_t* noise, uint8_t loudest);
void own_words_begin_speech(own_words_hearer* self, uint8_t is_sample, uint32_t count);
// All frames go through both: the first finds where the speech begins and ends, and its mean; then those in between, from
// hearer->at to hearer->end, become cepstra.
void own_words_survey(own_words_hearer* self, const own_words_frame* from);
void own_words_end_survey(own_words_hearer* self, own_words_speech* into);
void own_words_transform(own_words_hearer* self, const own_words_frame* from,
                         own_words_speech* into);

#ifdef __cplusplus
}
#endif
