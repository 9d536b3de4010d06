/* Stanford PLY, ASCII and binary of either byte order.

   Read: of "vertex" the coordinates x, y, z, the normal nx, ny, nz and the texture coordinates u, v or s, t; the
   polygons vertex_indices (or vertex_index) of "face" and the strips of "tristrips", in which -1 begins a new strip;
   the one texture that a comment names, as "comment TextureFile bunny.png". Everything else is skipped. */
#include "ply.h"

#include <stdlib.h>
#include <string.h>

static trax_status add_triangle(struct ply_reader *reader, uint32_t a, uint32_t b, uint32_t c) {
  struct trax_mesh *mesh = reader->mesh;
  if (!scene_grow(&mesh->triangles, sizeof *mesh->triangles, mesh->triangle_count, &reader->triangle_capacity))
    return scene_out_of_memory(reader->error, reader->path);
  const uint32_t number = mesh->triangle_count, vertices[3] = {a, b, c};
  mesh->triangles[number] = (struct trax_mesh_triangle){.vertices = {a, b, c}, .source_id = number};
  if ((reader->normals && !scene_reach(&mesh->normals, sizeof *mesh->normals, number + 1, &reader->normal_capacity)) ||
      (reader->uvs && !scene_reach(&mesh->uvs, sizeof *mesh->uvs, number + 1, &reader->uv_capacity)))
    return scene_out_of_memory(reader->error, reader->path);
  for (int corner = 0; corner < 3; corner++) {
    if (reader->normals)
      memcpy(mesh->normals[number][corner], reader->normals[vertices[corner]], sizeof *reader->normals);
    if (reader->uvs)
      memcpy(mesh->uvs[number][corner], reader->uvs[vertices[corner]], sizeof *reader->uvs);
  }
  mesh->triangle_count++;
  return TRAX_OK;
}

static trax_status add_face(struct ply_reader *reader, uint32_t count) {
  if (count < 3) { /* a point or a line, as some programs write them */
    reader->other_primitives++;
    return TRAX_OK;
  }
  const uint32_t *list = reader->list;
  if (count == 3)
    return add_triangle(reader, list[0], list[1], list[2]);
  const uint32_t(*triangles)[3];
  const char *problem = scene_cut_polygon(&reader->polygon_work, reader->mesh->vertices, list, count, &triangles);
  if (problem)
    return scene_ply_fail(reader, problem);
  trax_status result = TRAX_OK;
  for (uint32_t i = 0; i + 2 < count && result == TRAX_OK; i++)
    result = add_triangle(reader, list[triangles[i][0]], list[triangles[i][1]], list[triangles[i][2]]);
  return result;
}

enum { strip_break = UINT32_MAX };

/* Each vertex from the third on makes a triangle with the two before it, of alternating orientation. */
static trax_status add_strips(struct ply_reader *reader, uint32_t count) {
  trax_status result = TRAX_OK;
  uint32_t begin = 0;
  for (uint32_t i = 0; i < count && result == TRAX_OK; i++) {
    const uint32_t *last = &reader->list[i];
    if (*last == (uint32_t)strip_break)
      begin = i + 1;
    else if (i >= begin + 2)
      result = (i - begin) % 2 ? add_triangle(reader, last[-1], last[-2], last[0])
                               : add_triangle(reader, last[-2], last[-1], last[0]);
  }
  return result;
}

static trax_status read_indices(struct ply_reader *reader, const struct property *property, int64_t count) {
  const bool strips = reader->current->is_strips;
  trax_status result = TRAX_OK;
  for (int64_t i = 0; i < count && result == TRAX_OK; i++) {
    int64_t index;
    result = scene_ply_integer(reader, property->type, &index);
    if (result != TRAX_OK)
      break;
    if (!scene_grow(&reader->list, sizeof *reader->list, (uint32_t)i, &reader->list_capacity))
      return scene_out_of_memory(reader->error, reader->path);
    if (strips && index == -1)
      index = strip_break;
    else if (index < 0 || index >= reader->vertex_count) {
      char reason[128];
      snprintf(reason, sizeof reason, "vertex index %lld is out of range (%u vertices)", (long long)index,
               reader->vertex_count);
      return scene_ply_fail(reader, reason);
    }
    reader->list[i] = (uint32_t)index;
  }
  if (result != TRAX_OK)
    return result;
  if (reader->mesh->vertex_count != reader->vertex_count)
    return scene_ply_fail(reader, "faces before the vertices are not supported");
  return strips ? add_strips(reader, (uint32_t)count) : add_face(reader, (uint32_t)count);
}

