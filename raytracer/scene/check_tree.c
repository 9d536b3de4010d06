/* Checks the tree of a scene file: each node and triangle is in it once, and boxes are those of the triangles. */
#include "placing.h"

#include <stdlib.h>
#include <string.h>

struct checker {
  const char *name;
  trax_error *error;
  const struct trax_scene *view;
  uint32_t nodes_offset, nodes_size, triangles_offset, triangles_size;
  unsigned char *node_seen; /* one byte for each node */
  uint32_t nodes_left, next_triangle;
  uint32_t next_instance, numbers; /* numbers: of triangles of the instances so far */
  uint32_t first_node, end_node;   /* of this tree's */
  uint32_t max_depth, max_leaf;    /* found */
  struct scene_box bounds;         /* of all triangles */
  struct scene_range *ranges;      /* of each node */
  uint32_t *in_part;               /* of each triangle: the place of a box that does not contain it, or 0 */
  bool any_in_part;
};

/* Room for a node of any layout. */
enum {
#define LAYOUT(number, NAME, name, general, planes, visit, option, record, ...) +sizeof(record)
  MOST_NODE_BYTES = 0
#include "layouts/table.def"
};

static const struct trax_node_format *format_of(const struct checker *checker) {
  return &trax_node_formats[checker->view->header->node_layout];
}

static trax_status check_leaf(struct checker *checker, trax_scene_ref ref, struct scene_box *box) {
  const struct trax_scene *view = checker->view;
  uint32_t offset = TRAX_SCENE_REF_OFFSET(ref), count = TRAX_SCENE_REF_COUNT(ref);
  if (offset < checker->triangles_offset || offset - checker->triangles_offset >= checker->triangles_size ||
      (offset - checker->triangles_offset) % sizeof(struct trax_triangle) != 0)
    return trax_fail(checker->error, "%s: reference %08x is to no triangle", checker->name, ref);
  uint32_t first = (offset - checker->triangles_offset) / (uint32_t)sizeof(struct trax_triangle);
  if (count > view->triangle_count - first)
    return trax_fail(checker->error, "%s: reference %08x is to triangles behind the last", checker->name, ref);
  /* Leaf order is depth first: each of the file's triangles is in one leaf if every leaf begins where the one before
     ended. */
  if (first != checker->next_triangle)
    return trax_fail(checker->error, "%s: reference %08x is to triangle %u where %u is next", checker->name, ref, first,
                     checker->next_triangle);
  checker->next_triangle += count;
  if (count > checker->max_leaf)
    checker->max_leaf = count;
  for (uint32_t i = first; i < first + count; i++) {
    scene_box_add_point(box, view->triangles[i].v0);
    scene_box_add_point(box, view->triangles[i].v1);
    scene_box_add_point(box, view->triangles[i].v2);
  }
  return TRAX_OK;
}

static bool same_box(const struct scene_box *a, const struct scene_box *b) {
  for (int axis = 0; axis < 3; axis++)
    if (a->min[axis] != b->min[axis] || a->max[axis] != b->max[axis])
      return false;
  return true;
}

static bool box_within(const struct scene_box *inner, const struct scene_box *outer) {
  for (int axis = 0; axis < 3; axis++)
    if (!(inner->min[axis] >= outer->min[axis] && inner->max[axis] <= outer->max[axis]))
      return false;
  return true;
}

static struct scene_box as_stored(const struct checker *checker, const struct scene_box *box) {
  return scene_box_as_stored(checker->view->header->node_layout, &checker->view->grid, box);
}

/* Notes the triangles of a leaf that its box does not contain. Each must be in other leaves, too. `place`: of the box.
 */
static void note_parts(struct checker *checker, trax_scene_ref ref, const struct scene_box *stored, uint32_t place) {
  const uint32_t first =
      (TRAX_SCENE_REF_OFFSET(ref) - checker->triangles_offset) / (uint32_t)sizeof(struct trax_triangle);
  for (uint32_t i = first; i < first + TRAX_SCENE_REF_COUNT(ref); i++) {
    struct scene_box box = scene_empty_box();
    scene_box_add_point(&box, checker->view->triangles[i].v0);
    scene_box_add_point(&box, checker->view->triangles[i].v1);
    scene_box_add_point(&box, checker->view->triangles[i].v2);
    box = as_stored(checker, &box);
    if (!box_within(&box, stored)) {
      checker->in_part[i] = place + 1;
      checker->any_in_part = true;
    }
  }
}

