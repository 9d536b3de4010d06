// RUN: %run_c %s %t --turns -O0,-O2 --fault fault_inlined.c:9 --fault fault_inlined.c:15
// RUN: %run_c %s %t --levels -O2 --fault "inlined into" --fault fault_inlined.c:19
// A fault in a function that is inlined into another: the report names all the places.
struct list {
  volatile struct list *next;
};

static inline __attribute__((always_inline)) volatile struct list *after(volatile struct list *l) {
  return l->next;
}

static volatile struct list one, two = {&one};

static inline __attribute__((always_inline)) volatile struct list *second(volatile struct list *l) {
  return after(after(after(l)));
}

int main(void) {
  return second(&two) != 0;
}
