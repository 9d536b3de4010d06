/* Pictures with more than the paper's workload: against Embree's, and against what physics says of them. */
#include "gallery.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct trax_frame_options plain = {.width = 96,
                                                .height = 54,
                                                .ambient = TRAX_DEFAULT_AMBIENT,
                                                .background = TRAX_DEFAULT_BACKGROUND,
                                                .samples = 1,
                                                .shadows = true};

static bool by_embree; /* which of the two renderers the laws below are asked of */

/* Damages what the host prepares for paths of the device program. */
static void spoil_tables(struct trax_frame *frame) {
  memset(frame->params + 1, 0x41, frame->params_size - sizeof *frame->params);
}

static struct trax_picture shoot_frame(const struct trax_scene *scene, const struct trax_view *view,
                                       const struct trax_frame_options *options, bool embree, unsigned threads,
                                       bool spoiled) {
  struct trax_frame frame = {0};
  struct trax_picture picture = {0};
  struct trax_render_run run = {0};
  trax_error error;
  trax_status status = trax_frame_init(&frame, scene, view, options, &error);
  if (status == TRAX_OK && spoiled)
    spoil_tables(&frame);
  if (status == TRAX_OK)
    status = embree ? trax_render_embree(&picture, &frame, &run, &error)
                    : trax_render_twin(&picture, &frame, threads, &run, &error);
  if (status != TRAX_OK) {
    fprintf(stderr, "shoot: %s\n", error.message);
    abort();
  }
  assert_true(run.rays >= (uint64_t)options->width * options->height);
  trax_frame_release(&frame);
  return picture;
}

static struct trax_picture shoot(const struct trax_scene *scene, const struct trax_view *view,
                                 const struct trax_frame_options *options, bool embree, unsigned threads) {
  return shoot_frame(scene, view, options, embree, threads, false);
}

static size_t count_of(const struct trax_picture *picture) {
  return 3 * (size_t)picture->width * picture->height;
}

/* The mean of a picture of floats, every one a finite number. */
static double mean_of(const struct trax_picture *picture) {
  double sum = 0;
  for (size_t i = 0; i < count_of(picture); i++) {
    assert_true(isfinite(picture->radiance[i]) && picture->radiance[i] >= 0 &&
                picture->radiance[i] <= TRAX_MAX_RADIANCE);
    sum += (double)picture->radiance[i];
  }
  return sum / (double)count_of(picture);
}

/* --- every feature with every other --- */

/* Twelve rows in which any two columns have all four pairs of values (Plackett and Burman, "The Design of Optimum
   Multifactorial Experiments", 1946), and the same rows inverted: then any three have all eight. */
static bool design(unsigned row, unsigned column) {
  static const char first[] = "11011100010"; /* each row is the one before, turned by one */
  const bool high = row % 12 == 11 ? false : first[(column + 11 - row % 12) % 11] == '1';
  return row < 12 ? high : !high;
}

static void test_combinations(void **state) {
  (void)state;
  for (unsigned row = 0; row < 24; row++) {
    unsigned parts = 0;
    for (unsigned part = 0; part < 6; part++)
      parts |= (unsigned)design(row, part) << part;
    struct trax_frame_options options = plain;
    options.smooth = design(row, 6);
    options.samples = design(row, 7) ? 3 : 1;
    options.shadows = design(row, 8);
    options.floats = design(row, 9);
    options.one_sided = row / 2 % 3 == 1;
    const struct trax_view view = gallery_view(design(row, 10) ? 3 : 0);
    struct trax_scene scene = gallery_scene(parts);
    struct trax_picture twin = shoot(&scene, &view, &options, false, 2);
    struct trax_picture other = shoot(&scene, &view, &options, true, 0);
    struct trax_difference difference;
    trax_picture_compare(&difference, &twin, &other, 2);
    if (difference.beyond > 5) /* of 5184 pixels: 99.9 % */
      print_error("row %u: %llu pixels beyond 2/255, worst %u at (%u, %u)\n", row,
                  (unsigned long long)difference.beyond, difference.largest, difference.x, difference.y);
    assert_true(difference.beyond <= 5);
    assert_int_equal(twin.radiance != NULL, options.floats);
    assert_true(difference.floats == options.floats && difference.floats_beyond <= 5);
    if (options.floats)
      assert_true(fabs(mean_of(&twin) / mean_of(&other) - 1) < 1e-3);
    trax_picture_release(&twin);
    trax_picture_release(&other);

    /* Paths are alike, too: the random numbers are the same, so nearly all pixels are. */
    options.paths = 1 + row % 5;
    options.seed = row;
    options.floats = true;
    twin = shoot(&scene, &view, &options, false, 2);
    other = shoot(&scene, &view, &options, true, 0);
    trax_picture_compare(&difference, &twin, &other, 2);
    const double light = mean_of(&twin) / mean_of(&other) - 1;
    if (difference.floats_beyond > 26 || fabs(light) >= 1e-3)
      print_error("row %u, paths: %llu pixels beyond 2/255, light %+g\n", row,
                  (unsigned long long)difference.floats_beyond, light);
    assert_true(difference.floats_beyond <= 26); /* 0.5 %: some paths take another turn at a last place */
    assert_true(fabs(light) < 1e-3);
    trax_picture_release(&twin);
    trax_picture_release(&other);
    trax_scene_release(&scene);
  }
}

