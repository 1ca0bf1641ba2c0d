// See own_words_warp.h.
#include "runtime-m4/algorithms/own_words_warp.h"

#include "runtime-m4/algorithms/own_words_differ.h"

enum { NEVER = 1 << 28, FAR = 1 << 14, AHEAD = 4, BESIDE = 2, BEFORE_FIRST = 16 };

int own_words_can_align(uint32_t a, uint32_t b) {
  return a != 0 && b != 0 && a <= 2 * b && b <= 2 * a;
}

void own_words_begin_warp(own_words_warp* self, uint32_t limit) {
  self->at = 0;
  self->limit = limit;
  for (uint32_t i = 0; i < BEFORE_FIRST; ++i) {
    self->costs[0][i] = self->costs[1][i] = self->costs[2][i] = NEVER;
    self->local[0][i] = self->local[1][i] = FAR;
  }
  self->costs[2][AHEAD - 1] = 0;  // before the first place
}

// The columns of row `i` that a path with these slopes from corner to corner can pass, and two on either side, so that the places
// reached from there have been computed, too.
static void reach_of(uint32_t i, uint32_t rows, uint32_t columns, uint32_t* from, uint32_t* to) {
  const uint32_t behind = rows - 1 - i, last = columns - 1;
  const uint32_t left = last - (last < 2 * behind ? last : 2 * behind);
  const uint32_t right = last - (last < behind / 2 ? last : behind / 2);
  const uint32_t first = i / 2 > left ? i / 2 : left;
  const uint32_t end = (2 * i < right ? 2 * i : right) + BESIDE;
  *from = first > BESIDE ? first - BESIDE : 0;
  *to = (end < last ? end : last) + 1;
}

static uint32_t smaller(uint32_t a, uint32_t b) {
  return a < b ? a : b;
}

static void begin_in_corner(own_words_warp* self, uint32_t end) {
  for (uint32_t j = 1; j < end; ++j)
    self->costs[0][AHEAD + j] = NEVER;
  self->costs[2][AHEAD - 1] = NEVER;
}

uint32_t own_words_warp_row(own_words_warp* self, const own_words_speech* a,
                            const own_words_speech* b) {
  const uint32_t i = self->at++;
  uint32_t first, end;
  reach_of(i, a->count, b->count, &first, &end);
  uint32_t* now = self->costs[i % 3] + AHEAD + first;
  const uint32_t* before = self->costs[(i + 2) % 3] + AHEAD + first;
  const uint32_t* twice = self->costs[(i + 1) % 3] + AHEAD + first;
  uint16_t* here = self->local[i % 2] + AHEAD + first;
  const uint16_t* there = self->local[(i + 1) % 2] + AHEAD + first;
  const uint32_t one = a->frames[i][0], two = a->frames[i][1], three = a->frames[i][2];
  uint32_t least = NEVER, last = FAR;
  uint32_t before_two = before[-2], before_one = before[-1], twice_one = twice[-1];
  now[-2] = now[-1] = NEVER;
  for (uint32_t j = first; j < end; ++j) {
    const uint32_t* const from = b->frames[j];
    const uint32_t apart = differ(three, from[2], differ(two, from[1], differ(one, from[0], 0)));
    const uint32_t wide = before_two + 2 * last, steep = twice_one + 2u * *there++;
    const uint32_t cost = smaller(before_one + apart, smaller(wide, steep)) + apart;
    before_two = before_one;
    before_one = *before++;
    twice_one = *twice++;
    *here++ = (uint16_t)(last = apart);
    *now++ = cost;
    least = smaller(least, cost);
  }
  if (i == 0) begin_in_corner(self, end);
  now[0] = now[1] = now[2] = NEVER;
  here[0] = here[1] = FAR;
  return least <= self->limit ? end - first : 0;
}

static uint32_t all_apart(const own_words_speech* a, const own_words_speech* b) {
  return a->liveliness + b->liveliness + 1;
}

uint32_t own_words_warped(const own_words_warp* self, const own_words_speech* a,
                          const own_words_speech* b) {
  const uint32_t cost = self->costs[(a->count - 1) % 3][AHEAD + b->count - 1];
  if (cost >= NEVER) return OWN_WORDS_APART;
  return smaller((uint32_t)((uint64_t)cost * 1000 / all_apart(a, b)), OWN_WORDS_APART);
}

uint32_t own_words_cost_of(uint32_t distance, const own_words_speech* a,
                           const own_words_speech* b) {
  return distance * (all_apart(a, b) / 1000 + 1);
}
