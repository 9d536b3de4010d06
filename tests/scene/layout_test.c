/* The layouts of nodes: the same tree over the same triangles, boxes that contain what is below them and hardly more,
   and a checker that notices every wrong one. */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void build_layout(struct trax_scene *scene, const struct trax_mesh *mesh, enum trax_node_layout layout) {
  trax_error error;
  if (trax_scene_build(scene, mesh, &(struct trax_build_options){.nodes = layout}, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  assert_int_equal(scene->header->node_layout, layout);
}

static struct trax_node_children read_node(const struct trax_scene *scene, trax_scene_ref ref) {
  const struct trax_scene_section *section = &scene->header->sections[TRAX_SCENE_NODES];
  struct trax_node_children node;
  assert_true(ref >= section->offset && (ref - section->offset) % section->record_size == 0);
  assert_true((ref - section->offset) / section->record_size < section->count);
  trax_node_read(&node, scene, (ref - section->offset) / section->record_size);
  assert_true(node.count >= 2 || section->count == 1);
  return node;
}

/* Adds the triangles below ref to a box and to the numbers seen, in order. */
static void walk(const struct trax_scene *scene, trax_scene_ref ref, double min[3], double max[3], uint32_t *next) {
  if (TRAX_SCENE_REF_COUNT(ref)) {
    uint32_t first = (TRAX_SCENE_REF_OFFSET(ref) - scene->header->sections[TRAX_SCENE_TRIANGLES].offset) /
                     (uint32_t)sizeof(struct trax_triangle);
    assert_int_equal(first, *next);
    for (uint32_t i = 0; i < TRAX_SCENE_REF_COUNT(ref); i++)
      for (int corner = 0; corner < 3; corner++)
        for (int axis = 0; axis < 3; axis++) {
          const struct trax_triangle *triangle = &scene->triangles[first + i];
          const float *const corners[3] = {triangle->v0, triangle->v1, triangle->v2};
          const double value = corners[corner][axis];
          min[axis] = fmin(min[axis], value), max[axis] = fmax(max[axis], value);
        }
    *next += TRAX_SCENE_REF_COUNT(ref);
    return;
  }
  const struct trax_node_children node = read_node(scene, ref);
  const bool leaves_first = scene->header->node_layout == TRAX_NODES_WIDE8;
  double low[TRAX_NODE_MOST_CHILDREN][3], high[TRAX_NODE_MOST_CHILDREN][3];
  for (uint32_t k = 0; k < 2 * node.count; k++) {
    const uint32_t i = k % node.count;
    if (leaves_first ? (TRAX_SCENE_REF_COUNT(node.child[i]) == 0) != (k >= node.count) : k >= node.count)
      continue;
    for (int axis = 0; axis < 3; axis++)
      low[i][axis] = INFINITY, high[i][axis] = -INFINITY;
    walk(scene, node.child[i], low[i], high[i], next);
    for (int axis = 0; axis < 3; axis++)
      min[axis] = fmin(min[axis], low[i][axis]), max[axis] = fmax(max[axis], high[i][axis]);
  }
  for (uint32_t i = 0; i < node.count; i++)
    for (int axis = 0; axis < 3; axis++) {
      const double most = node.cell[axis]; /* by which a box may be larger than it must be */
      assert_true(node.min[i][axis] <= low[i][axis] && high[i][axis] <= node.max[i][axis]);
      assert_true(node.min[i][axis] + most >= low[i][axis] && high[i][axis] >= node.max[i][axis] - most);
    }
}

/* Meshes of all kinds: one triangle, two, many; flat scenes; scenes far from the origin, tiny and huge. */
static void make_mesh(struct trax_mesh *mesh, int kind) {
  static const uint32_t counts[] = {1, 2, 3, 5, 8, 9, 40, 1000, 777, 778};
  mesh_soup(mesh, counts[kind], 0.3f, (uint32_t)kind);
  for (uint32_t v = 0; v < mesh->vertex_count; v++)
    for (int axis = 0; axis < 3; axis++) {
      float *value = &mesh->vertices[v][axis];
      if (kind == 6 && axis == 1)
        *value = 3;
      if (kind == 7)
        *value = *value + 1e6f;
      if (kind == 8)
        *value *= 0x1p-100f;
      if (kind == 9)
        *value *= 0x1p59f;
    }
}

enum { MESH_KINDS = 10 };

/* Each triangle of the mesh once. */
static void check_same_triangles(const struct trax_scene *scene, const struct trax_scene *other, bool same_order) {
  const struct trax_triangle *of_mesh[1000] = {NULL};
  assert_int_equal(scene->triangle_count, other->triangle_count);
  for (uint32_t i = 0; i < other->triangle_count; i++)
    of_mesh[other->source_ids[i]] = &other->triangles[i];
  for (uint32_t i = 0; i < scene->triangle_count; i++) {
    const uint32_t id = scene->source_ids[i];
    assert_true(!same_order || of_mesh[id] == &other->triangles[i]);
    assert_non_null(of_mesh[id]);
    assert_memory_equal(&scene->triangles[i], of_mesh[id], sizeof *scene->triangles);
    of_mesh[id] = NULL;
  }
}

static void test_boxes(void **state) {
  (void)state;
  for (int kind = 0; kind < MESH_KINDS; kind++) {
    struct trax_mesh mesh = {0};
    struct trax_scene scenes[TRAX_NODE_LAYOUTS];
    make_mesh(&mesh, kind);
    for (unsigned layout = 0; layout < TRAX_NODE_LAYOUTS; layout++) {
      struct trax_scene *scene = &scenes[layout];
      build_layout(scene, &mesh, layout);
      trax_error error;
      if (trax_scene_check(NULL, scene->bytes, scene->size, "scene", &error) != TRAX_OK)
        fail_msg("%s nodes, mesh %d: %s", trax_node_formats[layout].name, kind, error.message);
      double min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {-INFINITY, -INFINITY, -INFINITY};
      uint32_t next = 0;
      walk(scene, scene->header->root, min, max, &next);
      assert_int_equal(next, mesh.triangle_count);
      check_same_triangles(scene, &scenes[0], layout != TRAX_NODES_WIDE8);
    }
    for (unsigned layout = 0; layout < TRAX_NODE_LAYOUTS; layout++)
      trax_scene_release(&scenes[layout]);
    trax_mesh_release(&mesh);
  }
}

/* Every half word of every node, one more and one less: boxes and references must be exactly what they are. */
static void test_changed_nodes(void **state) {
  (void)state;
  for (unsigned layout = 0; layout < TRAX_NODE_LAYOUTS; layout++) {
    struct trax_mesh mesh = {0};
    struct trax_scene scene;
    mesh_soup(&mesh, 60, 0.4f, 5);
    build_layout(&scene, &mesh, layout);
    const struct trax_scene_section *section = &scene.header->sections[TRAX_SCENE_NODES];
    uint16_t *halves = (uint16_t *)(void *)((unsigned char *)scene.bytes + section->offset);
    for (uint32_t i = 0; i < section->size / 2; i++)
      for (int step = -1; step <= 1; step += 2) {
        const uint16_t old = halves[i];
        halves[i] = (uint16_t)(old + step);
        seal(scene.bytes, scene.size);
        trax_error error;
        if (trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error) == TRAX_OK)
          fail_msg("%s nodes: half word %u may be %u as well as %u", trax_node_formats[layout].name, i, halves[i], old);
        assert_true(strstr(error.message, "scene: node ") || strstr(error.message, "scene: reference "));
        halves[i] = old;
      }
    struct trax_scene_header *header = scene.bytes;
    trax_error error;
    header->node_layout = 77;
    seal(scene.bytes, scene.size);
    assert_int_equal(trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error), TRAX_ERROR);
    assert_contains(error.message, "nodes of an unknown layout");
    const enum trax_node_layout other = layout == TRAX_NODES_BINARY ? TRAX_NODES_QUANTISED : TRAX_NODES_BINARY;
    header->node_layout = other;
    seal(scene.bytes, scene.size);
    assert_int_equal(trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error), TRAX_ERROR);
    if (trax_node_formats[layout].bytes != trax_node_formats[other].bytes)
      assert_contains(error.message, "records of");
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
}

