/* The extreme suite's cases. */
#ifndef TRAX_EXTREME_CASES_H
#define TRAX_EXTREME_CASES_H

#include "setup.h"

enum case_flags {
  CASE_CLOSED = 1,            /* every ray is inside a closed surface: none may escape */
  CASE_SHADOWS = 2,           /* with rays to the light */
  CASE_DUPLICATES = 4,        /* of triangles at equal distances the one with the lowest number must win */
  CASE_HARDWARE = 8,          /* the picture on machines at the ends of what there is */
  CASE_MANY_RAYS = 16,        /* a hundred times as many rays; a sample is judged exactly */
  CASE_BELOW_ROUNDING = 32,   /* the scene is finer than binary32 at that place: what is lost is shown, not forbidden */
  CASE_BEYOND_BINARY32 = 128, /* the watertight test in binary32 must fail: else the case would be too easy */
  CASE_BELOW_OFFSET = 256 /* surfaces nearer to each other or the light than shadow rays start off them: leaks and acne
                             that this explains are shown, not forbidden */
};

struct extreme_case {
  const char *name, *what;
  void (*make)(struct setup *setup, uint32_t rays);
  double numbers[3]; /* what tells it from other cases of this function */
  unsigned flags;
};

/* make and numbers */
#define BY(function, ...)                                                                                              \
  (function), {                                                                                                        \
    __VA_ARGS__                                                                                                        \
  }

/* From 0; NULL behind the last one. */
const struct extreme_case *extreme_case(unsigned number);

/* instance_cases.c */
extern const struct extreme_case instance_cases[];
extern const unsigned instance_case_count;

/* picture_cases.c */
extern const struct extreme_case picture_cases[];
extern const unsigned picture_case_count;

/* range_cases.c */
extern const struct extreme_case range_cases[];
extern const unsigned range_case_count;

#endif
