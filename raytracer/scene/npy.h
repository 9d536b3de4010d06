/* Arrays in numpy's file format, versions 1.0 to 3.0 (docs/own-tree.md). */
#ifndef TRAX_SCENE_NPY_H
#define TRAX_SCENE_NPY_H

#include "internal.h"

enum { SCENE_NPY_DIMENSIONS = 3 };

enum scene_npy_kind { SCENE_NPY_INTEGERS, SCENE_NPY_FLOATS };

struct scene_npy {
  const char *path;
  struct scene_bytes bytes; /* the file */
  const unsigned char *data;
  bool is_signed, is_float;
  unsigned item; /* bytes of an element: 4, or of an integer 8 */
  unsigned dimensions;
  uint64_t shape[SCENE_NPY_DIMENSIONS];
  uint64_t count; /* elements */
};

/* Reads an array of `kind`: <f4, or <i4, <i8, <u4 or <u8, in C's order. It has as many elements as its shape says. */
trax_status scene_npy_read(struct scene_npy *npy, const char *path, enum scene_npy_kind kind, trax_error *error);
void scene_npy_release(struct scene_npy *npy);

/* The element, if it is below `limit`; else `limit`. */
uint64_t scene_npy_integer(const struct scene_npy *npy, uint64_t index, uint64_t limit);
float scene_npy_float(const struct scene_npy *npy, uint64_t index);
/* The element as text, for messages. */
void scene_npy_print(const struct scene_npy *npy, uint64_t index, char text[24]);

#endif
