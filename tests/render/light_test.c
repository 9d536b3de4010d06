/* The device program's own functions for materials, lights and sampling, one by one, against formulas in binary64. */
#include "meshes.h"

static _Bool exact; /* which hits the lights below are for */
#define TRAX_EXACT_HITS exact

#include "../../raytracer/device/exact.h"

#include "../../raytracer/device/path.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

struct trax_buffer scene, params, image, paths; /* the program's, unused here */

static double wide(float value) {
  return (double)value;
}

/* --- the sampler --- */

/* The first 2^k points have exactly one in every elementary interval of area 2^-k, whatever the seed, and so have all
   blocks of 2^k that follow: that is what makes it a (0, 2)-sequence. */
static void test_points_are_a_net(void **state) {
  (void)state;
  static unsigned char seen[1024];
  for (uint32_t seed = 0; seed < 20; seed++)
    for (uint32_t k = 0; k <= 10; k++)
      for (uint32_t block = 0; block < 4; block++)
        for (uint32_t along = 0; along <= k; along++) {
          memset(seen, 0, sizeof seen);
          for (uint32_t i = 0; i < 1u << k; i++) {
            const struct words point = scrambled_point((block << k) + i, seed * 77777u);
            const uint32_t column = (uint32_t)((uint64_t)point.x >> (32 - along));
            const uint32_t row = (uint32_t)((uint64_t)point.y >> (32 - (k - along)));
            assert_int_equal(seen[row << along | column]++, 0);
          }
        }
}

/* Two dimensions of one path know nothing of each other: their 4-dimensional boxes are filled as by chance. */
static void test_dimensions_are_independent(void **state) {
  (void)state;
  unsigned counts[16] = {0};
  enum { PIXELS = 400, SAMPLES = 16 };
  for (uint32_t pixel = 0; pixel < PIXELS; pixel++)
    for (uint32_t sample = 0; sample < SAMPLES; sample++) {
      const struct place a = random_point(sample, DIMENSION_LIGHT, hash_word(pixel)),
                         b = random_point(sample, DIMENSION_SCATTER, hash_word(pixel));
      counts[(a.x >= 0.5f) | (a.y >= 0.5f) << 1 | (b.x >= 0.5f) << 2 | (b.y >= 0.5f) << 3]++;
    }
  for (int i = 0; i < 16; i++) /* 400 each; a standard deviation is below 20 */
    assert_in_range(counts[i], 320, 480);
}

static void test_even_points(void **state) {
  (void)state;
  for (uint32_t dimension = 0; dimension < 40; dimension++) {
    const struct place first = even_point(0, dimension);
    assert_true(first.x == 0.5f && first.y == 0.5f);
    double sum = 0;
    for (uint32_t i = 0; i < 256; i++) {
      const struct place place = even_point(i, dimension);
      assert_true(place.x >= 0 && place.x < 1 && place.y >= 0 && place.y < 1);
      sum += wide(place.x) * wide(place.y);
    }
    assert_true(fabs(sum / 256 - 0.25) < 0.004);
  }
}

/* --- the disk --- */

static void test_sine_and_cosine(void **state) {
  (void)state;
  for (int i = -4096; i <= 4096; i++) {
    const float x = (float)i / 4096;
    assert_true(fabs(wide(sine_of_eighth(x)) - sin(PI / 4 * wide(x))) < 5e-7);
    assert_true(fabs(wide(cosine_of_eighth(x)) - cos(PI / 4 * wide(x))) < 5e-7);
  }
}

/* Points of the square's sixteenths are in the disk, in equal parts of its area: rings and sectors. */
static void test_disk(void **state) {
  (void)state;
  unsigned rings[4] = {0}, sectors[8] = {0};
  for (int j = 0; j < 1024; j++)
    for (int i = 0; i < 1024; i++) {
      const struct place place = disk_point((struct place){((float)i + 0.5f) / 1024, ((float)j + 0.5f) / 1024});
      const double square = wide(place.x) * wide(place.x) + wide(place.y) * wide(place.y);
      assert_true(square <= 1.000001);
      rings[(int)fmin(4 * square, 3)]++;
      sectors[(int)(floor(atan2(wide(place.y), wide(place.x)) / (PI / 4)) + 8) % 8]++;
    }
  for (int i = 0; i < 4; i++)
    assert_in_range(rings[i], 262144 - 1500, 262144 + 1500);
  for (int i = 0; i < 8; i++)
    assert_in_range(sectors[i], 131072 - 800, 131072 + 800);
}

