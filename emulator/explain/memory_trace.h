/* The trace of transfers: a listener (machine/transfers.h), not a reader of spans. */
#ifndef TRAX_EXPLAIN_MEMORY_TRACE_H
#define TRAX_EXPLAIN_MEMORY_TRACE_H

#include "explain/span.h"

enum { TRAX_MEMORY_TRACE_RECORD = 20 }; /* bytes of a record of the binary trace */

trax_status trax_memory_trace_create(struct trax_memory_trace **trace, struct trax_explain *explain, trax_error *error);
trax_status trax_memory_trace_finish(struct trax_memory_trace *trace, trax_error *error);
void trax_memory_trace_destroy(struct trax_memory_trace *trace); /* which may be NULL */

#endif