static trax_status wrong_box(const struct checker *checker, uint32_t place) {
  return trax_fail(checker->error, "%s: node %u: box %u is not that of its triangles", checker->name,
                   place / TRAX_NODE_MOST_CHILDREN, place % TRAX_NODE_MOST_CHILDREN);
}

/* Checks a node that is the last of `depth` on its path, and reads it. */
static trax_status enter_node(struct checker *checker, trax_scene_ref ref, unsigned depth, uint32_t *entered,
                              struct scene_node *node) {
  const struct trax_node_format *format = format_of(checker);
  if (ref < checker->nodes_offset || ref - checker->nodes_offset >= checker->nodes_size ||
      (ref - checker->nodes_offset) % format->bytes != 0)
    return trax_fail(checker->error, "%s: reference %08x is to no node", checker->name, ref);
  const uint32_t number = *entered = (ref - checker->nodes_offset) / format->bytes;
  if (number < checker->first_node || number >= checker->end_node)
    return trax_fail(checker->error, "%s: node %u is of another tree", checker->name, number);
  if (checker->node_seen[number])
    return trax_fail(checker->error, "%s: node %u is referred to twice", checker->name, number);
  checker->node_seen[number] = 1;
  checker->nodes_left--;
  if (depth > TRAX_SCENE_MAX_DEPTH)
    return trax_fail(checker->error, "%s: node %u is deeper than %u", checker->name, number, TRAX_SCENE_MAX_DEPTH);
  scene_node_of(node, checker->view, number);
  if (node->count < 2 && !(format->code->arrange && node->count == 1 && checker->view->node_count == 1))
    return trax_fail(checker->error, "%s: node %u: fewer than two children", checker->name, number);
  return TRAX_OK;
}

/* Compares each byte with a node written around these boxes: its frame, reserved bytes, and absent children. */
static trax_status check_bytes(const struct checker *checker, uint32_t number, const struct scene_node *node) {
  _Alignas(TRAX_SCENE_ALIGNMENT) unsigned char right[MOST_NODE_BYTES];
  const struct trax_node_format *format = format_of(checker);
  format->code->write(right, format, node);
  if (memcmp(right, (const unsigned char *)checker->view->nodes + (size_t)number * format->bytes, format->bytes) == 0)
    return TRAX_OK;
  return trax_fail(checker->error, "%s: node %u: %s", checker->name, number,
                   format->children == 2 ? "reserved words are not zero"
                                         : "its frame, its reserved bytes or the places of its children are wrong");
}

static trax_status check_subtree(struct checker *checker, trax_scene_ref ref, unsigned depth, uint32_t entries,
                                 struct scene_box *box);

/* Checks a child of a node and what is below it. Its box becomes what counts above. */
static trax_status check_child(struct checker *checker, struct scene_node *node, uint32_t i, uint32_t number,
                               unsigned depth, uint32_t entries) {
  const trax_scene_ref child = node->child[i];
  struct scene_box expected = scene_empty_box();
  if (check_subtree(checker, child, depth, entries, &expected) != TRAX_OK)
    return TRAX_ERROR;
  const struct scene_box stored = node->box[i], right = scene_box_in_node(checker->view, number, &expected);
  if (!same_box(&stored, &right)) {
    if (!TRAX_SCENE_REF_COUNT(child) || !box_within(&stored, &right))
      return wrong_box(checker, TRAX_NODE_MOST_CHILDREN * number + i);
    note_parts(checker, child, &stored, TRAX_NODE_MOST_CHILDREN * number + i);
  }
  if (format_of(checker)->code->box)
    node->box[i] = TRAX_SCENE_REF_COUNT(child) ? scene_box_within(&stored, &expected) : expected;
  return TRAX_OK;
}