/* Floats and bytes are the same picture, and a Lambert scene is what it is without path.h. */
static void test_floats_are_the_picture(void **state) {
  (void)state;
  for (unsigned parts = 0; parts <= GALLERY_ALL; parts += GALLERY_ALL) {
    struct trax_scene scene = gallery_scene(parts);
    const struct trax_view view = gallery_view(0);
    struct trax_frame_options options = plain;
    for (options.samples = 1; options.samples <= 4; options.samples += 3) {
      struct trax_difference difference;
      options.floats = false;
      struct trax_picture bytes = shoot(&scene, &view, &options, false, 2);
      options.floats = true;
      struct trax_picture floats = shoot(&scene, &view, &options, false, 2);
      trax_picture_compare(&difference, &bytes, &floats, 1);
      assert_int_equal(difference.beyond, 0);
      assert_true(difference.unequal < 100); /* of rounding alone */
      trax_picture_release(&bytes);
      trax_picture_release(&floats);
    }
    trax_scene_release(&scene);
  }
}

/* The unit of length does not matter, not even in the last bit. */
static void test_scale(void **state) {
  (void)state;
  const int exponents[] = {0, 40, -50};
  struct trax_picture pictures[3];
  for (int i = 0; i < 3; i++) {
    struct trax_mesh mesh = {0};
    const float scale = ldexpf(1, exponents[i]);
    gallery_mesh(&mesh, GALLERY_ALL);
    mesh_transform(&mesh, scale, 0, 0, 0);
    struct trax_scene scene = scene_of(&mesh, &(struct trax_build_options){.smooth = true, .crease_degrees = 40});
    struct trax_view view = gallery_view(3);
    for (int k = 0; k < 3; k++) {
      view.eye[k] *= scale;
      for (int light = 0; light < 3; light++)
        view.lights[light].position[k] *= scale, view.lights[light].edges[0][k] *= scale,
            view.lights[light].edges[1][k] *= scale;
    }
    view.lights[0].falloff *= scale;
    assert_true((normalise(&scene, &view) != 0) == (i > 0));
    struct trax_frame_options options = plain;
    options.floats = true, options.paths = 4, options.samples = 2;
    pictures[i] = shoot(&scene, &view, &options, false, 2);
    trax_scene_release(&scene);
  }
  for (int i = 1; i < 3; i++)
    assert_memory_equal(pictures[0].radiance, pictures[i].radiance, count_of(&pictures[0]) * sizeof(float));
  for (int i = 0; i < 3; i++)
    trax_picture_release(&pictures[i]);
}

