// RUN: %run_c %s %t --turns -O0,-O2 --fault "read-only" --fault "fault_read_only.c:7" --fault "constant"
// A store to a constant.
static const volatile int constant[2] = {1, 2};

int main(void) {
  volatile int *p = (volatile int *)constant;
  p[1] = 3;
  return 0;
}
