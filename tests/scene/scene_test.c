/* The BVH and the file: shape, what rays find in it, determinism, writing and reading back. */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const unsigned char *bytes_of(const struct trax_scene *scene) {
  return scene->bytes;
}

/* --- a tree walk that shares nothing with the library --- */

struct found {
  unsigned char *seen; /* how often each triangle is in a leaf */
  uint32_t nodes, leaves, deepest, largest_leaf;
};

static void walk(const struct trax_scene *scene, uint32_t ref, unsigned depth, const float box[6],
                 struct found *found) {
  if (ref & 7u) {
    found->leaves++;
    if ((ref & 7u) > found->largest_leaf)
      found->largest_leaf = ref & 7u;
    const unsigned char *first = bytes_of(scene) + (ref & ~7u);
    for (uint32_t i = 0; i < (ref & 7u); i++) {
      const struct trax_triangle *triangle = (const struct trax_triangle *)(first + 40 * (size_t)i);
      size_t number = (size_t)(triangle - scene->triangles);
      assert_true(number < scene->triangle_count);
      found->seen[number]++;
      const float *corners[3] = {triangle->v0, triangle->v1, triangle->v2};
      for (int corner = 0; corner < 3; corner++)
        for (int axis = 0; axis < 3; axis++)
          assert_true(box[axis] <= corners[corner][axis] && corners[corner][axis] <= box[3 + axis]);
    }
    return;
  }
  found->nodes++;
  if (++depth > found->deepest)
    found->deepest = depth;
  assert_int_equal(ref % 64, 0);
  const struct trax_bvh_node *node = (const struct trax_bvh_node *)(bytes_of(scene) + ref);
  for (int i = 0; i < 2; i++) {
    float inner[6];
    memcpy(inner, node->box[i].min, 12);
    memcpy(inner + 3, node->box[i].max, 12);
    for (int axis = 0; axis < 3; axis++)
      assert_true(box[axis] <= inner[axis] && inner[axis] <= inner[3 + axis] && inner[3 + axis] <= box[3 + axis]);
    walk(scene, node->child[i], depth, inner, found);
  }
}

static void check_shape(const struct trax_scene *scene, const struct trax_mesh *mesh) {
  const struct trax_scene_header *header = scene->header;
  assert_int_equal(scene->triangle_count, mesh->triangle_count);
  struct found found = {.seen = calloc(scene->triangle_count + 1u, 1)};
  float box[6];
  memcpy(box, header->bounds_min, 12);
  memcpy(box + 3, header->bounds_max, 12);
  walk(scene, header->root, 0, box, &found);
  for (uint32_t i = 0; i < scene->triangle_count; i++)
    assert_int_equal(found.seen[i], 1);
  free(found.seen);
  assert_int_equal(found.nodes, scene->node_count);
  assert_int_equal(found.leaves, found.nodes + 1);
  assert_int_equal(found.deepest, header->max_depth);
  assert_int_equal(found.largest_leaf, header->max_leaf);
  /* Each triangle is the mesh's of the same number. */
  for (uint32_t i = 0; i < scene->triangle_count; i++) {
    const struct trax_mesh_triangle *source = &mesh->triangles[scene->source_ids[i]];
    assert_memory_equal(scene->triangles[i].v0, mesh->vertices[source->vertices[0]], 12);
    assert_memory_equal(scene->triangles[i].v1, mesh->vertices[source->vertices[1]], 12);
    assert_memory_equal(scene->triangles[i].v2, mesh->vertices[source->vertices[2]], 12);
    assert_memory_equal(scene->materials[scene->triangles[i].material].diffuse,
                        mesh->materials[source->material].surface.diffuse, 12);
  }
  trax_error error = {{0}};
  if (trax_scene_check(NULL, scene->bytes, scene->size, "scene", &error) != TRAX_OK)
    fail_msg("%s", error.message);
}

static void test_shapes(void **state) {
  (void)state;
  for (unsigned count = 1; count < 3000; count += 1 + count / 2)
    for (unsigned leaf = 0; leaf <= TRAX_SCENE_MAX_LEAF; leaf += 1 + leaf)
      for (unsigned lines = 0; lines <= 64; lines = lines * 8 + 1) {
        struct trax_mesh mesh = {0};
        struct trax_scene scene;
        mesh_soup(&mesh, count, 0.2f, count);
        build_good(&scene, &mesh, &(struct trax_build_options){.max_leaf = leaf, .cache_lines = lines});
        check_shape(&scene, &mesh);
        assert_true(scene.header->max_leaf <= (leaf ? leaf : TRAX_SCENE_MAX_LEAF));
        trax_scene_release(&scene);
        trax_mesh_release(&mesh);
      }
}

