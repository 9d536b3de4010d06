/* Pictures in memory and in files. */
#include "radiance.h"
#include "render.h"
#include "trax/input.h"
#include "trax/output.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

trax_status trax_picture_init(struct trax_picture *picture, uint32_t width, uint32_t height, trax_error *error) {
  picture->pixels = calloc((size_t)width * height, sizeof *picture->pixels);
  picture->radiance = NULL;
  picture->layers = NULL;
  if (!picture->pixels)
    return trax_fail(error, "out of memory for a picture of %u x %u", width, height);
  picture->width = width;
  picture->height = height;
  return TRAX_OK;
}

void trax_picture_release(struct trax_picture *picture) {
  free(picture->pixels);
  free(picture->radiance);
  free(picture->layers);
  memset(picture, 0, sizeof *picture);
}

/* Gamma 2, as the device has it. */
static uint32_t pixel_of(const float radiance[3]) {
  uint32_t pixel = 0xFF000000u;
  for (int channel = 0; channel < 3; channel++)
    pixel |= (uint32_t)(255 * sqrt(fmin(fmax((double)radiance[channel], 0), 1)) + 0.5) << 8 * channel;
  return pixel;
}

trax_status trax_picture_take(struct trax_picture *picture, const struct trax_frame *frame, const void *image,
                              trax_error *error) {
  const uint32_t bytes = trax_frame_image_bytes(frame);
  const size_t count = (size_t)frame->params->width * frame->params->height;
  if (trax_picture_init(picture, frame->params->width, frame->params->height, error) != TRAX_OK)
    return TRAX_ERROR;
  if (!(frame->params->features & TRAX_FEATURE_BIT(FLOATS))) {
    memcpy(picture->pixels, image, bytes);
    return TRAX_OK;
  }
  if (!(picture->radiance = malloc(bytes))) {
    trax_picture_release(picture);
    return trax_fail(error, "out of memory for a picture of %u x %u", frame->params->width, frame->params->height);
  }
  memcpy(picture->radiance, image, bytes);
  for (size_t i = 0; i < count; i++)
    picture->pixels[i] = pixel_of(picture->radiance + 3 * i);
  return TRAX_OK;
}

/* libpng reports errors by a callback that must not return. */
struct png_failure {
  jmp_buf place;
  char reason[256];
};

static void png_failed(png_structp png, png_const_charp message) {
  struct png_failure *failure = png_get_error_ptr(png);
  snprintf(failure->reason, sizeof failure->reason, "%s", message);
  longjmp(failure->place, 1);
}

static void png_warned(png_structp png, png_const_charp message) {
  (void)png;
  (void)message;
}

/* A failure is remembered by the file until the end, with its reason, which libpng does not tell. */
static void put_bytes(png_structp png, png_bytep bytes, size_t count) {
  fwrite(bytes, 1, count, png_get_io_ptr(png));
}

static void encode(png_structp png, png_infop info, FILE *file, const struct trax_picture *picture, png_bytep row) {
  png_set_write_fn(png, file, put_bytes, NULL);
  png_set_user_limits(png, TRAX_RENDER_MAX_SIDE, TRAX_RENDER_MAX_SIDE);
  png_set_IHDR(png, info, picture->width, picture->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_gAMA(png, info, 0.5);
  png_write_info(png, info);
  for (uint32_t y = 0; y < picture->height; y++) {
    const uint32_t *pixels = picture->pixels + (size_t)y * picture->width;
    for (uint32_t x = 0; x < picture->width; x++)
      for (int channel = 0; channel < 3; channel++)
        row[3 * x + channel] = (png_byte)(pixels[x] >> 8 * channel);
    png_write_row(png, row);
  }
  png_write_end(png, info);
}

/* A picture without linear floats gets those of its pixels. */
static trax_status write_floats(const struct trax_picture *picture, const char *path,
                                trax_status (*encode)(struct trax_bytes *, const struct trax_picture *, const char *,
                                                      trax_error *),
                                trax_error *error) {
  struct trax_picture made = *picture;
  struct trax_bytes bytes = {0};
  if (!picture->radiance) {
    const size_t count = (size_t)picture->width * picture->height;
    made.radiance = malloc(3 * count * sizeof *made.radiance);
    if (!made.radiance)
      return trax_fail(error, "out of memory for a picture of %u x %u", picture->width, picture->height);
    for (size_t i = 0; i < 3 * count; i++) {
      const float value = (float)(picture->pixels[i / 3] >> 8 * (i % 3) & 255) / 255;
      made.radiance[i] = value * value;
    }
  }
  trax_status status = encode(&bytes, &made, path, error);
  trax_output output;
  if (status == TRAX_OK)
    status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    fwrite(bytes.data, 1, bytes.size, output.file); /* a failure is remembered until the end */
    status = trax_output_commit(&output, error);
  }
  free(bytes.data);
  if (!picture->radiance)
    free(made.radiance);
  return status;
}

