/* Executes one instruction by a switch over the semantics. It is included after machine/semantics_begin.h and the
   definitions that the includer owes, and includes machine/semantics_end.h. An illegal word has faulted before and does
   nothing here. */
switch ((trax_op)inst->op) {
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  case TRAX_OP_##NAME:                                                                                                 \
    __VA_ARGS__                                                                                                        \
    break;
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
case TRAX_OP_ILLEGAL:
case TRAX_OP_COUNT:
  break;
}
#include "machine/semantics_end.h"
