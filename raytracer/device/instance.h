/* The traversal of a scene with instances (struct trax_instance), and the shading of an instance's triangles.
   traverse.h includes this file in programs that are compiled with TRAX_INSTANCES, and in the twin; its functions then
   replace those of the same name.

   At a leaf of the upper tree the ray is transformed into the instance's mesh. Its direction keeps the length that it
   gets, so that distances are those of the ray in the scene. A leaf without triangles on the stack marks where the mesh
   was entered. */
#ifndef TRAX_DEVICE_INSTANCE_H
#define TRAX_DEVICE_INSTANCE_H

#include "algebra.h"
#include "ray.h"
#include "run.h"
#include "shade.h"
#include "traverse.h"

#define AT_INSTANCE(member) ((int)__builtin_offsetof(struct trax_instance, member))

/* A ray before it is prepared. */
struct bare_ray {
  struct vector origin, direction;
  float margin;
};

/* The ray in the instance's mesh: 3 subtractions, 19 multiplications and 12 additions. */
static inline __attribute__((always_inline)) struct bare_ray ray_in_mesh(const struct ray *world, const char *record) {
  const struct trax_instance *instance = instance_at(record);
  return (struct bare_ray){turned_by(instance->to_object, minus(world->origin, load_vector(instance->origin))),
                           turned_by(instance->to_object, world->direction), instance->stretch * world->margin};
}

/* The ray is prepared again for each tree that it enters, and for the upper one where it returns to it and there is
   another node: local memory has no room for two prepared rays. */
static inline __attribute__((always_inline)) bool trace_two_levels(uint32_t layout, const char *scene,
                                                                   trax_scene_ref root, const struct ray *world,
                                                                   bool any, struct hit *hit) {
  if (!HAS_INSTANCES)
    return trace_ray(layout, scene, root, world, any, hit);
  struct stack_entry stack[TRAX_TREE_DEPTH + 1], *top = stack;
  trax_scene_ref reference = root;
  struct ray ray = *world;

  hit->visiting = NULL;
  if (root == 0)
    return false;
  *top++ = (struct stack_entry){NO_LEAF, INT32_MIN};
  for (;;) {
    struct bare_ray bare = {world->origin, world->direction, world->margin};
    if (hit->visiting)
      bare = ray_in_mesh(world, hit->visiting);
    if (hit->visiting || !leads_to_leaf(reference))
      prepare_ray(&ray, TRAX_NODES_BINARY, bare.origin, bare.direction, bare.margin, NULL);
    for (bool here = true; here;) {
      if (descend(TRAX_NODES_BINARY, scene, &ray, hit->distance_bits, &reference, &top)) {
        reference = leaf_of(reference);
        const char *record = scene_at(scene, TRAX_SCENE_REF_OFFSET(reference));
        if (TRAX_SCENE_REF_OFFSET(reference) == 0) {
          if (!hit->visiting)
            return hit->triangle != NULL;
          hit->visiting = NULL;
          here = false;
        } else if (!hit->visiting) {
          hit->visiting = record;
          push(&top, NO_LEAF, INT32_MIN);
          reference = load_word(record + AT_INSTANCE(root));
          break;
        } else {
          const char *end = record + TRAX_SCENE_REF_COUNT(reference) * sizeof(struct trax_triangle);
          do {
            HIDE_ORIGIN(record);
            ACCESS_TRIANGLE(record);
            if (hit_triangle(&ray.triangle, record, any, hit) && any)
              return true;
            record += sizeof(struct trax_triangle);
          } while (__builtin_expect_with_probability(record != end, 1, 0.5));
        }
      }
      KEEP_ROLLED
      do {
        --top;
        HIDE_ORIGIN(top);
      } while (top->enter >= hit->distance_bits);
      reference = top->reference;
    }
  }
}

/* The triangle that was hit, in the scene. */
static inline __attribute__((always_inline)) void place_triangle(struct trax_triangle *out, const struct hit *hit) {
  const float *corner = (const float *)(const void *)hit->triangle;
  float *const to[3] = {out->v0, out->v1, out->v2};
  for (int i = 0; i < 3; i++) {
    const struct vector point = placed_point(hit->instance, corner + 3 * i);
    to[i][0] = point.x, to[i][1] = point.y, to[i][2] = point.z;
  }
}

/* find_surface moves the start farther away by the uncertainty of the instance's place (bound_of_place). */
static inline __attribute__((always_inline)) void find_placed_surface(struct surface *surface, const struct hit *hit,
                                                                      struct vector eye, struct vector direction) {
  if (!HAS_INSTANCES) {
    find_surface(surface, hit, eye, direction);
    return;
  }
  struct trax_triangle placed;
  const struct trax_instance *instance = instance_at(hit->instance);
  place_triangle(&placed, hit);
  const struct hit at = {hit->distance_bits, (const char *)&placed, hit->weight1, hit->weight2, hit->instance, NULL};
  find_surface(surface, &at, eye, direction);
  surface->turned ^= (instance->flags & TRAX_INSTANCE_MIRRORED) != 0;
}

/* Normals are turned by the inverse's transpose, and scaled to about length 1 by a power of two. */
static inline __attribute__((always_inline)) void smooth_placed_surface(struct surface *surface, const struct hit *hit,
                                                                        uint32_t normals_distance) {
  if (!HAS_INSTANCES) {
    smooth_surface(surface, hit, normals_distance);
    return;
  }
  const float(*m)[3] = instance_at(hit->instance)->to_object;
  struct vector n = stored_normal(hit, normals_distance);
  n = (struct vector){m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z, m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z,
                      m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z};
  n = times(bits_float(0x7F000000 - (greatest_magnitude(n) & 0x7F800000)), n);
  set_smooth_normal(surface, n);
}

static inline uint32_t placed_material(const struct hit *hit) {
  if (HAS_INSTANCES && instance_at(hit->instance)->material != TRAX_NO_MATERIAL)
    return instance_at(hit->instance)->material;
  return triangle_material(hit->triangle);
}

#define trace_ray trace_two_levels
#undef find_surface /* exact.h may have replaced it, and was called above */
#define find_surface find_placed_surface
#define smooth_surface smooth_placed_surface
#define material_of_hit placed_material

#endif