static bool ends_with(const char *path, const char *ending) {
  const size_t length = strlen(path), tail = strlen(ending);
  return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

bool trax_picture_is_float(const char *path) {
  return ends_with(path, ".pfm") || ends_with(path, ".exr");
}

trax_status trax_picture_write(const struct trax_picture *picture, const char *path, trax_error *error) {
  trax_output output;
  if (trax_picture_is_float(path))
    return write_floats(picture, path, ends_with(path, ".pfm") ? trax_pfm_encode : trax_exr_encode, error);
  trax_status status = trax_output_open(&output, path, error);
  if (status)
    return status;
  struct png_failure failure = {.reason = "out of memory"};
  png_bytep row = malloc((size_t)picture->width * 3);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, png_failed, png_warned);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  bool written = false;
  if (row && info && !setjmp(failure.place)) {
    encode(png, info, output.file, picture, row);
    written = true;
  }
  png_destroy_write_struct(&png, &info);
  free(row);
  if (written)
    return trax_output_commit(&output, error);
  trax_output_discard(&output);
  return trax_fail(error, "%s: cannot write the picture: %s", path, failure.reason);
}

struct source {
  const uint8_t *at, *end;
};

static void take_bytes(png_structp png, png_bytep to, size_t count) {
  struct source *source = png_get_io_ptr(png);
  if ((size_t)(source->end - source->at) < count)
    png_error(png, "cut off");
  memcpy(to, source->at, count);
  source->at += count;
}

/* A byte of a PNG unpacks to at most 1032. Pixels of a bit, of which a byte has eight, would take a gigabyte of memory
   for 32 kB. */
enum { PIXELS_OF_A_BYTE = 1032, MOST_BLANK = 1 << 24 };

/* The caller frees *pixels, also after a failure. */
static void decode(png_structp png, png_infop info, struct source *source, struct trax_picture *picture) {
  const size_t size = (size_t)(source->end - source->at);
  png_set_read_fn(png, source, take_bytes);
  png_set_user_limits(png, TRAX_RENDER_MAX_SIDE, TRAX_RENDER_MAX_SIDE);
  png_read_info(png, info);
  picture->width = png_get_image_width(png, info);
  picture->height = png_get_image_height(png, info);
  const uint64_t pixels = (uint64_t)picture->width * picture->height;
  if (pixels > MOST_BLANK && pixels / PIXELS_OF_A_BYTE > size)
    png_error(png, "its few bytes have too many pixels");
  png_set_expand(png);
  png_set_strip_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
  int passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  size_t row_bytes = (size_t)picture->width * 4;
  if (png_get_rowbytes(png, info) != row_bytes)
    png_error(png, "unexpected row size");
  picture->pixels = calloc(picture->height, row_bytes);
  if (!picture->pixels)
    png_error(png, "out of memory");
  for (int pass = 0; pass < passes; pass++)
    for (uint32_t y = 0; y < picture->height; y++)
      png_read_row(png, (png_bytep)(picture->pixels + (size_t)y * picture->width), NULL);
  png_read_end(png, NULL);
}

static trax_status decode_png(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                              trax_error *error) {
  struct source source = {bytes, bytes + size};
  struct png_failure failure = {.reason = "out of memory"};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, png_failed, png_warned);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  volatile bool read = false;
  if (info && !setjmp(failure.place)) {
    decode(png, info, &source, picture);
    read = true;
  }
  png_destroy_read_struct(&png, &info, NULL);
  return read ? TRAX_OK : trax_fail(error, "%s: not a readable PNG: %s", name, failure.reason);
}

trax_status trax_picture_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                                trax_error *error) {
  memset(picture, 0, sizeof *picture);
  trax_status status = trax_is_pfm(bytes, size)   ? trax_pfm_decode(picture, bytes, size, name, error)
                       : trax_is_exr(bytes, size) ? trax_exr_decode(picture, bytes, size, name, error)
                       : trax_is_hdr(bytes, size) ? trax_hdr_decode(picture, bytes, size, name, error)
                                                  : decode_png(picture, bytes, size, name, error);
  if (status == TRAX_OK && picture->radiance) {
    const size_t count = (size_t)picture->width * picture->height;
    picture->pixels = malloc(count * sizeof *picture->pixels);
    if (!picture->pixels)
      status = trax_fail(error, "out of memory for a picture of %u x %u", picture->width, picture->height);
    for (size_t i = 0; status == TRAX_OK && i < count; i++)
      picture->pixels[i] = pixel_of(picture->radiance + 3 * i);
  }
  if (status != TRAX_OK)
    trax_picture_release(picture);
  return status;
}

