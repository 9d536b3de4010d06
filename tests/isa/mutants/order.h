/* Events that machine.c, which stands between the files of the reference engine, reports to order.c. */
#ifndef TRAX_TESTS_ISA_MUTANTS_ORDER_H
#define TRAX_TESTS_ISA_MUTANTS_ORDER_H

#include "reference/reference.h"

/* The TP's access, whose address is known, is about to be made; may come again before it is. */
void trax_order_before(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp);
/* The TP's instruction has issued. */
void trax_order_behind(const struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t);
/* An increment's result has arrived. */
void trax_order_arrival(const struct trax_ref_tm *tm, const struct trax_ref_request *atomic);
/* Cycle t begins. */
void trax_order_cycle(const struct trax_ref_tm *tm, uint64_t t);
/* The machine ends by a fault. */
void trax_order_fault(const struct trax_ref_tm *tm);

#endif
