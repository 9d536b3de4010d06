// RUN: %run_c %s %t --turns -O0,-O2 --fault "fault_unmapped.c:5" --fault "0xf0000000"
// A store beyond the end of memory.
int main(void) {
  volatile char *p = (volatile char *)0xF0000000u;
  *p = 1;
  return 0;
}
