volatile int go_on = 1, turns;
int main(void) {
  while (go_on)
    turns++;
  return 5;
}
