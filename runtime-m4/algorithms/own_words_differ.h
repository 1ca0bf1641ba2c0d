// How far cepstra are apart. Only the files own_words_….c include this.
#pragma once

#include <stdint.h>

#if defined(__ARM_FEATURE_SIMD32)
#include <arm_acle.h>
#endif

// The sum of the differences of four bytes.
static inline uint32_t differ(uint32_t a, uint32_t b, uint32_t sum) {
#if defined(__ARM_FEATURE_SIMD32)
  return __usada8(a, b, sum);
#else
  for (uint32_t i = 0; i < 32; i += 8) {
    const uint32_t one = a >> i & 0xFF, other = b >> i & 0xFF;
    sum += one > other ? one - other : other - one;
  }
  return sum;
#endif
}