static void test_paths_of_any_number_of_threads(void **state) {
  (void)state;
  struct trax_scene scene = gallery_scene(GALLERY_ALL);
  const struct trax_view view = gallery_view(3);
  struct trax_frame_options options = plain;
  options.paths = 5, options.samples = 2, options.smooth = true, options.seed = 4;
  struct trax_picture one = shoot(&scene, &view, &options, false, 1);
  for (unsigned threads = 2; threads < 90; threads *= 3) {
    struct trax_picture more = shoot(&scene, &view, &options, false, threads);
    assert_memory_equal(one.pixels, more.pixels, 4 * (size_t)options.width * options.height);
    trax_picture_release(&more);
  }
  options.seed = 5; /* another seed is other noise */
  struct trax_picture other = shoot(&scene, &view, &options, false, 2);
  struct trax_difference difference;
  trax_picture_compare(&difference, &one, &other, 0);
  assert_true(difference.unequal > difference.pixels / 2);
  trax_picture_release(&one);
  trax_picture_release(&other);
  trax_scene_release(&scene);
}

/* --- light adds up --- */

static void test_lights_add_up(void **state) {
  (void)state;
  struct trax_scene scene = gallery_scene(GALLERY_ALL & ~GALLERY_LAMP);
  struct trax_frame_options options = plain;
  options.floats = true, options.ambient = 0, options.background = 0xFF000000u;
  const struct trax_view all = gallery_view(3);
  struct trax_picture sum = shoot(&scene, &all, &options, by_embree, 2);
  for (int light = 0; light < 3; light++) {
    struct trax_view view = all;
    view.light_count = 1;
    view.lights[0] = all.lights[light];
    struct trax_picture one = shoot(&scene, &view, &options, by_embree, 2);
    const double least[] = {0.07, 0.016, 0.007}; /* measured: 0.0706, 0.0165, 0.00715 */
    assert_true(mean_of(&one) > least[light]);
    for (size_t i = 0; i < count_of(&sum); i++)
      sum.radiance[i] -= one.radiance[i];
    trax_picture_release(&one);
  }
  for (size_t i = 0; i < count_of(&sum); i++)
    assert_true(fabsf(sum.radiance[i]) < 1e-5f);
  trax_picture_release(&sum);
  trax_scene_release(&scene);
}

/* A mesh of one sphere about the origin, all of one material. */
static struct trax_scene sphere_scene(float radius, const struct trax_material *material) {
  struct trax_mesh whole = {0};
  mesh_sphere(&whole, radius, 4, mesh_material(&whole, 0, 0, 0));
  whole.materials[0].surface = *material;
  return scene_of(&whole, &(struct trax_build_options){.smooth = true});
}

static const struct trax_view *dark_view(void) {
  static struct trax_view view;
  view = view_from(0, 0, 3, 0, 0, -1, 60, 0, 0, 0);
  view.light_count = 1; /* one that does not shine: it is left out */
  view.lights[0] = (struct trax_light){.kind = TRAX_LIGHT_POINT, .colour = {1, 1, 1}};
  return &view;
}

/* The light in a closed surface that shines e and reflects r is e + e r + e r^2 + ..., up to the length of paths. */
static void test_furnace_from_inside(void **state) {
  (void)state;
  const struct trax_material material = {
      .diffuse = {0.5f, 0.8f, 0}, .emission = {1, 0.5f, 0.25f}, .ior = 1, .opacity = 1};
  struct trax_scene scene = sphere_scene(1, &material);
  struct trax_view view = *dark_view();
  view.eye[0] = 0.3f, view.eye[2] = 0.1f;
  struct trax_frame_options options = plain;
  options.floats = true, options.samples = 4;
  for (uint32_t depth = 1; depth <= 16; depth *= 4) {
    options.paths = depth;
    struct trax_picture picture = shoot(&scene, &view, &options, by_embree, 2);
    for (int channel = 0; channel < 3; channel++) {
      const double r = (double)material.diffuse[channel], e = (double)material.emission[channel];
      double mean = 0, exact = 0;
      for (size_t i = (size_t)channel; i < count_of(&picture); i += 3)
        mean += (double)picture.radiance[i] * 3 / (double)count_of(&picture);
      for (uint32_t k = 0; k <= depth; k++)
        exact += e * pow(r, k);
      assert_true(fabs(mean / exact - 1) < 0.004);
    }
    trax_picture_release(&picture);
  }
  trax_scene_release(&scene);
}

