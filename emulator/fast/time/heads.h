/* The heads of a TM's TPs, as arrays that are processed for all TPs at once. There are versions for AVX2 and for any
   host. */
#ifndef TRAX_FAST_HEADS_H
#define TRAX_FAST_HEADS_H

#include "translate/burst.h"

#include <stdbool.h>
#include <string.h>
#ifdef __AVX2__
#include <immintrin.h>
#endif

/* The 16 bits of a step: the resources that it needs. */
enum {
  TRAX_STEP_SLOW = 1,        /* a slow head: the last step of a burst, a latency above 1, or a bubble after it */
  TRAX_STEP_FP_ADD = 1 << 1, /* the resource after its operands are usable; 0: the TP's own units */
  TRAX_STEP_FP_MUL = 2 << 1,
  TRAX_STEP_INT_MUL = 3 << 1,
  TRAX_STEP_BANK = 4 << 1, /* of the data cache */
  TRAX_STEP_SPECIAL = 5 << 1,
  TRAX_STEP_QUEUE = 6 << 1,   /* the memory queue without a bank */
  TRAX_STEP_FURTHER = 7 << 1, /* a shared unit of another kind, whose number replaces the bank's */
  TRAX_STEP_KIND = 7 << 1,
  /* From TRAX_STEP_BANK_SHIFT on: the bank of the data cache. */
  TRAX_STEP_FETCH_SHIFT = 10, /* the bank of the instruction cache, in the remaining bits */
  TRAX_STEP_FETCH = 63 << TRAX_STEP_FETCH_SHIFT
};

/* With AVX2, a lane of 64 bits holds a TP's next four steps, the head's in the lowest bits. When heads are issued, the
   lanes of all TPs are shifted at once. Each 32 TPs have four rows of eight lanes: TP 4 * lane + row. */
enum { TRAX_FAST_NEXT = 4 /* steps in a lane */, TRAX_FAST_ROWS = 8 };

struct trax_fast_heads {
  _Alignas(64) uint8_t at[64]; /* the number of the head's step in its burst */
  uint8_t low[64], high[64];   /* the low and the high byte of the head's step */
  uint8_t check_at[64]; /* the first step of the burst at which the head must be checked (trax_fast_schedule_check) */
  uint8_t last[64];     /* the last step of the burst */
  uint8_t load[64];     /* the number of loads of global memory before the head in its burst */
  uint32_t address[64]; /* of the next load of global memory, from the head on */
  uint32_t begin[64];   /* the index of the TP's first step in `steps`; of TPs that do not exist, TP 0's */
  _Alignas(64) uint64_t next[TRAX_FAST_ROWS][8];
  uint32_t row_begin[TRAX_FAST_ROWS][8]; /* begin, in the order of the lanes */
  uint32_t moves;                        /* number of calls of trax_fast_move_on; every fourth one fills `next` */
  const uint16_t *steps; /* of all TPs; the step of a head that executes at issue is complete after classify */
};

static inline void trax_fast_begin_heads(struct trax_fast_heads *heads, unsigned tp, uint32_t begin) {
  heads->begin[tp] = begin;
  heads->row_begin[tp / 32 * 4 + tp % 4][tp % 32 / 4] = begin;
}

/* Makes the TP's step `at` its head. */
static inline void trax_fast_set_head(struct trax_fast_heads *heads, unsigned tp, unsigned at) {
  const uint16_t *const step = heads->steps + heads->begin[tp] + at;
  heads->at[tp] = (uint8_t)at;
  heads->low[tp] = (uint8_t)*step;
  heads->high[tp] = (uint8_t)(*step >> 8);
  memcpy(&heads->next[tp / 32 * 4 + tp % 4][tp % 32 / 4], step, sizeof **heads->next);
}

#ifdef __AVX2__
/* Returns the steps of the heads of 16 TPs: the lowest 16 bits of each lane of half a row. */
static inline __m256i trax_fast_join_rows(const __m256i *row) {
  const __m256i two = _mm256_blend_epi16(row[0], _mm256_slli_epi64(row[1], 16), 0x22);
  const __m256i three = _mm256_blend_epi16(two, _mm256_slli_epi64(row[2], 32), 0x44);
  return _mm256_blend_epi16(three, _mm256_slli_epi64(row[3], 48), 0x88);
}

