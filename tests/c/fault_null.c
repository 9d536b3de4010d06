// RUN: %run_c %s %t --turns -O0,-O2 --fault "null" --fault "fault_null.c:8" --fault "0x00000010"
// A load through a null pointer.
struct list {
  int values[4], next;
};
static struct list *volatile nothing;

int main(void) { return nothing->next; }
