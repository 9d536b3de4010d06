/* Memory on the stack, which has 512 bytes in all. */
#ifndef TRAX_ALLOCA_H
#define TRAX_ALLOCA_H

#define alloca(size) __builtin_alloca(size)

#endif
