// See own_words_distance.h.
#include "runtime-m4/algorithms/own_words_distance.h"

#include "runtime-m4/algorithms/own_words_warp.h"

enum { LOUDEST = 53 };  // of a sample in a quiet room

static void hear_speech(own_words_hearer* self, const own_words_frame* frames, uint32_t count,
                        own_words_speech* into) {
  const uint8_t noise[OWN_WORDS_BANDS] = {0};
  own_words_set_noise(self, noise, LOUDEST);
  own_words_begin_speech(self, 1, count);
  while (self->at < self->end)
    own_words_survey(self, &frames[self->at]);
  own_words_end_survey(self, into);
  while (self->at < self->end)
    own_words_transform(self, &frames[self->at], into);
}

uint32_t own_words_distance(const own_words_frame* a, uint32_t a_count, const own_words_frame* b,
                            uint32_t b_count) {
  own_words_hearer hearer;
  own_words_speech one, other;
  own_words_warp warp;
  hear_speech(&hearer, a, a_count, &one);
  hear_speech(&hearer, b, b_count, &other);
  if (!own_words_can_align(one.count, other.count)) return OWN_WORDS_APART;
  own_words_begin_warp(&warp, UINT32_MAX);
  while (warp.at < one.count)
    (void)own_words_warp_row(&warp, &one, &other);
  return own_words_warped(&warp, &one, &other);
}