/* Stores the steps of the heads of 32 TPs. */
static inline void trax_fast_set_steps(struct trax_fast_heads *heads, unsigned half, const __m256i *step) {
  const __m256i byte = _mm256_set1_epi16(0xFF);
  const __m256i low = _mm256_packus_epi16(_mm256_and_si256(step[0], byte), _mm256_and_si256(step[1], byte));
  const __m256i high = _mm256_packus_epi16(_mm256_srli_epi16(step[0], 8), _mm256_srli_epi16(step[1], 8));
  _mm256_store_si256((__m256i *)heads->low + half, _mm256_permute4x64_epi64(low, 0xD8));
  _mm256_store_si256((__m256i *)heads->high + half, _mm256_permute4x64_epi64(high, 0xD8));
}

/* Loads the lanes of 32 TPs with the steps from the heads on. */
static inline void trax_fast_fill_rows(struct trax_fast_heads *heads, unsigned half) {
  __m256i row[2][4];
  __m256i at = _mm256_load_si256((const __m256i *)heads->at + half);
#pragma GCC unroll 4
  for (unsigned i = 0; i < 4; i++, at = _mm256_srli_epi32(at, 8)) {
    const __m256i index = _mm256_add_epi32(_mm256_and_si256(at, _mm256_set1_epi32(0xFF)),
                                           _mm256_load_si256((const __m256i *)heads->row_begin[4 * half + i]));
    row[0][i] = _mm256_i32gather_epi64((const void *)heads->steps, _mm256_castsi256_si128(index), 2);
    row[1][i] = _mm256_i32gather_epi64((const void *)heads->steps, _mm256_extracti128_si256(index, 1), 2);
    _mm256_store_si256((__m256i *)heads->next[4 * half + i], row[0][i]);
    _mm256_store_si256((__m256i *)heads->next[4 * half + i] + 1, row[1][i]);
  }
  const __m256i step[2] = {trax_fast_join_rows(row[0]), trax_fast_join_rows(row[1])};
  trax_fast_set_steps(heads, half, step);
}

/* Shifts the lanes of those of 32 TPs that are in `who`. */
static inline void trax_fast_shift_rows(struct trax_fast_heads *heads, unsigned half, uint32_t who) {
  __m256i step[2];
#pragma GCC unroll 2
  for (unsigned part = 0; part < 2; part++) {
    /* Lane i has the bit of TP 16 * part + 4 * i + 3 as its sign. */
    const __m256i signs = _mm256_sllv_epi64(_mm256_set1_epi64x((long long)((uint64_t)who << (32 - 16 * part))),
                                            _mm256_set_epi64x(16, 20, 24, 28));
    __m256i row[4];
#pragma GCC unroll 4
    for (unsigned i = 0; i < 4; i++) {
      __m256i *const next = (__m256i *)heads->next[4 * half + i] + part;
      const __m256i lane = _mm256_load_si256(next);
      row[i] = (__m256i)_mm256_blendv_pd((__m256d)lane, (__m256d)_mm256_srli_epi64(lane, 16),
                                         (__m256d)_mm256_slli_epi64(signs, 3 - i));
      _mm256_store_si256(next, row[i]);
    }
    step[part] = trax_fast_join_rows(row);
  }
  trax_fast_set_steps(heads, half, step);
}
#endif

