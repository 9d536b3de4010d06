#include "environment.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 1 << TRAX_ENVIRONMENT_LOG2, TEXELS = SIDE * SIDE };

/* --- from the picture to texels --- */

/* Sine and cosine of a part of a whole turn, by additions and multiplications only, so that every host gives the same.
 */
static void turned(double part, double *sine, double *cosine) {
  part -= floor(part);
  const int quarter = (int)(4 * part);
  const double angle = (4 * part - quarter) * 1.57079632679489661923, square = angle * angle;
  double s = 0, c = 0;
  for (int i = 10; i >= 1; i--) {
    s = (1 + s) * -square / (2 * i * (2 * i + 1));
    c = (1 + c) * -square / (2 * i * (2 * i - 1));
  }
  s = angle * (1 + s), c = 1 + c;
  *sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
  *cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
}

static int place_of(double coordinate) {
  const int place = (int)((coordinate + 1) * 0.5 * SIDE);
  return place < 0 ? 0 : place >= SIDE ? SIDE - 1 : place;
}

static int texel_of(double x, double y, double z) {
  const double size = fabs(x) + fabs(y) + fabs(z);
  double u = x / size, v = z / size;
  if (y < 0) {
    const double across = copysign(1 - fabs(v), u);
    v = copysign(1 - fabs(u), v);
    u = across;
  }
  return place_of(v) * SIDE + place_of(u);
}

struct sums {
  double light[3], weight;
};

/* Adds each pixel's light to the texels that it covers, by solid angle. A pixel's parts miss no texel. */
static void spread(struct sums *sums, const struct trax_picture *picture, float strength, double turn) {
  const uint32_t width = picture->width, height = picture->height;
  const uint32_t down = (4 * SIDE + height - 1) / height, across = (8 * SIDE + width - 1) / width;
  for (uint32_t row = 0; row < height * down; row++) {
    double sine, cosine;
    turned((row + 0.5) / (2.0 * height * down), &sine, &cosine);
    for (uint32_t column = 0; column < width * across; column++) {
      double right, forwards;
      turned((column + 0.5) / ((double)width * across) - 0.5 + turn / 360, &right, &forwards);
      struct sums *sum = &sums[texel_of(sine * right, cosine, -sine * forwards)];
      const size_t pixel = (size_t)(row / down) * width + column / across;
      for (int channel = 0; channel < 3; channel++) {
        const double part = (picture->pixels[pixel] >> 8 * channel & 255) / 255.0;
        const double light = picture->radiance ? (double)picture->radiance[3 * pixel + (size_t)channel] : part * part;
        sum->light[channel] += sine * (double)strength * light;
      }
      sum->weight += sine;
    }
  }
}

static trax_status check(const struct trax_picture *picture, const char *name, trax_error *error) {
  for (size_t i = 0; picture->radiance && i < 3 * (size_t)picture->width * picture->height; i++)
    if (!(picture->radiance[i] >= 0 && isfinite(picture->radiance[i])))
      return trax_fail(error, "%s: the light of pixel (%zu, %zu) is %g", name, i / 3 % picture->width,
                       i / 3 / picture->width, (double)picture->radiance[i]);
  return TRAX_OK;
}

/* --- probabilities --- */

/* A texel's probability is in proportion to its luminance (Rec. 709) times its solid angle. */
static void choose(struct trax_environment *environment) {
  double total = 0;
  for (int i = 0; i < TEXELS; i++) {
    const double u = (i % SIDE + 0.5) * 2 / SIDE - 1, v = (i / SIDE + 0.5) * 2 / SIDE - 1;
    const bool folded = fabs(u) + fabs(v) > 1;
    const double x = folded ? 1 - fabs(v) : u, z = folded ? 1 - fabs(u) : v, y = 1 - fabs(u) - fabs(v);
    const double square = x * x + y * y + z * z;
    const float *light = environment->radiance[i];
    environment->probability[i] =
        (0.2126 * (double)light[0] + 0.7152 * (double)light[1] + 0.0722 * (double)light[2]) / (square * sqrt(square));
    total += environment->probability[i];
  }
  for (int i = 0; i < TEXELS && total > 0; i++)
    environment->probability[i] /= total;
}

/* Each texel keeps a part of its share of the draws and gives the rest to another one. */
static trax_status make_aliases(struct trax_environment *environment, trax_error *error) {
  double *left = malloc(TEXELS * sizeof *left);
  uint32_t *few = malloc(TEXELS * sizeof *few), *many = malloc(TEXELS * sizeof *many);
  uint32_t few_count = 0, many_count = 0;
  if (!left || !few || !many) {
    free(left), free(few), free(many);
    return trax_fail(error, "out of memory for an environment");
  }
  for (uint32_t i = 0; i < TEXELS; i++) {
    left[i] = environment->probability[i] * TEXELS;
    environment->aliases[i] = (struct trax_environment_alias){UINT32_MAX, i};
    if (left[i] < 1)
      few[few_count++] = i;
    else
      many[many_count++] = i;
  }
  while (few_count && many_count) {
    const uint32_t poor = few[--few_count], rich = many[many_count - 1];
    environment->aliases[poor] = (struct trax_environment_alias){(uint32_t)(left[poor] * 0x1p32), rich};
    left[rich] -= 1 - left[poor];
    if (left[rich] < 1) {
      many_count--;
      few[few_count++] = rich;
    }
  }
  free(left), free(few), free(many);
  return TRAX_OK;
}

static trax_status make_texels(struct trax_environment *environment, const struct trax_picture *picture, float strength,
                               double turn, trax_error *error) {
  *environment = (struct trax_environment){.radiance = calloc(TEXELS, sizeof *environment->radiance),
                                           .probability = calloc(TEXELS, sizeof *environment->probability),
                                           .aliases = calloc(TEXELS, sizeof *environment->aliases)};
  struct sums *sums = calloc(TEXELS, sizeof *sums);
  trax_status status = environment->radiance && environment->probability && environment->aliases && sums
                           ? TRAX_OK
                           : trax_fail(error, "out of memory for an environment");
  if (status == TRAX_OK) {
    spread(sums, picture, strength, turn);
    for (int i = 0; i < TEXELS; i++)
      for (int channel = 0; channel < 3; channel++)
        environment->radiance[i][channel] =
            (float)fmin(sums[i].light[channel] / fmax(sums[i].weight, 0x1p-1000), TRAX_MAX_RADIANCE);
    choose(environment);
    status = make_aliases(environment, error);
  }
  free(sums);
  return status;
}

trax_status trax_environment_read(struct trax_environment *environment, const char *path, float strength, double turn,
                                  trax_error *error) {
  struct trax_picture picture;
  *environment = (struct trax_environment){0};
  trax_status status = trax_picture_read(&picture, path, error);
  if (status == TRAX_OK)
    status = check(&picture, path, error);
  if (status == TRAX_OK)
    status = make_texels(environment, &picture, strength, turn, error);
  trax_picture_release(&picture);
  return status;
}

void trax_environment_release(struct trax_environment *environment) {
  free(environment->radiance);
  free(environment->probability);
  free(environment->aliases);
  *environment = (struct trax_environment){0};
}
