// RUN: %run_c %s %t
// Attributes that change calls, kept code, places and start-up. (Expected output by hand.)
#include <stdio.h>
#include <stdlib.h>

#define NOINLINE __attribute__((noinline))

// Weak definitions, aliases, references that may stay empty.
__attribute__((weak)) int weak_value = 3;
NOINLINE int original(int x) {
  return 2 * x + 1;
}
int renamed(int x) __attribute__((alias("original")));
int weakly_renamed(int x) __attribute__((weak, alias("original")));
extern int nowhere(void) __attribute__((weak));
static int maybe(void) __attribute__((weakref("nowhere_either")));
extern int second_name __attribute__((alias("first_name")));
int first_name = 40;

// The body is the assembly alone.
__attribute__((naked)) static int sum(int a, int b) {
  __asm__("add a0, a0, a1\n\tret");
}

// A section of one's own, with its ends.
struct entry {
  const char *name;
  int value;
};
#define ENTRY(text, number)                                                                                            \
  __attribute__((used, section("entries"))) static const struct entry entry_##number = {text, number};
ENTRY("one", 1)
ENTRY("two", 2)
ENTRY("three", 3)
extern const struct entry __start_entries[], __stop_entries[];
__attribute__((section(".text.far"), noinline)) static int far_away(int x) {
  return x - 1;
}

// Run at the ends of scopes, in reverse order, however the scope is left.
static char trail[64], *trail_end = trail;
static void leave(const char *c) {
  *trail_end++ = *c;
}
NOINLINE static int scopes(int n) {
  char a __attribute__((cleanup(leave))) = 'a';
  for (int i = 0; i < n; i++) {
    char b __attribute__((cleanup(leave))) = (char)('0' + i);
    if (i == 1)
      continue;
    char c __attribute__((cleanup(leave))) = 'c';
    if (i == 3)
      goto out;
  }
  return 0;
out:
  return 1;
}

// Run before main, lower priorities first.
static char order[8];
static int started;
__attribute__((constructor(200))) static void second(void) {
  order[started++] = '2';
}
__attribute__((constructor)) static void third(void) {
  order[started++] = '3';
}
__attribute__((constructor(101))) static void first(void) {
  order[started++] = '1';
}

struct __attribute__((packed)) packed {
  char c;
  int i;
  struct __attribute__((packed, aligned(2))) {
    short s;
    long long l;
  } inner;
};
_Noreturn static void finish(void);

int main(void) {
  printf("%s\n", order);
  printf("%d %d %d %d %d\n", weak_value, renamed(5), weakly_renamed(6), second_name, &second_name == &first_name);
  printf("%d %d\n", nowhere ? nowhere() : -1, maybe ? maybe() : -2);
  printf("%d %d\n", sum(40, 2), far_away(8));
  int total = 0;
  for (const struct entry *e = __start_entries; e < __stop_entries; e++)
    total += e->value * (e->name[0] == 't' ? 10 : 1);
  printf("%d entries, %d\n", (int)(__stop_entries - __start_entries), total);
  int two = scopes(2), five = scopes(5);
  printf("%d %d %s\n", two, five, trail);
  volatile struct packed p = {'x', 0x12345678, {-2, 0x123456789ALL}};
  printf("%d %d %x %d %llx\n", (int)sizeof p, (int)_Alignof(struct packed), p.i, p.inner.s, p.inner.l);
  finish();
}

static void finish(void) {
  _Exit(0);
}
