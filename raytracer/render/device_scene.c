/* The scene as a specialised program reads it: the sections that its picture needs, and references as addresses. */
#include "render.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static uint32_t round_up(uint32_t bytes) {
  return (bytes + TRAX_SCENE_ALIGNMENT - 1) & ~(TRAX_SCENE_ALIGNMENT - 1);
}

/* The sections that features may read, in the order of trax_scene_build. References lead to nodes and triangles, and
   normals are at a fixed distance from triangles, so these must keep their places: they come first. The others are
   found by the section table. A file in another order is kept whole. */
static const enum trax_scene_section_kind kept[] = {TRAX_SCENE_NODES, TRAX_SCENE_TRIANGLES, TRAX_SCENE_NORMALS,
                                                    TRAX_SCENE_UVS,   TRAX_SCENE_TEXTURES,  TRAX_SCENE_TEXELS};
enum { KEPT = sizeof kept / sizeof *kept, KEPT_IN_PLACE = 3 };

static bool in_order(const struct trax_scene_header *header) {
  uint32_t end = sizeof *header;
  for (unsigned i = 0; i < KEPT_IN_PLACE; i++) {
    const struct trax_scene_section *section = &header->sections[kept[i]];
    if (section->count && section->offset != end)
      return false;
    end += round_up(section->size);
  }
  return true;
}

/* Adjusts the textures, which are in the header's new places already, to the new place of their texels. */
static void move_texels(unsigned char *bytes, const struct trax_scene_header *header, uint32_t from) {
  const struct trax_scene_section *section = &header->sections[TRAX_SCENE_TEXTURES];
  struct trax_texture *textures = (struct trax_texture *)(void *)(bytes + section->offset);
  for (uint32_t i = 0; i < section->count; i++)
    textures[i].texels += header->sections[TRAX_SCENE_TEXELS].offset - from;
}

trax_status trax_device_scene_init(struct trax_device_scene *scene, const struct trax_frame *frame, trax_error *error) {
  const uint32_t needed = trax_feature_sections(frame->params->features);
  const unsigned char *file = frame->scene->bytes;
  struct trax_scene_header header = *frame->scene->header;
  *scene = (struct trax_device_scene){.bytes = malloc(header.file_size)};
  if (!scene->bytes)
    return trax_fail(error, "out of memory for a scene of %u bytes", header.file_size);
  if (!in_order(&header)) {
    memcpy(scene->bytes, file, header.file_size);
    scene->size = header.file_size;
    return TRAX_OK;
  }
  uint32_t end = sizeof header;
  memset(header.sections, 0, sizeof header.sections);
  for (unsigned i = 0; i < KEPT; i++) {
    const struct trax_scene_section *section = &frame->scene->header->sections[kept[i]];
    if (!(needed >> kept[i] & 1) || section->count == 0)
      continue;
    const uint32_t rounded = round_up(section->size);
    memcpy(scene->bytes + end, file + section->offset, section->size);
    memset(scene->bytes + end + section->size, 0, rounded - section->size);
    header.sections[kept[i]] = *section;
    header.sections[kept[i]].offset = end;
    end += rounded;
  }
  move_texels(scene->bytes, &header, frame->scene->header->sections[TRAX_SCENE_TEXELS].offset);
  header.file_size = end;
  header.checksum = 0; /* the bytes are no scene file */
  memcpy(scene->bytes, &header, sizeof header);
  scene->size = end;
  return TRAX_OK;
}

void trax_device_scene_release(struct trax_device_scene *scene) {
  free(scene->bytes);
  *scene = (struct trax_device_scene){0};
}

void trax_scene_relocate(void *bytes, uint32_t address) {
  struct trax_scene_header *header = bytes;
  const struct trax_scene_section *section = &header->sections[TRAX_SCENE_NODES];
  const struct trax_node_format *format = &trax_node_formats[header->node_layout];
  unsigned char *node = (unsigned char *)bytes + section->offset;
  for (uint32_t i = 0; i < section->count; i++, node += format->bytes)
    format->code->relocate(node, format, address);
  if (header->version == TRAX_SCENE_VERSION_INSTANCES) {
    const struct trax_scene_more *more = (const struct trax_scene_more *)(header + 1);
    const struct trax_scene_section *instances = &more->sections[TRAX_SCENE_INSTANCES];
    struct trax_instance *instance = (struct trax_instance *)(void *)((unsigned char *)bytes + instances->offset);
    for (uint32_t i = 0; i < instances->count; i++)
      instance[i].root = trax_ref_at(instance[i].root, address);
  }
  const struct trax_scene_section *textures = &header->sections[TRAX_SCENE_TEXTURES];
  struct trax_texture *texture = (struct trax_texture *)(void *)((unsigned char *)bytes + textures->offset);
  for (uint32_t i = 0; i < textures->count; i++)
    texture[i].texels += address;
  if (header->root)
    header->root = trax_ref_at(header->root, address);
  header->base = address;
}
