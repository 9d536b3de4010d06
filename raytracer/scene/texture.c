/* Converts images to the textures of a scene file: sides are powers of two, with gamma 2. Images are resampled in
   linear light by a tent filter as wide as the coarser of the two grids. Correctly rounded operations give the same
   bytes everywhere. */
#include "internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- light --- */

/* x^(1/5) for x in (0, 1], by Newton's method. */
static double fifth_root(double x) {
  double root = 1;
  for (int i = 0; i < 60; i++)
    root = (4 * root + x / (root * root * root * root)) / 5;
  return root;
}

/* sRGB (IEC 61966-2-1), 0 to 255, in linear light. */
static const float *linear_table(void) {
  static float table[256];
  static bool made;
  for (int i = 0; !made && i < 256; i++) {
    double value = i / 255.0, base = (value + 0.055) / 1.055;
    table[i] = (float)(value <= 0.04045 ? value / 12.92 : base * base * fifth_root(base * base));
  }
  made = true;
  return table;
}

static uint32_t encode_colour(float linear) {
  return (uint32_t)(255 * sqrtf(scene_clamp_colour(linear)) + 0.5f);
}

/* --- resampling --- */

struct axis {
  uint32_t from, to; /* lengths */
  bool clamp;        /* the image ends at its edge, else it repeats */
};

/* The first source texel for the target texel `at`, and their number. */
static uint32_t taps(const struct axis *axis, uint32_t at, double *middle, double *radius, int64_t *first) {
  if (axis->from == axis->to) {
    *middle = at + 0.5, *radius = 1, *first = at;
    return 1;
  }
  const double scale = (double)axis->from / axis->to;
  *middle = (at + 0.5) * scale;
  *radius = scale > 1 ? scale : 1;
  *first = (int64_t)floor(*middle - *radius);
  return (uint32_t)((int64_t)ceil(*middle + *radius) - *first);
}

static float weight_of(double middle, double radius, int64_t tap) {
  double weight = 1 - fabs((double)tap + 0.5 - middle) / radius;
  return weight > 0 ? (float)weight : 0;
}

static uint32_t source_of(const struct axis *axis, int64_t tap) {
  if (axis->clamp)
    return tap < 0 ? 0 : tap >= axis->from ? axis->from - 1 : (uint32_t)tap;
  int64_t rest = tap % axis->from;
  return (uint32_t)(rest < 0 ? rest + axis->from : rest);
}

/* R, G and B times alpha, alpha, and R, G and B alone for completely transparent texels. */
enum { CHANNELS = 7 };

/* The shares of the image's texels in those of a row. */
struct shares {
  uint32_t *firsts; /* index of each texel into the following, with an end behind the last one */
  struct share {
    uint32_t source;
    float weight;
  } *shares;
};

static bool list_shares(struct shares *shares, const struct axis *axis) {
  double middle, radius;
  int64_t first;
  size_t count = 0;
  for (uint32_t at = 0; at < axis->to; at++)
    count += taps(axis, at, &middle, &radius, &first);
  shares->firsts = malloc(((size_t)axis->to + 1) * sizeof *shares->firsts);
  shares->shares = malloc(count * sizeof *shares->shares);
  if (!shares->firsts || !shares->shares)
    return false;
  uint32_t made = 0;
  for (uint32_t at = 0; at < axis->to; at++) {
    const uint32_t number = taps(axis, at, &middle, &radius, &first);
    shares->firsts[at] = made;
    for (uint32_t i = 0; i < number; i++) {
      const float weight = weight_of(middle, radius, first + i);
      if (weight > 0)
        shares->shares[made++] = (struct share){source_of(axis, first + i), weight};
    }
  }
  shares->firsts[axis->to] = made;
  return true;
}

static void add_row(float *sums, const struct scene_image *image, uint32_t y, const struct shares *across,
                    uint32_t width, float weight) {
  const float *linear = linear_table();
  const unsigned char *row = image->rgba + (size_t)y * image->width * 4;
  for (uint32_t x = 0; x < width; x++) {
    float total = 0, sum[CHANNELS] = {0};
    for (uint32_t i = across->firsts[x]; i < across->firsts[x + 1]; i++) {
      const float share = across->shares[i].weight;
      const unsigned char *texel = row + 4 * (size_t)across->shares[i].source;
      const float alpha = (float)texel[3] / 255;
      total += share;
      sum[3] += share * alpha;
      for (int channel = 0; channel < 3; channel++) {
        sum[channel] += share * (alpha * linear[texel[channel]]);
        sum[4 + channel] += share * linear[texel[channel]];
      }
    }
    for (int channel = 0; channel < CHANNELS; channel++)
      sums[CHANNELS * (size_t)x + (unsigned)channel] += weight * (sum[channel] / total);
  }
}

static uint32_t texel_of(const float *sums, float total) {
  const float alpha = sums[3] / total;
  uint32_t texel = (uint32_t)(255 * scene_clamp_colour(alpha) + 0.5f) << 24;
  for (int channel = 0; channel < 3; channel++)
    texel |= encode_colour(sums[3] > 0 ? sums[channel] / sums[3] : sums[4 + channel] / total) << 8 * channel;
  return texel;
}