/* Triangles that no plane separates; a row in which each is a fraction of the one before; a row over so many octaves
   that surface areas alone would make a tree far deeper than allowed. */
static void test_awkward_meshes(void **state) {
  (void)state;
  struct trax_mesh same = {0}, row = {0}, nest = {0};
  for (int i = 0; i < 5000; i++)
    mesh_triangle(&same, (float[]){0, 0, 0}, (float[]){1, 0, 0}, (float[]){0, 1, 0}, 0);
  float x = 1e17f;
  for (int i = 0; i < 120; i++, x *= 0.45f)
    mesh_triangle(&row, (float[]){x, 0, 0}, (float[]){x, x, 0}, (float[]){x * 1.1f, 0, x}, 0);
  for (int i = 0; i < 5000; i++) {
    x = exp2f(59 - 0.0358f * (float)i);
    mesh_triangle(&nest, (float[]){x, 0, 0}, (float[]){0, x, 0}, (float[]){0, 0, x}, 0);
  }
  const struct trax_mesh *meshes[] = {&same, &row, &nest};
  for (int m = 0; m < 3; m++)
    for (unsigned depth = m == 1 ? 8 : 11; depth <= TRAX_SCENE_MAX_DEPTH; depth += depth < 30 ? 5 : 15) {
      struct trax_scene scene;
      build_good(&scene, meshes[m], &(struct trax_build_options){.max_depth = depth});
      check_shape(&scene, meshes[m]);
      assert_true(scene.header->max_depth <= depth);
      trax_scene_release(&scene);
    }
  /* Too few levels are an error. */
  struct trax_scene scene;
  trax_error error;
  assert_int_equal(trax_scene_build(&scene, &same, &(struct trax_build_options){.max_depth = 3}, &error), TRAX_ERROR);
  assert_contains(error.message, "at most 3 levels");
  trax_mesh_release(&same);
  trax_mesh_release(&row);
  trax_mesh_release(&nest);
}