/* Checks the subtree below ref, with `depth` nodes above it. *box receives the box that must be stored for it; that of
   a leaf may be smaller. The recursion ends, because a node is entered once and the depth is limited. */
static trax_status check_subtree(struct checker *checker, trax_scene_ref ref, unsigned depth, uint32_t entries,
                                 struct scene_box *box) {
  if (TRAX_SCENE_REF_COUNT(ref)) {
    struct scene_box exact = scene_empty_box();
    trax_status result = check_leaf(checker, ref, &exact);
    scene_box_add_box(&checker->bounds, &exact);
    *box = as_stored(checker, &exact);
    return result;
  }
  const enum trax_node_layout layout = checker->view->header->node_layout;
  struct scene_node node;
  uint32_t number;
  if (enter_node(checker, ref, ++depth, &number, &node) != TRAX_OK)
    return TRAX_ERROR;
  entries = scene_stack_entries(layout, entries, node.count, &checker->max_depth);
  checker->ranges[number].first = checker->next_triangle;
  const bool leaves_first = trax_node_formats[layout].code->arrange != NULL;
  for (uint32_t i = 0; i < node.count; i++)
    if (!leaves_first || TRAX_SCENE_REF_COUNT(node.child[i]))
      if (check_child(checker, &node, i, number, depth, entries) != TRAX_OK)
        return TRAX_ERROR;
  for (uint32_t i = 0; i < node.count; i++)
    if (leaves_first && !TRAX_SCENE_REF_COUNT(node.child[i]))
      if (check_child(checker, &node, i, number, depth, entries) != TRAX_OK)
        return TRAX_ERROR;
  if (check_bytes(checker, number, &node) != TRAX_OK)
    return TRAX_ERROR;
  *box = scene_box_around(&node);
  checker->ranges[number].end = checker->next_triangle;
  return TRAX_OK;
}

/* The checker has room for the notes of each node and triangle. */
static trax_status check_whole_tree(struct checker *checker) {
  struct scene_box root;
  if (format_of(checker)->code->arrange && TRAX_SCENE_REF_COUNT(checker->view->header->root))
    return trax_fail(checker->error, "%s: its root is no node", checker->name);
  trax_status result = check_subtree(checker, checker->view->header->root, 0, 0, &root);
  if (result != TRAX_OK || !checker->any_in_part)
    return result;
  const struct scene_parts parts = {checker->view, checker->ranges, checker->in_part};
  uint32_t bad;
  result = scene_check_parts(&parts, &bad, checker->error);
  if (result == TRAX_OK && bad != UINT32_MAX)
    result = wrong_box(checker, checker->in_part[bad] - 1);
  return result;
}

/* --- two levels --- */

static trax_status check_mesh(struct checker *checker, uint32_t number) {
  const struct trax_scene_mesh *mesh = &checker->view->meshes[number];
  const char *wrong = NULL;
  struct scene_box root;
  static const uint32_t zeros[sizeof mesh->reserved / sizeof *mesh->reserved];
  const uint32_t first = checker->next_triangle;
  checker->max_depth = 0;
  checker->bounds = scene_empty_box();
  if (mesh->root == 0)
    return trax_fail(checker->error, "%s: mesh %u: a tree without triangles", checker->name, number);
  const trax_status result = check_subtree(checker, mesh->root, 0, 0, &root);
  if (result != TRAX_OK)
    return result;
  const struct scene_box stored = {{mesh->bounds_min[0], mesh->bounds_min[1], mesh->bounds_min[2]},
                                   {mesh->bounds_max[0], mesh->bounds_max[1], mesh->bounds_max[2]}};
  if (mesh->first_triangle != first || mesh->triangle_count != checker->next_triangle - first)
    wrong = "its triangles are not those of its tree";
  else if (mesh->source_count < mesh->triangle_count)
    wrong = "it has fewer triangles than its tree";
  else if (!same_box(&stored, &checker->bounds))
    wrong = "the bounds are not those of its triangles";
  else if (mesh->depth != checker->max_depth)
    wrong = "the depth is not that of its tree";
  else if (checker->any_in_part)
    wrong = "triangles are split";
  else if (memcmp(mesh->reserved, zeros, sizeof zeros) != 0)
    wrong = "reserved words are not zero";
  return wrong ? trax_fail(checker->error, "%s: mesh %u: %s", checker->name, number, wrong) : TRAX_OK;
}

