/* trax-eval, which is beside the program that is running. It compares runs (docs/compare.md) and makes several. */
#ifndef TRAX_COMPARE_H
#define TRAX_COMPARE_H

#include "trax/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Becomes trax-eval with these arguments, and returns only with an error. */
trax_status trax_become_eval(char **arguments, trax_error *error);
/* Adds the differences to the run of `other`, a file of --stats or a page, to a page of --explore. */
trax_status trax_compare_add(const char *other, const char *page, const volatile int *interrupt, trax_error *error);

#ifdef __cplusplus
}
#endif
#endif