static void test_extreme_scales(void **state) {
  (void)state;
  const float scales[] = {1e-42f, 1e-30f, 1e-10f, 1e10f, 1e17f};
  for (size_t s = 0; s < sizeof scales / sizeof scales[0]; s++) {
    struct trax_mesh mesh = {0};
    struct trax_scene scene;
    mesh_soup(&mesh, 300, 0.3f, 7);
    for (uint32_t i = 0; i < mesh.vertex_count; i++)
      for (int axis = 0; axis < 3; axis++)
        mesh.vertices[i][axis] *= scales[s];
    build_good(&scene, &mesh, NULL);
    check_shape(&scene, &mesh);
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
}

/* --- rays --- */

static bool hits_triangle(const struct trax_triangle *triangle, const float o[3], const float d[3], double *t) {
  double e1[3], e2[3], s[3], p[3], q[3];
  for (int i = 0; i < 3; i++) {
    e1[i] = (double)triangle->v1[i] - triangle->v0[i];
    e2[i] = (double)triangle->v2[i] - triangle->v0[i];
    s[i] = (double)o[i] - triangle->v0[i];
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    p[i] = d[j] * e2[k] - d[k] * e2[j];
    q[i] = s[j] * e1[k] - s[k] * e1[j];
  }
  double det = e1[0] * p[0] + e1[1] * p[1] + e1[2] * p[2];
  double u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det, v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
  *t = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / det;
  return det != 0 && u >= 0 && v >= 0 && u + v <= 1 && *t > 0;
}

static bool hits_box(const float min[3], const float max[3], const float o[3], const float d[3], double nearest) {
  double from = 0, to = nearest;
  for (int axis = 0; axis < 3; axis++) {
    double a = ((double)min[axis] - o[axis]) / d[axis], b = ((double)max[axis] - o[axis]) / d[axis];
    from = fmax(from, fmin(a, b));
    to = fmin(to, fmax(a, b));
  }
  return from <= to * (1 + 1e-12);
}

static void trace(const struct trax_scene *scene, uint32_t ref, const float o[3], const float d[3], double *nearest,
                  unsigned *tests) {
  double t;
  for (uint32_t i = 0; i < (ref & 7u); i++) {
    ++*tests;
    if (hits_triangle((const struct trax_triangle *)(bytes_of(scene) + (ref & ~7u)) + i, o, d, &t) && t < *nearest)
      *nearest = t;
  }
  if (ref & 7u)
    return;
  const struct trax_bvh_node *node = (const struct trax_bvh_node *)(bytes_of(scene) + ref);
  for (int i = 0; i < 2; i++)
    if (hits_box(node->box[i].min, node->box[i].max, o, d, *nearest))
      trace(scene, node->child[i], o, d, nearest, tests);
}

static void test_rays_find_the_nearest(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene;
  mesh_soup(&mesh, 2000, 0.15f, 99);
  build_good(&scene, &mesh, NULL);
  uint32_t seed = 5;
  unsigned hits = 0, tests = 0;
  for (int ray = 0; ray < 2000; ray++) {
    float o[3], d[3];
    for (int axis = 0; axis < 3; axis++) {
      o[axis] = 4 * random_unit(&seed) - 2;
      d[axis] = random_unit(&seed) - 0.5f - 0.2f * o[axis];
    }
    double expected = INFINITY, found = INFINITY, t;
    for (uint32_t i = 0; i < scene.triangle_count; i++)
      if (hits_triangle(&scene.triangles[i], o, d, &t) && t < expected)
        expected = t;
    trace(&scene, scene.header->root, o, d, &found, &tests);
    assert_true(found == expected);
    hits += expected < INFINITY;
  }
  assert_in_range(hits, 300, 2000);       /* or the test would say nothing */
  assert_true(tests < 2000u * 2000 / 20); /* and the tree would be of no use */
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* --- determinism --- */

static void test_determinism(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 20000, 0.05f, 3);
  struct trax_scene first;
  build_good(&first, &mesh, NULL);
  for (int run = 0; run < 5; run++) {
    struct trax_scene again;
    build_good(&again, &mesh, NULL);
    assert_int_equal(again.size, first.size);
    assert_memory_equal(again.bytes, first.bytes, first.size);
    trax_scene_release(&again);
  }
  trax_scene_release(&first);
  trax_mesh_release(&mesh);
}

/* --- options --- */

/* --- normals for smooth shading --- */

static double cosine_between(const float a[3], const float b[3]) {
  double dot = 0, squares[2] = {0, 0};
  for (int axis = 0; axis < 3; axis++) {
    dot += (double)a[axis] * b[axis];
    squares[0] += (double)a[axis] * a[axis], squares[1] += (double)b[axis] * b[axis];
  }
  return dot / sqrt(squares[0] * squares[1]);
}

static void face_normal(float normal[3], const struct trax_triangle *t) {
  for (int axis = 0; axis < 3; axis++) {
    int next = (axis + 1) % 3, last = (axis + 2) % 3;
    normal[axis] = (t->v1[next] - t->v0[next]) * (t->v2[last] - t->v0[last]) -
                   (t->v1[last] - t->v0[last]) * (t->v2[next] - t->v0[next]);
  }
}

/* Makes `around` by `down` faces of a sphere of radius 1, from the pole down. */
static void add_sphere(struct trax_mesh *mesh, int around, int down) {
  const double pi = acos(-1);
  for (int row = 0; row < down; row++)
    for (int column = 0; column < around; column++) {
      float corners[2][2][3];
      for (int i = 0; i < 4; i++) {
        double longitude = 2 * pi * ((column + (i & 1)) % around) / around, latitude = pi * (row + (i >> 1)) / down;
        float *corner = corners[i >> 1][i & 1];
        corner[0] = row + (i >> 1) == down || row + (i >> 1) == 0 ? 0 : (float)(sin(latitude) * cos(longitude));
        corner[1] = (float)cos(latitude);
        corner[2] = row + (i >> 1) == down || row + (i >> 1) == 0 ? 0 : (float)(sin(latitude) * sin(longitude));
      }
      if (row > 0)
        mesh_triangle(mesh, corners[0][0], corners[0][1], corners[1][1], 0);
      if (row + 1 < down)
        mesh_triangle(mesh, corners[0][0], corners[1][1], corners[1][0], 0);
    }
}

static void test_normals(void **state) {
  (void)state;
  struct trax_mesh sphere = {0}, roof = {0}, cone = {0};
  struct trax_scene scene, again;
  add_sphere(&sphere, 64, 32);
  build_good(&scene, &sphere, &(struct trax_build_options){.smooth = true});
  build_good(&again, &sphere, &(struct trax_build_options){.smooth = true, .crease_degrees = TRAX_DEFAULT_CREASE});
  assert_int_equal(scene.size, again.size);
  assert_memory_equal(scene.bytes, again.bytes, scene.size);
  trax_scene_release(&again);
  double worst = 1;
  for (uint32_t i = 0; i < scene.triangle_count; i++) {
    const struct trax_triangle *t = &scene.triangles[i];
    const float *corners[3] = {t->v0, t->v1, t->v2};
    for (int corner = 0; corner < 3; corner++) {
      float face[3];
      face_normal(face, t);
      double side = cosine_between(face, corners[corner]) > 0 ? 1 : -1;
      worst = fmin(worst, side * cosine_between(scene.normals[i].corner[corner], corners[corner]));
    }
  }
  assert_true(worst > 0.9985); /* radial, but for the mesh's own coarseness: a face is 5.6 degrees wide */
  trax_scene_release(&scene);

  /* Two faces at 50 degrees share an edge: one surface across a crease of 60 degrees, two across one of 40. */
  const double angle = 50 * acos(-1) / 180;
  mesh_triangle(&roof, (float[]){0, 0, 0}, (float[]){0, 0, 1}, (float[]){1, 0, 0}, 0);
  mesh_triangle(&roof, (float[]){0, 0, 1}, (float[]){0, 0, 0}, (float[]){-(float)cos(angle), -(float)sin(angle), 0}, 0);
  for (float crease = 40; crease <= 60; crease += 20) {
    build_good(&scene, &roof, &(struct trax_build_options){.smooth = true, .crease_degrees = crease});
    for (uint32_t i = 0; i < 2; i++) {
      float face[3];
      face_normal(face, &scene.triangles[i]);
      int shared = 0;
      for (int corner = 0; corner < 3; corner++) {
        const float *place = (const float *)&scene.triangles[i] + 3 * corner;
        double cosine = cosine_between(face, scene.normals[i].corner[corner]);
        if (place[0] == 0 && crease > 50) {
          assert_true(fabs(cosine - cos(angle / 2)) < 1e-6);
          shared++;
        } else {
          assert_true(cosine > 1 - 1e-6);
        }
      }
      assert_int_equal(shared, crease > 50 ? 2 : 0);
    }
    trax_scene_release(&scene);
  }

  /* The tip of a cone of many faces, and of a spike whose mean is across its faces. */
  for (float height = 0.5f; height < 100; height *= 100) {
    for (int i = 0; i < 500; i++) {
      float a = (float)(2 * acos(-1) * i / 500), b = (float)(2 * acos(-1) * (i + 1) / 500);
      mesh_triangle(&cone, (float[]){0, height, 0}, (float[]){cosf(b), 0, sinf(b)}, (float[]){cosf(a), 0, sinf(a)}, 0);
    }
    build_good(&scene, &cone, &(struct trax_build_options){.smooth = true});
    for (uint32_t i = 0; i < scene.triangle_count; i++)
      for (int corner = 0; corner < 3; corner++) {
        float face[3];
        face_normal(face, &scene.triangles[i]);
        assert_true(cosine_between(face, scene.normals[i].corner[corner]) > 0.09);
      }
    trax_scene_release(&scene);
    trax_mesh_release(&cone);
  }
  build_good(&scene, &roof, NULL);
  assert_null(scene.normals);
  trax_scene_release(&scene);
  trax_mesh_release(&sphere);
  trax_mesh_release(&roof);
}

/* Passes over the tree that was built make it cheaper, keep its depth within bounds and every triangle in it, and end.
 */
static void test_passes(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 4000, 0.1f, 5);
  for (float splits = 0; splits <= 2; splits += 2) {
    double visited[3];
    for (unsigned i = 0; i < 3; i++) {
      struct trax_scene scene, again;
      struct trax_scene_stats stats;
      const struct trax_build_options options = {
          .passes = (unsigned[]){0, 2, TRAX_SCENE_MAX_PASSES}[i], .splits = splits, .max_depth = 20};
      build_good(&scene, &mesh, &options);
      if (splits == 0)
        check_shape(&scene, &mesh);
      trax_scene_measure(&stats, &scene);
      visited[i] = stats.sah_nodes;
      assert_true(scene.header->max_depth <= 20);
      build_good(&again, &mesh, &options);
      assert_int_equal(scene.size, again.size);
      assert_memory_equal(scene.bytes, again.bytes, scene.size);
      trax_scene_release(&scene);
      trax_scene_release(&again);
    }
    assert_true(visited[1] < 0.99 * visited[0]);
    assert_true(visited[2] < visited[1]);
  }
  trax_mesh_release(&mesh);
}