/* A body that loses no light is not seen before a background that is the same everywhere. */
static void test_furnace_from_outside(void **state) {
  (void)state;
  const struct trax_material bodies[] = {
      {.diffuse = {1, 1, 1}, .ior = 1, .opacity = 1},
      {.kind = TRAX_MATERIAL_MIRROR, .specular = {1, 1, 1}, .ior = 1, .opacity = 1},
      {.kind = TRAX_MATERIAL_GLASS, .specular = {1, 1, 1}, .ior = 1.5f, .opacity = 1},
      {.kind = TRAX_MATERIAL_GGX, .specular = {1, 1, 1}, .roughness = 0.1f, .ior = 1, .opacity = 1},
      {.kind = TRAX_MATERIAL_GGX,
       .specular = {0.04f, 0.04f, 0.04f},
       .diffuse = {1, 1, 1},
       .roughness = 0.6f,
       .ior = 1,
       .opacity = 1},
      {.kind = TRAX_MATERIAL_GGX, .specular = {1, 1, 1}, .roughness = 1, .ior = 1, .opacity = 1},
  };
  const double least[] = {0.99999, 0.99999, 0.999, 0.97, 0.85, 0.35},
               most[] = {1.00001, 1.00001, 1.00001, 1.002, 1.002, 1.002};
  for (int i = 0; i < 6; i++)
    for (int smooth = 0; smooth < 2; smooth++) {
      struct trax_scene scene = sphere_scene(1, &bodies[i]);
      struct trax_frame_options options = plain;
      options.floats = true, options.samples = 16, options.paths = 32, options.background = 0xFFFFFFFFu;
      options.smooth = smooth;
      struct trax_picture picture = shoot(&scene, dark_view(), &options, by_embree, 2);
      double mean = 0;
      unsigned seen = 0;
      for (uint32_t y = 0; y < options.height; y++)
        for (uint32_t x = 0; x < options.width; x++) {
          const double dx = x + 0.5 - 48, dy = y + 0.5 - 27;
          if (dx * dx + dy * dy < 15 * 15) { /* the sphere's radius is 16.5 pixels */
            mean += (double)picture.radiance[3 * (y * options.width + x)];
            seen++;
          }
        }
      mean /= seen;
      /* Smooth normals let some ways lead into the body, at its rim. */
      if (mean < least[i] - (smooth ? 0.01 : 0) || mean > most[i])
        print_error("body %d, smooth %d: %g\n", i, smooth, mean);
      assert_true(mean >= least[i] - (smooth ? 0.01 : 0) && mean <= most[i]);
      trax_picture_release(&picture);
      trax_scene_release(&scene);
    }
}

/* A closed body is from outside what it is without its back faces, and from inside nothing. */
static void test_one_side(void **state) {
  (void)state;
  struct trax_scene scene = sphere_scene(1, &trax_default_material);
  struct trax_view view = view_from(0, 0, 3, 0, 0, -1, 60, 2, 3, 4);
  struct trax_frame_options options = plain;
  struct trax_difference difference;
  struct trax_picture both = shoot(&scene, &view, &options, by_embree, 2);
  options.one_sided = true;
  struct trax_picture one = shoot(&scene, &view, &options, by_embree, 2);
  trax_picture_compare(&difference, &both, &one, 1);
  assert_true(difference.beyond <= 5 && background_pixels(&one) < one.width * one.height - 500);
  trax_picture_release(&both);
  trax_picture_release(&one);
  view.eye[2] = 0;
  one = shoot(&scene, &view, &options, by_embree, 2);
  assert_int_equal(background_pixels(&one), one.width * one.height);
  trax_picture_release(&one);
  trax_scene_release(&scene);
}

