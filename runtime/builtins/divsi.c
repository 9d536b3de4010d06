/* 32-bit division and remainder, for code that is not optimised or should be small. At -O2, with which this file is
   compiled, the compiler writes divisions out (llvm-target/TraxDivision.cpp). */
#include "builtins.h"

uint32_t __udivsi3(uint32_t n, uint32_t d) {
  return n / d;
}

uint32_t __umodsi3(uint32_t n, uint32_t d) {
  return n % d;
}

uint32_t __udivmodsi4(uint32_t n, uint32_t d, uint32_t *remainder) {
  *remainder = n % d;
  return n / d;
}

int32_t __divsi3(int32_t n, int32_t d) {
  return n / d;
}

int32_t __modsi3(int32_t n, int32_t d) {
  return n % d;
}

int32_t __divmodsi4(int32_t n, int32_t d, int32_t *remainder) {
  *remainder = n % d;
  return n / d;
}
