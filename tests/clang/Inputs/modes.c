#ifdef QUOTED
const char quoted[] = QUOTED;
#endif
int twice(int x) { return 2 * x; }
