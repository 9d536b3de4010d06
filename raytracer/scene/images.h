/* Pictures, and textures made of them. */
#ifndef TRAX_SCENE_IMAGES_H
#define TRAX_SCENE_IMAGES_H

#include "files.h"

/* --- image.c --- */

struct scene_image {
  uint32_t width, height;
  unsigned char *rgba; /* row by row from the top left; colours as sRGB, alpha linear */
};

/* PNG or JPEG of at most 2^26 pixels. */
trax_status scene_decode_image(struct scene_image *image, const struct scene_bytes *file, const char *name,
                               trax_error *error);
void scene_image_release(struct scene_image *image);

/* --- texture.c --- */

struct scene_texture {
  const char *base, *mask; /* names of images as the mesh file has them, or NULL; mask: where there are holes */
  uint32_t flags;          /* TRAX_TEXTURE_CLAMP */
  enum { SCENE_TEXTURE_COLOUR, SCENE_TEXTURE_DATA } use;
  bool mean_only; /* do not add it to the mesh */
  /* found */
  bool good;
  uint32_t number; /* in the mesh, from 1 */
  float mean[3];   /* linear, if it is a colour */
};

/* The textures of one mesh file. */
struct scene_textures {
  struct trax_mesh *mesh;
  const struct trax_import_options *options;
  struct trax_import_report *report;
  /* Sets the bytes of an image within the mesh file; false: it is a file of its own. NULL: there are none. */
  bool (*embedded)(void *context, const char *name, struct scene_bytes *file);
  void *context;
  struct scene_texture **known;
  uint32_t count;
  size_t capacity;
};

/* Finds a texture, or takes it from those found before. *found is valid until the release. It is not good if the image
   is missing or cannot be read, which the report notes. */
trax_status scene_find_texture(struct scene_textures *textures, const struct scene_texture *wanted,
                               const char *referrer, const struct scene_texture **found, trax_error *error);
/* Adds an image to the mesh as its last texture. */
trax_status scene_add_image(struct scene_textures *textures, const struct scene_image *image, uint32_t flags,
                            const char *name, trax_error *error);
void scene_textures_release(struct scene_textures *textures);

#endif