/* A height field of 2 * 50 * 50 triangles. */
static void height_field(struct trax_mesh *mesh) {
  enum { SIDE = 50 };
  float heights[SIDE + 1][SIDE + 1];
  uint32_t seed = 7;
  for (int i = 0; i <= SIDE; i++)
    for (int k = 0; k <= SIDE; k++)
      heights[i][k] = 0.05f * random_unit(&seed);
  for (int i = 0; i < SIDE; i++)
    for (int k = 0; k < SIDE; k++) {
      const float x = (float)i / SIDE, y = (float)k / SIDE, right = (float)(i + 1) / SIDE, up = (float)(k + 1) / SIDE;
      const float a[3] = {x, heights[i][k], y}, b[3] = {right, heights[i + 1][k], y},
                  c[3] = {right, heights[i + 1][k + 1], up}, d[3] = {x, heights[i][k + 1], up};
      mesh_triangle(mesh, a, b, c, 0);
      mesh_triangle(mesh, a, c, d, 0);
    }
}

static void soup(struct trax_mesh *mesh) {
  mesh_soup(mesh, 4000, 0.1f, 5);
}

/* Its clearing is small: the foci of reinsert.c decide about its tree. */
static void forest(struct trax_mesh *mesh) {
  struct trax_import_report report;
  import_good(mesh, "generate:forest", &report);
}

