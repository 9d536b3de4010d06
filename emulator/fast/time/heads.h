/* The heads of a TM's TPs, as arrays that are processed for all TPs at once. There are versions for AVX2 and for any
   host. */
#ifndef TRAX_FAST_HEADS_H
#define TRAX_FAST_HEADS_H

#include "fast/time/masks.h"
#include "translate/burst.h"

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
  _Alignas(64) uint64_t next[TRAX_FAST_ROWS][8];
  uint32_t begin[TRAX_FAST_ROWS][8]; /* the index of the TP's first step in `steps`; of TPs that do not exist, TP 0's */
  uint8_t lane[64];                  /* of each TP, in `next` and `begin` */
  uint32_t moves;                    /* number of calls of trax_fast_move_on; every fourth one fills `next` */
  const uint16_t *steps; /* of all TPs; the step of a head that executes at issue is complete after classify */
};

/* Makes the TP's step `at` its head. */
static inline void trax_fast_set_head(struct trax_fast_heads *heads, unsigned tp, unsigned at) {
  const unsigned lane = heads->lane[tp];
  const uint16_t *const step = heads->steps + heads->begin[lane / 8][lane % 8] + at;
  heads->at[tp] = (uint8_t)at;
  heads->low[tp] = (uint8_t)*step;
  heads->high[tp] = (uint8_t)(*step >> 8);
  memcpy(&heads->next[lane / 8][lane % 8], step, sizeof **heads->next);
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
                                           _mm256_load_si256((const __m256i *)heads->begin[4 * half + i]));
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
static ALWAYS_INLINE void trax_fast_move_on(struct trax_fast_heads *heads, const bool wide, uint64_t who) {
#ifdef __AVX2__
  if (__builtin_popcountll(who) > (wide ? 8 : 4)) { /* fewer are faster one by one */
    const bool fills = ++heads->moves % TRAX_FAST_NEXT == 0;
    trax_fast_count_bytes(heads->at, wide, who);
#pragma GCC unroll 2
    for (unsigned half = 0; half < 1u + wide; half++)
      if (fills)
        trax_fast_fill_rows(heads, half);
      else
        trax_fast_shift_rows(heads, half, (uint32_t)(who >> 32 * half));
    return;
  }
#else
  (void)wide;
#endif
  for (; who; who &= who - 1)
    trax_fast_set_head(heads, (unsigned)__builtin_ctzll(who), heads->at[__builtin_ctzll(who)] + 1u);
}

/* Returns the TPs at whose heads a check is due. This only matters for TPs that are busy or uncertain. */
static ALWAYS_INLINE uint64_t trax_fast_due(const struct trax_fast_heads *heads, const bool wide) {
  uint64_t due = 0;
  for (unsigned i = 0; i < 32u + 32 * wide; i += TRAX_FAST_VECTOR) {
    const trax_fast_bytes at = *(const trax_fast_bytes *)(heads->at + i);
    const trax_fast_bytes check_at = *(const trax_fast_bytes *)(heads->check_at + i);
    due |= trax_fast_top_bits((trax_fast_bytes)(at >= check_at)) << i;
  }
  return due;
}

/* Sets plane[k] to bit `first` + k of the heads' steps, for all k < `count`. first and count must be constants, and all
   bits in the same byte. */
static ALWAYS_INLINE void trax_fast_transpose(const struct trax_fast_heads *heads, const bool wide,
                                              const unsigned first, const unsigned count, uint64_t *plane) {
  const uint8_t *const bytes = first < 8 ? heads->low : heads->high;
  for (unsigned i = 0; i < 32u + 32 * wide; i += TRAX_FAST_VECTOR) {
    const trax_fast_lanes16 some = *(const trax_fast_lanes16 *)(bytes + i);
#pragma GCC unroll 8
    for (unsigned k = 0; k < count; k++)
      plane[k] = (i ? plane[k] : 0) | trax_fast_top_bits((trax_fast_bytes)(some << (int)(7 - (first + k) % 8))) << i;
  }
}

#endif
