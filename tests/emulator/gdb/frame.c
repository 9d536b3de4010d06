/* A function whose variables are found through its frame pointer, since its stack pointer moves. */
__attribute__((noinline)) int scale(int size, int factor) {
  volatile int row[size];
  int local = size * factor;
  row[size - 1] = local;
  return row[size - 1];
}

int main(void) {
  return scale(3, 7);
}
