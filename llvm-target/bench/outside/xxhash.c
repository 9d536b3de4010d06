#include "outside.h"
#define XXH_STATIC_LINKING_ONLY
#include <xxhash.h>

enum { SIZE = 100000 };
static _Alignas(8) char text[SIZE]; /* loads of words are tested for, as of a buffer of malloc */

void kernel_setup(void) {
  outside_begin();
  outside_text(text, SIZE);
}

struct result kernel_run(void) {
  uint64_t long_hash = XXH64(text, SIZE, 1), third = XXH3_64bits(text, SIZE);
  uint32_t sum = XXH32(text, SIZE, 1);
  return (struct result){
      mix(mix(sum, (uint32_t)long_hash ^ (uint32_t)(long_hash >> 32)), (uint32_t)third ^ (uint32_t)(third >> 32)), 0};
}
