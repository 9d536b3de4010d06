/* Checks of a scene file that is read. Nothing in the file is trusted. After these checks, a traversal that follows its
   references stays inside the file, ends, and needs no more stack than the header says. */
#include "internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

struct checker {
  const char *name;
  trax_error *error;
  struct trax_scene view;
};

/* --- header and sections --- */

static const struct {
  const char *name;
  uint32_t record_size;
} section_kinds[TRAX_SCENE_SECTIONS + TRAX_SCENE_MORE_SECTIONS] = {
    [TRAX_SCENE_NODES] = {"nodes", 0}, /* as long as their layout says */
    [TRAX_SCENE_TRIANGLES] = {"triangles", sizeof(struct trax_triangle)},
    [TRAX_SCENE_MATERIALS] = {"materials", sizeof(struct trax_material)},
    [TRAX_SCENE_SOURCE_IDS] = {"source ids", sizeof(uint32_t)},
    [TRAX_SCENE_NORMALS] = {"normals", sizeof(struct trax_triangle_normals)},
    [TRAX_SCENE_UVS] = {"texture coordinates", sizeof(struct trax_triangle_uvs)},
    [TRAX_SCENE_TEXTURES] = {"textures", sizeof(struct trax_texture)},
    [TRAX_SCENE_TEXELS] = {"texels", sizeof(uint32_t)},
    [TRAX_SCENE_SECTIONS + TRAX_SCENE_INSTANCES] = {"instances", sizeof(struct trax_instance)},
    [TRAX_SCENE_SECTIONS + TRAX_SCENE_MESHES] = {"meshes", sizeof(struct trax_scene_mesh)},
};

static size_t header_bytes(const struct trax_scene_header *header) {
  return sizeof *header + (header->version == TRAX_SCENE_VERSION_INSTANCES ? sizeof(struct trax_scene_more) : 0);
}

static trax_status check_header(const struct checker *checker, const struct trax_scene_header *header, size_t size) {
  const char *name = checker->name;
  trax_error *error = checker->error;
  if (size < sizeof header->magic || header->magic != TRAX_SCENE_MAGIC)
    return trax_fail(error, "%s: not a scene file", name);
  if (size < sizeof *header)
    return trax_fail(error, "%s: cut off: %zu bytes, less than the header's %zu", name, size, sizeof *header);
  if (header->version != TRAX_SCENE_VERSION && header->version != TRAX_SCENE_VERSION_INSTANCES)
    return trax_fail(error, "%s: scene file version %u; this program reads version %u: import the meshes again", name,
                     header->version, TRAX_SCENE_VERSION);
  if (header->file_size != size)
    return trax_fail(error, "%s: %zu bytes, where its header says %u", name, size, header->file_size);
  struct trax_scene_header unsummed = *header;
  unsummed.checksum = 0;
  uint32_t sum = (uint32_t)crc32_z(0, (const unsigned char *)&unsummed, sizeof unsummed);
  sum = (uint32_t)crc32_z(sum, (const unsigned char *)(header + 1), size - sizeof *header);
  if (sum != header->checksum)
    return trax_fail(error, "%s: damaged: checksum %08x, where its header says %08x", name, sum, header->checksum);
  if (size < header_bytes(header))
    return trax_fail(error, "%s: cut off: %zu bytes, less than the header's %zu", name, size, header_bytes(header));
  if (header->file_size % TRAX_SCENE_ALIGNMENT != 0)
    return trax_fail(error, "%s: the size, %u bytes, is not a multiple of %u", name, header->file_size,
                     TRAX_SCENE_ALIGNMENT);
  if (header->base)
    return trax_fail(error, "%s: its references are addresses, for a device that has it at %08x", name, header->base);
  if (header->node_layout >= TRAX_NODE_LAYOUTS)
    return trax_fail(error, "%s: nodes of an unknown layout, %u: import the meshes again", name, header->node_layout);
  return TRAX_OK;
}

/* The sections of the header, and then those of a file with instances. */
enum { ALL_SECTIONS = TRAX_SCENE_SECTIONS + TRAX_SCENE_MORE_SECTIONS };

