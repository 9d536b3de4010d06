// RUN: %run_c %s %t --turns -O0,-O2 --simflags "--config 1x32" --status 3
// A constructor that calls exit ends the program: no thread enters main. (Expected output by hand.)
#include <stdio.h>
#include <stdlib.h>

__attribute__((constructor)) static void refuse(void) {
  puts("no");
  exit(3);
}

int main(void) {
  return puts("main") < 0;
}