/* Makes the next step of each TP of `who` its head. `wide`: the TM has more than 32 TPs. */
static inline __attribute__((always_inline)) void trax_fast_move_on(struct trax_fast_heads *heads, const bool wide,
                                                                    uint64_t who) {
#ifdef __AVX2__
  if (__builtin_popcountll(who) <= (wide ? 8 : 4)) { /* one by one is faster */
    for (; who; who &= who - 1)
      trax_fast_set_head(heads, (unsigned)__builtin_ctzll(who), heads->at[__builtin_ctzll(who)] + 1u);
    return;
  }
  const bool fills = ++heads->moves % TRAX_FAST_NEXT == 0;
#pragma GCC unroll 2
  for (unsigned half = 0; half < 1u + wide; half++) {
    const uint32_t here = (uint32_t)(who >> 32 * half);
    const __m256i spread = _mm256_shuffle_epi8(
        _mm256_set1_epi32((int)here), _mm256_set_epi64x(0x0303030303030303, 0x0202020202020202, 0x0101010101010101, 0));
    const __m256i bit = _mm256_set1_epi64x((long long)0x8040201008040201);
    __m256i *const at = (__m256i *)heads->at + half; /* lanes of all ones are subtracted */
    _mm256_store_si256(at, _mm256_sub_epi8(*at, _mm256_cmpeq_epi8(_mm256_and_si256(spread, bit), bit)));
    if (fills)
      trax_fast_fill_rows(heads, half);
    else
      trax_fast_shift_rows(heads, half, here);
  }
#else
  (void)wide;
  for (; who; who &= who - 1) {
    const unsigned tp = (unsigned)__builtin_ctzll(who);
    const uint16_t step = heads->steps[heads->begin[tp] + ++heads->at[tp]];
    heads->low[tp] = (uint8_t)step;
    heads->high[tp] = (uint8_t)(step >> 8);
  }
#endif
}

#ifndef __AVX2__
static inline uint64_t trax_fast_eight_bytes(const uint8_t *bytes) {
  uint64_t word;
  memcpy(&word, bytes, sizeof word);
  return word;
}

/* Returns a bit of each of eight bytes, the first byte's in bit 0: the product moves byte i's bit from 8 i to 56 + i.
 */
static inline uint64_t trax_fast_bit_of_eight(uint64_t bytes, unsigned bit) {
  return ((bytes >> bit) & 0x0101010101010101) * 0x0102040810204080 >> 56;
}
#endif

/* Returns the TPs at whose heads a check is due. This only matters for TPs that are busy or uncertain. */
static inline __attribute__((always_inline)) uint64_t trax_fast_due(const struct trax_fast_heads *heads,
                                                                    const bool wide) {
#ifdef __AVX2__
  uint64_t due = 0;
  for (unsigned i = 0; i < 32u + 32 * wide; i += 32) {
    const __m256i at = _mm256_load_si256((const __m256i *)(heads->at + i));
    const __m256i later = _mm256_max_epu8(at, _mm256_load_si256((const __m256i *)(heads->check_at + i)));
    due |= (uint64_t)(uint32_t)_mm256_movemask_epi8(_mm256_cmpeq_epi8(at, later)) << i;
  }
  return due;
#else
  const uint64_t top = 0x8080808080808080;
  uint64_t due = 0;
  for (unsigned i = 0; i < 32u + 32 * wide; i += 8) {
    const uint64_t at = trax_fast_eight_bytes(heads->at + i), check_at = trax_fast_eight_bytes(heads->check_at + i);
    const uint64_t low_bits = (at | top) - (check_at & ~top); /* top bit: the low 7 bits of `at` are not less */
    due |= trax_fast_bit_of_eight((at & ~check_at) | (~(at ^ check_at) & low_bits), 7) << i;
  }
  return due;
#endif
}

/* Returns the TPs of whose next load's address the bits of `mask` are those of `address`. */
static inline uint64_t trax_fast_loads_like(const struct trax_fast_heads *heads, uint32_t mask, uint32_t address) {
  uint64_t found = 0;
#ifdef __AVX2__
  for (unsigned i = 0; i < 64; i += 8) {
    const __m256i some =
        _mm256_and_si256(_mm256_loadu_si256((const __m256i *)(heads->address + i)), _mm256_set1_epi32((int)mask));
    const __m256i like = _mm256_cmpeq_epi32(some, _mm256_set1_epi32((int)(address & mask)));
    found |= (uint64_t)(uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(like)) << i;
  }
#else
  for (unsigned i = 0; i < 64; i++)
    found |= (uint64_t)(((heads->address[i] ^ address) & mask) == 0) << i;
#endif
  return found;
}

/* Sets plane[k] to bit `first` + k of the heads' steps, for all k < `count`. first and count must be constants, and all
   bits in the same byte. */
static inline __attribute__((always_inline)) void trax_fast_transpose(const struct trax_fast_heads *heads,
                                                                      const bool wide, const unsigned first,
                                                                      const unsigned count, uint64_t *plane) {
  const uint8_t *const bytes = first < 8 ? heads->low : heads->high;
#ifdef __AVX2__
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