/* --- split triangles --- */

struct point {
  double at[3];
  const struct trax_triangle *triangle;
};

/* Is the point in the boxes of all nodes above a leaf with its triangle? */
static bool finds(const struct trax_scene *scene, trax_scene_ref ref, const struct point *point) {
  if (TRAX_SCENE_REF_COUNT(ref)) {
    const struct trax_triangle *first =
        (const struct trax_triangle *)((const unsigned char *)scene->bytes + TRAX_SCENE_REF_OFFSET(ref));
    for (uint32_t i = 0; i < TRAX_SCENE_REF_COUNT(ref); i++)
      if (memcmp(&first[i], point->triangle, sizeof first[i]) == 0)
        return true;
    return false;
  }
  const struct trax_node_children node = read_node(scene, ref);
  for (uint32_t i = 0; i < node.count; i++) {
    bool inside = true;
    for (int axis = 0; axis < 3; axis++)
      inside &= point->at[axis] >= node.min[i][axis] - 1e-9 && point->at[axis] <= node.max[i][axis] + 1e-9;
    if (inside && finds(scene, node.child[i], point))
      return true;
  }
  return false;
}

/* Every point of every triangle: corners, points of edges, and within. */
static void check_points(const struct trax_scene *scene, const struct trax_triangle *triangles, uint32_t count,
                         unsigned points, uint32_t *seed) {
  for (uint32_t t = 0; t < count; t++)
    for (unsigned i = 0; i < points; i++) {
      double u = i == 0 ? 0 : i == 1 ? 1 : random_unit(seed), v = i == 2 ? 1 - u : (1 - u) * random_unit(seed);
      struct point point = {.triangle = &triangles[t]};
      for (int axis = 0; axis < 3; axis++)
        point.at[axis] = triangles[t].v0[axis] + u * ((double)triangles[t].v1[axis] - triangles[t].v0[axis]) +
                         v * ((double)triangles[t].v2[axis] - triangles[t].v0[axis]);
      if (!finds(scene, scene->header->root, &point))
        fail_msg("%s nodes: no leaf of triangle %u is around %g, %g, %g",
                 trax_node_formats[scene->header->node_layout].name, t, point.at[0], point.at[1], point.at[2]);
    }
}

