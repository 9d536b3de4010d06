/* Between manifest.c, which reads, and manifest_write.c. */
#ifndef TRAX_HOST_MANIFEST_H
#define TRAX_HOST_MANIFEST_H

#include <stddef.h>

#define TRAX_MANIFEST_FORMAT 1
#define TRAX_HASH_DIGITS 32

/* XXH3 of 128 bits as hexadecimal digits, as xxhsum -H2 prints it. */
void trax_hash(char digits[TRAX_HASH_DIGITS + 1], const void *bytes, size_t size);

#endif
