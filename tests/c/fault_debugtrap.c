// RUN: %run_c %s %t --fault "abort" --status 134
int main(void) {
  __builtin_debugtrap();
  return 0;
}
