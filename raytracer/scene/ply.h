/* Shared by ply_header.c, ply_values.c and ply_reader.c. */
#ifndef SCENE_PLY_H
#define SCENE_PLY_H

#include "internal.h"

enum format { ascii, little_endian, big_endian };

enum type { no_type, int8, uint8, int16, uint16, int32, uint32, float32, float64 };

static const unsigned char type_sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};

enum { max_elements = 32, max_properties = 256, max_name = 32 };

/* The use of a property. */
enum role {
  skipped,
  coordinate_x,
  coordinate_y,
  coordinate_z,
  normal_x,
  normal_y,
  normal_z,
  texture_u,
  texture_v,
  indices
};

enum { per_vertex = texture_v - coordinate_x + 1 }; /* the roles that are numbers of a vertex */

struct property {
  enum type list_count, type; /* list_count: no_type for a single value */
  enum role role;
};

struct element {
  char name[max_name];
  uint64_t count;
  unsigned first_property, property_count;
  bool is_vertex, is_strips;
};

struct ply_reader {
  const char *path;
  trax_error *error;
  struct trax_mesh *mesh;
  const unsigned char *start, *at, *end; /* *end is 0 */
  enum format format;
  struct element elements[max_elements];
  unsigned element_count;
  struct property properties[max_properties];
  unsigned property_count;
  const struct element *current; /* being read, its number, for messages */
  uint64_t current_number;
  uint32_t vertex_count; /* as declared */
  unsigned roles;        /* 1 << role: there is one */
  float (*normals)[3];   /* of the vertices; NULL: there are none */
  float (*uvs)[2];
  char texture[256]; /* "": none */
  unsigned unread;   /* as the report has it */
  uint32_t other_primitives;
  size_t triangle_capacity, normal_capacity, uv_capacity;
  uint32_t *list; /* the indices of one face or strip */
  size_t list_capacity;
  struct scene_polygon_work polygon_work;
};

static inline bool ply_is_space(unsigned char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Whether there are properties of all these roles. */
static inline bool ply_has_roles(unsigned roles, enum role first, enum role last) {
  for (enum role role = first; role <= last; role++)
    if (!(roles >> role & 1))
      return false;
  return true;
}

/* FILE:LINE: in text, FILE: ELEMENT NUMBER: in binary data. */
trax_status scene_ply_fail(const struct ply_reader *reader, const char *reason);

/* Reads the header: elements, properties and the texture's name. Moves to the first byte after it. Checks that there
   are vertices and faces, and that the file is long enough for them. */
trax_status scene_ply_header(struct ply_reader *reader);

/* The next value of the data, ASCII or binary. */
trax_status scene_ply_integer(struct ply_reader *reader, enum type type, int64_t *value);
trax_status scene_ply_real(struct ply_reader *reader, enum type type, float *value);
trax_status scene_ply_skip(struct ply_reader *reader, enum type type);

#endif
