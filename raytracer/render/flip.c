/* FLIP, from the paper that metrics.h names; section numbers are the paper's. */
#include "metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PIXELS_PER_DEGREE (0.7 * 3840 / 0.7 * (PI / 180))
#define PI 3.14159265358979323846
enum { MOST_RADIUS = 10, MOST_TAPS = 2 * MOST_RADIUS + 1 };

/* --- colour spaces --- */

/* Linear sRGB to XYZ and back, as the authors' published program has it: the white point's last digits are a choice.
   The rows' sums are the white. */
static const double to_xyz[3][3] = {{0.412386563252992, 0.357591490920625, 0.180450491203564},
                                    {0.212636821677324, 0.715182981841251, 0.072180196481425},
                                    {0.019330620152484, 0.119197163640208, 0.950372587005435}};
static const double from_xyz[3][3] = {{3.241003232976359, -1.537398969488786, -0.498615881996363},
                                      {-0.969224252202517, 1.875929983695176, 0.041554226340085},
                                      {0.055639419851975, -0.204011206123910, 1.057148977187534}};

static double white(int i) {
  return to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
}

static void multiply(double out[3], const double matrix[3][3], const double in[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = matrix[i][0] * in[0] + matrix[i][1] * in[1] + matrix[i][2] * in[2];
}

/* A linear space of opponent colours: luminance, red against green, blue against yellow. */
static void ycxcz_of(double ycxcz[3], const double rgb[3]) {
  double xyz[3];
  multiply(xyz, to_xyz, rgb);
  const double x = xyz[0] / white(0), y = xyz[1] / white(1), z = xyz[2] / white(2);
  ycxcz[0] = 116 * y - 16, ycxcz[1] = 500 * (x - y), ycxcz[2] = 200 * (y - z);
}

static void rgb_of(double rgb[3], const double ycxcz[3]) {
  const double y = (ycxcz[0] + 16) / 116;
  const double xyz[3] = {(y + ycxcz[1] / 500) * white(0), y * white(1), (y - ycxcz[2] / 200) * white(2)};
  multiply(rgb, from_xyz, xyz);
}

static double lab_curve(double t) {
  const double delta = 6.0 / 29;
  return t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/* CIELAB with colours that fade in the dark, after Hunt. */
static void lab_of(double lab[3], const double rgb[3]) {
  double xyz[3];
  multiply(xyz, to_xyz, rgb);
  const double x = lab_curve(xyz[0] / white(0)), y = lab_curve(xyz[1] / white(1)), z = lab_curve(xyz[2] / white(2));
  lab[0] = 116 * y - 16;
  lab[1] = 0.01 * lab[0] * 500 * (x - y);
  lab[2] = 0.01 * lab[0] * 200 * (y - z);
}

static double hyab(const double a[3], const double b[3]) {
  return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

/* --- filters --- */

struct kernel {
  int radius;
  double taps[MOST_TAPS];
};

struct plane {
  uint32_t width, height;
  double *values; /* [height][width] */
};

/* The border's values stand for what is beyond it. */
static void convolve_rows(struct plane *out, const struct plane *in, const struct kernel *kernel) {
  for (uint32_t y = 0; y < in->height; y++)
    for (uint32_t x = 0; x < in->width; x++) {
      double sum = 0;
      for (int i = -kernel->radius; i <= kernel->radius; i++) {
        const int64_t at = (int64_t)x + i, last = in->width - 1;
        sum += kernel->taps[i + kernel->radius] * in->values[(size_t)y * in->width + (size_t)(at < 0      ? 0
                                                                                              : at > last ? last
                                                                                                          : at)];
      }
      out->values[(size_t)y * in->width + x] = sum;
    }
}

static void convolve_columns(struct plane *out, const struct plane *in, const struct kernel *kernel) {
  for (uint32_t y = 0; y < in->height; y++) {
    double *row = out->values + (size_t)y * in->width;
    memset(row, 0, in->width * sizeof *row);
    for (int i = -kernel->radius; i <= kernel->radius; i++) {
      const int64_t at = (int64_t)y + i, last = in->height - 1;
      const double *from = in->values + (size_t)(at < 0 ? 0 : at > last ? last : at) * in->width;
      for (uint32_t x = 0; x < in->width; x++)
        row[x] += kernel->taps[i + kernel->radius] * from[x];
    }
  }
}

/* --- contrast sensitivity (4.1) --- */

/* A sum of two Gaussians of the frequency, in cycles per degree; transformed, one of Gaussians of the distance, each
   with the weight a sqrt(pi / b) (equation 5 of the paper), and the product of a row's and a column's. */
static const struct {
  double a, b;
} sensitivity[3][2] = {{{1, 0.0047}, {0, 1e-5}}, {{1, 0.0053}, {0, 1e-5}}, {{34.1, 0.04}, {13.5, 0.025}}};

/* Three standard deviations of the widest. */
static int sensitivity_radius(void) {
  return (int)ceil(3 * sqrt(0.04 / (2 * PI * PI)) * PIXELS_PER_DEGREE);
}

/* The sum of its taps. */
static double gaussian_kernel(struct kernel *kernel, double b) {
  double sum = 0;
  kernel->radius = sensitivity_radius();
  for (int i = -kernel->radius; i <= kernel->radius; i++) {
    const double x = i / PIXELS_PER_DEGREE;
    sum += kernel->taps[i + kernel->radius] = exp(-PI * PI * x * x / b);
  }
  return sum;
}

static void filter_channel(struct plane *channel, int which, struct plane *scratch, struct plane *sum) {
  struct kernel kernels[2];
  double weights[2], total = 0;
  for (int i = 0; i < 2; i++) {
    const double row = gaussian_kernel(&kernels[i], sensitivity[which][i].b);
    weights[i] = sensitivity[which][i].a * sqrt(PI / sensitivity[which][i].b);
    total += weights[i] * row * row;
  }
  const size_t count = (size_t)channel->width * channel->height;
  memset(sum->values, 0, count * sizeof *sum->values);
  struct plane term = {channel->width, channel->height, scratch->values + count};
  for (int i = 0; i < 2; i++) {
    if (weights[i] == 0)
      continue;
    convolve_rows(scratch, channel, &kernels[i]);
    convolve_columns(&term, scratch, &kernels[i]);
    for (size_t j = 0; j < count; j++)
      sum->values[j] += weights[i] / total * term.values[j];
  }
  memcpy(channel->values, sum->values, count * sizeof *sum->values);
}

/* --- features (4.2) --- */

/* Each side of a derivative's taps sums to 1. */
static void normalise_sides(struct kernel *kernel) {
  double positive = 0, negative = 0;
  for (int i = 0; i <= 2 * kernel->radius; i++)
    *(kernel->taps[i] > 0 ? &positive : &negative) += fabs(kernel->taps[i]);
  for (int i = 0; i <= 2 * kernel->radius; i++)
    kernel->taps[i] /= kernel->taps[i] > 0 ? positive : negative > 0 ? negative : 1;
}

/* The Gaussian of a feature 0.082 degrees wide, its first and second derivative. */
static void feature_kernels(struct kernel *across, struct kernel *edge, struct kernel *point) {
  const double deviation = 0.5 * 0.082 * PIXELS_PER_DEGREE;
  const int radius = (int)ceil(3 * deviation);
  double sum = 0;
  across->radius = edge->radius = point->radius = radius;
  for (int i = -radius; i <= radius; i++) {
    const double g = exp(-i * i / (2 * deviation * deviation));
    sum += across->taps[i + radius] = g;
    edge->taps[i + radius] = -i * g;
    point->taps[i + radius] = (i * i / (deviation * deviation) - 1) * g;
  }
  for (int i = 0; i <= 2 * radius; i++)
    across->taps[i] /= sum;
  normalise_sides(edge);
  normalise_sides(point);
}

/* out += the squares of what the derivative finds along rows and along columns. */
static void add_squares(struct plane *out, const struct plane *in, const struct kernel *along,
                        const struct kernel *across, struct plane *scratch) {
  const size_t count = (size_t)in->width * in->height;
  struct plane found = {in->width, in->height, scratch->values + count};
  for (int direction = 0; direction < 2; direction++) {
    convolve_rows(scratch, in, direction ? across : along);
    convolve_columns(&found, scratch, direction ? along : across);
    for (size_t i = 0; i < count; i++)
      out->values[i] += found.values[i] * found.values[i];
  }
}

/* --- both --- */

/* What is computed of each picture: the colours as they are perceived, and the strengths of edges and points. */
struct seen {
  double *lab; /* [pixels][3] */
  struct plane edges, points;
};

static void perceive(struct seen *seen, const double *picture, struct plane *scratch) {
  const uint32_t width = seen->edges.width, height = seen->edges.height;
  const size_t count = (size_t)width * height;
  struct plane channels[3], sum = {width, height, scratch->values + 2 * count};
  for (int i = 0; i < 3; i++)
    channels[i] = (struct plane){width, height, scratch->values + (3 + i) * count};
  for (size_t i = 0; i < count; i++) {
    double rgb[3], ycxcz[3];
    for (int channel = 0; channel < 3; channel++) {
      const double value = fmin(fmax(picture[3 * i + channel] / 255, 0), 1);
      rgb[channel] = value * value;
    }
    ycxcz_of(ycxcz, rgb);
    for (int channel = 0; channel < 3; channel++)
      channels[channel].values[i] = ycxcz[channel];
  }

  struct kernel across, edge, point;
  feature_kernels(&across, &edge, &point);
  for (size_t i = 0; i < count; i++) {
    sum.values[i] = (channels[0].values[i] + 16) / 116;
    seen->edges.values[i] = seen->points.values[i] = 0;
  }
  add_squares(&seen->edges, &sum, &edge, &across, scratch);
  add_squares(&seen->points, &sum, &point, &across, scratch);

  for (int i = 0; i < 3; i++)
    filter_channel(&channels[i], i, scratch, &sum);
  for (size_t i = 0; i < count; i++) {
    const double ycxcz[3] = {channels[0].values[i], channels[1].values[i], channels[2].values[i]};
    double rgb[3];
    rgb_of(rgb, ycxcz);
    for (int channel = 0; channel < 3; channel++)
      rgb[channel] = fmin(fmax(rgb[channel], 0), 1);
    lab_of(seen->lab + 3 * i, rgb);
  }
}

/* Large colour differences are drawn together, since they are all large (4.1.3). */
static double colour_difference(const double a[3], const double b[3], double most) {
  const double power = 0.7, knee = 0.4 * most, at_knee = 0.95;
  const double difference = pow(hyab(a, b), power);
  return difference < knee ? difference * at_knee / knee
                           : at_knee + (difference - knee) / (most - knee) * (1 - at_knee);
}

/* The largest colour difference there is: between green and blue. */
static double most_difference(void) {
  double green[3], blue[3];
  lab_of(green, (const double[]){0, 1, 0});
  lab_of(blue, (const double[]){0, 0, 1});
  return pow(hyab(green, blue), 0.7);
}

trax_status trax_flip(double *mean, const double *picture, const double *reference, uint32_t width, uint32_t height,
                      trax_error *error) {
  const size_t count = (size_t)width * height;
  double *memory = malloc((6 + 2 * 5) * count * sizeof *memory);
  if (!memory)
    return trax_fail(error, "out of memory to compare pictures of %u x %u", width, height);
  struct plane scratch = {width, height, memory};
  struct seen seen[2];
  for (int i = 0; i < 2; i++) {
    double *own = memory + (6 + 5 * i) * count;
    seen[i] = (struct seen){own, {width, height, own + 3 * count}, {width, height, own + 4 * count}};
    perceive(&seen[i], i ? reference : picture, &scratch);
  }
  const double most = most_difference();
  double sum = 0;
  for (size_t i = 0; i < count; i++) {
    const double colour = colour_difference(seen[0].lab + 3 * i, seen[1].lab + 3 * i, most);
    const double edge = fabs(sqrt(seen[0].edges.values[i]) - sqrt(seen[1].edges.values[i]));
    const double point = fabs(sqrt(seen[0].points.values[i]) - sqrt(seen[1].points.values[i]));
    sum += pow(colour, 1 - sqrt(fmax(edge, point) / sqrt(2)));
  }
  *mean = count ? sum / (double)count : 0;
  free(memory);
  return TRAX_OK;
}