/* Boxes whose normals are smooth across their edges: at many points these are turned away from the eye. */
static void test_bent_surfaces(void **state) {
  (void)state;
  for (uint32_t kind = TRAX_MATERIAL_LAMBERT; kind < TRAX_MATERIAL_KINDS; kind++) {
    struct trax_mesh mesh = {0};
    const uint32_t body = mesh_material(&mesh, 0.5f, 0.6f, 0.7f), floor = mesh_material(&mesh, 0.7f, 0.3f, 0.2f);
    struct trax_material *material = &mesh.materials[body].surface;
    material->kind = kind, material->ior = 1.4f, material->roughness = 0.3f;
    memcpy(material->specular, (float[]){0.9f, 0.8f, 0.9f}, sizeof material->specular);
    mesh_box(&mesh, (float[]){-1.6f, -0.5f, -0.5f}, (float[]){-0.2f, 0.5f, 0.5f}, body);
    mesh_box(&mesh, (float[]){0.1f, -0.5f, -1.5f}, (float[]){0.9f, 0.5f, 0.8f}, body);
    mesh_box(&mesh, (float[]){-3, -0.8f, -3}, (float[]){3, -0.6f, 3}, floor);
    struct trax_scene scene = scene_of(&mesh, &(struct trax_build_options){.smooth = true, .crease_degrees = 180});
    const struct trax_view view = view_from(0.2f, 1.6f, 3, 0, -0.5f, -1, 45, 2, 3, 1);
    struct trax_frame_options options = plain;
    options.smooth = true;
    struct trax_picture twin = shoot(&scene, &view, &options, false, 2);
    struct trax_picture other = shoot(&scene, &view, &options, true, 0);
    struct trax_difference difference;
    trax_picture_compare(&difference, &twin, &other, 2);
    if (difference.beyond > 5)
      print_error("kind %u: %llu pixels beyond 2/255\n", kind, (unsigned long long)difference.beyond);
    assert_true(difference.beyond <= 5);
    trax_picture_release(&twin);
    trax_picture_release(&other);
    trax_scene_release(&scene);
  }
}

/* --- two ways to the same light --- */

static void wide_floor(struct trax_mesh *mesh, float width, uint32_t material) {
  mesh_quad(mesh, (float[][3]){{-width, 0, -width}, {width, 0, -width}, {width, 0, width}, {-width, 0, width}},
            material);
}

static void floor_mesh(struct trax_mesh *mesh, bool lamp) {
  const uint32_t grey = mesh_material(mesh, 0.6f, 0.6f, 0.6f), bright = mesh_material(mesh, 0, 0, 0);
  wide_floor(mesh, 3, grey);
  mesh_box(mesh, (float[]){-0.3f, 0, -0.3f}, (float[]){0.3f, 0.4f, 0.3f}, grey);
  const float height = lamp ? 1 : -1; /* below the floor it does nothing */
  mesh_quad(mesh,
            (float[][3]){{-0.8f, height, -0.5f}, {0.2f, height, -0.5f}, {0.2f, height, 0.5f}, {-0.8f, height, 0.5f}},
            bright);
  for (int channel = 0; channel < 3; channel++)
    mesh->materials[bright].surface.emission[channel] = 2;
}

/* A rectangle of the view, without paths and with them; a lamp of the same place and radiance, found by shadow rays and
   by chance, and by chance alone; and through holes: all shine alike on a floor. */
static void test_rectangles_and_lamps(void **state) {
  (void)state;
  double means[5];
  for (int way = 0; way < 5; way++) {
    struct trax_mesh mesh = {0};
    floor_mesh(&mesh, way >= 2);
    if (way == 3)
      mesh.materials[1].surface.alpha_cutoff = 0.5f; /* it has no holes, but shadow rays leave it out */
    if (way == 4) {                                  /* sheets of holes between floor and lamp */
      const uint32_t hole = mesh_material(&mesh, 0, 0, 0);
      mesh.materials[hole].surface.alpha_cutoff = 0.5f, mesh.materials[hole].surface.opacity = 0;
      for (int i = 0; i < 3; i++)
        mesh_box(&mesh, (float[]){-2, 0.5f + 0.1f * (float)i, -2}, (float[]){2, 0.55f + 0.1f * (float)i, 2}, hole);
    }
    struct trax_scene scene = scene_of(&mesh, NULL);
    struct trax_view view = view_from(0, 0.9f, 2.9f, 0, -0.5f, -1, 40, 0, 0, 0);
    view.light_count = 1;
    view.lights[0] = (struct trax_light){.kind = TRAX_LIGHT_RECTANGLE,
                                         .position = {-0.8f, 1, -0.5f},
                                         .direction = {0, -1, 0},
                                         .edges = {{1, 0, 0}, {0, 0, 1}},
                                         .colour = {1, 1, 1},
                                         .strength = way < 2 ? 2 : 0};
    struct trax_frame_options options = plain;
    options.floats = true, options.ambient = 0, options.background = 0xFF000000u;
    options.width = 64, options.height = 36;
    options.samples = way == 3 ? 512 : 64;
    options.paths = way > 0;
    struct trax_picture picture = shoot(&scene, &view, &options, by_embree, 2);
    mean_of(&picture);
    double sum = 0;
    for (uint32_t y = options.height / 2; y < options.height; y++) /* below the lamp itself */
      for (uint32_t x = 0; x < options.width; x++)
        sum += (double)picture.radiance[3 * (y * options.width + x)];
    means[way] = sum;
    trax_picture_release(&picture);
    trax_scene_release(&scene);
  }
  assert_true(means[0] > 10);
  for (int way = 1; way < 5; way++) {
    if (fabs(means[way] / means[0] - 1) > 0.005)
      print_error("way %d: %g instead of %g\n", way, means[way], means[0]);
    assert_true(fabs(means[way] / means[0] - 1) < 0.005);
  }
}

