/* Memory on the stack: 512 bytes are all there is. */
#ifndef TRAX_ALLOCA_H
#define TRAX_ALLOCA_H

#define alloca(size) __builtin_alloca(size)

#endif