static struct trax_scene_section section_of(const struct trax_scene_header *header, unsigned kind) {
  if (kind < TRAX_SCENE_SECTIONS)
    return header->sections[kind];
  return header->version == TRAX_SCENE_VERSION_INSTANCES
             ? ((const struct trax_scene_more *)(header + 1))->sections[kind - TRAX_SCENE_SECTIONS]
             : (struct trax_scene_section){0};
}

static trax_status check_section(const struct checker *checker, const struct trax_scene_header *header, unsigned kind) {
  const struct trax_scene_section section = section_of(header, kind);
  if (section.offset == 0 && section.size == 0 && section.count == 0 && section.record_size == 0)
    return TRAX_OK;
  const char *what = section_kinds[kind].name;
  const uint32_t record_size =
      kind == TRAX_SCENE_NODES ? trax_node_formats[header->node_layout].bytes : section_kinds[kind].record_size;
  if (!what)
    return trax_fail(checker->error, "%s: a section of an unknown kind", checker->name);
  if (section.record_size != record_size)
    return trax_fail(checker->error, "%s: %s: records of %u bytes instead of %u", checker->name, what,
                     section.record_size, record_size);
  if (section.count == 0 || section.size != (uint64_t)section.count * section.record_size)
    return trax_fail(checker->error, "%s: %s: %u records do not make %u bytes", checker->name, what, section.count,
                     section.size);
  if (section.offset % TRAX_SCENE_ALIGNMENT != 0 || section.offset < header_bytes(header) ||
      (uint64_t)section.offset + section.size > header->file_size)
    return trax_fail(checker->error, "%s: %s: bytes %u to %llu are outside of the file's %u or not aligned",
                     checker->name, what, section.offset, (unsigned long long)section.offset + section.size,
                     header->file_size);
  for (unsigned other = 0; other < kind; other++) {
    const struct trax_scene_section before = section_of(header, other);
    if (before.count && section.offset < before.offset + before.size && before.offset < section.offset + section.size)
      return trax_fail(checker->error, "%s: the sections %s and %s overlap", checker->name, section_kinds[other].name,
                       what);
  }
  return TRAX_OK;
}

static trax_status check_sections(const struct checker *checker, const struct trax_scene_header *header) {
  for (unsigned kind = 0; kind < ALL_SECTIONS; kind++)
    if (check_section(checker, header, kind) != TRAX_OK)
      return TRAX_ERROR;
  uint32_t triangles = header->sections[TRAX_SCENE_TRIANGLES].count;
  uint32_t ids = header->sections[TRAX_SCENE_SOURCE_IDS].count;
  if (header->triangle_count != triangles)
    return trax_fail(checker->error, "%s: %u triangles, where its header says %u", checker->name, triangles,
                     header->triangle_count);
  if (ids && ids != triangles)
    return trax_fail(checker->error, "%s: %u source ids for %u triangles", checker->name, ids, triangles);
  /* The device finds what belongs to a triangle at a constant distance from it. */
  const struct trax_scene_section *before = &header->sections[TRAX_SCENE_TRIANGLES];
  static const enum trax_scene_section_kind beside[] = {TRAX_SCENE_NORMALS, TRAX_SCENE_UVS};
  for (unsigned i = 0; i < sizeof beside / sizeof *beside; i++) {
    const struct trax_scene_section *section = &header->sections[beside[i]];
    const char *what = section_kinds[beside[i]].name;
    if (section->count == 0)
      continue;
    if (section->count != triangles)
      return trax_fail(checker->error, "%s: %u %s for %u triangles", checker->name, section->count, what, triangles);
    if (section->offset !=
        (before->offset + before->size + TRAX_SCENE_ALIGNMENT - 1) / TRAX_SCENE_ALIGNMENT * TRAX_SCENE_ALIGNMENT)
      return trax_fail(checker->error, "%s: the %s are not right behind the %s", checker->name, what,
                       section_kinds[before - header->sections].name);
    before = section;
  }
  return TRAX_OK;
}

static const void *section_view(const struct trax_scene_header *header, unsigned kind) {
  const struct trax_scene_section section = section_of(header, kind);
  return section.count ? (const unsigned char *)header + section.offset : NULL;
}

/* --- contents --- */