/* A leaf that is one hole is not there. */
static void test_holes_are_nothing(void **state) {
  (void)state;
  struct trax_picture pictures[2][2]; /* without paths and with them; without leaves and with them */
  for (int leaves = 0; leaves < 2; leaves++) {
    struct trax_mesh mesh = {0};
    const uint32_t hole = mesh_material(&mesh, 1, 0, 0);
    mesh.materials[hole].surface.alpha_cutoff = 0.5f;
    mesh.materials[hole].surface.opacity = 0.25f;
    floor_mesh(&mesh, true);
    for (int i = 0; leaves && i < 5; i++)
      mesh_box(&mesh, (float[]){-1 - 0.1f * (float)i, 0.1f, -1}, (float[]){1 + 0.1f * (float)i, 0.8f, 1}, hole);
    struct trax_scene scene = scene_of(&mesh, NULL);
    struct trax_view view = view_from(0, 0.9f, 2.9f, 0, -0.5f, -1, 40, 1, 2, 1);
    struct trax_frame_options options = plain;
    options.floats = true;
    pictures[0][leaves] = shoot(&scene, &view, &options, by_embree, 2);
    options.paths = 3, options.samples = 16;
    pictures[1][leaves] = shoot(&scene, &view, &options, by_embree, 2);
    trax_scene_release(&scene);
  }
  for (int paths = 0; paths < 2; paths++) {
    struct trax_difference difference;
    trax_picture_compare(&difference, &pictures[paths][0], &pictures[paths][1], 2);
    const double light = mean_of(&pictures[paths][1]) / mean_of(&pictures[paths][0]) - 1;
    if (difference.floats_beyond > 5 || fabs(light) > 2e-4)
      print_error("paths %d: %llu pixels beyond 2/255, light %+g\n", paths,
                  (unsigned long long)difference.floats_beyond, light);
    assert_true(difference.floats_beyond <= 5 && fabs(light) <= 2e-4);
    trax_picture_release(&pictures[paths][0]);
    trax_picture_release(&pictures[paths][1]);
  }
}

/* --- light comes from the point --- */

/* A floor so wide that shadow rays start far above it, and a lamp near it: the light is that on a small floor. */
static struct trax_picture near_lamp(float width, int lamp, const struct trax_frame_options *options) {
  struct trax_mesh mesh = {0};
  const uint32_t grey = mesh_material(&mesh, 0.6f, 0.6f, 0.6f), bright = mesh_material(&mesh, 0, 0, 0);
  wide_floor(&mesh, width, grey);
  if (lamp == 3) {
    mesh_quad(&mesh, (float[][3]){{-1, 1, -0.5f}, {0, 1, -0.5f}, {0, 1, 0.5f}, {-1, 1, 0.5f}}, bright);
    mesh.materials[bright].surface.emission[0] = 2;
  }
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = view_from(0.4f, 0.9f, 0.5f, 0, -1, -0.01f, 60, 0.3f, 1, 0.2f);
  const struct trax_light lights[] = {{0},
                                      {.position = {0.3f, 1, 0.2f}, .falloff = 1, .strength = 1, .colour = {1, 1, 1}},
                                      {.kind = TRAX_LIGHT_RECTANGLE,
                                       .position = {-1, 1, -0.5f},
                                       .direction = {0, -1, 0},
                                       .edges = {{1, 0, 0}, {0, 0, 1}},
                                       .colour = {1, 1, 1},
                                       .strength = 2},
                                      {.strength = 0}};
  view.light_count = lamp > 0;
  view.lights[0] = lights[lamp];
  struct trax_picture picture = shoot(&scene, &view, options, by_embree, 2);
  trax_scene_release(&scene);
  return picture;
}

