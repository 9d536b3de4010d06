/* The heads of a TM's TPs and what they ask for, for all TPs at once. Written for AVX-512, for AVX2 and for any host.
 */
#ifndef TRAX_FAST_HEADS_H
#define TRAX_FAST_HEADS_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#ifdef __SSE2__
#include <immintrin.h>
#endif

/* What a step asks for. */
enum {
  TRAX_ASKS_SLOWLY = 1,      /* its issue has more to do: the last of a burst, a longer latency, a bubble behind it */
  TRAX_ASKS_FP_ADD = 1 << 1, /* after its operands; 0: the TP's own units */
  TRAX_ASKS_FP_MUL = 2 << 1,
  TRAX_ASKS_INT_MUL = 3 << 1,
  TRAX_ASKS_BANK = 4 << 1, /* of the data cache */
  TRAX_ASKS_SPECIAL = 5 << 1,
  TRAX_ASKS_QUEUE = 6 << 1, /* the memory queue without a bank */
  TRAX_ASKS_KIND = 7 << 1,
  TRAX_ASKS_BANK_SHIFT = 4,   /* which bank */
  TRAX_ASKS_FETCH_SHIFT = 10, /* and of the instruction cache, in the rest of the bits */
  TRAX_ASKS_FETCH = 63 << TRAX_ASKS_FETCH_SHIFT
};

struct trax_fast_heads {
  _Alignas(64) uint8_t at[64]; /* the head's number in its burst */
  uint16_t asks[64];           /* of the heads, once a cycle has begun */
  uint32_t begin[64];          /* of the TP's steps in `steps`; of TPs that do not exist, TP 0's */
  uint8_t last[64];            /* the last number of its burst */
  const uint16_t *steps; /* of all TPs, what each step asks for; of a deferred head, once its operands are usable */
};

/* The TP's step `at` becomes its head. */
static inline void trax_fast_set_head(struct trax_fast_heads *heads, unsigned tp, unsigned at) {
  heads->at[tp] = (uint8_t)at;
  heads->asks[tp] = heads->steps[heads->begin[tp] + at];
}

/* With AVX-512 and few TPs, it is cheaper to look up what all heads ask for when a cycle begins than to do so where
   they change. */
#ifdef __AVX512BW__
enum { TRAX_FAST_LOOKED_UP = 32 }; /* TPs */
#else
enum { TRAX_FAST_LOOKED_UP = 0 };
#endif

/* Each TP of `who` goes on to its next step. */
static inline void trax_fast_move_on(struct trax_fast_heads *heads, unsigned tps, uint64_t who) {
#ifdef __AVX512BW__
  if (tps <= TRAX_FAST_LOOKED_UP) {
    const __m512i at = _mm512_load_si512(heads->at);
    _mm512_store_si512(heads->at, _mm512_mask_add_epi8(at, who, at, _mm512_set1_epi8(1)));
    return;
  }
#endif
  (void)tps;
  for (; who; who &= who - 1) {
    const unsigned tp = (unsigned)__builtin_ctzll(who);
    trax_fast_set_head(heads, tp, heads->at[tp] + 1u);
  }
}

/* Begins a cycle: what the heads ask for is in heads->asks. */
static inline void trax_fast_look_up_asks(struct trax_fast_heads *heads, unsigned tps) {
#ifdef __AVX512BW__
  if (tps > TRAX_FAST_LOOKED_UP)
    return;
  __m256i half[2];
#pragma GCC unroll 2
  for (unsigned i = 0; i < 2; i++) {
    const __m512i at = _mm512_cvtepu8_epi32(_mm_load_si128((const __m128i *)heads->at + i));
    const __m512i place = _mm512_add_epi32(at, _mm512_load_si512(heads->begin + 16 * i));
    half[i] = _mm512_cvtepi32_epi16(_mm512_i32gather_epi32(place, heads->steps, 2));
  }
  _mm512_store_si512(heads->asks, _mm512_inserti64x4(_mm512_castsi256_si512(half[0]), half[1], 1));
#else
  (void)heads, (void)tps;
#endif
}

/* Into plane[k], bit `first` + k of heads->asks, for all k < `count`: constants, and all bits in the same byte. */
static inline __attribute__((always_inline)) void trax_fast_transpose(const struct trax_fast_heads *heads, unsigned tps,
                                                                      const unsigned first, const unsigned count,
                                                                      uint64_t *plane) {
#ifdef __AVX512BW__
  for (unsigned i = 0; i == 0 || i < tps; i += 32) {
    const __m512i asks = _mm512_load_si512(heads->asks + i);
#pragma GCC unroll 8
    for (unsigned k = 0; k < count; k++) {
      const uint64_t mask = _mm512_test_epi16_mask(asks, _mm512_set1_epi16((short)(1 << (first + k))));
      plane[k] = i ? plane[k] | mask << 32 : mask;
    }
  }
#elif defined(__AVX2__)
  for (unsigned i = 0; i == 0 || i < tps; i += 32) {
    __m256i half[2] = {*(const __m256i *)(heads->asks + i), *(const __m256i *)(heads->asks + i + 16)};
#pragma GCC unroll 2
    for (unsigned j = 0; j < 2; j++)
      half[j] = first < 8 ? _mm256_and_si256(half[j], _mm256_set1_epi16(0xFF)) : _mm256_srli_epi16(half[j], 8);
    const __m256i bytes = _mm256_permute4x64_epi64(_mm256_packus_epi16(half[0], half[1]), 0xD8);
#pragma GCC unroll 8
    for (unsigned k = 0; k < count; k++) {
      const int mask = _mm256_movemask_epi8(_mm256_slli_epi16(bytes, 7 - (int)((first + k) % 8)));
      plane[k] = (i ? plane[k] : 0) | (uint64_t)(uint32_t)mask << i;
    }
  }
#elif defined(__SSE2__)
  for (unsigned i = 0; i < tps; i += 16) {
    __m128i half[2] = {*(const __m128i *)(heads->asks + i), *(const __m128i *)(heads->asks + i + 8)};
    for (unsigned j = 0; j < 2; j++)
      half[j] = first < 8 ? _mm_and_si128(half[j], _mm_set1_epi16(0xFF)) : _mm_srli_epi16(half[j], 8);
    const __m128i bytes = _mm_packus_epi16(half[0], half[1]);
#pragma GCC unroll 8
    for (unsigned k = 0; k < count; k++) {
      const int mask = _mm_movemask_epi8(_mm_slli_epi16(bytes, 7 - (int)((first + k) % 8)));
      plane[k] = (i ? plane[k] : 0) | (uint64_t)(uint32_t)mask << i;
    }
  }
#else
  for (unsigned k = 0; k < count; k++)
    plane[k] = 0;
  for (unsigned i = 0; i < tps; i++)
    for (unsigned k = 0; k < count; k++)
      plane[k] |= (uint64_t)(heads->asks[i] >> (first + k) & 1) << i;
#endif
}

#endif
