/* Pictures' errors against values worked out by hand, and FLIP against its authors' program. */
#include "metrics.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void test_channel_errors(void **state) {
  (void)state;
  const double reference[] = {10, 20, 30, 40, 50, 60}, picture[] = {10, 23, 30, 36, 50, 60};
  struct trax_channel_errors errors;
  trax_channel_errors(&errors, picture, reference, 2);
  assert_true(fabs(errors.rmse - sqrt(25.0 / 6)) < 1e-15);
  assert_true(errors.largest == 4);
  trax_channel_errors(&errors, reference, reference, 2);
  assert_true(errors.rmse == 0 && errors.largest == 0);
}

static double flip(const double *picture, const double *reference, uint32_t width, uint32_t height) {
  double mean;
  trax_error error;
  assert_int_equal(trax_flip(&mean, picture, reference, width, height, &error), TRAX_OK);
  return mean;
}

enum { WIDTH = 61, HEIGHT = 37 };

static double *even_picture(double red, double green, double blue) {
  double *picture = malloc(sizeof(double) * 3 * WIDTH * HEIGHT);
  assert_non_null(picture);
  for (size_t i = 0; i < WIDTH * HEIGHT; i++)
    picture[3 * i] = red, picture[3 * i + 1] = green, picture[3 * i + 2] = blue;
  return picture;
}

/* Pictures of one colour have neither edges nor anything to blur: what is left is the difference of two colours. */
static void test_flip_of_even_pictures(void **state) {
  (void)state;
  double *black = even_picture(0, 0, 0), *white = even_picture(255, 255, 255), *green = even_picture(0, 255, 0),
         *blue = even_picture(0, 0, 255), *grey = even_picture(255 * sqrt(0.5), 255 * sqrt(0.5), 255 * sqrt(0.5));
  assert_true(flip(black, black, WIDTH, HEIGHT) == 0);
  assert_true(fabs(flip(green, blue, WIDTH, HEIGHT) - 1) < 1e-12); /* by definition the largest */
  assert_true(fabs(flip(blue, green, WIDTH, HEIGHT) - 1) < 1e-12);

  /* L* of black is 0, of white 100, of half the light 116 cbrt(0.5) - 16; a* and b* are 0. L*, a*, b* of sRGB's green
     are 87.74, -86.18, 83.18, of its blue 32.30, 79.19, -107.86, and a*, b* are multiplied by L* / 100. */
  const double most =
      pow(87.74 - 32.30 + hypot(0.8774 * -86.18 - 0.3230 * 79.19, 0.8774 * 83.18 + 0.3230 * 107.86), 0.7);
  const double knee = 0.4 * most, to_white = pow(100, 0.7), to_grey = pow(116 * cbrt(0.5) - 16, 0.7),
               grey_white = pow(116 - 116 * cbrt(0.5), 0.7);
  assert_true(fabs(flip(black, white, WIDTH, HEIGHT) - (0.95 + 0.05 * (to_white - knee) / (most - knee))) < 1e-4);
  assert_true(fabs(flip(black, grey, WIDTH, HEIGHT) - (0.95 + 0.05 * (to_grey - knee) / (most - knee))) < 1e-4);
  assert_true(fabs(flip(grey, white, WIDTH, HEIGHT) - 0.95 * grey_white / knee) < 1e-4);
  free(black), free(white), free(green), free(blue), free(grey);
}

/* A pattern of smooth shades, noise, edges and dots, with its blur, its noise and a shift. */
static double pattern(int x, int y, int channel) {
  const unsigned noise = ((unsigned)(x * 73 + y * 151 + channel * 211) * 2654435761u) >> 24;
  if (x < 20)
    return 4 * x + 3 * y + 20 * channel;
  if (x < 40)
    return (x / 5 + y / 7) % 2 ? 200 - 40 * channel : 30 + 10 * channel;
  return y < 18 ? (x % 8 == 4 && y % 8 == 4 ? 255 : 60) : noise;
}

static void make_pattern(double *picture, int shift, int noise) {
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++)
      for (int channel = 0; channel < 3; channel++) {
        const int jitter = noise ? (x * 31 + y * 17 + channel * 7) % noise : 0;
        const double value = floor(pattern((x + shift) % WIDTH, y, channel)) + jitter;
        picture[3 * ((size_t)y * WIDTH + (size_t)x) + (size_t)channel] = fmin(value, 255);
      }
}

/* What the authors' own program (FLIP.h of version 1.6, github.com/NVlabs/flip) prints for the same pictures, its
   floats made doubles; its constants have nine digits. */
static void test_flip_of_a_pattern(void **state) {
  (void)state;
  double *reference = even_picture(0, 0, 0), *picture = even_picture(0, 0, 0);
  make_pattern(reference, 0, 0);
  make_pattern(picture, 1, 0);
  const double shifted = flip(picture, reference, WIDTH, HEIGHT);
  make_pattern(picture, 0, 30);
  const double noisy = flip(picture, reference, WIDTH, HEIGHT);
  assert_true(fabs(shifted - 0.207528244) < 1e-8);
  assert_true(fabs(noisy - 0.256194520) < 1e-8);
  free(reference), free(picture);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_channel_errors),
                                     cmocka_unit_test(test_flip_of_even_pictures),
                                     cmocka_unit_test(test_flip_of_a_pattern)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
