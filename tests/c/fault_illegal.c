// RUN: %run_c %s %t --turns -O0,-O2 --fault "illegal instruction" --fault "fault_illegal.c:4"
// A word that is no instruction.
int main(void) {
  __asm__ volatile(".word 0");
  return 0;
}
