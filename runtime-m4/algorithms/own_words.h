// What own_words hears and is taught, for those that teach it (companion/), and how a computer runs it. Its parts are in
// own_words_….h; the firmware uses only own_words_module.
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

// A computer that has the time goes on with the module's work at once: while it is busy, after robosync_show(). Returns the number of
// the word that is heard then; 0: none.
int own_words_is_busy(const void* state);
uint32_t own_words_go_on(void* state, const robosync_block* block);

#ifdef __cplusplus
}
#endif
