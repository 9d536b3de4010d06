/* Scene files under libFuzzer. The checksum of a case is corrected first, so that cases get past its check. The native
   twin renders accepted files, a few pixels with all features: it must neither leave the file nor hang. */
#include "fuzz_case.h"
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

static void seal(void *bytes, size_t size) {
  struct trax_scene_header *header = bytes;
  if (size < sizeof *header)
    return;
  header->checksum = 0;
  header->file_size = (uint32_t)size;
  header->checksum = (uint32_t)crc32_z(0, bytes, size);
}

static void render(struct trax_scene *scene, bool paths) {
  const struct trax_frame_options options = {.width = 4,
                                             .height = 3,
                                             .ambient = TRAX_DEFAULT_AMBIENT,
                                             .samples = 2,
                                             .shadows = true,
                                             .smooth = true,
                                             .floats = true,
                                             .paths = paths ? 4 : 0};
  struct trax_view view;
  struct trax_frame frame = {0};
  struct trax_picture picture = {0};
  struct trax_render_run run = {0};
  trax_error error;
  int exponent;
  trax_view_frame(&view, scene, (const float[]){0, 1, 0}, 0, 4 / 3.0f);
  if (trax_normalise(scene, &view, &exponent, &error) != TRAX_OK ||
      trax_frame_init(&frame, scene, &view, &options, &error) != TRAX_OK)
    return;
  if (trax_render_twin(&picture, &frame, 1, &run, &error) != TRAX_OK)
    abort();
  for (int i = 0; picture.radiance && i < 4 * 3 * 3; i++)
    if (!isfinite(picture.radiance[i]) || picture.radiance[i] < 0)
      abort();
  trax_picture_release(&picture);
  struct trax_device_scene device;
  if (trax_device_scene_init(&device, &frame, &error) != TRAX_OK)
    abort();
  trax_device_scene_release(&device);
  trax_frame_release(&frame);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  void *copy = NULL; /* of exactly this size, so that a sanitizer sees what is read beyond */
  if (posix_memalign(&copy, TRAX_SCENE_ALIGNMENT, size ? size : 1) != 0)
    abort();
  if (size)
    memcpy(copy, bytes, size);
  seal(copy, size);
  struct trax_scene scene;
  struct trax_scene_stats stats;
  trax_error error = {.message = ""};
  if (trax_scene_check(&scene, copy, size, "scene", &error) == TRAX_OK) {
    scene.bytes = copy;
    trax_scene_measure(&stats, &scene);
    render(&scene, bytes[size - 1] & 1);
  } else if (!error.message[0])
    abort(); /* an error without a reason */
  free(copy);
  return 0;
}

/* --- mutation: words, most of them where the structure is --- */

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t capacity, unsigned seed) {
  static const uint32_t steps[] = {1, 2, 4, 7, 8, 16, 40, 64, 128, 0x80000000u, 0x7F800000u, 0x00800000u};
  fuzz_random random = {seed + 1u};
  if (size < sizeof(struct trax_scene_header) || fuzz_below(&random, 8) == 0)
    return LLVMFuzzerMutate(bytes, size, capacity);
  for (uint32_t count = 1 + fuzz_below(&random, 3); count > 0; count--) {
    const size_t words = (fuzz_below(&random, 3) ? size : sizeof(struct trax_scene_header)) / 4;
    uint8_t *at = bytes + 4 * (size_t)fuzz_below(&random, (uint32_t)words);
    uint32_t word, step = steps[fuzz_below(&random, sizeof steps / sizeof *steps)];
    memcpy(&word, at, 4);
    switch (fuzz_below(&random, 5)) {
    case 0:
      word += step;
      break;
    case 1:
      word -= step;
      break;
    case 2:
      word ^= step;
      break;
    case 3: /* one of the file's elsewhere */
      memcpy(&word, bytes + 4 * (size_t)fuzz_below(&random, (uint32_t)(size / 4)), 4);
      break;
    default:
      word = step;
    }
    memcpy(at, &word, 4);
  }
  return size;
}