/* The first row of an image is the uppermost, that of a texture the lowest, at v = 0. */
static bool resample(uint32_t *texels, uint32_t width, uint32_t height, const struct scene_image *image, bool clamp) {
  const struct axis across = {image->width, width, clamp}, down = {image->height, height, clamp};
  struct shares shares = {0};
  float *sums = malloc(CHANNELS * (size_t)width * sizeof *sums);
  const bool good = sums && list_shares(&shares, &across);
  for (uint32_t y = 0; good && y < height; y++) {
    double middle, radius;
    int64_t first;
    uint32_t count = taps(&down, y, &middle, &radius, &first);
    float total = 0;
    memset(sums, 0, CHANNELS * (size_t)width * sizeof *sums);
    for (uint32_t i = 0; i < count; i++) {
      float weight = weight_of(middle, radius, first + i);
      if (weight == 0)
        continue;
      total += weight;
      add_row(sums, image, source_of(&down, first + i), &shares, width, weight);
    }
    for (uint32_t x = 0; x < width; x++)
      texels[(size_t)(height - 1 - y) * width + x] = texel_of(sums + CHANNELS * (size_t)x, total);
  }
  free(sums);
  free(shares.firsts);
  free(shares.shares);
  return good;
}

/* The power of two that is nearest: 4/3 of the side or more is rounded up. */
static uint32_t log2_side(uint32_t side, uint32_t most) {
  uint32_t result = 0;
  while (result < TRAX_TEXTURE_MAX_LOG2 && (2u << result) <= most && 4 * ((uint64_t)1 << result) < 3 * (uint64_t)side)
    result++;
  return result;
}

trax_status scene_add_image(struct scene_textures *textures, const struct scene_image *image, uint32_t flags,
                            const char *name, trax_error *error) {
  struct trax_mesh *mesh = textures->mesh;
  const uint32_t most = textures->options->texture_size ? textures->options->texture_size : 1u << TRAX_TEXTURE_MAX_LOG2;
  struct trax_mesh_texture texture = {mesh->texel_count, log2_side(image->width, most), log2_side(image->height, most),
                                      flags};
  const uint32_t width = 1u << texture.log2_width, height = 1u << texture.log2_height, count = width * height;
  const uint64_t bytes = ((uint64_t)mesh->texel_count + count) * sizeof *mesh->texels;
  if (bytes > UINT32_MAX || bytes > scene_memory_for(scene_bytes_read()))
    return trax_fail(error, "%s: the textures together are too large; --texture-size makes them smaller", name);
  void *grown = realloc(mesh->texels, ((size_t)mesh->texel_count + count) * sizeof *mesh->texels);
  if (!grown)
    return scene_out_of_memory(error, name);
  mesh->texels = grown;
  grown = realloc(mesh->textures, (mesh->texture_count + (size_t)1) * sizeof *mesh->textures);
  if (!grown)
    return scene_out_of_memory(error, name);
  mesh->textures = grown;
  uint32_t *texels = mesh->texels + mesh->texel_count;
  if (!resample(texels, width, height, image, flags & TRAX_TEXTURE_CLAMP))
    return scene_out_of_memory(error, name);
  for (uint32_t i = 0; i < count && !(texture.flags & TRAX_TEXTURE_ALPHA); i++)
    if (texels[i] >> 24 != 255)
      texture.flags |= TRAX_TEXTURE_ALPHA;
  mesh->textures[mesh->texture_count++] = texture;
  mesh->texel_count += count;
  return TRAX_OK;
}

/* --- the files of one mesh --- */

/* Loads an image. A missing or damaged one is noted, and *good is false. */
static trax_status load_image(const struct scene_textures *textures, struct scene_image *image, const char *referrer,
                              const char *name, bool *good, trax_error *error) {
  *good = false;
  struct scene_bytes file, embedded;
  struct trax_import_report *report = textures->report;
  if (textures->embedded && textures->embedded(textures->context, name, &embedded)) {
    trax_error reason;
    *good = scene_decode_image(image, &embedded, name, &reason) == TRAX_OK;
    if (!*good && report->bad_images++ == 0)
      snprintf(report->first_bad_image, sizeof report->first_bad_image, "%s: %.180s", referrer, reason.message);
    return TRAX_OK;
  }
  char *path = scene_referred_path(referrer, name);
  if (!path)
    return scene_out_of_memory(error, name);
  trax_error reason;
  trax_status result = TRAX_OK;
  if (scene_load_referred(&file, path, scene_limits_of(textures->options->unpack_limit)) != TRAX_OK) {
    if (report->missing_files++ == 0)
      snprintf(report->first_missing_file, sizeof report->first_missing_file, "%s", path);
  } else {
    result = trax_files_check_input(textures->options->files, path, error);
    *good = result == TRAX_OK && scene_decode_image(image, &file, path, &reason) == TRAX_OK;
    if (result == TRAX_OK && !*good && report->bad_images++ == 0)
      snprintf(report->first_bad_image, sizeof report->first_bad_image, "%.255s", reason.message);
    free(file.data);
  }
  free(path);
  return result;
}

