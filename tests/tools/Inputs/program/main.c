struct point { float x, y; unsigned char tag; };
int helper(struct point *p, long long wide);
int counter = 3;
static int twice(int value) { int result = value * 2; return result; }
int main(void) {
  struct point local = {1.0f, 2.0f, 'a'};
  long long wide = 1LL << 40;
  return helper(&local, wide) + twice(counter);
}