/* Five walls of a room with two blocks in it, which are turned. */
static void room(struct trax_mesh *mesh) {
  static const unsigned char faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                            {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  static const struct {
    float middle[3], half[3], x, z; /* x, z: the direction of its first side */
    int faces;
  } boxes[] = {{{0, 1, 0}, {1, 1, 1}, 1, 0, 5},
               {{-0.35f, 0.6f, -0.3f}, {0.3f, 0.6f, 0.3f}, 0.96f, 0.28f, 6},
               {{0.3f, 0.3f, 0.35f}, {0.3f, 0.3f, 0.3f}, 0.8f, -0.6f, 6}};
  for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++)
    for (int f = 0; f < boxes[b].faces; f++) {
      float corners[4][3];
      for (int c = 0; c < 4; c++) {
        float side[3];
        for (int axis = 0; axis < 3; axis++)
          side[axis] = faces[f][c] >> axis & 1 ? boxes[b].half[axis] : -boxes[b].half[axis];
        corners[c][0] = boxes[b].middle[0] + boxes[b].x * side[0] - boxes[b].z * side[2];
        corners[c][1] = boxes[b].middle[1] + side[1];
        corners[c][2] = boxes[b].middle[2] + boxes[b].z * side[0] + boxes[b].x * side[2];
      }
      mesh_triangle(mesh, corners[0], corners[1], corners[2], 0);
      mesh_triangle(mesh, corners[0], corners[2], corners[3], 0);
    }
}