/* Long ones askew across many small ones, some of them at one place. */
static void split_mesh(struct trax_mesh *mesh, uint32_t doubled) {
  mesh_soup(mesh, 400, 0.1f, 11);
  for (uint32_t t = 0; t < 24; t++) {
    const uint32_t *v = mesh->triangles[t].vertices;
    for (int axis = 0; axis < 3; axis++) {
      mesh->vertices[v[0]][axis] = t >> axis & 1 ? -1.0f : 1.0f;
      mesh->vertices[v[1]][axis] = -mesh->vertices[v[0]][axis] + 0.01f * (float)t;
      mesh->vertices[v[2]][axis] = mesh->vertices[v[1]][axis] + (axis == (int)t % 3 ? 0.2f : 0);
    }
  }
  for (uint32_t t = 0; t < doubled; t++)
    memcpy(mesh->triangles[100 + t].vertices, mesh->triangles[t / 2].vertices, sizeof mesh->triangles->vertices);
}

static void test_splits(void **state) {
  (void)state;
  uint32_t seed = 3;
  for (unsigned layout = 0; layout < TRAX_NODE_LAYOUTS; layout++) {
    struct trax_mesh mesh = {0};
    struct trax_scene whole, scene;
    trax_error error;
    split_mesh(&mesh, 12);
    build_layout(&whole, &mesh, layout);
    const struct trax_build_options options = {.nodes = layout, .splits = 3, .smooth = true};
    if (trax_scene_build(&scene, &mesh, &options, &error) != TRAX_OK ||
        trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error) != TRAX_OK)
      fail_msg("%s", error.message);
    assert_true(scene.triangle_count > mesh.triangle_count + 20);
    assert_true(scene.header->max_leaf <= 4);
    check_points(&scene, whole.triangles, whole.triangle_count, 80, &seed);
    /* A triangle has its normals wherever it stands. */
    for (uint32_t i = 0; i < scene.triangle_count; i++)
      for (uint32_t k = 0; k < i; k++)
        if (scene.source_ids[i] == scene.source_ids[k]) {
          assert_memory_equal(&scene.triangles[i], &scene.triangles[k], sizeof *scene.triangles);
          assert_memory_equal(&scene.normals[i], &scene.normals[k], sizeof *scene.normals);
        }
    /* A scene that is accepted after a change still has every point. */
    const struct trax_scene_section *section = &scene.header->sections[TRAX_SCENE_NODES];
    uint16_t *halves = (uint16_t *)(void *)((unsigned char *)scene.bytes + section->offset);
    unsigned accepted = 0, refused = 0;
    for (uint32_t i = 0; i < section->size / 2; i += 17)
      for (int step = -1; step <= 1; step += 2) {
        const uint16_t old = halves[i];
        halves[i] = (uint16_t)(old + step);
        seal(scene.bytes, scene.size);
        if (trax_scene_check(NULL, scene.bytes, scene.size, "scene", NULL) == TRAX_OK) {
          check_points(&scene, whole.triangles, 24, 40, &seed);
          accepted++;
        } else {
          refused++;
        }
        halves[i] = old;
      }
    /* Boxes that are larger by one. Of eight children more bytes are planes. */
    assert_true(accepted > 0 && (layout == TRAX_NODES_WIDE8 ? 7 : 15) * accepted < refused);
    trax_scene_release(&whole);
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
}