/* --- boundaries --- */

static double exact_fresnel(double n1, double n2, double cosine) {
  const double sine2 = n1 / n2 * sqrt(1 - cosine * cosine);
  if (sine2 >= 1)
    return 1;
  const double other = sqrt(1 - sine2 * sine2);
  const double s = (n1 * cosine - n2 * other) / (n1 * cosine + n2 * other);
  const double p = (n1 * other - n2 * cosine) / (n1 * other + n2 * cosine);
  return (s * s + p * p) / 2;
}

static void test_fresnel(void **state) {
  (void)state;
  float other;
  assert_true(fabsf(fresnel(1, 1 / 1.5f, &other) - 0.04f) < 1e-7f); /* ((n - 1) / (n + 1))^2 */
  assert_true(fabsf(fresnel(1, 1.5f, &other) - 0.04f) < 1e-7f);
  assert_true(fresnel(0.5f, 1.5f, &other) == 1 && other == 0); /* beyond the critical angle */
  /* Brewster's angle, whose tangent is n, reflects only the part across the plane, ((n^2 - 1) / (n^2 + 1))^2. */
  const double n = 1.5, across = (n * n - 1) / (n * n + 1);
  assert_true(fabs(wide(fresnel((float)(1 / sqrt(1 + n * n)), (float)(1 / n), &other)) - across * across / 2) < 1e-6);
  for (int k = 0; k <= 64; k++) {
    const float ratio = k < 32 ? 1 + (float)k / 8 : 1 / (1 + (float)(k - 32) / 8);
    for (int i = 1; i <= 256; i++) {
      const float c = (float)i / 256;
      const double exact = exact_fresnel(wide(ratio), 1, wide(c));
      if (fabs(wide(ratio) * sqrt(1 - wide(c) * wide(c)) - 1) > 1e-4) /* the critical angle's slope is infinite */
        assert_true(fabs(wide(fresnel(c, ratio, &other)) - exact) < 3e-5);
    }
  }
  assert_true(fresnel(0x1p-20f, 1, &other) >= 0 && fresnel(0, 1, &other) <= 1);
}

static struct vector random_direction(uint32_t *seed) {
  for (;;) {
    const struct vector v = {2 * random_unit(seed) - 1, 2 * random_unit(seed) - 1, 2 * random_unit(seed) - 1};
    const float square = dot(v, v);
    if (square < 1 && square > 0.01f)
      return unit(v);
  }
}

/* A view on the normal's side. */
static struct scatterer random_scatterer(uint32_t *seed) {
  struct scatterer at = {.flat = random_direction(seed), .view = random_direction(seed)};
  if (dot(at.flat, at.view) < 0)
    at.view = times(-1, at.view);
  at.normal = at.flat;
  return at;
}

static void test_mirrors_and_snell(void **state) {
  (void)state;
  uint32_t seed = 5;
  for (int i = 0; i < 20000; i++) {
    const struct scatterer at = random_scatterer(&seed);
    const float ratio = i & 1 ? 1.5f : 1 / 1.5f, cosine = dot(at.normal, at.view);
    if (cosine < 0.01f)
      continue;
    const struct vector mirror = mirror_direction(&at);
    assert_true(fabsf(dot(at.normal, mirror) - cosine) < 1e-6f);
    assert_true(fabsf(dot(cross(at.view, at.normal), mirror)) < 1e-6f); /* in one plane */
    bool through;
    const struct vector way = glass_direction(&at, ratio, random_unit(&seed), &through);
    assert_true(fabsf(dot(way, way) - 1) < 1e-6f);
    assert_true(fabsf(dot(cross(at.view, at.normal), way)) < 2e-6f);
    const double sine = sqrt(1 - wide(cosine) * wide(cosine)), inside = wide(dot(at.normal, way));
    if (through) {
      assert_true(inside < 0);
      assert_true(fabs(sqrt(fmax(0, 1 - inside * inside)) - wide(ratio) * sine) < 2e-4);
    } else {
      assert_true(fabs(inside - wide(cosine)) < 1e-6);
    }
  }
}

