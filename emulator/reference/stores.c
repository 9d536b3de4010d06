/* docs/timing.md, "Stores and write combining". */
#include "reference/reference.h"

enum { BLOCK = 64 }; /* bytes */

static uint32_t least(uint32_t a, uint32_t b) {
  return a < b ? a : b;
}

static uint32_t greatest(uint32_t a, uint32_t b) {
  return a > b ? a : b;
}

static bool request_write(struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint32_t begin, uint32_t end) {
  return trax_ref_request(
      tm, (struct trax_ref_request){.kind = WRITE, .tp = tp->number, .address = begin, .bytes = end - begin});
}

bool trax_ref_write_run(struct trax_ref_tm *tm, struct trax_ref_tp *tp) {
  if (tp->run_begin != tp->run_end && !request_write(tm, tp, tp->run_begin, tp->run_end))
    return false;
  tp->run_begin = tp->run_end = 0;
  return true;
}

static bool combines(const struct trax_ref_tp *tp, uint32_t begin, uint32_t end) {
  return tp->run_begin != tp->run_end && begin / BLOCK == tp->run_begin / BLOCK && begin <= tp->run_end &&
         end >= tp->run_begin;
}

static bool write(struct trax_ref_tm *tm, struct trax_ref_tp *tp) {
  const uint32_t begin = tp->address, end = begin + trax_ref_info(tp)->access_bytes;
  if (!tm->config->memory.write_combining)
    return request_write(tm, tp, begin, end);
  if (combines(tp, begin, end)) {
    tm->stats->combined_stores++;
    tp->outcome |= TRAX_OUTCOME_COMBINED;
    tp->run_begin = least(tp->run_begin, begin);
    tp->run_end = greatest(tp->run_end, end);
    return true;
  }
  if (!trax_ref_write_run(tm, tp))
    return false;
  tp->run_begin = begin;
  tp->run_end = end;
  return true;
}

bool trax_ref_store(struct trax_ref_tm *tm, struct trax_ref_tp *tp) {
  if (!write(tm, tp))
    return false;
  if (trax_ref_is(tp, TRAX_IS_NONTEMPORAL)) {
    tm->stats->nontemporal_stores++;
    return true;
  }
  if (trax_ref_lines_use(&tm->dcache, tp->address / tm->config->dcache.line_bytes)) { /* updated in place */
    tm->stats->store_hits++;
    tp->outcome |= TRAX_OUTCOME_HIT;
  } else {
    tm->stats->store_misses++;
  }
  return true;
}
