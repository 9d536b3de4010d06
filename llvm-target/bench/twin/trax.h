/* <trax.h> for machines other than the TP, so that the ray tracer's sources can be compared: each function is the least
   that such a machine can do for it. */
#ifndef TRAX_H
#define TRAX_H

#include <trax/ray_kinds.h>

struct trax_buffer {
  void *data;
  unsigned size; /* bytes */
};

#ifdef HOST
extern int exact_rsqrt; /* of the driver */
#endif

/* Two roundings instead of the TP's one; with exact_rsqrt the TP's result. */
static inline float trax_rsqrt(float x) {
#ifdef HOST
  if (exact_rsqrt)
    return x >= 0 ? (float)(1.0 / __builtin_sqrt((double)x)) : __builtin_nanf("");
#endif
  return 1.0f / __builtin_sqrtf(x);
}

static inline unsigned trax_atomic_inc(unsigned *p) {
  return (*p)++;
}
static inline void trax_store_nt(unsigned *p, unsigned value) {
  *p = value;
}
static inline void trax_count_rays(unsigned n) {
  (void)n;
}
enum {
#define TRAX_RAY_KIND(X, ID, name, number, meaning) TRAX_RAY_##ID = number,
  TRAX_RAY_KINDS(TRAX_RAY_KIND, )
};
#define TRAX_RAYS(kind, n) ((unsigned)(n) << TRAX_KIND_BITS * (kind))
static inline void trax_count_kinds(unsigned rays) {
  (void)rays;
}
static inline void trax_count_items(unsigned n) {
  (void)n;
}
static inline unsigned trax_tm(void) {
  return 0;
}
static inline unsigned trax_thread(void) {
  return 0;
}
static inline void trax_abort(const char *message) {
  (void)message;
  __builtin_trap();
}

#endif
