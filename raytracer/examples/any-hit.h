/* The traversal of steps 3 and 4. A step defines struct ray and hit_box before it includes this file. */
#ifndef TRAX_EXAMPLES_ANY_HIT_H
#define TRAX_EXAMPLES_ANY_HIT_H

/* The nearest hit before hit->distance; or, if any hit will do, whether there is one. */
static __attribute__((noinline)) bool trace(const struct ray *ray, bool any, struct hit *hit) {
  const struct trax_plain_node *nodes = plain_nodes.data;
  const struct trax_plain_triangle *triangles = plain_triangles.data;
  unsigned stack[TRAX_PLAIN_MAX_DEPTH], top = 0, number = 0;
  for (;;) {
    const struct trax_plain_node *node = &nodes[number];
    if (node->count < 0) {
      int enter0, enter1, nearest = bits(hit->distance);
      unsigned first = node->first;
      bool hit0 = hit_box(ray, &nodes[first], nearest, &enter0);
      bool hit1 = hit_box(ray, &nodes[first + 1], nearest, &enter1);
      if (hit0 && hit1) {
        bool second = enter1 < enter0;
        stack[top++] = second ? first : first + 1;
        number = second ? first + 1 : first;
        continue;
      }
      if (hit0 || hit1) {
        number = hit0 ? first : first + 1;
        continue;
      }
    } else {
      for (int i = 0; i < node->count; i++)
        if (hit_triangle(&ray->origin, &ray->direction, &triangles[node->first + i], any, hit) && any)
          return true;
    }
    if (top == 0)
      return hit->triangle != NULL;
    number = stack[--top];
  }
}

#endif