/* Checks all but the stretch, which depends on the bounds of all instances. */
static trax_status check_instance(struct checker *checker, uint32_t number) {
  const struct trax_scene *view = checker->view;
  const struct trax_instance *instance = &view->instances[number];
  struct trax_instance right = *instance;
  if (instance->mesh >= view->mesh_count)
    return trax_fail(checker->error, "%s: instance %u: mesh %u is out of range (%u meshes)", checker->name, number,
                     instance->mesh, view->mesh_count);
  const struct trax_scene_mesh *mesh = &view->meshes[instance->mesh];
  const char *wrong = scene_derive_instance(&right);
  memset(right.reserved, 0, sizeof right.reserved);
  right.root = mesh->root;
  right.first_number = checker->numbers;
  if (!wrong && instance->material != TRAX_NO_MATERIAL && instance->material >= view->material_count)
    wrong = "its material is out of range";
  else if (!wrong && (uint64_t)checker->numbers + mesh->triangle_count > UINT32_MAX)
    wrong = "there are too many triangles before it";
  else if (!wrong && (uint64_t)instance->first_source + mesh->source_count > UINT32_MAX)
    wrong = "its triangles' numbers are out of range";
  else if (!wrong && memcmp(&right, instance, sizeof right) != 0)
    wrong = "root, inverse, spread, flags, number or reserved words do not follow from its mesh and transform";
  checker->numbers += mesh->triangle_count;
  return wrong ? trax_fail(checker->error, "%s: instance %u: %s", checker->name, number, wrong) : TRAX_OK;
}

static trax_status check_upper(struct checker *checker, trax_scene_ref ref, unsigned depth, struct scene_box *box) {
  const struct trax_scene *view = checker->view;
  if (TRAX_SCENE_REF_COUNT(ref)) {
    const uint32_t number = checker->next_instance, offset = TRAX_SCENE_REF_OFFSET(ref);
    if (TRAX_SCENE_REF_COUNT(ref) != 1 || number >= view->instance_count ||
        offset != (uint32_t)((const char *)&view->instances[number] - (const char *)view->header))
      return trax_fail(checker->error, "%s: reference %08x is not to instance %u, which is next", checker->name, ref,
                       number);
    checker->next_instance++;
    if (check_instance(checker, number) != TRAX_OK)
      return TRAX_ERROR;
    *box = scene_instance_box(view, &view->instances[number]);
    for (int axis = 0; axis < 3; axis++)
      if (!(box->min[axis] >= -SCENE_MAX_COORDINATE && box->max[axis] <= SCENE_MAX_COORDINATE))
        return trax_fail(checker->error, "%s: instance %u is too far away", checker->name, number);
    scene_box_add_box(&checker->bounds, box);
    depth += 1 + view->meshes[view->instances[number].mesh].depth;
    checker->max_depth = depth > checker->max_depth ? depth : checker->max_depth;
    return TRAX_OK;
  }
  struct scene_node node;
  uint32_t number;
  if (enter_node(checker, ref, ++depth, &number, &node) != TRAX_OK)
    return TRAX_ERROR;
  for (uint32_t i = 0; i < node.count; i++) {
    struct scene_box expected = scene_empty_box();
    if (check_upper(checker, node.child[i], depth, &expected) != TRAX_OK)
      return TRAX_ERROR;
    if (!same_box(&node.box[i], &expected))
      return trax_fail(checker->error, "%s: node %u: box %u is not that of its instances", checker->name, number, i);
  }
  if (check_bytes(checker, number, &node) != TRAX_OK)
    return TRAX_ERROR;
  *box = scene_box_around(&node);
  return TRAX_OK;
}