static void test_near_lamps(void **state) {
  (void)state;
  for (int lamp = 0; lamp < 4; lamp++) /* a plain light, one with falloff, a rectangle, triangles */
    for (uint32_t paths = lamp == 3; paths < 2; paths++) {
      struct trax_frame_options options = plain;
      options.ambient = 0, options.background = 0xFF000000u, options.floats = lamp > 0;
      options.paths = paths, options.samples = paths ? 256 : 1;
      options.width = 32, options.height = 18;
      struct trax_picture small = near_lamp(10, lamp, &options), wide = near_lamp(2000, lamp, &options);
      struct trax_difference difference;
      trax_picture_compare(&difference, &small, &wide, 0);
      const double light = trax_picture_light(&wide) / trax_picture_light(&small) - 1;
      if (difference.most > 1.5 || difference.largest > 1 || fabs(light) > 1e-3)
        print_error("lamp %d, paths %u: off by up to %g/255, light %+g\n", lamp, paths, difference.most, light);
      assert_true(difference.most <= 1.5 && difference.largest <= 1 && fabs(light) <= 1e-3);
      trax_picture_release(&small);
      trax_picture_release(&wide);
    }
}

/* Exact hits, too: a floor of 2 x 10^5, and the light 1 above it. */
static void test_exact_hits(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  wide_floor(&mesh, 1e5f, mesh_material(&mesh, 0.5625f, 0.5625f, 0.5625f));
  struct trax_scene scene = scene_of(&mesh, NULL);
  const struct trax_view view = view_from(0, 5, 0, 0, -1, -0.01f, 1, 0, 1, 0);
  struct trax_frame_options options = plain;
  options.ambient = 0;
  struct trax_picture picture = shoot(&scene, &view, &options, by_embree, 2);
  for (size_t i = 0; i < (size_t)options.width * options.height; i++)
    assert_in_range(picture.pixels[i] & 255, 190, 191); /* the root of 0.5625 */
  trax_picture_release(&picture);
  trax_scene_release(&scene);
}

/* Embree's picture takes lights, depth, reach, seed and background from view, scene and options. */
static void test_embree_has_its_own_parameters(void **state) {
  (void)state;
  struct trax_scene scene = gallery_scene(GALLERY_ALL);
  for (int kind = 0; kind < 3; kind++) {
    const struct trax_view view = gallery_view(3);
    struct trax_frame_options options = plain;
    options.floats = true, options.samples = 2, options.seed = 5;
    options.paths = kind == 1 ? 3 : 0, options.occlusion = kind == 2 ? 4 : 0;
    struct trax_picture picture = shoot_frame(&scene, &view, &options, true, 0, false);
    struct trax_picture other = shoot_frame(&scene, &view, &options, true, 0, true);
    assert_memory_equal(picture.radiance, other.radiance, count_of(&picture) * sizeof(float));
    assert_true(mean_of(&picture) > 0.1);
    trax_picture_release(&picture);
    trax_picture_release(&other);
  }
  trax_scene_release(&scene);
}

/* --- nothing that a file may say leads to infinity --- */

static float extreme(uint32_t *seed, float most) {
  const float choices[] = {0, most, 0.5f * most, 0x1p-20f * most};
  return choices[(unsigned)(4 * random_unit(seed))];
}