/* The trees that are built are as good as they were: nodes and triangles that a ray visits, by the surface areas. */
static void test_quality(void **state) {
  (void)state;
  const struct {
    void (*make)(struct trax_mesh *mesh);
    struct trax_build_options options;
    const char *visited;
  } trees[] = {
      {soup, {0}, "45.304275 2.4249715"},
      {soup, {.passes = 2}, "44.635755 2.4249715"},
      {soup, {.passes = 2, .splits = 1.5f}, "44.615152 2.4274679"},
      {height_field, {.passes = 2}, "20.159606 7.3179161"},
      {height_field, {.passes = 2, .splits = 1.5f}, "20.159915 7.3173019"},
      {height_field, {.passes = 2, .nodes = TRAX_NODES_QUANTISED}, "20.165534 7.3249526"},
      {height_field, {.passes = 2, .cache_lines = 64}, "20.159606 7.3179161"},
      {height_field, {.passes = 2, .choose_splits = true}, "20.159606 7.3179161"},
      {forest, {.passes = 2, .choose_splits = true}, "15.674391 3.4155276"},
      {room, {.passes = 2}, "7.9730454 4.8135575"},
      {soup, {.passes = 2, .choose_splits = true}, "44.635755 2.4249715"},
      {room, {.passes = 2, .traversal_cost = 4}, "5.6233228 8.7004268"},
  };
  for (size_t i = 0; i < sizeof trees / sizeof *trees; i++) {
    struct trax_mesh mesh = {0};
    struct trax_scene scene;
    struct trax_scene_stats stats;
    char visited[64];
    trees[i].make(&mesh);
    build_good(&scene, &mesh, &trees[i].options);
    trax_scene_measure(&stats, &scene);
    snprintf(visited, sizeof visited, "%.8g %.8g", stats.sah_nodes, stats.sah_triangles);
    assert_string_equal(visited, trees[i].visited);
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
}

static void test_bad_options(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 10, 0.5f, 1);
  const struct {
    struct trax_build_options options;
    const char *message;
  } bad[] = {{{.max_leaf = 8}, "at most 7"},         {{.max_depth = 63}, "at most 62"},
             {{.passes = 17}, "at most 16 passes"},  {{.cache_lines = 4097}, "at most 4096"},
             {{.crease_degrees = 181}, "up to 180"}, {{.crease_degrees = NAN}, "up to 180"},
             {{.traversal_cost = NAN}, "cost"},      {{.traversal_cost = -1}, "cost"}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    struct trax_scene scene;
    trax_error error;
    assert_int_equal(trax_scene_build(&scene, &mesh, &bad[i].options, &error), TRAX_ERROR);
    assert_contains(error.message, bad[i].message);
    assert_null(scene.bytes);
  }
  const volatile int interrupt = 1;
  struct trax_scene scene;
  trax_error error;
  assert_int_equal(trax_scene_build(&scene, &mesh, &(struct trax_build_options){.interrupt = &interrupt}, &error),
                   TRAX_INTERRUPTED);
  assert_null(scene.bytes);
  trax_mesh_release(&mesh);
}

static void test_empty(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene;
  trax_error error;
  assert_int_equal(trax_scene_build(&scene, &mesh, NULL, &error), TRAX_ERROR);
  assert_contains(error.message, "no triangles");
  build_good(&scene, &mesh, &(struct trax_build_options){.allow_empty = true});
  assert_int_equal(scene.header->root, 0);
  assert_int_equal(scene.size, sizeof(struct trax_scene_header));
  const char *path = test_path("empty.trax");
  assert_int_equal(trax_scene_write(&scene, path, &error), TRAX_OK);
  trax_scene_release(&scene);
  assert_int_equal(trax_scene_read(&scene, path, 0, &error), TRAX_OK);
  assert_int_equal(scene.triangle_count, 0);
  struct trax_scene_stats stats;
  trax_scene_measure(&stats, &scene);
  assert_int_equal(stats.leaves, 0);
  trax_scene_release(&scene);
}

/* --- files --- */

