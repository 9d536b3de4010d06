/* trax-ld, the program. */
#include "ld.h"

int main(int argc, char **argv) {
  return ld_main(argc, argv);
}
