/* Duplicates: triangles with the same vertices. Their order in the file alone decides which of them a ray hits
   (device/triangle.h). They are ordered by their numbers, so that the first one imported is seen in every tree. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

static void corners(float out[9], const struct trax_mesh *mesh, uint32_t triangle) {
  for (int corner = 0; corner < 3; corner++)
    memcpy(out + 3 * corner, mesh->vertices[mesh->triangles[triangle].vertices[corner]], 3 * sizeof *out);
}

static uint64_t hash_of(const struct trax_mesh *mesh, uint32_t triangle) {
  uint32_t bits[10] = {0};
  for (int corner = 0; corner < 3; corner++)
    memcpy(bits + 3 * corner, mesh->vertices[mesh->triangles[triangle].vertices[corner]], 3 * sizeof *bits);
  uint64_t hash = 0;
  for (int i = 0; i < 10; i += 2) {
    hash = (hash ^ (bits[i] | (uint64_t)bits[i + 1] << 32)) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 29;
  }
  return hash;
}

static bool same_place(const struct trax_mesh *mesh, uint32_t a, uint32_t b) {
  float left[9], right[9];
  corners(left, mesh, a);
  corners(right, mesh, b);
  return !memcmp(left, right, sizeof left);
}

/* The last triangle at a place, with a part of its hash that is rarely the same at another place. */
struct slot {
  uint32_t last, tag;
};

/* Lookups miss the caches, so the table's slots of the next triangles are prefetched. */
enum { AHEAD = 16 };

trax_status scene_find_duplicates(struct scene_duplicates *duplicates, const struct trax_mesh *mesh,
                                  trax_error *error) {
  const uint32_t count = mesh->triangle_count;
  size_t size = 16; /* of the table: more than half of it stays empty */
  while (size <= 2 * (size_t)count)
    size *= 2;
  struct slot *table = malloc(size * sizeof *table);
  uint64_t hashes[AHEAD];
  uint32_t *first = malloc((count + (size_t)1) * sizeof *first), *after = malloc((count + (size_t)1) * sizeof *after);
  *duplicates = (struct scene_duplicates){first, after, false};
  if (!table || !first || !after) {
    free(table);
    scene_duplicates_release(duplicates);
    return scene_out_of_memory(error, "BVH");
  }
  memset(table, 0xFF, size * sizeof *table);
  for (uint64_t next = 0; next < (uint64_t)count + AHEAD; next++) {
    uint64_t *hash = &hashes[next % AHEAD];
    if (next >= AHEAD) {
      const uint32_t i = (uint32_t)(next - AHEAD), tag = (uint32_t)(*hash >> 32);
      size_t at = *hash & (size - 1);
      while (table[at].last != SCENE_NO_DUPLICATE && !(table[at].tag == tag && same_place(mesh, i, table[at].last)))
        at = (at + 1) & (size - 1);
      first[i] = i, after[i] = SCENE_NO_DUPLICATE;
      if (table[at].last != SCENE_NO_DUPLICATE) {
        first[i] = first[table[at].last];
        after[table[at].last] = i;
        duplicates->any = true;
      }
      table[at] = (struct slot){i, tag};
    }
    if (next < count) {
      *hash = hash_of(mesh, (uint32_t)next);
      __builtin_prefetch(&table[*hash & (size - 1)]);
    }
  }
  free(table);
  return TRAX_OK;
}

void scene_duplicates_release(struct scene_duplicates *duplicates) {
  free(duplicates->first);
  free(duplicates->after);
  *duplicates = (struct scene_duplicates){0};
}

trax_status scene_order_duplicates(struct scene_tree *tree, const uint32_t *leaves, const struct trax_mesh *mesh,
                                   trax_error *error) {
  struct scene_duplicates duplicates;
  trax_status result = scene_find_duplicates(&duplicates, mesh, error);
  if (result != TRAX_OK)
    return result;
  /* next[first]: the next triangle at this place to be put into the tree. It starts at the first. */
  uint32_t *next = malloc((mesh->triangle_count + (size_t)1) * sizeof *next);
  if (!next)
    result = scene_out_of_memory(error, "BVH");
  for (uint32_t i = 0; next && i < mesh->triangle_count; i++)
    next[i] = i;
  const uint32_t count = leaves ? tree->node_count - tree->inner_count : tree->node_count;
  for (uint32_t i = 0; next && duplicates.any && i < count; i++) {
    struct scene_tree_node *node = &tree->nodes[leaves ? leaves[i] : i];
    for (uint32_t t = 0; t < node->triangle_count; t++) {
      uint32_t *slot = &node->triangles[t], place = duplicates.first[*slot];
      *slot = next[place];
      next[place] = duplicates.after[*slot];
    }
  }
  free(next);
  scene_duplicates_release(&duplicates);
  return result;
}

/* Each part of a split triangle is followed by those of its duplicates: along the tree, a part ends where a number is
   not larger than the one before. */
trax_status scene_order_split_duplicates(struct scene_tree *tree, const uint32_t *leaves, const struct trax_mesh *mesh,
                                         trax_error *error) {
  struct scene_duplicates duplicates;
  trax_status result = scene_find_duplicates(&duplicates, mesh, error);
  if (result != TRAX_OK)
    return result;
  const size_t count = mesh->triangle_count + (size_t)1;
  uint32_t *part = malloc(count * sizeof *part), *last = malloc(count * sizeof *last); /* of each first triangle */
  uint32_t *first_part = malloc((tree->node_count + (size_t)1) * sizeof *first_part);  /* of each leaf, in parts */
  uint32_t *parts = malloc(tree->ref_count * sizeof *parts), *next = malloc(tree->ref_count * sizeof *next);
  if (!part || !last || !first_part || !parts || !next)
    result = scene_out_of_memory(error, "BVH");
  for (uint32_t i = 0; i + 1 < count && result == TRAX_OK; i++)
    part[i] = last[i] = SCENE_NO_DUPLICATE;
  uint32_t used = 0, part_count = 0;
  for (uint32_t i = 0; i < tree->node_count && result == TRAX_OK && duplicates.any; i++) {
    first_part[i] = used;
    for (uint32_t t = 0; t < tree->nodes[i].triangle_count; t++) {
      const uint32_t triangle = tree->nodes[i].triangles[t], first = duplicates.first[triangle];
      if (last[first] == SCENE_NO_DUPLICATE || triangle <= last[first]) {
        part[first] = part_count;
        next[part_count++] = first;
      }
      last[first] = triangle;
      parts[used++] = part[first];
    }
  }
  for (uint32_t i = 0; i < tree->node_count - tree->inner_count && result == TRAX_OK && duplicates.any; i++) {
    struct scene_tree_node *leaf = &tree->nodes[leaves[i]];
    for (uint32_t t = 0; t < leaf->triangle_count; t++) {
      uint32_t *one = &next[parts[first_part[leaves[i]] + t]];
      leaf->triangles[t] = *one;
      *one = duplicates.after[*one];
    }
  }
  free(part), free(last), free(first_part), free(parts), free(next);
  scene_duplicates_release(&duplicates);
  return result;
}