/* Smooth normals may lead into the surface; no mirror and no glass does. */
static void test_bent_normals(void **state) {
  (void)state;
  uint32_t seed = 17;
  unsigned bent = 0;
  for (int i = 0; i < 20000; i++) {
    struct scatterer at = random_scatterer(&seed);
    at.normal = unit(plus(at.flat, times(0.8f, random_direction(&seed))));
    if (dot(at.normal, at.view) < 0.001f || dot(at.flat, at.view) < 0.001f)
      continue;
    bent += dot(at.flat, reflected(at.view, at.normal)) <= 0;
    assert_true(dot(at.flat, mirror_direction(&at)) > 0);
    bool through;
    const struct vector way = glass_direction(&at, i & 1 ? 1.5f : 1 / 1.5f, random_unit(&seed), &through);
    assert_true(through ? dot(at.flat, way) < 0 : dot(at.flat, way) > 0);
  }
  assert_true(bent > 100);
}

/* The share of ways that are reflected is what Fresnel's equations say. */
static void test_glass_splits(void **state) {
  (void)state;
  struct scatterer at = {.flat = {0, 0, 1}, .normal = {0, 0, 1}};
  for (int i = 1; i <= 20; i++) {
    const double cosine = i / 20.0;
    at.view = (struct vector){(float)sqrt(1 - cosine * cosine), 0, (float)cosine};
    unsigned reflected_ways = 0;
    enum { CHOICES = 10000 };
    for (int k = 0; k < CHOICES; k++) {
      bool through;
      glass_direction(&at, 1 / 1.5f, ((float)k + 0.5f) / CHOICES, &through);
      reflected_ways += !through;
    }
    assert_true(fabs(reflected_ways / (double)CHOICES - exact_fresnel(1, 1.5, cosine)) < 2e-4);
  }
}

/* --- textures --- */

/* Against the bilinear formula in binary64, within the texture and far outside. */
static void test_texels(void **state) {
  (void)state;
  enum { LOG2_WIDTH = 2, LOG2_HEIGHT = 3, WIDTH = 1 << LOG2_WIDTH, HEIGHT = 1 << LOG2_HEIGHT };
  struct {
    struct trax_texture texture;
    uint32_t texels[WIDTH * HEIGHT];
  } file = {.texture = {sizeof file.texture, LOG2_WIDTH, LOG2_HEIGHT, 0}};
  uint32_t seed = 3;
  for (int i = 0; i < WIDTH * HEIGHT; i++)
    file.texels[i] = hash_word((uint32_t)i);
  for (int i = 0; i < 20000; i++) {
    const bool clamp = i & 1;
    file.texture.flags = clamp ? TRAX_TEXTURE_CLAMP : 0;
    const float reach = i % 3 ? 2 : 40, u = reach * (2 * random_unit(&seed) - 1),
                v = reach * (2 * random_unit(&seed) - 1);
    const struct texel found = texture_at((const char *)&file, &file.texture, u, v);
    const double x = wide(u) * WIDTH - 0.5, y = wide(v) * HEIGHT - 0.5;
    double red = 0, alpha = 0;
    for (int tap = 0; tap < 4; tap++) {
      int column = (int)floor(x) + (tap & 1), row = (int)floor(y) + (tap >> 1);
      const double weight = (1 - fabs(x - column)) * (1 - fabs(y - row));
      if (clamp) {
        column = column < 0 ? 0 : column >= WIDTH ? WIDTH - 1 : column;
        row = row < 0 ? 0 : row >= HEIGHT ? HEIGHT - 1 : row;
      }
      const uint32_t word = file.texels[((row % HEIGHT + HEIGHT) % HEIGHT) * WIDTH + (column % WIDTH + WIDTH) % WIDTH];
      red += weight * (word & 255) * (word & 255) / 65025.0;
      alpha += weight * (word >> 24) / 255.0;
    }
    assert_true(fabs(wide(found.colour.x) - red) < 1e-4 && fabs(wide(found.alpha) - alpha) < 1e-4);
  }
}

/* --- rough layers --- */