trax_status trax_picture_read(struct trax_picture *picture, const char *path, trax_error *error) {
  enum { max_size = 1 << 30 };
  uint8_t *bytes;
  size_t size;
  memset(picture, 0, sizeof *picture);
  if (trax_read_file(path, max_size, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_status status = trax_picture_decode(picture, bytes, size, path, error);
  free(bytes);
  return status;
}

/* The shown value, gamma 2. */
static double root_of(float value) {
  return copysign(sqrt(fabs((double)value)), (double)value);
}

/* The difference of roots in parts of 255; above white, relative to the brighter one. */
static double float_distance(float a, float b) {
  const double x = root_of(a), y = root_of(b);
  if (memcmp(&a, &b, sizeof a) == 0 || x == y)
    return 0;
  return isfinite(x) && isfinite(y) ? 255 * fabs(x - y) / fmax(1, fmax(fabs(x), fabs(y))) : INFINITY;
}

/* The mean is that of the channels that are numbers in both. */
static void compare_floats(struct trax_difference *difference, const struct trax_picture *a,
                           const struct trax_picture *b, unsigned within) {
  const size_t count = 3 * (size_t)a->width * a->height;
  double sum = 0, roots = 0, worst = 0;
  size_t finite = 0;
  for (size_t i = 0; i < count; i++) {
    worst = fmax(i % 3 ? worst : 0, float_distance(a->radiance[i], b->radiance[i]));
    difference->most = fmax(difference->most, worst);
    difference->floats_beyond += i % 3 == 2 && worst > within;
    const double delta = (double)a->radiance[i] - (double)b->radiance[i];
    if (!isfinite(delta)) {
      difference->not_finite++;
      continue;
    }
    const double root_delta = 255 * (root_of(a->radiance[i]) - root_of(b->radiance[i]));
    sum += delta * delta;
    roots += root_delta * root_delta;
    finite++;
  }
  difference->radiance_rmse = finite ? sqrt(sum / (double)finite) : 0;
  difference->root_rmse = finite ? sqrt(roots / (double)finite) : 0;
}

void trax_picture_compare(struct trax_difference *difference, const struct trax_picture *a,
                          const struct trax_picture *b, unsigned within) {
  memset(difference, 0, sizeof *difference);
  double sum = 0;
  for (uint32_t y = 0; y < a->height; y++)
    for (uint32_t x = 0; x < a->width; x++) {
      size_t i = (size_t)y * a->width + x;
      unsigned worst = 0;
      for (int shift = 0; shift < 32; shift += 8) {
        int delta = (int)(a->pixels[i] >> shift & 0xFF) - (int)(b->pixels[i] >> shift & 0xFF);
        unsigned size = (unsigned)abs(delta);
        if (shift < 24)
          sum += (double)delta * delta;
        worst = size > worst ? size : worst;
      }
      difference->pixels++;
      const bool same_floats = !a->radiance || !b->radiance ||
                               memcmp(a->radiance + 3 * i, b->radiance + 3 * i, 3 * sizeof *a->radiance) == 0;
      difference->unequal += worst > 0 || !same_floats;
      difference->beyond += worst > within;
      if (worst > difference->largest)
        difference->largest = worst, difference->x = x, difference->y = y;
    }
  difference->rmse = sqrt(sum / (3 * (double)a->width * a->height));
  difference->floats = a->radiance && b->radiance;
  if (difference->floats)
    compare_floats(difference, a, b, within);
}

double trax_picture_light(const struct trax_picture *picture) {
  double sum = 0;
  for (size_t i = 0; i < (size_t)picture->width * picture->height; i++)
    for (int channel = 0; channel < 3; channel++) {
      const double value = picture->pixels[i] >> 8 * channel & 255;
      sum += picture->radiance ? 65025 * (double)picture->radiance[3 * i + (size_t)channel] : value * value;
    }
  return sum / (3 * 65025.0 * picture->width * picture->height);
}

double trax_difference_percent(const struct trax_difference *difference) {
  return 100.0 * (double)(difference->pixels - difference->beyond) / (double)difference->pixels;
}

double trax_difference_floats_percent(const struct trax_difference *difference) {
  if (!difference->floats)
    return trax_difference_percent(difference);
  return 100.0 * (double)(difference->pixels - difference->floats_beyond) / (double)difference->pixels;
}
