/* Images of textures: PNG by libpng, JPEG by libjpeg, from memory. They come from anywhere: sizes are limited before
   anything is allocated for them. */
#include "internal.h"

#include <jpeglib.h> /* after stdio.h, which internal.h includes */
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

enum { max_side = 16384, max_pixels = 1 << 26, max_scans = 500 };

void scene_image_release(struct scene_image *image) {
  free(image->rgba);
  *image = (struct scene_image){0};
}

static trax_status check_size(uint32_t width, uint32_t height, const char *name, trax_error *error) {
  if (width == 0 || height == 0 || width > max_side || height > max_side || (uint64_t)width * height > max_pixels)
    return trax_fail(error, "%s: an image of %u x %u; at most %u a side and %u in all are read", name, width, height,
                     (unsigned)max_side, (unsigned)max_pixels);
  return TRAX_OK;
}

static trax_status decode_png(struct scene_image *image, const struct scene_bytes *file, const char *name,
                              trax_error *error) {
  png_image png = {.version = PNG_IMAGE_VERSION};
  if (!png_image_begin_read_from_memory(&png, file->data, file->size))
    return trax_fail(error, "%s: not a readable PNG: %s", name, png.message);
  trax_status result = check_size(png.width, png.height, name, error);
  if (result == TRAX_OK && !(image->rgba = malloc((size_t)png.width * png.height * 4)))
    result = scene_out_of_memory(error, name);
  if (result == TRAX_OK) {
    image->width = png.width;
    image->height = png.height;
    png.format = PNG_FORMAT_RGBA;
    if (!png_image_finish_read(&png, NULL, image->rgba, 0, NULL))
      result = trax_fail(error, "%s: not a readable PNG: %s", name, png.message);
  }
  png_image_free(&png);
  return result;
}

/* libjpeg reports errors by a callback that must not return. */
struct jpeg_failure {
  struct jpeg_error_mgr manager; /* first: libjpeg knows this one only */
  jmp_buf place;
  char reason[JMSG_LENGTH_MAX];
};

static void jpeg_failed(j_common_ptr jpeg) {
  struct jpeg_failure *failure = (struct jpeg_failure *)(void *)jpeg->err;
  jpeg->err->format_message(jpeg, failure->reason);
  longjmp(failure->place, 1);
}

static void jpeg_warned(j_common_ptr jpeg, int level) {
  (void)jpeg, (void)level;
}

/* Limits the scans: a progressive image can have many scans of a few bytes, and each visits all pixels. */
static void count_scans(j_common_ptr jpeg) {
  if (((j_decompress_ptr)jpeg)->input_scan_number > max_scans) {
    struct jpeg_failure *failure = (struct jpeg_failure *)(void *)jpeg->err;
    snprintf(failure->reason, sizeof failure->reason, "more than %d scans", max_scans);
    longjmp(failure->place, 1);
  }
}

static trax_status decode_jpeg(struct scene_image *image, const struct scene_bytes *file, const char *name,
                               trax_error *error) {
  struct jpeg_decompress_struct jpeg;
  struct jpeg_failure failure;
  struct jpeg_progress_mgr progress = {.progress_monitor = count_scans};
  jpeg.err = jpeg_std_error(&failure.manager);
  failure.manager.error_exit = jpeg_failed;
  failure.manager.emit_message = jpeg_warned;
  if (setjmp(failure.place)) {
    jpeg_destroy_decompress(&jpeg);
    return trax_fail(error, "%s: not a readable JPEG: %s", name, failure.reason);
  }
  jpeg_create_decompress(&jpeg);
  jpeg.progress = &progress;
  jpeg_mem_src(&jpeg, file->data, file->size);
  jpeg_read_header(&jpeg, TRUE);
  trax_status result = check_size(jpeg.image_width, jpeg.image_height, name, error);
  if (result == TRAX_OK && jpeg.num_components != 1 && jpeg.num_components != 3)
    result = trax_fail(error, "%s: a JPEG of %d components; grey and colour are read", name, jpeg.num_components);
  if (result == TRAX_OK) {
    image->width = jpeg.image_width;
    image->height = jpeg.image_height;
    image->rgba = malloc((size_t)image->width * image->height * 4);
    if (!image->rgba)
      result = scene_out_of_memory(error, name);
  }
  if (result == TRAX_OK) {
    jpeg.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
      JSAMPROW row = image->rgba + (size_t)jpeg.output_scanline * image->width * 4;
      jpeg_read_scanlines(&jpeg, &row, 1);
    }
  }
  jpeg_destroy_decompress(&jpeg);
  return result;
}

trax_status scene_decode_image(struct scene_image *image, const struct scene_bytes *file, const char *name,
                               trax_error *error) {
  static const unsigned char png_magic[] = {0x89, 'P', 'N', 'G'}, jpeg_magic[] = {0xFF, 0xD8, 0xFF};
  *image = (struct scene_image){0};
  trax_status result;
  if (file->size > sizeof png_magic && !memcmp(file->data, png_magic, sizeof png_magic))
    result = decode_png(image, file, name, error);
  else if (file->size > sizeof jpeg_magic && !memcmp(file->data, jpeg_magic, sizeof jpeg_magic))
    result = decode_jpeg(image, file, name, error);
  else
    result = trax_fail(error, "%s: neither a PNG nor a JPEG", name);
  if (result != TRAX_OK)
    scene_image_release(image);
  return result;
}
