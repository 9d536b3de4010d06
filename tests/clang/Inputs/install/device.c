#include "device.h"
#include <stdio.h>
int main(void) {
  printf("sum %d\n", sum_below(100));
  return 0;
}
