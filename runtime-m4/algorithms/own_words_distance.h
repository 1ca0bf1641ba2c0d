// How far samples of words are apart. For a computer that teaches them; the firmware does without.
#pragma once

#include "runtime-m4/algorithms/own_words.h"

#ifdef __cplusplus
extern "C" {
#endif

// The distance of two samples in a quiet room, in thousandths of that of sounds that have nothing in common.
uint32_t own_words_distance(const own_words_frame* a, uint32_t a_count, const own_words_frame* b,
                            uint32_t b_count);

#ifdef __cplusplus
}
#endif