static void test_hostile_materials(void **state) {
  (void)state;
  uint32_t seed = 11;
  for (int round = 0; round < 12; round++) {
    struct trax_mesh mesh = {0};
    for (uint32_t i = 0; i < 16; i++) {
      mesh_material(&mesh, 0, 0, 0);
      struct trax_material *material = &mesh.materials[i].surface;
      material->kind = (uint32_t)(4 * random_unit(&seed));
      for (int k = 0; k < 3; k++) {
        material->diffuse[k] = extreme(&seed, 1), material->specular[k] = extreme(&seed, 1);
        material->emission[k] = i % 4 ? 0 : extreme(&seed, TRAX_SCENE_MAX_EMISSION);
      }
      material->roughness = extreme(&seed, 1), material->ior = 1 + extreme(&seed, TRAX_SCENE_MAX_IOR - 1);
      material->opacity = extreme(&seed, 1), material->alpha_cutoff = i % 3 ? 0 : extreme(&seed, 1);
    }
    mesh_soup(&mesh, 600, (uint32_t)round + 1);
    for (uint32_t i = 0; i < mesh.triangle_count; i++)
      mesh.triangles[i].material = (uint32_t)(16 * random_unit(&seed));
    mesh_box(&mesh, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, (uint32_t)round);
    struct trax_scene scene = scene_of(&mesh, &(struct trax_build_options){.smooth = true});
    struct trax_view view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 0, 0, 0);
    view.light_count = 4;
    for (int i = 0; i < 4; i++) /* two in corners of the box, one on a vertex, one of no area */
      view.lights[i] = (struct trax_light){.kind = i == 1  ? TRAX_LIGHT_DIRECTIONAL
                                                   : i > 1 ? TRAX_LIGHT_RECTANGLE
                                                           : TRAX_LIGHT_POINT,
                                           .position = {1, 1, i == 0 ? 1 : -1},
                                           .direction = {0, i == 1 ? -1 : 1, 0},
                                           .edges = {{i == 3 ? 0x1p-40f : 2, 0, 0}, {0, 0, i == 3 ? 0x1p-40f : 2}},
                                           .colour = {1, 0, 1},
                                           .strength = TRAX_VIEW_MAX_STRENGTH,
                                           .falloff = round & 1 ? 1000 : 0};
    struct trax_frame_options options = plain;
    options.floats = true, options.smooth = round & 2;
    struct trax_picture direct = shoot(&scene, &view, &options, by_embree, 2);
    struct trax_picture other = shoot(&scene, &view, &options, !by_embree, 2);
    struct trax_difference difference;
    trax_picture_compare(&difference, &direct, &other, 2);
    assert_true(difference.beyond <= 100); /* of 5184 pixels; a light on a vertex is before its triangles or behind */
    assert_true(mean_of(&direct) > 0 && mean_of(&other) > 0);
    trax_picture_release(&other);
    options.paths = TRAX_RENDER_MAX_DEPTH, options.samples = 2, options.seed = (uint32_t)round;
    struct trax_picture picture = shoot(&scene, &view, &options, by_embree, 2);
    assert_true(mean_of(&picture) > 0);
    trax_picture_release(&direct);
    trax_picture_release(&picture);
    trax_scene_release(&scene);
  }
}

int main(void) {
  const struct CMUnitTest pictures[] = {
      cmocka_unit_test(test_combinations),  cmocka_unit_test(test_floats_are_the_picture),
      cmocka_unit_test(test_scale),         cmocka_unit_test(test_paths_of_any_number_of_threads),
      cmocka_unit_test(test_bent_surfaces), cmocka_unit_test(test_embree_has_its_own_parameters),
  };
  const struct CMUnitTest laws[] = {
      cmocka_unit_test(test_lights_add_up),        cmocka_unit_test(test_furnace_from_inside),
      cmocka_unit_test(test_furnace_from_outside), cmocka_unit_test(test_one_side),
      cmocka_unit_test(test_rectangles_and_lamps), cmocka_unit_test(test_holes_are_nothing),
      cmocka_unit_test(test_near_lamps),           cmocka_unit_test(test_exact_hits),
      cmocka_unit_test(test_hostile_materials),
  };
  int failures = cmocka_run_group_tests_name("both renderers", pictures, NULL, NULL);
  failures += cmocka_run_group_tests_name("laws, the twin", laws, NULL, NULL);
  by_embree = true;
  return failures + cmocka_run_group_tests_name("laws, Embree", laws, NULL, NULL);
}