/* A scene without a part of a triangle is refused. */
static void test_missing_part(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene;
  trax_error error = {{0}};
  split_mesh(&mesh, 0);
  const struct trax_build_options options = {.splits = 3, .without_source_ids = true};
  assert_int_equal(trax_scene_build(&scene, &mesh, &options, &error), TRAX_OK);
  struct trax_triangle *triangles = (struct trax_triangle *)scene.triangles;
  unsigned refused = 0, parts = 0;
  for (uint32_t i = 0; i < scene.triangle_count; i++) {
    unsigned copies = 0;
    for (uint32_t k = 0; k < scene.triangle_count; k++)
      copies += memcmp(&triangles[i], &triangles[k], sizeof *triangles) == 0;
    if (copies < 2)
      continue;
    const struct trax_triangle old = triangles[i];
    triangles[i].v1[1] = 0.5f * (old.v0[1] + old.v1[1]); /* another triangle of the same bounds, or less */
    seal(scene.bytes, scene.size);
    refused += trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error) != TRAX_OK;
    triangles[i] = old;
    parts++;
  }
  assert_true(parts > 50);
  assert_true(refused * 10 > parts * 9);
  assert_contains(error.message, "is not that of its triangles");
  trax_scene_release(&scene);
  /* The builder splits these by itself, and none that emit. */
  struct trax_build_options choice = {0};
  assert_true(trax_splits_choose("auto", &choice));
  assert_int_equal(trax_scene_build(&scene, &mesh, &choice, &error), TRAX_OK);
  assert_true(scene.triangle_count > mesh.triangle_count);
  trax_scene_release(&scene);
  mesh.materials[0].surface.emission[1] = 1;
  assert_int_equal(trax_scene_build(&scene, &mesh, &choice, &error), TRAX_OK);
  assert_int_equal(scene.triangle_count, mesh.triangle_count);
  trax_scene_release(&scene);
  assert_int_equal(trax_scene_build(&scene, &mesh, &options, &error), TRAX_ERROR);
  assert_contains(error.message, "no splits where triangles emit light");
  trax_mesh_release(&mesh);
}

