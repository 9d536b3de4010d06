// RUN: %run_c %s %t --turns -O0,-O1,-O3,-Os
// Compression there and back: copies from a window, run lengths, a Huffman code; the tables in global memory.
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { SIZE = 600 };
static uint8_t plain[SIZE], packed[2 * SIZE], again[SIZE];

/* A byte below 128 says how many literal bytes follow, less one; others are a
 * length of 3 to 130 and then a distance. */
__attribute__((noinline)) static int compress(void) {
  int out = 0, literals = -1;
  for (int at = 0; at < SIZE;) {
    int best = 0, distance = 0;
    for (int back = 1; back <= at && back < 256; back++) {
      int n = 0;
      while (n < 130 && at + n < SIZE && plain[at + n] == plain[at + n - back])
        n++;
      if (n > best)
        best = n, distance = back;
    }
    if (best >= 3) {
      packed[out++] = (uint8_t)(128 + best - 3);
      packed[out++] = (uint8_t)distance;
      at += best;
      literals = -1;
    } else {
      if (literals < 0 || packed[literals] == 127) {
        literals = out++;
        packed[literals] = 0;
      } else
        packed[literals]++;
      packed[out++] = plain[at++];
    }
  }
  return out;
}

__attribute__((noinline)) static int expand(int size) {
  int out = 0;
  for (int at = 0; at < size;) {
    int n = packed[at++];
    if (n < 128) {
      memcpy(again + out, packed + at, (size_t)n + 1);
      at += n + 1;
      out += n + 1;
    } else {
      for (n -= 125; n > 0; n--, out++)
        again[out] = again[out - packed[at]];
      at++;
    }
  }
  return out;
}

static struct { uint16_t weight, parent; } tree[52];

__attribute__((noinline)) static int huffman(void) {
  int nodes = 26, bits = 0;
  memset(tree, 0, sizeof tree);
  for (int i = 0; i < SIZE; i++)
    tree[plain[i] % 26].weight++;
  for (;;) {
    int a = -1, b = -1; /* the two lightest without a parent */
    for (int i = 0; i < nodes; i++) {
      if (tree[i].parent || !tree[i].weight)
        continue;
      if (a < 0 || tree[i].weight < tree[a].weight)
        b = a, a = i;
      else if (b < 0 || tree[i].weight < tree[b].weight)
        b = i;
    }
    if (b < 0)
      break;
    tree[nodes].weight = (uint16_t)(tree[a].weight + tree[b].weight);
    tree[a].parent = tree[b].parent = (uint16_t)nodes++;
  }
  for (int i = 0; i < 26; i++) {
    int depth = 0;
    for (int n = i; tree[n].parent; n = tree[n].parent)
      depth++;
    bits += depth * tree[i].weight;
  }
  return bits;
}

int main(void) {
  static const char words[] = "ray box leaf ray ray node box ";
  uint32_t x = 99;
  for (int i = 0; i < SIZE; i++) {
    x = x * 69069 + 1;
    plain[i] = (uint8_t)(x >> 29 == 0 ? (x >> 20) % 10 + 'a' : words[i % (sizeof words - 1)]);
  }
  int size = compress(), length = expand(size);
  uint32_t hash = 0;
  for (int i = 0; i < size; i++)
    hash = hash * 31 + packed[i];
  printf("%d %08x %d %d\n", size, (unsigned)hash, length, memcmp(plain, again, SIZE));
  printf("%d\n", huffman());
  return 0;
}
