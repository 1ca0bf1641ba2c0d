// The levels of a frame's bands, in steps of 1.5 dB; softer than that in parts of such a step. Only the files own_words_….c include
// this.
#pragma once

#include "runtime-m4/algorithms/own_words.h"

enum { BANDS = OWN_WORDS_BANDS, VALUES = OWN_WORDS_VALUES, IN_VALUE = BANDS / VALUES };
enum { LEVEL_BITS = 6, TOP = OWN_WORDS_MOST_LEVEL };
enum { PARTS = 16 };  // of a level

typedef own_words_frame frame;

enum { OWN_WORDS_QUARTERS = (TOP + 1) * 4 };
extern const uint8_t own_words_more[OWN_WORDS_QUARTERS];

// In parts: the level of two sounds together.
static inline int32_t together(int32_t a, int32_t b) {
  const uint32_t apart = (uint32_t)(a < b ? b - a : a - b);
  return (a < b ? b : a) + own_words_more[apart / 4 % OWN_WORDS_QUARTERS];
}

static inline void unpack(const frame* from, uint8_t* levels) {
  for (uint32_t v = 0; v < VALUES; ++v) {
    uint32_t rest = from->values[v];
    for (uint32_t i = 0; i < IN_VALUE; ++i, rest >>= LEVEL_BITS)
      *levels++ = (uint8_t)(rest & TOP);
  }
}

static inline void pack(const uint8_t* levels, frame* into) {
  for (uint32_t v = 0; v < VALUES; ++v) {
    uint32_t value = 0;
    for (uint32_t i = 0; i < IN_VALUE; ++i)
      value |= (uint32_t)levels[v * IN_VALUE + i] << (i * LEVEL_BITS);
    into->values[v] = value;
  }
}
