/* The heads of a TM's TPs and what they ask for, for all TPs at once. Written for AVX-512, for AVX2 and for any host.
 */
#ifndef TRAX_FAST_HEADS_H
#define TRAX_FAST_HEADS_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#ifdef __AVX2__
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
  TRAX_ASKS_QUEUE = 6 << 1,   /* the memory queue without a bank */
  TRAX_ASKS_FURTHER = 7 << 1, /* a shared unit without a place of its own: which, where else the bank is */
  TRAX_ASKS_KIND = 7 << 1,
  TRAX_ASKS_BANK_SHIFT = 4,   /* which bank */
  TRAX_ASKS_FETCH_SHIFT = 10, /* and of the instruction cache, in the rest of the bits */
  TRAX_ASKS_FETCH = 63 << TRAX_ASKS_FETCH_SHIFT
};

/* With AVX-512, what a TP's next steps ask for waits in a lane of 64 bits, the head's in the lowest ones, and goes down
   when the head is issued, for all TPs at once. Of each 32 TPs, four rows of eight lanes: TP 4 * lane + row. */
enum { TRAX_FAST_NEXT = 4 /* steps in a lane */, TRAX_FAST_ROWS = 8 };

struct trax_fast_heads {
  _Alignas(64) uint8_t at[64]; /* the head's number in its burst */
  uint8_t load[64];            /* how many loads of global memory its burst has before it */
  uint8_t low[64], high[64];   /* what the heads ask for: the bytes of it */
  uint8_t look[64];            /* the first number of its burst at which trax_fast_plan wants the head looked at */
  uint8_t last[64];            /* the last number of its burst */
  uint32_t begin[64];          /* of the TP's steps in `steps`; of TPs that do not exist, TP 0's */
  _Alignas(64) uint64_t next[TRAX_FAST_ROWS][8];
  uint32_t row_begin[TRAX_FAST_ROWS][8]; /* as begin */
  uint32_t moves;                        /* of all TPs; `next` is filled in every fourth */
  const uint16_t *steps; /* of all TPs, what each step asks for; of a deferred head, once its operands are usable */
};

static inline void trax_fast_begin_heads(struct trax_fast_heads *heads, unsigned tp, uint32_t begin) {
  heads->begin[tp] = begin;
  heads->row_begin[tp / 32 * 4 + tp % 4][tp % 32 / 4] = begin;
}

/* The TP's step `at` becomes its head. */
static inline void trax_fast_set_head(struct trax_fast_heads *heads, unsigned tp, unsigned at) {
  const uint16_t *const step = heads->steps + heads->begin[tp] + at;
  heads->at[tp] = (uint8_t)at;
  heads->low[tp] = (uint8_t)*step;
  heads->high[tp] = (uint8_t)(*step >> 8);
#ifdef __AVX512BW__
  memcpy(&heads->next[tp / 32 * 4 + tp % 4][tp % 32 / 4], step, sizeof **heads->next);
#endif
}

#ifdef __AVX512BW__
/* From the rows of 32 TPs, what their heads ask for: the lowest 16 bits of each lane. */
static inline __m512i trax_fast_join_rows(const __m512i *row) {
  __m512i asks = row[0];
#pragma GCC unroll 3
  for (unsigned i = 1; i < 4; i++) /* what is below stays */
    asks = _mm512_ternarylogic_epi64(asks, _mm512_slli_epi64(row[i], 16 * i),
                                     _mm512_set1_epi64(((long long)1 << 16 * i) - 1), 0xE4);
  return asks;
}

/* Notes what the heads ask for; of each 32 TPs, asks[...]. Stored as it is going to be loaded. */
static inline void trax_fast_set_asks(struct trax_fast_heads *heads, const bool wide, const __m512i *asks) {
#pragma GCC unroll 2
  for (unsigned i = 0; i < 2; i++) {
    uint8_t *const bytes = i ? heads->high : heads->low;
    const __m256i first = _mm512_cvtepi16_epi8(_mm512_srli_epi16(asks[0], 8 * i));
    if (wide)
      _mm512_store_si512(bytes, _mm512_inserti64x4(_mm512_castsi256_si512(first),
                                                   _mm512_cvtepi16_epi8(_mm512_srli_epi16(asks[1], 8 * i)), 1));
    else
      _mm256_store_si256((__m256i *)bytes, first);
  }
}

/* Fills the lanes of all TPs from their heads on. */
static inline __attribute__((always_inline)) void trax_fast_fill_rows(struct trax_fast_heads *heads, const bool wide) {
  __m512i asks[2];
  for (unsigned half = 0; half < 1u + wide; half++) {
    __m512i *const next = (__m512i *)heads->next[4 * half];
    const __m256i *const begin = (const __m256i *)heads->row_begin[4 * half];
    __m256i at = _mm256_load_si256((const __m256i *)heads->at + half);
#pragma GCC unroll 4
    for (unsigned i = 0; i < 4; i++, at = _mm256_srli_epi32(at, 8))
      next[i] = _mm512_i32gather_epi64(_mm256_add_epi32(_mm256_and_si256(at, _mm256_set1_epi32(0xFF)), begin[i]),
                                       heads->steps, sizeof *heads->steps);
    asks[half] = trax_fast_join_rows(next);
  }
  trax_fast_set_asks(heads, wide, asks);
}
#endif

