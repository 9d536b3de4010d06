/* For functions of a few instructions in headers. */
#ifndef TRAX_RUNTIME_INLINE_H
#define TRAX_RUNTIME_INLINE_H

#define INLINE static inline __attribute__((always_inline, unused))

#endif