/* Integrals over the hemisphere by a grid in the angle, fine where highlights are. */
static void integrate(const struct scatterer *at, double *reflectance_sum, double *density_sum) {
  enum { RINGS = 400, SECTORS = 240 };
  *reflectance_sum = *density_sum = 0;
  struct vector s, t;
  tangents(at->normal, &s, &t);
  for (int i = 0; i < RINGS; i++) {
    const double cosine = (i + 0.5) / RINGS, sine = sqrt(1 - cosine * cosine);
    for (int k = 0; k < SECTORS; k++) {
      const double angle = 2 * PI * (k + 0.5) / SECTORS;
      const struct vector way = plus(plus(times((float)(sine * cos(angle)), s), times((float)(sine * sin(angle)), t)),
                                     times((float)cosine, at->normal));
      float density;
      const struct vector part = layered_reflectance(at, way, (float)cosine, &density);
      *reflectance_sum += wide(part.y) * cosine;
      *density_sum += wide(density);
    }
  }
  *reflectance_sum *= 2.0 / (RINGS * (double)SECTORS); /* solid angle / pi */
  *density_sum *= 2.0 / (RINGS * (double)SECTORS);
}

static struct scatterer layer(double cosine, float roughness, float diffuse, float specular) {
  return (struct scatterer){.flat = {0, 0, 1},
                            .normal = {0, 0, 1},
                            .view = {(float)sqrt(1 - cosine * cosine), 0, (float)cosine},
                            .roughness = roughness,
                            .diffuse = {diffuse, diffuse, diffuse},
                            .specular = {specular, specular, specular}};
}

/* Whatever the surface, it sends back no more than it gets; and what is chosen from adds up to one, but for the ways
   that lead into the surface. */
static void test_layers_keep_energy(void **state) {
  (void)state;
  const float roughnesses[] = {0.15f, 0.4f, 1}, speculars[] = {0, 0.04f, 0.5f, 1};
  for (int r = 0; r < 3; r++)
    for (int f = 0; f < 4; f++)
      for (int white = 0; white < 2; white++)
        for (int c = 1; c <= 4; c++) {
          const struct scatterer at = layer(c / 4.0, roughnesses[r], (float)white, speculars[f]);
          double sent, density;
          integrate(&at, &sent, &density);
          assert_true(sent > 0 || speculars[f] == 0);
          assert_true(sent <= 1.002);
          assert_true(density < 1.003);
          if (speculars[f] == 1 && roughnesses[r] < 0.2f && c > 1)
            assert_true(sent > 0.9); /* a polished metal loses little */
        }
}

/* Light goes both ways alike. */
static void test_layers_are_reciprocal(void **state) {
  (void)state;
  uint32_t seed = 9;
  for (int i = 0; i < 5000; i++) {
    struct scatterer at = random_scatterer(&seed);
    struct vector way = random_direction(&seed);
    if (dot(at.normal, way) < 0)
      way = times(-1, way);
    if (dot(at.normal, way) < 0.02f || dot(at.normal, at.view) < 0.02f)
      continue;
    at.roughness = 0.05f + 0.9f * random_unit(&seed);
    at.diffuse = (struct vector){0.3f, 0.6f, 0.9f}, at.specular = (struct vector){0.04f, 0.3f, 0.9f};
    float density;
    const struct vector forth = layered_reflectance(&at, way, dot(at.normal, way), &density);
    const struct vector view = at.view;
    at.view = way;
    const struct vector back = layered_reflectance(&at, view, dot(at.normal, view), &density);
    assert_true(fabsf(forth.y - back.y) < 1e-3f * (0.01f + forth.y));
  }
}

/* The mean of what scatter returns is the integral: its density is the one it chooses by. */
static void test_scatter_is_unbiased(void **state) {
  (void)state;
  const float roughnesses[] = {0.15f, 0.5f, 1};
  for (int r = 0; r < 3; r++)
    for (int c = 1; c <= 3; c++) {
      const struct scatterer at = layer(c / 3.0 - 0.05, roughnesses[r], 0.7f, 0.3f);
      double sent, density_sum, mean = 0;
      unsigned taken = 0;
      integrate(&at, &sent, &density_sum);
      enum { SAMPLES = 1 << 14 };
      for (uint32_t i = 0; i < SAMPLES; i++) {
        struct vector way;
        float density;
        const struct place choice = place_of(scrambled_point(i, 1)), place = place_of(scrambled_point(i, 2));
        mean += wide(scatter(&at, true, place, choice.x, &way, &density).y) / SAMPLES;
        taken += density > 0;
      }
      assert_true(fabs(mean - sent) < 0.006);
      /* The density adds up to the share of chosen directions that do not lead into the surface. */
      assert_true(fabs(density_sum - (double)taken / SAMPLES) < 0.006);
    }
}

/* --- lights --- */

/* The factor of a rectangle parallel to a surface, with a corner above the point: Howell, "A Catalog of Radiation Heat
   Transfer Configuration Factors", B-3. */