static void test_write_and_read(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene, read;
  trax_error error;
  mesh_soup(&mesh, 500, 0.2f, 11);
  build_good(&scene, &mesh, &(struct trax_build_options){.without_source_ids = true});
  assert_null(scene.source_ids);
  const char *path = test_path("soup.trax");
  assert_int_equal(trax_scene_write(&scene, path, &error), TRAX_OK);
  assert_int_equal(trax_scene_read(&read, path, 0, &error), TRAX_OK);
  assert_int_equal((uintptr_t)read.bytes % TRAX_SCENE_ALIGNMENT, 0);
  assert_int_equal(read.size, scene.size);
  assert_memory_equal(read.bytes, scene.bytes, scene.size);
  assert_int_equal(read.node_count, scene.node_count);
  assert_null(read.source_ids);
  trax_scene_release(&read);

  /* A link stays a link, the mode of what is replaced stays, and nothing is left over. */
  const char *link = test_path("link.trax");
  assert_int_equal(symlink("soup.trax", link), 0);
  assert_int_equal(chmod(path, 0600), 0);
  unsigned files = count_files();
  assert_int_equal(trax_scene_write(&scene, link, &error), TRAX_OK);
  struct stat status;
  assert_int_equal(lstat(link, &status), 0);
  assert_true(S_ISLNK(status.st_mode));
  assert_int_equal(stat(path, &status), 0);
  assert_int_equal(status.st_mode & 0777, 0600);
  assert_int_equal(count_files(), files);
  /* A path that is no regular file is written to, not replaced. */
  assert_int_equal(trax_scene_write(&scene, "/dev/null", &error), TRAX_OK);
  assert_int_equal(stat("/dev/null", &status), 0);
  assert_true(S_ISCHR(status.st_mode));

  assert_int_equal(trax_scene_write(&scene, test_path("no/where.trax"), &error), TRAX_ERROR);
  assert_contains(error.message, "no/where.trax: cannot be written: No such file");
  assert_int_equal(trax_scene_write(&scene, "/dev/full", &error), TRAX_ERROR);
  assert_contains(error.message, "/dev/full: cannot be written: No space left");
  assert_int_equal(trax_scene_write(&scene, test_directory(), &error), TRAX_ERROR);
  assert_int_equal(count_files(), files);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

static void test_statistics(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene;
  /* Two unit squares, one above the other at distance 2: the halves are known. */
  for (int z = 0; z <= 2; z += 2) {
    float height = (float)z;
    mesh_triangle(&mesh, (float[]){0, 0, height}, (float[]){1, 0, height}, (float[]){1, 1, height}, 0);
    mesh_triangle(&mesh, (float[]){0, 0, height}, (float[]){1, 1, height}, (float[]){0, 1, height}, 0);
  }
  build_good(&scene, &mesh, &(struct trax_build_options){.max_leaf = 2});
  struct trax_scene_stats stats;
  trax_scene_measure(&stats, &scene);
  assert_int_equal(scene.node_count, 1);
  assert_int_equal(stats.leaves, 2);
  assert_int_equal(stats.leaf_sizes[2], 2);
  assert_true(stats.mean_leaf_depth == 1);
  assert_true(stats.sah_nodes == 1);
  /* Half areas: 1 of a square, 1 + 2 + 2 of the whole; two triangles in each of two leaves. */
  assert_true(fabs(stats.sah_triangles - 2 * 2 * 1 / 5.0) < 1e-12);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* --- interrupts --- */

struct interrupter {
  double from; /* interrupted at the second call with no less than this fraction */
  unsigned calls, later;
  volatile int interrupt;
};

static void count_calls(void *context, const char *step, double fraction) {
  struct interrupter *interrupter = context;
  interrupter->later += interrupter->interrupt != 0;
  if (strcmp(step, "BVH") == 0 && fraction >= interrupter->from && ++interrupter->calls == 2)
    interrupter->interrupt = 1;
}

/* Each step of a build ends where it finds out, and not when it is done: Embree's builder does not ask. */
static void test_interrupts(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 50000, 0.01f, 7);
  static const double phases[] = {0, 0.8}; /* as the tree is built and as it is improved */
  for (size_t i = 0; i < sizeof phases / sizeof *phases; i++)
    for (int splits = 0; splits < 2; splits++) {
      struct interrupter interrupter = {.from = phases[i]};
      struct trax_scene scene;
      trax_error error;
      const struct trax_build_options options = {.passes = 1,
                                                 .splits = splits ? 2 : 0,
                                                 .progress = count_calls,
                                                 .progress_context = &interrupter,
                                                 .interrupt = &interrupter.interrupt};
      assert_int_equal(trax_scene_build(&scene, &mesh, &options, &error), TRAX_INTERRUPTED);
      assert_true(interrupter.interrupt);
      assert_int_equal(interrupter.later, 0);
    }
  trax_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_shapes),         cmocka_unit_test(test_awkward_meshes),
      cmocka_unit_test(test_extreme_scales), cmocka_unit_test(test_rays_find_the_nearest),
      cmocka_unit_test(test_determinism),    cmocka_unit_test(test_passes),
      cmocka_unit_test(test_quality),        cmocka_unit_test(test_bad_options),
      cmocka_unit_test(test_normals),        cmocka_unit_test(test_empty),
      cmocka_unit_test(test_write_and_read), cmocka_unit_test(test_statistics),
      cmocka_unit_test(test_interrupts),
  };
  return cmocka_run_group_tests_name("scene", tests, NULL, NULL);
}