/* Slivers across the scene call for splits, but not one sliver many times over: the tree has it once. */
static void test_duplicates_do_not_call_for_splits(void **state) {
  (void)state;
  for (int apart = 0; apart <= 1; apart++) {
    struct trax_mesh mesh = {0};
    struct trax_scene scene;
    struct trax_build_options choice = {0};
    mesh_soup(&mesh, 400, 0.01f, 1);
    for (int i = 0; i < 12; i++) {
      const float shift = apart ? 0.01f * (float)i : 0;
      mesh_triangle(&mesh, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, (float[]){1, 1, 0.9f - shift}, 0);
    }
    assert_true(trax_splits_choose("auto", &choice));
    build_good(&scene, &mesh, &choice);
    assert_true((scene.triangle_count > mesh.triangle_count) == apart);
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
}

/* Triangles at one place are in the order of their numbers, whichever thread has found them. */
static void test_order_of_duplicates(void **state) {
  (void)state;
  enum { COUNT = 20000 };
  for (unsigned threads = 1; threads <= 4; threads++) {
    struct trax_mesh mesh = {0};
    struct trax_scene scene;
    mesh_soup(&mesh, COUNT, 0.02f, threads);
    for (uint32_t i = 0; i < COUNT; i++) /* each once more, in another order */
      memcpy(mesh.triangles[i].vertices, mesh.triangles[(i & ~1u) * 7 % COUNT].vertices,
             sizeof mesh.triangles->vertices);
    build_good(&scene, &mesh, &(struct trax_build_options){.threads = threads, .choose_splits = true});
    assert_int_equal(scene.triangle_count, COUNT);
    uint32_t *last = malloc(mesh.vertex_count * sizeof *last); /* by the first vertex of the place */
    assert_non_null(last);
    memset(last, 0, mesh.vertex_count * sizeof *last);
    unsigned again = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
      uint32_t *number = &last[mesh.triangles[scene.source_ids[i]].vertices[0]];
      assert_true(*number <= scene.source_ids[i]);
      again += *number > 0;
      *number = scene.source_ids[i] + 1;
    }
    assert_true(again > COUNT / 3);
    free(last);
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
}

/* Many slivers of which none is worse than the others are not split, either: the tree is that without splits. */
static void test_equals_do_not_call_for_splits(void **state) {
  (void)state;
  struct trax_scene_stats stats[2];
  for (int chosen = 0; chosen <= 1; chosen++) {
    struct trax_mesh mesh = {0};
    struct trax_scene scene;
    struct trax_build_options options = {0};
    uint32_t random = 1;
    for (int i = 0; i < 200; i++) {
      float at[3];
      for (int axis = 0; axis < 3; axis++) {
        random = random * 1664525 + 1013904223;
        at[axis] = (float)(random >> 8) * 0x1p-24f;
      }
      const float x = at[0] + 0.5f, y = at[1] + 0.5f, z = at[2] + 0.5f;
      mesh_triangle(&mesh, at, (float[]){x, y, z}, (float[]){x, y, z - 0.03f}, 0);
    }
    if (chosen)
      assert_true(trax_splits_choose("auto", &options));
    build_good(&scene, &mesh, &options);
    trax_scene_measure(&stats[chosen], &scene);
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
  assert_true(stats[0].sah_nodes == stats[1].sah_nodes);
}

/* Quantised where the grid is fine enough. */
static void test_choice(void **state) {
  (void)state;
  for (int far = 0; far <= 1; far++) {
    struct trax_mesh mesh = {0};
    struct trax_scene scene;
    trax_error error;
    mesh_soup(&mesh, 300, 0.1f, 1);
    if (far) /* one triangle reaches so far that a cell is larger than the others */
      mesh.vertices[0][0] = mesh.vertices[0][1] = mesh.vertices[0][2] = 1e5f;
    struct trax_build_options options = {0};
    assert_true(trax_node_layout_choose("auto", &options));
    assert_int_equal(trax_scene_build(&scene, &mesh, &options, &error), TRAX_OK);
    assert_int_equal(scene.header->node_layout, far ? TRAX_NODES_BINARY : TRAX_NODES_QUANTISED);
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
  struct trax_build_options options = {0};
  assert_false(trax_node_layout_choose("octal", &options));
  for (unsigned layout = 0; layout < TRAX_NODE_LAYOUTS; layout++) {
    assert_true(trax_node_layout_choose(trax_node_formats[layout].name, &options));
    assert_true(options.nodes == layout && !options.choose_nodes);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_boxes),
      cmocka_unit_test(test_changed_nodes),
      cmocka_unit_test(test_splits),
      cmocka_unit_test(test_duplicates_do_not_call_for_splits),
      cmocka_unit_test(test_equals_do_not_call_for_splits),
      cmocka_unit_test(test_order_of_duplicates),
      cmocka_unit_test(test_missing_part),
      cmocka_unit_test(test_choice),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
