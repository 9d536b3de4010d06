// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DSTATUS=-1 --status 255
// RUN: %run_c %s %t --levels -O2 --cflags -DSTATUS=0x1234 --status 52
// RUN: %run_c %s %t --levels -O2 --cflags -DSTATUS=256 --status 0
// The exit status is the low byte of main's result. (Expected output by hand.)
#include <stdio.h>

static volatile int status = STATUS;

int main(void) {
  puts("done");
  return status;
}