static trax_status check_triangles(const struct checker *checker) {
  const struct trax_scene *view = &checker->view;
  for (uint32_t i = 0; i < view->triangle_count; i++) {
    const struct trax_triangle *triangle = &view->triangles[i];
    for (int axis = 0; axis < 3; axis++)
      if (!isfinite(triangle->v0[axis]) || !isfinite(triangle->v1[axis]) || !isfinite(triangle->v2[axis]))
        return trax_fail(checker->error, "%s: triangle %u: a coordinate is not finite", checker->name, i);
    if (triangle->material >= view->material_count)
      return trax_fail(checker->error, "%s: triangle %u: material %u is out of range (%u materials)", checker->name, i,
                       triangle->material, view->material_count);
  }
  for (uint32_t i = 0; view->normals && i < view->triangle_count; i++)
    for (int corner = 0; corner < 3; corner++) {
      const float *n = view->normals[i].corner[corner];
      const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
      if (!(square > 0.99f && square < 1.01f))
        return trax_fail(checker->error, "%s: triangle %u: a normal is not of length 1", checker->name, i);
    }
  for (uint32_t i = 0; view->uvs && i < view->triangle_count; i++)
    for (int k = 0; k < 6; k++)
      if (!(fabsf(view->uvs[i].corner[k / 2][k % 2]) <= TRAX_SCENE_MAX_UV))
        return trax_fail(checker->error, "%s: triangle %u: a texture coordinate is not within %g", checker->name, i,
                         (double)TRAX_SCENE_MAX_UV);
  return TRAX_OK;
}

static bool within(const float *values, unsigned count, float least, float most) {
  for (unsigned i = 0; i < count; i++)
    if (!(values[i] >= least && values[i] <= most))
      return false;
  return true;
}

static trax_status check_materials(const struct checker *checker) {
  const struct trax_scene *view = &checker->view;
  for (uint32_t i = 0; i < view->material_count; i++) {
    const struct trax_material *material = &view->materials[i];
    const char *wrong = NULL;
    if (!within(material->diffuse, 3, 0, 1) || !within(material->specular, 3, 0, 1))
      wrong = "a colour is not between 0 and 1";
    else if (!within(&material->roughness, 1, 0, 1) || !within(&material->opacity, 1, 0, 1) ||
             !within(&material->alpha_cutoff, 1, 0, 1))
      wrong = "roughness, opacity or the alpha cutoff is not between 0 and 1";
    else if (!within(material->emission, 3, 0, TRAX_SCENE_MAX_EMISSION))
      wrong = "the emission is out of range";
    else if (!within(&material->ior, 1, 1, TRAX_SCENE_MAX_IOR))
      wrong = "the index of refraction is out of range";
    else if (material->kind >= TRAX_MATERIAL_KINDS)
      wrong = "it is of an unknown kind";
    else if (material->texture > view->texture_count)
      wrong = "its texture is out of range";
    else if (material->reserved)
      wrong = "the reserved word is not zero";
    if (wrong)
      return trax_fail(checker->error, "%s: material %u: %s", checker->name, i, wrong);
  }
  return TRAX_OK;
}

/* Textures follow one another and have all texels among them. */
static trax_status check_textures(const struct checker *checker) {
  const struct trax_scene *view = &checker->view;
  const struct trax_scene_section *texels = &view->header->sections[TRAX_SCENE_TEXELS];
  uint64_t next = texels->offset;
  if (view->texture_count && !view->uvs && view->triangle_count)
    return trax_fail(checker->error, "%s: textures without texture coordinates", checker->name);
  for (uint32_t i = 0; i < view->texture_count; i++) {
    const struct trax_texture *texture = &view->textures[i];
    if (texture->log2_width > TRAX_TEXTURE_MAX_LOG2 || texture->log2_height > TRAX_TEXTURE_MAX_LOG2 ||
        texture->flags & ~(uint32_t)(TRAX_TEXTURE_ALPHA | TRAX_TEXTURE_CLAMP))
      return trax_fail(checker->error, "%s: texture %u: its size or its flags are out of range", checker->name, i);
    if (texture->texels != next)
      return trax_fail(checker->error, "%s: texture %u: its texels do not begin where those before it end",
                       checker->name, i);
    next += (uint64_t)sizeof(uint32_t) << (texture->log2_width + texture->log2_height);
    if (next > (uint64_t)texels->offset + texels->size)
      return trax_fail(checker->error, "%s: texture %u: its texels are beyond the last", checker->name, i);
  }
  if (next != (uint64_t)texels->offset + texels->size)
    return trax_fail(checker->error, "%s: texels of no texture", checker->name);
  return TRAX_OK;
}