/* Each TP of `who` goes on to its next step. `wide`: there may be more than 32. */
static inline __attribute__((always_inline)) void trax_fast_move_on(struct trax_fast_heads *heads, const bool wide,
                                                                    uint64_t who) {
#ifdef __AVX512BW__
  const __m512i at = _mm512_load_si512(heads->at);
  _mm512_store_si512(heads->at, _mm512_mask_add_epi8(at, who, at, _mm512_set1_epi8(1)));
  if (++heads->moves % TRAX_FAST_NEXT == 0) {
    trax_fast_fill_rows(heads, wide);
    return;
  }
  __m512i asks[2];
#pragma GCC unroll 2
  for (unsigned half = 0; half < 1u + wide; half++) {
    __m512i *const next = (__m512i *)heads->next[4 * half];
    __m512i row[4];
#pragma GCC unroll 4
    for (unsigned i = 0; i < 4; i++) {
      const __mmask8 moves = (__mmask8)_pext_u64(who, (uint64_t)0x11111111 << (32 * half + i));
      next[i] = row[i] = _mm512_mask_srli_epi64(next[i], moves, next[i], 16);
    }
    asks[half] = trax_fast_join_rows(row);
  }
  trax_fast_set_asks(heads, wide, asks);
#else
  (void)wide;
  for (; who; who &= who - 1) {
    const unsigned tp = (unsigned)__builtin_ctzll(who);
    trax_fast_set_head(heads, tp, heads->at[tp] + 1u);
  }
#endif
}

#ifndef __AVX2__
static inline uint64_t trax_fast_eight_bytes(const uint8_t *bytes) {
  uint64_t word;
  memcpy(&word, bytes, sizeof word);
  return word;
}

/* A bit of each of eight bytes, the first byte's the lowest: the product moves the one of byte i from 8 i to 56 + i. */
static inline uint64_t trax_fast_bit_of_eight(uint64_t bytes, unsigned bit) {
  return ((bytes >> bit) & 0x0101010101010101) * 0x0102040810204080 >> 56;
}
#endif

/* The TPs whose heads must be looked at, if there is anything to look for. */
static inline __attribute__((always_inline)) uint64_t trax_fast_due(const struct trax_fast_heads *heads,
                                                                    const bool wide) {
#ifdef __AVX512BW__
  (void)wide;
  return _mm512_cmpge_epu8_mask(_mm512_load_si512(heads->at), _mm512_load_si512(heads->look));
#elif defined(__AVX2__)
  uint64_t due = 0;
  for (unsigned i = 0; i < 32u + 32 * wide; i += 32) {
    const __m256i at = _mm256_load_si256((const __m256i *)(heads->at + i));
    const __m256i later = _mm256_max_epu8(at, _mm256_load_si256((const __m256i *)(heads->look + i)));
    due |= (uint64_t)(uint32_t)_mm256_movemask_epi8(_mm256_cmpeq_epi8(at, later)) << i;
  }
  return due;
#else
  const uint64_t top = 0x8080808080808080;
  uint64_t due = 0;
  for (unsigned i = 0; i < 32u + 32 * wide; i += 8) {
    const uint64_t at = trax_fast_eight_bytes(heads->at + i), look = trax_fast_eight_bytes(heads->look + i);
    const uint64_t low_bits = (at | top) - (look & ~top); /* the top bit: those below are at least those of `look` */
    due |= trax_fast_bit_of_eight((at & ~look) | (~(at ^ look) & low_bits), 7) << i;
  }
  return due;
#endif
}

/* The heads of `who`, loads of global memory, are issued. */
static inline __attribute__((always_inline)) void trax_fast_pass_loads(struct trax_fast_heads *heads, uint64_t who) {
#ifdef __AVX512BW__
  const __m512i load = _mm512_load_si512(heads->load);
  _mm512_store_si512(heads->load, _mm512_mask_add_epi8(load, who, load, _mm512_set1_epi8(1)));
#else
  for (; who; who &= who - 1)
    heads->load[__builtin_ctzll(who)]++;
#endif
}

/* Into plane[k], bit `first` + k of what the heads ask for, for all k < `count`: constants, and all bits in the same
   byte. */
static inline __attribute__((always_inline)) void trax_fast_transpose(const struct trax_fast_heads *heads,
                                                                      const bool wide, const unsigned first,
                                                                      const unsigned count, uint64_t *plane) {
  const uint8_t *const bytes = first < 8 ? heads->low : heads->high;
#ifdef __AVX512BW__
#pragma GCC unroll 8
  for (unsigned k = 0; k < count; k++) {
    const char bit = (char)(1 << (first + k) % 8);
    plane[k] = wide ? _mm512_test_epi8_mask(_mm512_load_si512(bytes), _mm512_set1_epi8(bit))
                    : _mm256_test_epi8_mask(_mm256_load_si256((const __m256i *)bytes), _mm256_set1_epi8(bit));
  }
#elif defined(__AVX2__)
  for (unsigned i = 0; i < 32u + 32 * wide; i += 32) {
    const __m256i some = _mm256_load_si256((const __m256i *)(bytes + i));
#pragma GCC unroll 8
    for (unsigned k = 0; k < count; k++) {
      const int mask = _mm256_movemask_epi8(_mm256_slli_epi16(some, 7 - (int)((first + k) % 8)));
      plane[k] = (i ? plane[k] : 0) | (uint64_t)(uint32_t)mask << i;
    }
  }
#else
  for (unsigned i = 0; i < 32u + 32 * wide; i += 8) {
    const uint64_t some = trax_fast_eight_bytes(bytes + i);
    for (unsigned k = 0; k < count; k++)
      plane[k] = (i ? plane[k] : 0) | trax_fast_bit_of_eight(some, (first + k) % 8) << i;
  }
#endif
}

#endif
