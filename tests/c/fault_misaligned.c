// RUN: %run_c %s %t --turns -O0,-O2 --fault "misaligned" --fault "fault_misaligned.c:9"
// A word at an address that is no multiple of 4.
static _Alignas(4) char bytes[8] = {1};
static char *volatile start = bytes;

int main(void) {
  int *p = (int *)(void *)(start + 1);
  *(volatile char *)start = 2;
  return *(volatile int *)p;
}
