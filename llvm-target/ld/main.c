/* trax-ld, the program. */
#include "ld.h"

#include "trax/reads.h"
#include "trax/signals.h"

int main(int argc, char **argv) {
  trax_reads_begin();
  trax_end_with_parent(); /* the compiler that waits for it */
  return ld_main(argc, argv);
}