static trax_status read_list(struct ply_reader *reader, const struct property *property) {
  int64_t count;
  trax_status result = scene_ply_integer(reader, property->list_count, &count);
  if (result != TRAX_OK)
    return result;
  /* Each value takes at least a byte, so a count beyond the file is refused before memory is allocated for it. */
  if (count < 0 || count > reader->end - reader->at)
    return scene_ply_fail(reader, count < 0 ? "a list's length is negative" : "a list is longer than the file");
  if (property->role == indices)
    return read_indices(reader, property, count);
  for (int64_t i = 0; i < count && result == TRAX_OK; i++)
    result = scene_ply_skip(reader, property->type);
  return result;
}

static void add_vertex(struct ply_reader *reader, const float values[per_vertex]) {
  const uint32_t number = reader->mesh->vertex_count++;
  memcpy(reader->mesh->vertices[number], values, sizeof *reader->mesh->vertices);
  if (reader->normals)
    memcpy(reader->normals[number], &values[normal_x - coordinate_x], sizeof *reader->normals);
  if (reader->uvs)
    memcpy(reader->uvs[number], &values[texture_u - coordinate_x], sizeof *reader->uvs);
}

/* Whether the element's records are as in most large files: vertices of binary32 numbers, or faces of nothing but a
   list of 32-bit integers with its length in a byte. */
static bool is_plain(const struct ply_reader *reader, const struct element *element) {
  const struct property *properties = &reader->properties[element->first_property];
  bool plain = reader->format == little_endian && !element->is_strips;
  for (unsigned i = 0; i < element->property_count; i++)
    plain =
        plain && (element->is_vertex ? !properties[i].list_count && properties[i].type == float32
                                     : element->property_count == 1 && properties[i].role == indices &&
                                           type_sizes[properties[i].list_count] == 1 && properties[i].type >= int32);
  return plain;
}

/* Reads a plain vertex, or a face if it is a triangle. All others, and those with an error, are left. */
static trax_status read_plain(struct ply_reader *reader, const struct element *element, bool *was_read) {
  const struct property *properties = &reader->properties[element->first_property];
  const size_t left = (size_t)(reader->end - reader->at);
  float values[per_vertex] = {0};
  uint32_t list[3];
  *was_read = false;
  if (element->is_vertex) {
    if (left < element->property_count * sizeof(float))
      return TRAX_OK;
    for (unsigned i = 0; i < element->property_count; i++, reader->at += sizeof(float))
      if (properties[i].role >= coordinate_x && properties[i].role <= texture_v)
        memcpy(&values[properties[i].role - coordinate_x], reader->at, sizeof(float));
    add_vertex(reader, values);
    *was_read = true;
    return TRAX_OK;
  }
  if (left < 1 + sizeof list || *reader->at != 3 || reader->mesh->vertex_count != reader->vertex_count)
    return TRAX_OK;
  memcpy(list, reader->at + 1, sizeof list);
  for (int i = 0; i < 3; i++)
    if (list[i] >= reader->vertex_count || list[i] > INT32_MAX)
      return TRAX_OK;
  reader->at += 1 + sizeof list;
  *was_read = true;
  return add_triangle(reader, list[0], list[1], list[2]);
}

static trax_status read_record(struct ply_reader *reader, const struct element *element) {
  float values[per_vertex] = {0}; /* by role, from coordinate_x */
  trax_status result = TRAX_OK;
  for (unsigned i = 0; i < element->property_count && result == TRAX_OK; i++) {
    const struct property *property = &reader->properties[element->first_property + i];
    if (property->list_count)
      result = read_list(reader, property);
    else if (property->role >= coordinate_x && property->role <= texture_v)
      result = scene_ply_real(reader, property->type, &values[property->role - coordinate_x]);
    else
      result = scene_ply_skip(reader, property->type);
  }
  if (result != TRAX_OK)
    return result;
  if (element->is_vertex)
    add_vertex(reader, values);
  if (reader->format == ascii) {
    while (*reader->at == ' ' || *reader->at == '\t')
      reader->at++;
    if (reader->at < reader->end && *reader->at != '\n' && *reader->at != '\r')
      return scene_ply_fail(reader, "more values than the header says");
  }
  return TRAX_OK;
}

