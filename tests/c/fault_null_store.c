// RUN: %run_c %s %t --turns -O0,-O2 --fault "null page" --fault "store of 1 byte" --fault fault_null_store.c:8
// A store through a null pointer.
struct object {
  char padding[40], flag;
};

__attribute__((noinline)) static void set(volatile struct object *o) {
  o->flag = 1;
}

int main(void) {
  static struct object good;
  set(&good);
  set(0);
  return 0;
}
