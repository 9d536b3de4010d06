/* Further functions of the heap. */
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>

int posix_memalign(void **memory, size_t alignment, size_t size) {
  if (alignment < sizeof(void *) || (alignment & (alignment - 1)))
    return EINVAL;
  void *fresh = aligned_alloc(alignment, size);
  if (!fresh)
    return ENOMEM;
  *memory = fresh;
  return 0;
}

void *memalign(size_t alignment, size_t size) {
  return aligned_alloc(alignment, size);
}

void *reallocarray(void *memory, size_t count, size_t size) {
  size_t bytes;
  if (__builtin_mul_overflow(count, size, &bytes)) {
    errno = ENOMEM;
    return NULL;
  }
  return realloc(memory, bytes);
}
