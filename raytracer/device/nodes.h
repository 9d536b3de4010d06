/* The common part of all layouts of nodes (layouts/). The layout is a constant in code that is compiled for one, so
   that nothing is left of the others. */
#ifndef TRAX_DEVICE_NODES_H
#define TRAX_DEVICE_NODES_H

#include "layouts/records.h"
#include "vector.h"

#include <stdbool.h>
#include <stdint.h>

#ifndef GENERAL_LAYOUTS_ONLY
#if defined __trax__ && !defined TRAX_NODE_LAYOUT
#define GENERAL_LAYOUTS_ONLY 1
#else
#define GENERAL_LAYOUTS_ONLY 0
#endif
#endif

/* is_NAME for each layout; has_NAME_planes and has_NAME_visit for each that has its own. In general programs all but
   the first layout are the second. Each predicate is a plain function: the compiler's choices depend on it. */
enum {
#define LAYOUT(number, NAME, name, general, ...) name##_number = number, name##_general = general,
#include "layouts/table.def"
#define OWN(kind) kind##_number
#define LAYOUT(number, NAME, name, general, planes, ...) | planes << 4 * number
  PLANES = 0
#include "layouts/table.def"
  ,
#define OWN(kind) kind##_number
#define LAYOUT(number, NAME, name, general, planes, visit, ...) | visit << 4 * number
  VISITS = 0
#include "layouts/table.def"
};
#define LAYOUT(number, NAME, name, general, ...)                                                                       \
  static inline bool is_##name(uint32_t layout) {                                                                      \
    return GENERAL_LAYOUTS_ONLY ? general && layout != 0 : layout == number;                                           \
  }
#include "layouts/table.def"
#define OF(kind)
#define OWN(kind)                                                                                                      \
  static inline bool has_##kind##_planes(uint32_t layout) {                                                            \
    return GENERAL_LAYOUTS_ONLY ? kind##_general && layout != 0 : (PLANES >> 4 * layout & 15) == kind##_number;        \
  }
#define LAYOUT(number, NAME, name, general, planes, ...) planes
#include "layouts/table.def"
#define OF(kind)
#define OWN(kind)                                                                                                      \
  static inline bool has_##kind##_visit(uint32_t layout) {                                                             \
    return GENERAL_LAYOUTS_ONLY ? kind##_general && layout != 0 : (VISITS >> 4 * layout & 15) == kind##_number;        \
  }
#define LAYOUT(number, NAME, name, general, planes, visit, ...) visit
#include "layouts/table.def"

/* A ray, prepared for boxes. A plane is at (plane - origin) * inverse, or, if it is a number on the grid, at plane *
   inverse - origin. The origins, one for near and one for far planes, include the margin by which boxes are widened. */
struct box_ray {
  struct vector near_origin, far_origin, inverse;
};

static inline uint32_t load_word(const char *address) {
  return *(const uint32_t *)(const void *)address;
}

static inline float load_float(const char *address) {
  return *(const float *)(const void *)address;
}

#endif
