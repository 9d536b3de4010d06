int *volatile nowhere = (int *)8;
__attribute__((noinline)) int load(int *at) {
  return *at;
}
int main(void) {
  return load(nowhere) + 1;
}