static double corner_factor(double a, double b, double height) {
  const double x = a / height, y = b / height, rx = sqrt(1 + x * x), ry = sqrt(1 + y * y);
  return (x / rx * atan(y / rx) + y / ry * atan(x / ry)) / (2 * PI);
}

static void test_rectangle_against_its_form_factor(void **state) {
  (void)state;
  const double sizes[][4] = {{-1, -1, 1, 1}, {-0.2, -0.3, 0.5, 0.1}, {0, 0, 3, 2}, {-4, -1, -0, 2}},
               heights[] = {0.5, 1, 3};
  for (int k = 0; k < 4; k++)
    for (int h = 0; h < 3; h++) {
      const double *s = sizes[k], height = heights[h];
      double factor = 0; /* the sum of four rectangles with the corner above the point */
      factor += corner_factor(fabs(s[0]), fabs(s[1]), height) + corner_factor(s[2], fabs(s[1]), height) +
                corner_factor(fabs(s[0]), s[3], height) + corner_factor(s[2], s[3], height);
      const double area = (s[2] - s[0]) * (s[3] - s[1]);
      const struct trax_device_light light = {.kind = TRAX_FROM_RECTANGLE,
                                              .place = {(float)s[0], (float)height, (float)s[1]},
                                              .edge = {{(float)(s[2] - s[0]), 0, 0}, {0, 0, (float)(s[3] - s[1])}},
                                              .normal = {0, -1, 0},
                                              .radiance = {(float)(area / PI), 0, 0}};
      double mean = 0;
      enum { SAMPLES = 4096 };
      for (uint32_t i = 0; i < SAMPLES; i++) {
        struct arrival arrival;
        if (light_arrives(&arrival, &light, (struct vector){0, 0, 0}, place_of(scrambled_point(i, 3))))
          mean += wide(arrival.radiance.x) * wide(arrival.direction.y) / SAMPLES;
      }
      assert_true(fabs(mean - factor) < 1e-3 * factor);
      struct arrival arrival; /* it shines to one side */
      assert_false(light_arrives(&arrival, &light, (struct vector){0, (float)height + 1, 0}, PIXEL_MIDDLE));
    }
}

static void test_falloff(void **state) {
  (void)state;
  struct trax_device_light light = {.kind = TRAX_FROM_POINT, .place = {0, 3, 0}, .radiance = {2, 2, 2}};
  struct arrival arrival;
  assert_true(light_arrives(&arrival, &light, (struct vector){0, 0, 0}, PIXEL_MIDDLE));
  assert_true(arrival.radiance.x == 2 && arrival.direction.y == 1);
  light.kind = TRAX_FROM_FADING_POINT;
  assert_true(light_arrives(&arrival, &light, (struct vector){0, 0, 0}, PIXEL_MIDDLE));
  assert_true(fabsf(arrival.radiance.x - 2.0f / 9) < 1e-6f);
  assert_false(light_arrives(&arrival, &light, (struct vector){0, 3, 0}, PIXEL_MIDDLE)); /* in the light itself */
  light.kind = TRAX_FROM_DIRECTION, light.place[1] = 1;
  assert_true(light_arrives(&arrival, &light, (struct vector){0, 1e6f, 0}, PIXEL_MIDDLE));
  assert_true(arrival.radiance.x == 2 && arrival.distance_bits == FARTHEST_BITS);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_points_are_a_net),
      cmocka_unit_test(test_dimensions_are_independent),
      cmocka_unit_test(test_even_points),
      cmocka_unit_test(test_sine_and_cosine),
      cmocka_unit_test(test_disk),
      cmocka_unit_test(test_fresnel),
      cmocka_unit_test(test_mirrors_and_snell),
      cmocka_unit_test(test_bent_normals),
      cmocka_unit_test(test_glass_splits),
      cmocka_unit_test(test_texels),
      cmocka_unit_test(test_layers_keep_energy),
      cmocka_unit_test(test_layers_are_reciprocal),
      cmocka_unit_test(test_scatter_is_unbiased),
      cmocka_unit_test(test_rectangle_against_its_form_factor),
      cmocka_unit_test(test_falloff),
  };
  const int failures = cmocka_run_group_tests_name("hits in binary32", tests, NULL, NULL);
  exact = true;
  return failures + cmocka_run_group_tests_name("exact hits", tests, NULL, NULL);
}
