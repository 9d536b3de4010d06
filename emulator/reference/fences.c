/* docs/timing-memory.md, "Fences". */
#include "reference/reference.h"

bool trax_ref_fence_waits(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  for (uint32_t i = 0; tp->inst.op == TRAX_OP_FENCE && i < tm->places; i++) {
    const struct trax_ref_request *request = &tm->queue[i];
    if (request->tp == tp->number && ((request->kind == ATOMIC && trax_ref_fences(tp, TRAX_FENCE_RW)) ||
                                      (request->kind == WRITE && trax_ref_fences(tp, TRAX_FENCE_W))))
      return true;
  }
  return false;
}

void trax_ref_fence(struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  if (!trax_ref_fences(tp, TRAX_FENCE_R))
    return;
  tm->stats->dropped_lines += trax_ref_lines_drop(&tm->dcache);
  for (uint32_t i = 0; i < tm->places; i++)
    tm->queue[i].passing = tm->queue[i].kind == DATA_LINE;
}
