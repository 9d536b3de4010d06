// RUN: %run_c %s %t
// Sorting written out: heap, shell, merge on a list, quick with an explicit stack, radix on floats.
#include <stdio.h>
#include <string.h>

enum { N = 61 };
static int v[N], expected_sum;
static float floats[N], spare[N];
static struct item {
  struct item *next;
  int key, order;
} items[N];

__attribute__((noinline)) static void fill(void) {
  unsigned x = 12345;
  expected_sum = 0;
  for (int i = 0; i < N; i++) {
    x = x * 1103515245 + 12345;
    v[i] = (int)(x >> 8) % 500 - 250;
    expected_sum += v[i];
    items[i] = (struct item){&items[i + 1], v[i] / 10, i};
    floats[i] = (float)v[i] * 0.37f;
  }
  items[N - 1].next = NULL;
}

__attribute__((noinline)) static void check(const char *name) {
  int bad = 0, sum = 0;
  for (int i = 0; i < N; i++) {
    bad += i > 0 && v[i - 1] > v[i];
    sum += v[i];
  }
  printf("%s %d %d %d %d\n", name, bad, sum == expected_sum, v[0], v[N / 2]);
}

static void sift(int root, int n) {
  for (int child; (child = 2 * root + 1) < n; root = child) {
    if (child + 1 < n && v[child] < v[child + 1])
      child++;
    if (v[root] >= v[child])
      return;
    int t = v[root];
    v[root] = v[child];
    v[child] = t;
  }
}
__attribute__((noinline)) static void heap_sort(void) {
  for (int i = N / 2; i-- > 0;)
    sift(i, N);
  for (int i = N; i-- > 1;) {
    int t = v[0];
    v[0] = v[i];
    v[i] = t;
    sift(0, i);
  }
}

__attribute__((noinline)) static void shell_sort(void) {
  for (int gap = 40; gap > 0; gap /= 3)
    for (int i = gap; i < N; i++) {
      int t = v[i], j = i;
      for (; j >= gap && v[j - gap] > t; j -= gap)
        v[j] = v[j - gap];
      v[j] = t;
    }
}

__attribute__((noinline)) static void quick_sort(void) {
  unsigned char stack[16];
  int top = 0;
  stack[top++] = 0, stack[top++] = N - 1;
  while (top) {
    int high = stack[--top], low = stack[--top];
    while (low < high) {
      int pivot = v[(low + high) / 2], i = low - 1, j = high + 1;
      for (;;) {
        do
          i++;
        while (v[i] < pivot);
        do
          j--;
        while (v[j] > pivot);
        if (i >= j)
          break;
        int t = v[i];
        v[i] = v[j], v[j] = t;
      }
      if (j - low > high - j - 1) { /* the larger part waits */
        stack[top++] = (unsigned char)low, stack[top++] = (unsigned char)j;
        low = j + 1;
      } else {
        stack[top++] = (unsigned char)(j + 1), stack[top++] = (unsigned char)high;
        high = j;
      }
    }
  }
}

static struct item *merge(struct item *a, struct item *b) {
  struct item head, *last = &head;
  while (a && b) {
    struct item **least = b->key < a->key ? &b : &a;
    last = last->next = *least;
    *least = (*least)->next;
  }
  last->next = a ? a : b;
  return head.next;
}
__attribute__((noinline)) static struct item *merge_sort(struct item *list, int n) {
  if (n == 1) {
    list->next = NULL;
    return list;
  }
  struct item *half = list;
  for (int i = 0; i < n / 2; i++)
    half = half->next;
  struct item *a = merge_sort(list, n / 2);
  return merge(a, merge_sort(half, n - n / 2));
}

/* Floats ordered as their bits: negative ones turned round. */
__attribute__((noinline)) static void radix_sort(void) {
  float *from = floats, *to = spare;
  for (int shift = 0; shift < 32; shift += 4) {
    unsigned char count[17] = {0};
    for (int pass = 0; pass < 2; pass++) {
      for (int i = 0; i < N; i++) {
        unsigned u;
        memcpy(&u, &from[i], 4);
        u = (u ^ ((unsigned)((int)u >> 31) | 0x80000000u)) >> shift & 15;
        if (pass == 0)
          count[u + 1]++;
        else
          to[count[u]++] = from[i];
      }
      if (pass == 0)
        for (int i = 1; i < 17; i++)
          count[i] = (unsigned char)(count[i] + count[i - 1]);
    }
    float *t = from;
    from = to, to = t;
  }
}

int main(void) {
  fill();
  heap_sort();
  check("heap");
  fill();
  shell_sort();
  check("shell");
  fill();
  quick_sort();
  check("quick");
  int bad = 0;
  for (struct item *i = merge_sort(items, N); i->next; i = i->next)
    bad += i->key > i->next->key || (i->key == i->next->key && i->order > i->next->order);
  radix_sort();
  for (int i = 1; i < N; i++)
    bad += floats[i - 1] > floats[i];
  printf("%d %g %g\n", bad, (double)floats[0], (double)floats[N - 1]);
  return 0;
}