trax_status trax_scene_check(struct trax_scene *scene, const void *bytes, size_t size, const char *name,
                             trax_error *error) {
  const struct trax_scene_header *header = bytes;
  struct checker checker = {.name = name, .error = error};
  trax_status result = check_header(&checker, header, size);
  if (result == TRAX_OK)
    result = check_sections(&checker, header);
  if (result != TRAX_OK)
    return result;
  const struct trax_scene_section *sections = header->sections;
  checker.view =
      (struct trax_scene){.size = size,
                          .header = header,
                          .nodes = section_view(header, TRAX_SCENE_NODES),
                          .triangles = section_view(header, TRAX_SCENE_TRIANGLES),
                          .normals = section_view(header, TRAX_SCENE_NORMALS),
                          .uvs = section_view(header, TRAX_SCENE_UVS),
                          .materials = section_view(header, TRAX_SCENE_MATERIALS),
                          .textures = section_view(header, TRAX_SCENE_TEXTURES),
                          .texels = section_view(header, TRAX_SCENE_TEXELS),
                          .source_ids = section_view(header, TRAX_SCENE_SOURCE_IDS),
                          .node_count = sections[TRAX_SCENE_NODES].count,
                          .triangle_count = sections[TRAX_SCENE_TRIANGLES].count,
                          .material_count = sections[TRAX_SCENE_MATERIALS].count,
                          .texture_count = sections[TRAX_SCENE_TEXTURES].count,
                          .texel_count = sections[TRAX_SCENE_TEXELS].count,
                          .grid = trax_scene_grid_of(header->bounds_min, header->bounds_max),
                          .instances = section_view(header, TRAX_SCENE_SECTIONS + TRAX_SCENE_INSTANCES),
                          .meshes = section_view(header, TRAX_SCENE_SECTIONS + TRAX_SCENE_MESHES),
                          .instance_count = section_of(header, TRAX_SCENE_SECTIONS + TRAX_SCENE_INSTANCES).count,
                          .mesh_count = section_of(header, TRAX_SCENE_SECTIONS + TRAX_SCENE_MESHES).count};
  if (header->version == TRAX_SCENE_VERSION_INSTANCES && !(checker.view.instances && checker.view.meshes))
    return trax_fail(error, "%s: a file with instances has none", name);
  if (checker.view.instances && checker.view.triangle_count == 0)
    return trax_fail(error, "%s: instances without triangles", name);
  result = check_triangles(&checker);
  if (result == TRAX_OK)
    result = check_materials(&checker);
  if (result == TRAX_OK)
    result = check_textures(&checker);
  if (result == TRAX_OK)
    result = scene_check_tree(&checker.view, name, error);
  if (result == TRAX_OK && scene)
    *scene = checker.view;
  return result;
}

trax_status trax_scene_read(struct trax_scene *scene, const char *path, size_t unpack_limit, trax_error *error) {
  *scene = (struct trax_scene){0};
  struct scene_bytes file;
  trax_status result = scene_load_file(&file, path, scene_limits_of(unpack_limit), error);
  if (result != TRAX_OK)
    return result;
  size_t room = (file.size + TRAX_SCENE_ALIGNMENT) / TRAX_SCENE_ALIGNMENT * TRAX_SCENE_ALIGNMENT;
  void *bytes = aligned_alloc(TRAX_SCENE_ALIGNMENT, room);
  if (!bytes)
    result = scene_out_of_memory(error, path);
  else {
    memcpy(bytes, file.data, file.size);
    result = trax_scene_check(scene, bytes, file.size, path, error);
  }
  free(file.data);
  if (result == TRAX_OK)
    scene->bytes = bytes;
  else
    free(bytes);
  return result;
}
