// See own_words_levels.h.
#include "runtime-m4/algorithms/own_words_levels.h"

// Two sounds together have the level of the louder one and, by how many quarters of a level the other is softer, these parts more.
const uint8_t own_words_more[OWN_WORDS_QUARTERS] = {
    32, 30, 28, 26, 25, 23, 22, 20, 19, 17, 16, 15, 14, 13, 12, 11, 10, 10,
    9,  8,  8,  7,  6,  6,  5,  5,  5,  4,  4,  4,  3,  3,  3,  3,  2,  2,
    2,  2,  2,  2,  1,  1,  1,  1,  1,  1,  1,  1,  1,  1,  1,  1,  1};
