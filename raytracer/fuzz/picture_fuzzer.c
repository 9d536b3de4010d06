/* Pictures and textures under libFuzzer: PNG, PFM and EXR as trax-compare reads them, PNG and JPEG as the importer
   does. What is accepted as a picture of floats is written in both formats and reads back with the same bits. */
#include "fuzz_case.h"
#include "internal.h"
#include "radiance.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* tinyexr loses memory of some damaged files. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
  return "leak:libtinyexr\n";
}

static void read_back(const struct trax_picture *picture,
                      trax_status (*encode)(struct trax_bytes *, const struct trax_picture *, const char *,
                                            trax_error *)) {
  struct trax_bytes bytes;
  struct trax_picture again;
  trax_error error = {.message = ""};
  const size_t size = 3 * sizeof(float) * picture->width * picture->height;
  if (encode(&bytes, picture, "again", &error) != TRAX_OK ||
      trax_picture_decode(&again, bytes.data, bytes.size, "again", &error) != TRAX_OK) {
    fprintf(stderr, "what was written is refused: %s\n", error.message);
    abort();
  }
  if (again.width != picture->width || again.height != picture->height ||
      memcmp(again.radiance, picture->radiance, size) != 0) {
    fputs("read back as another picture\n", stderr);
    abort();
  }
  trax_picture_release(&again);
  free(bytes.data);
}

/* The texture of a mesh file whose only image this is. */
static void make_texture(const uint8_t *bytes, size_t size) {
  struct scene_image image;
  trax_error error = {.message = ""};
  if (scene_decode_image(&image, &(struct scene_bytes){(uint8_t *)bytes, size}, "image", &error) != TRAX_OK) {
    if (strncmp(error.message, "image: ", 7) != 0)
      abort();
    return;
  }
  if ((uint64_t)image.width * image.height <= 1 << 16) {
    struct trax_mesh mesh = {0};
    struct trax_import_report report = {0};
    const struct trax_import_options options = {.texture_size = 16u << size % 4};
    struct scene_textures textures = {.mesh = &mesh, .options = &options, .report = &report};
    if (scene_add_image(&textures, &image, size % 8 / 4 ? TRAX_TEXTURE_CLAMP : 0, "image", &error) != TRAX_OK ||
        mesh.texture_count != 1)
      abort();
    trax_mesh_release(&mesh);
  }
  scene_image_release(&image);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  struct trax_picture picture;
  trax_error error = {.message = ""};
  if (trax_picture_decode(&picture, bytes, size, "picture", &error) == TRAX_OK) {
    if (picture.radiance && (uint64_t)picture.width * picture.height <= 1 << 16) {
      read_back(&picture, trax_pfm_encode);
      read_back(&picture, trax_exr_encode);
    }
    trax_picture_release(&picture);
  } else if (!error.message[0])
    abort(); /* an error without a reason */
  make_texture(bytes, size);
  return 0;
}
