/* For races_test.py: each thread has a byte of each word, which the others neither read nor write; what all have is
 * read only. */
#include <trax.h>

static const unsigned table[4] = {3, 5, 7, 11};
static unsigned char bytes[64 * 4];

int main(void) {
  volatile unsigned char *own = bytes + trax_thread() % 4;
  for (unsigned round = 0; round < 8; round++)
    for (unsigned i = 0; i < sizeof bytes; i += 4)
      own[i] = (unsigned char)(own[i] + table[i / 4 % 4]);
  return own[0] != 24;
}