/* First the meshes, which the boxes of instances depend on. */
static trax_status check_two_levels(struct checker *checker) {
  const struct trax_scene *view = checker->view;
  struct scene_box root;
  if (view->header->node_layout != TRAX_NODES_BINARY)
    return trax_fail(checker->error, "%s: instances with nodes that are not binary", checker->name);
  checker->first_node = view->instance_count - 1;
  for (uint32_t i = 0; i < view->mesh_count; i++)
    if (check_mesh(checker, i) != TRAX_OK)
      return TRAX_ERROR;
  checker->first_node = 0;
  checker->end_node = view->instance_count - 1;
  checker->max_depth = 0;
  checker->bounds = scene_empty_box();
  if (check_upper(checker, view->header->root, 0, &root) != TRAX_OK)
    return TRAX_ERROR;
  if (checker->next_instance != view->instance_count)
    return trax_fail(checker->error, "%s: %u instances are in no leaf", checker->name,
                     view->instance_count - checker->next_instance);
  if (checker->max_depth > TRAX_SCENE_MAX_DEPTH)
    return trax_fail(checker->error, "%s: deeper than %u", checker->name, TRAX_SCENE_MAX_DEPTH);
  for (uint32_t i = 0; i < view->instance_count; i++)
    if (view->instances[i].stretch != scene_stretch_of(&view->instances[i], &checker->bounds))
      return trax_fail(checker->error, "%s: instance %u: its stretch does not follow from its transform", checker->name,
                       i);
  return scene_check_lamps(view, checker->name, checker->error);
}

static trax_status check_tree(struct checker *checker) {
  const struct trax_scene_header *header = checker->view->header;
  struct scene_box bounds = scene_empty_box();
  if (header->triangle_count == 0) {
    if (header->root != 0 || checker->view->node_count != 0)
      return trax_fail(checker->error, "%s: a tree without triangles", checker->name);
    bounds = (struct scene_box){0};
  } else {
    checker->nodes_left = checker->view->node_count;
    checker->bounds = bounds;
    checker->node_seen = calloc(checker->view->node_count + (size_t)1, 1);
    checker->ranges = calloc(checker->view->node_count + (size_t)1, sizeof *checker->ranges);
    checker->in_part = calloc(header->triangle_count, sizeof *checker->in_part);
    checker->end_node = checker->view->node_count;
    trax_status result = checker->node_seen && checker->ranges && checker->in_part
                             ? (checker->view->instances ? check_two_levels : check_whole_tree)(checker)
                             : scene_out_of_memory(checker->error, checker->name);
    free(checker->node_seen);
    free(checker->ranges);
    free(checker->in_part);
    if (result != TRAX_OK)
      return result;
    bounds = checker->bounds;
    if (checker->nodes_left != 0)
      return trax_fail(checker->error, "%s: %u nodes are not in the tree", checker->name, checker->nodes_left);
    if (checker->next_triangle != header->triangle_count)
      return trax_fail(checker->error, "%s: %u triangles are in no leaf", checker->name,
                       header->triangle_count - checker->next_triangle);
  }
  if (checker->max_depth > TRAX_SCENE_MAX_DEPTH)
    return trax_fail(checker->error, "%s: its traversal needs more than %u entries of the stack", checker->name,
                     TRAX_SCENE_MAX_DEPTH);
  if (checker->max_depth != header->max_depth || checker->max_leaf != header->max_leaf)
    return trax_fail(checker->error, "%s: depth %u and leaves of %u, where its header says %u and %u", checker->name,
                     checker->max_depth, checker->max_leaf, header->max_depth, header->max_leaf);
  for (int axis = 0; axis < 3; axis++)
    if (header->bounds_min[axis] != bounds.min[axis] || header->bounds_max[axis] != bounds.max[axis])
      return trax_fail(checker->error, "%s: the bounds are not those of its triangles", checker->name);
  return TRAX_OK;
}

trax_status scene_check_tree(const struct trax_scene *view, const char *name, trax_error *error) {
  const struct trax_scene_section *sections = view->header->sections;
  struct checker checker = {.name = name,
                            .error = error,
                            .view = view,
                            .nodes_offset = sections[TRAX_SCENE_NODES].offset,
                            .nodes_size = sections[TRAX_SCENE_NODES].size,
                            .triangles_offset = sections[TRAX_SCENE_TRIANGLES].offset,
                            .triangles_size = sections[TRAX_SCENE_TRIANGLES].size};
  return check_tree(&checker);
}
