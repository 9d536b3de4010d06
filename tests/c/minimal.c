// RUN: %run_c %s %t --levels -O2
// A program without printf holds little more than itself: exit status by main. (Expected output by hand.)
static volatile int zero;
int main(void) {
  return zero;
}