static trax_status read_elements(struct ply_reader *reader) {
  for (unsigned e = 0; e < reader->element_count; e++) {
    const struct element *element = &reader->elements[e];
    if (element->property_count == 0)
      continue;
    reader->current = element;
    const bool plain = is_plain(reader, element);
    for (reader->current_number = 0; reader->current_number < element->count; reader->current_number++) {
      bool was_read = false;
      trax_status result = scene_is_interrupted(reader->polygon_work.interrupt) ? TRAX_INTERRUPTED : TRAX_OK;
      if (result == TRAX_OK && plain)
        result = read_plain(reader, element, &was_read);
      if (result == TRAX_OK && !was_read)
        result = read_record(reader, element);
      if (result != TRAX_OK)
        return result;
    }
  }
  return TRAX_OK;
}

/* Prepares the vertices' arrays, the one material and its texture. */
static trax_status prepare(struct ply_reader *reader, const struct trax_import_options *options,
                           struct trax_import_report *report) {
  struct trax_mesh *mesh = reader->mesh;
  const size_t count = (size_t)reader->vertex_count + 1;
  const bool normals = ply_has_roles(reader->roles, normal_x, normal_z),
             uvs = ply_has_roles(reader->roles, texture_u, texture_v);
  uint64_t faces = 0;
  for (unsigned e = 0; e < reader->element_count; e++)
    for (unsigned i = 0; i < reader->elements[e].property_count; i++)
      faces +=
          reader->properties[reader->elements[e].first_property + i].role == indices ? reader->elements[e].count : 0;
  mesh->vertices = malloc(count * sizeof *mesh->vertices);
  if (faces && faces <= UINT32_MAX && (mesh->triangles = malloc(faces * sizeof *mesh->triangles)))
    reader->triangle_capacity = faces;
  mesh->materials = calloc(1, sizeof *mesh->materials);
  if (normals)
    reader->normals = malloc(count * sizeof *reader->normals);
  if (uvs)
    reader->uvs = malloc(count * sizeof *reader->uvs);
  if (!mesh->vertices || !mesh->materials || (normals && !reader->normals) || (uvs && !reader->uvs))
    return scene_out_of_memory(reader->error, reader->path);
  mesh->materials[0].surface = trax_default_material;
  mesh->material_count = 1;
  if (!uvs || !reader->texture[0])
    return TRAX_OK;
  struct scene_textures textures = {.mesh = mesh, .options = options, .report = report};
  const struct scene_texture wanted = {.base = reader->texture}, *texture;
  trax_status result = scene_find_texture(&textures, &wanted, reader->path, &texture, reader->error);
  if (result == TRAX_OK && texture->good) {
    mesh->materials[0].surface.texture = texture->number;
    for (int channel = 0; channel < 3; channel++)
      mesh->materials[0].surface.diffuse[channel] = 1;
  }
  scene_textures_release(&textures);
  return result;
}

trax_status scene_read_ply(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                           struct trax_import_report *report, trax_error *error) {
  *mesh = (struct trax_mesh){0};
  struct scene_bytes file;
  trax_status result = scene_load_text(&file, path, scene_limits_of(options->unpack_limit), error);
  if (result != TRAX_OK)
    return result;
  struct ply_reader *reader = calloc(1, sizeof *reader);
  if (!reader) {
    free(file.data);
    return scene_out_of_memory(error, path);
  }
  reader->path = path;
  reader->error = error;
  reader->mesh = mesh;
  reader->polygon_work.interrupt = options->interrupt;
  reader->start = reader->at = file.data;
  reader->end = file.data + file.size;
  result = scene_ply_header(reader);
  if (result == TRAX_OK)
    result = prepare(reader, options, report);
  if (result == TRAX_OK)
    result = read_elements(reader);
  report->source_triangles += mesh->triangle_count;
  report->unread |= reader->unread;
  report->other_primitives += reader->other_primitives;
  free(reader->list);
  free(reader->normals);
  free(reader->uvs);
  scene_polygon_work_release(&reader->polygon_work);
  free(reader);
  free(file.data);
  if (result != TRAX_OK)
    trax_mesh_release(mesh);
  return result;
}
