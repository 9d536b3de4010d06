/* Places a tree in a scene file: nodes, and the triangles of its leaves. */
#include "layout.h"

#include <string.h>

static trax_scene_ref place_leaf(struct layout *layout, const struct scene_tree_node *node) {
  uint32_t offset = layout->triangles_offset + layout->next_triangle * (uint32_t)sizeof(struct trax_triangle);
  if (layout->has_triangles) {
    layout->next_triangle += node->triangle_count;
    return offset | node->triangle_count;
  }
  for (uint32_t i = 0; i < node->triangle_count; i++) {
    const struct trax_mesh_triangle *source = &layout->mesh->triangles[node->triangles[i]];
    struct trax_triangle *triangle = &layout->triangles[layout->next_triangle];
    float *corners[3] = {triangle->v0, triangle->v1, triangle->v2};
    for (int corner = 0; corner < 3; corner++)
      memcpy(corners[corner], layout->mesh->vertices[source->vertices[corner]], 3 * sizeof(float));
    triangle->material = layout->materials[source->material];
    if (layout->normals && layout->file_normals)
      memcpy(layout->normals[layout->next_triangle].corner, layout->mesh->normals[node->triangles[i]],
             sizeof layout->normals->corner);
    /* Coordinates without a texture stay zeros: nothing reads them, and their range was not checked. */
    if (layout->uvs && layout->mesh->uvs && layout->mesh->materials[source->material].surface.texture)
      memcpy(layout->uvs[layout->next_triangle].corner, layout->mesh->uvs[node->triangles[i]],
             sizeof layout->uvs->corner);
    if (layout->numbers)
      layout->numbers[layout->next_triangle] = node->triangles[i];
    if (layout->source_ids)
      layout->source_ids[layout->next_triangle] = source->source_id;
    layout->next_triangle++;
  }
  return offset | node->triangle_count;
}

void scene_place_triangles(struct layout *layout) {
  for (uint32_t i = 0; i < layout->tree->node_count; i++) /* in the order of the recursion below */
    if (layout->tree->nodes[i].triangle_count)
      place_leaf(layout, &layout->tree->nodes[i]);
  layout->next_triangle = 0;
  layout->has_triangles = true;
}

/* Recursion is bounded by the depth of the tree, at most TRAX_SCENE_MAX_DEPTH. */
trax_scene_ref scene_place_subtree(struct layout *layout, uint32_t index, struct scene_box *box) {
  const struct scene_tree_node *node = &layout->tree->nodes[index];
  if (node->triangle_count) {
    *box = scene_box_as_stored(layout->node_layout, &layout->grid, &node->box);
    return place_leaf(layout, node);
  }
  struct scene_node out = {.count = 2};
  for (int i = 0; i < 2; i++)
    out.child[i] = scene_place_subtree(layout, node->child[i], &out.box[i]);
  *box = scene_box_around(&out);
  const struct trax_node_format *format = &trax_node_formats[layout->node_layout];
  const uint32_t offset = layout->positions[index] * format->bytes;
  format->code->write(layout->nodes + offset, format, &out);
  return layout->nodes_offset + offset;
}

static void place_child(struct layout *layout, struct scene_node *out, uint32_t i, uint32_t index) {
  const struct scene_tree_node *node = &layout->tree->nodes[index];
  out->child[i] = node->triangle_count ? scene_place_subtree(layout, index, &out->box[i])
                                       : scene_place_wide_node(layout, layout->wide->number[index], &out->box[i]);
}

/* A leaf's box in a frame may be larger than its part. The nodes above count the stored box where it has triangles,
   which is all that the checker knows. */
static void read_back(struct scene_node *out, const struct layout *layout, const struct scene_wide_node *wide,
                      const void *bytes) {
  const struct trax_node_format *format = &trax_node_formats[layout->node_layout];
  struct scene_node stored;
  format->code->read(&stored, format, bytes);
  for (uint32_t i = 0; i < out->count; i++) {
    const struct scene_tree_node *leaf = &layout->tree->nodes[wide->child[i]];
    struct scene_box whole = scene_empty_box();
    for (uint32_t k = 0; k < leaf->triangle_count; k++) {
      const struct scene_box one = scene_triangle_box(layout->mesh, leaf->triangles[k]);
      scene_box_add_box(&whole, &one);
    }
    if (leaf->triangle_count)
      out->box[i] = scene_box_within(&stored.box[i], &whole);
  }
}

trax_scene_ref scene_place_wide_node(struct layout *layout, uint32_t number, struct scene_box *box) {
  const struct scene_wide_node *wide = &layout->wide->nodes[number];
  const bool leaves_first = layout->wide->leaves != NULL;
  struct scene_node out = {.count = wide->count};
  memcpy(out.slot, wide->slot, sizeof out.slot);
  for (uint32_t i = 0; i < wide->count; i++)
    if (!leaves_first || layout->tree->nodes[wide->child[i]].triangle_count)
      place_child(layout, &out, i, wide->child[i]);
  for (uint32_t i = 0; i < wide->count; i++)
    if (leaves_first && !layout->tree->nodes[wide->child[i]].triangle_count)
      place_child(layout, &out, i, wide->child[i]);
  const struct trax_node_format *format = &trax_node_formats[layout->node_layout];
  const uint32_t offset = layout->wide->position[number] * format->bytes;
  format->code->write(layout->nodes + offset, format, &out);
  if (format->code->box)
    read_back(&out, layout, wide, layout->nodes + offset);
  *box = scene_box_around(&out);
  return layout->nodes_offset + offset;
}
