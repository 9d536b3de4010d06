/* The layouts of nodes: the same tree over the same triangles, boxes that contain what is below them and hardly more,
   and a checker that notices every wrong one. */
#include "support.h"

#include <math.h>

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
  assert_true(node.count >= 2 && node.count <= trax_node_formats[scene->header->node_layout].width);
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
  const bool quantised = trax_node_formats[scene->header->node_layout].quantised;
  for (uint32_t i = 0; i < node.count; i++) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    walk(scene, node.child[i], low, high, next);
    for (int axis = 0; axis < 3; axis++) {
      const double cell = quantised ? scene->grid.cell[axis] : 0;
      assert_true(node.min[i][axis] <= low[axis] && high[axis] <= node.max[i][axis]);
      assert_true(node.min[i][axis] + cell >= low[axis] && high[axis] >= node.max[i][axis] - cell);
      min[axis] = fmin(min[axis], low[axis]), max[axis] = fmax(max[axis], high[axis]);
    }
  }
}

/* Of all kinds: one triangle, two, many; flat scenes; scenes far from the origin, tiny and huge. */
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
      assert_memory_equal(scene->triangles, scenes[0].triangles, next * sizeof *scene->triangles);
      assert_memory_equal(scene->source_ids, scenes[0].source_ids, next * sizeof *scene->source_ids);
    }
    for (unsigned layout = 0; layout < TRAX_NODE_LAYOUTS; layout++)
      trax_scene_release(&scenes[layout]);
    trax_mesh_release(&mesh);
  }
}

/* Every half word of every node, one more and one less: boxes and references must be exactly what they are. */
static void test_changed_nodes(void **state) {
  (void)state;
  for (unsigned layout = 1; layout < TRAX_NODE_LAYOUTS; layout++) {
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
        if (trax_scene_check(NULL, scene.bytes, scene.size, "scene", NULL) == TRAX_OK)
          fail_msg("%s nodes: half word %u may be %u as well as %u", trax_node_formats[layout].name, i, halves[i], old);
        halves[i] = old;
      }
    struct trax_scene_header *header = scene.bytes;
    trax_error error;
    header->node_layout = TRAX_NODE_LAYOUTS;
    seal(scene.bytes, scene.size);
    assert_int_equal(trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error), TRAX_ERROR);
    assert_contains(error.message, "nodes of an unknown layout");
    header->node_layout = TRAX_NODES_BINARY;
    seal(scene.bytes, scene.size);
    assert_int_equal(trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error), TRAX_ERROR);
    assert_contains(error.message, "records of");
    trax_scene_release(&scene);
    trax_mesh_release(&mesh);
  }
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
      cmocka_unit_test(test_choice),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
