// RUN: %run_c %s %t --turns -O0,-O2,-Os
// Graphs and tables: shortest paths with a binary heap, union and find, a knapsack, a common subsequence, strong
// components.
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { NODES = 20, EDGES = 60 };
static struct edge {
  uint8_t from, to;
  uint16_t length;
} edges[EDGES];
static int16_t distance[NODES], heap[EDGES + 1][2];
static int8_t parent[NODES], low[NODES], number[NODES], stacked[NODES], stack[NODES];
static int count, visited, components, top;

static void push(int d, int node) {
  int i = ++count;
  for (; i > 1 && heap[i / 2][0] > d; i /= 2)
    memcpy(heap[i], heap[i / 2], sizeof heap[i]);
  heap[i][0] = (int16_t)d;
  heap[i][1] = (int16_t)node;
}
static int pop(int *d) {
  int node = heap[1][1], i = 1;
  *d = heap[1][0];
  int16_t *last = heap[count--];
  for (int c; (c = 2 * i) <= count; i = c) {
    c += c < count && heap[c + 1][0] < heap[c][0];
    if (heap[c][0] >= last[0])
      break;
    memcpy(heap[i], heap[c], sizeof heap[i]);
  }
  memmove(heap[i], last, sizeof heap[i]);
  return node;
}
__attribute__((noinline)) static void shortest(int start) {
  memset(distance, 0x7F, sizeof distance);
  distance[start] = 0;
  push(0, start);
  while (count) {
    int d, node = pop(&d);
    if (d > distance[node])
      continue;
    for (const struct edge *e = edges; e < edges + EDGES; e++)
      if (e->from == node && d + e->length < distance[e->to]) {
        distance[e->to] = (int16_t)(d + e->length);
        push(distance[e->to], e->to);
      }
  }
}

static int find(int node) {
  while (parent[node] >= 0)
    node = parent[node];
  return node;
}
__attribute__((noinline)) static int spanning(void) {
  int total = 0;
  memset(parent, -1, sizeof parent);
  for (int length = 0; length < 100; length++) /* by length: a bucket sort */
    for (int i = 0; i < EDGES; i++) {
      int a = find(edges[i].from), b = find(edges[i].to);
      if (edges[i].length == length && a != b) {
        parent[a] = (int8_t)b;
        total += length;
      }
    }
  return total;
}

__attribute__((noinline)) static void strong(int node) { /* Tarjan */
  number[node] = low[node] = (int8_t)++visited;
  stack[top++] = (int8_t)node;
  stacked[node] = 1;
  for (int i = 0; i < EDGES; i += 2) {
    if (edges[i].from % 7 != node)
      continue;
    int to = edges[i].to % 7;
    if (!number[to])
      strong(to);
    if (stacked[to] && low[to] < low[node])
      low[node] = low[to];
  }
  if (low[node] == number[node]) {
    components++;
    int popped;
    do
      stacked[popped = stack[--top]] = 0;
    while (popped != node);
  }
}

__attribute__((noinline)) static int knapsack(int capacity) {
  static int16_t best[64];
  memset(best, 0, sizeof best);
  for (int i = 0; i < 12; i++) {
    int weight = 3 + i * 5 % 11, value = 10 + i * 7 % 13;
    for (int c = capacity; c >= weight; c--)
      if (best[c - weight] + value > best[c])
        best[c] = (int16_t)(best[c - weight] + value);
  }
  return best[capacity];
}

__attribute__((noinline)) static int common(const char *a, const char *b) {
  static uint8_t table[17][17];
  int n = (int)strlen(a), m = (int)strlen(b);
  for (int i = 1; i <= n; i++)
    for (int j = 1; j <= m; j++) {
      uint8_t up = table[i - 1][j], left = table[i][j - 1];
      table[i][j] = a[i - 1] == b[j - 1] ? (uint8_t)(table[i - 1][j - 1] + 1) : up > left ? up : left;
    }
  return table[n][m];
}

int main(void) {
  unsigned x = 5;
  for (int i = 0; i < EDGES; i++) {
    x = x * 1664525 + 1013904223;
    edges[i] = (struct edge){(uint8_t)((x >> 8) % NODES), (uint8_t)((x >> 16) % NODES), (uint16_t)((x >> 24) % 90 + 1)};
  }
  shortest(3);
  for (int i = 0; i < NODES; i++)
    printf("%d ", distance[i]);
  for (int i = 0; i < 7; i++)
    if (!number[i])
      strong(i);
  printf("\n%d %d %d\n", spanning(), components, visited);
  printf("%d %d\n", knapsack(40), common("intersections", "interpolation"));
  return 0;
}
