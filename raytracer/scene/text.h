/* Lines and words of OBJ and MTL files. */
#ifndef TRAX_SCENE_TEXT_H
#define TRAX_SCENE_TEXT_H

#include "internal.h"

#include <stdlib.h>
#include <string.h>

static inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static inline char *skip_blanks(char *at) {
  while (is_blank(*at))
    at++;
  return at;
}

/* Cuts the next word off *rest; NULL at the end of the line or at a comment. */
static inline char *next_word(char **rest) {
  char *word = skip_blanks(*rest);
  if (!*word || *word == '#')
    return NULL;
  char *end = word;
  while (*end && !is_blank(*end))
    end++;
  if (*end)
    *end++ = 0;
  *rest = end;
  return word;
}

/* Returns the rest of the line without blanks around it: a name, which may have spaces and '#'. */
static inline char *remainder_of(char *rest) {
  rest = skip_blanks(rest);
  size_t length = strlen(rest);
  while (length > 0 && is_blank(rest[length - 1]))
    rest[--length] = 0;
  return rest;
}

/* Takes a logical line from *text, NUL-terminated in place, and returns how many physical ones it took; 0 at the end. A
   final backslash continues a line. */
static inline unsigned next_line(char **text, char **line) {
  char *from = *text, *to = *text;
  if (!*from)
    return 0;
  *line = to;
  unsigned lines = 1;
  for (; *from && *from != '\n'; from++) {
    if (*from == '\\' && (from[1] == '\n' || (from[1] == '\r' && from[2] == '\n'))) {
      from += from[1] == '\r' ? 2 : 1;
      *to++ = ' ';
      lines++;
      continue;
    }
    *to++ = *from;
  }
  *text = *from ? from + 1 : from;
  *to = 0;
  return lines;
}

static inline bool parse_float(const char *word, float *value) {
  char *end;
  *value = strtof(word, &end);
  return end != word && !*end;
}

/* Checks that a text file has no NUL; releases the bytes on failure. */
static inline trax_status check_text(struct scene_bytes *file, const char *path, trax_error *error) {
  if (!memchr(file->data, 0, file->size))
    return TRAX_OK;
  free(file->data);
  return trax_fail(error, "%s: not a mesh: binary data where text should be", path);
}

/* --- mtl_reader.c --- */

/* The mesh whose materials are found by name, and the room for them. */
struct scene_material_list {
  struct trax_mesh *mesh;
  size_t capacity;
};

enum { SCENE_NO_MATERIAL = UINT32_MAX };

uint32_t scene_find_material(const struct trax_mesh *mesh, const char *name);
/* SCENE_NO_MATERIAL when out of memory. */
uint32_t scene_add_material(struct scene_material_list *list, const char *name);

/* Adds a library's materials. Images that cannot be read are noted in textures->report. */
trax_status scene_read_mtl(struct scene_material_list *list, struct scene_textures *textures, const char *path,
                           trax_error *error);

#endif
