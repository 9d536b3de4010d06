/* Triangles at one place, vertex by vertex: which of them a ray hits follows from their order in the file alone
   (device/triangle.h). They get it by their numbers, so that the one that was imported first is seen, however the tree
   has distributed them. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

struct place {
  uint64_t hash;
  uint32_t triangle;
};

static int compare_places(const void *a, const void *b) {
  const struct place *left = a, *right = b;
  if (left->hash != right->hash)
    return left->hash < right->hash ? -1 : 1;
  return left->triangle < right->triangle ? -1 : left->triangle > right->triangle;
}

static void corners(float out[9], const struct trax_mesh *mesh, uint32_t triangle) {
  for (int corner = 0; corner < 3; corner++)
    memcpy(out + 3 * corner, mesh->vertices[mesh->triangles[triangle].vertices[corner]], 3 * sizeof *out);
}

static uint64_t hash_of(const struct trax_mesh *mesh, uint32_t triangle) {
  float values[9];
  corners(values, mesh, triangle);
  uint64_t hash = 0;
  for (int i = 0; i < 9; i++) {
    uint32_t bits;
    memcpy(&bits, &values[i], sizeof bits);
    hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 32;
  }
  return hash;
}

static bool same_place(const struct trax_mesh *mesh, uint32_t a, uint32_t b) {
  float left[9], right[9];
  corners(left, mesh, a);
  corners(right, mesh, b);
  return !memcmp(left, right, sizeof left);
}

trax_status scene_order_duplicates(struct scene_tree *tree, const struct trax_mesh *mesh, trax_error *error) {
  enum { none = UINT32_MAX };
  const uint32_t count = mesh->triangle_count;
  struct place *places = malloc((count + (size_t)1) * sizeof *places);
  /* Of each triangle the first one at its place, of that one the next to be put into the tree, of each the one after
     it. */
  uint32_t *first = malloc((count + (size_t)1) * sizeof *first), *next = malloc((count + (size_t)1) * sizeof *next),
           *after = malloc((count + (size_t)1) * sizeof *after);
  if (!places || !first || !next || !after) {
    free(places), free(first), free(next), free(after);
    return scene_out_of_memory(error, "BVH");
  }
  for (uint32_t i = 0; i < count; i++)
    places[i] = (struct place){hash_of(mesh, i), i};
  qsort(places, count, sizeof *places, compare_places);
  bool any = false;
  for (uint32_t begin = 0, end; begin < count; begin = end) {
    for (end = begin + 1; end < count && places[end].hash == places[begin].hash;)
      end++;
    for (uint32_t i = begin; i < end; i++) {
      uint32_t triangle = places[i].triangle;
      first[triangle] = next[triangle] = triangle, after[triangle] = none;
      for (uint32_t before = i; before-- > begin;) /* nearly always the one before, or none at all */
        if (same_place(mesh, triangle, places[before].triangle)) {
          first[triangle] = first[places[before].triangle];
          after[places[before].triangle] = triangle;
          any = true;
          break;
        }
    }
  }
  free(places);
  for (uint32_t i = 0; any && i < tree->node_count; i++)
    for (uint32_t t = 0; t < tree->nodes[i].triangle_count; t++) {
      uint32_t *slot = &tree->nodes[i].triangles[t], place = first[*slot];
      *slot = next[place];
      next[place] = after[*slot];
    }
  free(first), free(next), free(after);
  return TRAX_OK;
}
