/* The table of layouts, and what they have in common. */
#include "layouts.h"

#include <stddef.h>
#include <string.h>

#define LAYOUT(number, NAME, name, general, planes, visit, option, record, children, code)                             \
  extern const struct node_code code##_code;
#include "table.def"

const struct trax_node_format trax_node_formats[TRAX_NODE_LAYOUTS] = {
#define OWN(kind) kind##_on_grid, kind##_step
#define LAYOUT(number, NAME, name, general, planes, visit, option, record, children, code)                             \
  [number] = {option, sizeof(record), children, general, planes, &code##_code},
#include "table.def"
};

bool trax_node_layout_choose(const char *name, struct trax_build_options *build) {
  build->choose_nodes = strcmp(name, "auto") == 0;
  for (unsigned i = 0; i < TRAX_NODE_LAYOUTS; i++)
    if (strcmp(name, trax_node_formats[i].name) == 0) {
      build->nodes = (enum trax_node_layout)i;
      return true;
    }
  return build->choose_nodes;
}

struct scene_box scene_box_as_stored(enum trax_node_layout layout, const struct trax_scene_grid *grid,
                                     const struct scene_box *box) {
  return trax_node_formats[layout].quantised ? scene_box_in_cells(grid, box) : *box;
}

struct scene_box scene_box_around(const struct scene_node *node) {
  struct scene_box box = scene_empty_box();
  for (uint32_t i = 0; i < node->count; i++)
    scene_box_add_box(&box, &node->box[i]);
  return box;
}

static const void *record_of(const struct trax_scene *scene, uint32_t number) {
  return (const unsigned char *)scene->nodes + (size_t)number * trax_node_formats[scene->header->node_layout].bytes;
}

void scene_node_of(struct scene_node *node, const struct trax_scene *scene, uint32_t number) {
  const struct trax_node_format *format = &trax_node_formats[scene->header->node_layout];
  format->code->read(node, format, record_of(scene, number));
}

struct scene_box scene_box_in_node(const struct trax_scene *scene, uint32_t number, const struct scene_box *box) {
  const struct node_code *code = trax_node_formats[scene->header->node_layout].code;
  return code->box ? code->box(record_of(scene, number), box) : *box;
}

uint32_t scene_stack_entries(enum trax_node_layout layout, uint32_t above, uint32_t children, uint32_t *most) {
  const uint32_t here = above + (trax_node_formats[layout].code->arrange ? 1 : children - 1);
  *most = here > *most ? here : *most;
  return here;
}

void trax_node_read(struct trax_node_children *children, const struct trax_scene *scene, uint32_t number) {
  const struct trax_node_format *format = &trax_node_formats[scene->header->node_layout];
  struct scene_node node;
  scene_node_of(&node, scene, number);
  children->count = node.count;
  memcpy(children->child, node.child, sizeof children->child);
  for (int axis = 0; axis < 3; axis++) {
    const double origin = format->quantised ? scene->grid.origin[axis] : 0;
    const double cell = format->quantised ? scene->grid.cell[axis] : 1;
    for (uint32_t i = 0; i < node.count; i++) {
      children->min[i][axis] = origin + node.box[i].min[axis] * cell;
      children->max[i][axis] = origin + node.box[i].max[axis] * cell;
    }
    children->cell[axis] = format->quantised ? cell : 0;
    if (format->code->cell)
      children->cell[axis] = format->code->cell(record_of(scene, number), axis);
  }
}