static bool has_alpha(const struct scene_image *image) {
  const size_t count = (size_t)image->width * image->height;
  for (size_t i = 0; i < count; i++)
    if (image->rgba[4 * i + 3] < 255)
      return true;
  return false;
}

/* Takes the image's alpha from the mask: its alpha or, if the mask is opaque everywhere, its brightest channel. If
   sizes differ, the nearest texel counts. */
static void apply_mask(struct scene_image *image, const struct scene_image *mask) {
  const bool alpha = has_alpha(mask);
  for (uint32_t y = 0; y < image->height; y++)
    for (uint32_t x = 0; x < image->width; x++) {
      const unsigned char *from = mask->rgba + 4 * ((size_t)((uint64_t)y * mask->height / image->height) * mask->width +
                                                    (uint64_t)x * mask->width / image->width);
      unsigned char value = from[0] > from[1] ? from[0] : from[1];
      value = from[2] > value ? from[2] : value;
      image->rgba[4 * ((size_t)y * image->width + x) + 3] = alpha ? from[3] : value;
    }
}

static bool same_name(const char *a, const char *b) {
  return a && b ? !strcmp(a, b) : a == b;
}

static void mean_of(float mean[3], const struct scene_image *image, bool encoded) {
  const float *linear = linear_table();
  double sums[3] = {0};
  const size_t count = (size_t)image->width * image->height;
  for (size_t i = 0; i < count; i++)
    for (int channel = 0; channel < 3; channel++)
      sums[channel] +=
          encoded ? linear[image->rgba[4 * i + (unsigned)channel]] : image->rgba[4 * i + (unsigned)channel] / 255.0;
  for (int channel = 0; channel < 3; channel++)
    mean[channel] = (float)(sums[channel] / (double)count);
}

static trax_status make(struct scene_textures *textures, struct scene_texture *texture, const char *referrer,
                        trax_error *error) {
  struct scene_image image = {0}, mask = {0};
  bool good = false, masked = false;
  trax_status result = TRAX_OK;
  if (texture->base)
    result = load_image(textures, &image, referrer, texture->base, &good, error);
  if (result == TRAX_OK && texture->mask)
    result = load_image(textures, &mask, referrer, texture->mask, &masked, error);
  if (result == TRAX_OK && masked && !good) { /* white with holes */
    image = (struct scene_image){mask.width, mask.height, malloc((size_t)mask.width * mask.height * 4)};
    if (image.rgba)
      memset(image.rgba, 255, (size_t)mask.width * mask.height * 4);
    else
      result = scene_out_of_memory(error, texture->mask);
    good = true;
  }
  if (result == TRAX_OK && masked)
    apply_mask(&image, &mask);
  if (result == TRAX_OK && good) {
    texture->good = true;
    mean_of(texture->mean, &image, texture->use == SCENE_TEXTURE_COLOUR);
    if (texture->use == SCENE_TEXTURE_COLOUR && !texture->mean_only)
      result = scene_add_image(textures, &image, texture->flags, referrer, error);
    if (result == TRAX_OK && texture->use == SCENE_TEXTURE_COLOUR && !texture->mean_only)
      texture->number = textures->mesh->texture_count;
  }
  scene_image_release(&image);
  scene_image_release(&mask);
  return result;
}

trax_status scene_find_texture(struct scene_textures *textures, const struct scene_texture *wanted,
                               const char *referrer, const struct scene_texture **found, trax_error *error) {
  static const struct scene_texture none;
  *found = &none;
  if (textures->options->no_textures || (!wanted->base && !wanted->mask))
    return TRAX_OK;
  for (uint32_t i = 0; i < textures->count; i++) {
    const struct scene_texture *known = textures->known[i];
    if (same_name(known->base, wanted->base) && same_name(known->mask, wanted->mask) && known->flags == wanted->flags &&
        known->use == wanted->use && known->mean_only == wanted->mean_only) {
      *found = known;
      return TRAX_OK;
    }
  }
  struct scene_texture *texture = calloc(1, sizeof *texture);
  if (!texture || !scene_grow(&textures->known, sizeof *textures->known, textures->count, &textures->capacity)) {
    free(texture);
    return scene_out_of_memory(error, referrer);
  }
  *texture = *wanted;
  texture->base = wanted->base ? strdup(wanted->base) : NULL;
  texture->mask = wanted->mask ? strdup(wanted->mask) : NULL;
  textures->known[textures->count++] = texture;
  if ((wanted->base && !texture->base) || (wanted->mask && !texture->mask))
    return scene_out_of_memory(error, referrer);
  *found = texture;
  return make(textures, texture, referrer, error);
}

void scene_textures_release(struct scene_textures *textures) {
  for (uint32_t i = 0; i < textures->count; i++) {
    free((char *)textures->known[i]->base);
    free((char *)textures->known[i]->mask);
    free(textures->known[i]);
  }
  free(textures->known);
  textures->known = NULL;
  textures->count = 0;
}
