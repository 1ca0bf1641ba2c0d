// Two pieces of speech, aligned for the best fit (dynamic time warping: H. Sakoe and S. Chiba, "Dynamic programming algorithm optimization
// for spoken word recognition", IEEE Trans. ASSP 26 (1978), the symmetric form with slopes from 1/2 to 2), a row at a time: a row
// is a frame of the first one, a column one of the second.
#pragma once

#include "runtime-m4/algorithms/own_words_speech.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { OWN_WORDS_ROW = OWN_WORDS_MOST_FRAMES + 8 };
typedef struct own_words_warp {
  uint32_t costs[3][OWN_WORDS_ROW];
  uint16_t local[2][OWN_WORDS_ROW];
  uint32_t at;     // the next row
  uint32_t limit;  // what costs more is too far away
} own_words_warp;

// Whether pieces of so many frames can be aligned at all.
int own_words_can_align(uint32_t a, uint32_t b);
// For a path that costs no more than `limit`.
void own_words_begin_warp(own_words_warp* self, uint32_t limit);
// Computes row self->at. Returns the columns that it computed, 0 if no path from here can stay below the limit.
uint32_t own_words_warp_row(own_words_warp* self, const own_words_speech* a,
                            const own_words_speech* b);
// When all rows are computed, in thousandths of what it costs to have nothing in common.
uint32_t own_words_warped(const own_words_warp* self, const own_words_speech* a,
                          const own_words_speech* b);
// The cost of such a distance, rounded up.
uint32_t own_words_cost_of(uint32_t distance, const own_words_speech* a, const own_words_speech* b);

#ifdef __cplusplus
}
#endif
