/* Hits of instances, natively, against exact arithmetic and Embree's instances: transforms of many kinds, from inside
   and outside. Within a mesh there is no hole, whatever the transform. */
#include "hits.h"
#include "matrices.h"
#include "meshes.h"
#include "placed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include <cmocka.h>

enum { WIDTH = 64, HEIGHT = 40, PIXELS = WIDTH * HEIGHT, MOST = 16 };

static void place(struct trax_mesh *mesh, uint32_t part, struct matrix transform) {
  struct trax_mesh_instance *out = &mesh->instances[mesh->instance_count++];
  *out = (struct trax_mesh_instance){.part = part, .material = TRAX_NO_MATERIAL};
  memcpy(out->transform, transform.m, sizeof out->transform);
}

/* Part 0 is the mesh so far; ends it. */
static void end_part(struct trax_mesh *mesh) {
  if (!mesh->parts) {
    mesh->parts = calloc(MOST, sizeof *mesh->parts);
    mesh->instances = calloc(MOST, sizeof *mesh->instances);
    assert_true(mesh->parts && mesh->instances);
  }
  const struct trax_mesh_part *last = mesh->part_count ? &mesh->parts[mesh->part_count - 1] : NULL;
  const uint32_t first = last ? last->first_triangle + last->triangle_count : 0, count = mesh->triangle_count - first;
  mesh->parts[mesh->part_count++] = (struct trax_mesh_part){first, count, count};
  for (uint32_t i = 0; i < count; i++)
    mesh->triangles[first + i].source_id = i;
}

static void find(struct trax_hits *hits, const struct trax_frame *frame, int finder) {
  struct trax_render_run run = {0};
  trax_error error;
  const trax_status status = finder == 0   ? trax_hits_native(hits, frame, 2, &run, &error)
                             : finder == 1 ? trax_hits_embree(hits, frame, &run, &error)
                                           : trax_hits_exact(hits, frame, &run, &error);
  if (status != TRAX_OK)
    fail_msg("%s", error.message);
}

/* Pixels where both hit the same triangle, or triangles at one place. Which of those Embree finds depends on the width
   of the host's vectors. */
static uint64_t same_places(const struct trax_hits *a, const struct trax_hits *b, const struct trax_scene *scene) {
  uint64_t same = 0;
  for (int i = 0; i < PIXELS; i++) {
    struct placed_triangle one, other;
    bool equal = a->triangles[i] == b->triangles[i];
    if (!equal && a->triangles[i] != TRAX_NO_TRIANGLE && b->triangles[i] != TRAX_NO_TRIANGLE) {
      trax_place(&one, scene, a->triangles[i]);
      trax_place(&other, scene, b->triangles[i]);
      equal = memcmp(&one.triangle, &other.triangle, 9 * sizeof(float)) == 0;
    }
    same += equal;
  }
  return same;
}

/* least: pixels that hit the nearest triangle for certain; closed: every ray hits something. */
static void check(const char *name, struct trax_mesh *mesh, struct trax_view view, uint64_t least, bool closed) {
  struct trax_frame frame = {0};
  struct trax_hits device, embree, exact;
  struct trax_hits_difference difference;
  const struct trax_frame_options options = {.width = WIDTH, .height = HEIGHT, .samples = 1};
  trax_error error;
  struct trax_scene scene = scene_of(mesh, NULL);
  if (trax_scene_check(NULL, scene.bytes, scene.size, name, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  normalise(&scene, &view);
  if (trax_frame_init(&frame, &scene, &view, &options, &error) != TRAX_OK)
    fail_msg("%s: %s", name, error.message);
  assert_true(frame.params->features & TRAX_FEATURE_BIT(INSTANCES));
  find(&device, &frame, 0);
  find(&embree, &frame, 1);
  find(&exact, &frame, 2);
  trax_hits_judge(&difference, &device, &exact, &frame);
  uint64_t hit = 0;
  for (int i = 0; i < PIXELS; i++)
    hit += device.triangles[i] != TRAX_NO_TRIANGLE;
  if (getenv("TRAX_TEST_VERBOSE"))
    printf("%-24s %5llu same %4llu tied %4llu of Embree's, %llu hit\n", name, (unsigned long long)difference.same,
           (unsigned long long)difference.tied, (unsigned long long)trax_hits_same(&device, &embree, &frame),
           (unsigned long long)hit);
  if (difference.holes + difference.wrong)
    fail_msg("%s: %llu holes and %llu wrong hits, the first at (%u, %u)", name, (unsigned long long)difference.holes,
             (unsigned long long)difference.wrong, difference.x, difference.y);
  if (difference.same < least)
    fail_msg("%s: only %llu hits are the nearest", name, (unsigned long long)difference.same);
  const uint64_t of_embree = same_places(&device, &embree, &scene);
  if (of_embree < least)
    fail_msg("%s: only %llu hits are Embree's", name, (unsigned long long)of_embree);
  assert_true(closed ? hit == PIXELS : hit > PIXELS / 8);
  trax_hits_release(&device);
  trax_hits_release(&embree);
  trax_hits_release(&exact);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
}

/* The transforms of a family; each places a sphere or a soup of radius 1 about `middle`, of size about `size`. */
static const struct family {
  const char *name;
  double scale, offset;
  bool mirrored, flat, nested;
} families[] = {
    {"plain", 1, 0, false, false, false},
    {"scale-1e-3", 1e-3, 0, false, false, false},
    {"scale-1e3", 1e3, 0, false, false, false},
    {"mirrored", 1, 0, true, false, false},
    {"flat", 1, 0, false, true, false},
    {"nested-twice", 1, 0, true, true, true},
    {"offset-1e6", 100, 1e6, false, false, false},
    {"offset-1e6-all", 100, 1e6, true, true, true},
    {"scale-1e-3-all", 1e-3, 2, true, true, true},
    {"scale-1e3-all", 1e3, -1e4, true, true, true},
};
enum { FAMILIES = sizeof families / sizeof *families };

static struct matrix inner(const struct family *family, double turn) {
  struct matrix t = product(turned(turn, 0), turned(0.3 + turn, 1));
  if (family->flat)
    t = product(product(t, scaled(1, 0.05, 0.7)), turned(0.7, 2));
  if (family->mirrored)
    t = product(t, scaled(-1, 1, 1));
  return t;
}

static struct matrix whole(const struct family *family, double turn, double x, double y, double z) {
  struct matrix t = inner(family, turn);
  if (family->nested) /* in a group that is in a group */
    t = product(product(moved(0.1, -0.2, 0.05), turned(1, 2)),
                product(scaled(1.5, 0.8, 1.1), product(turned(-2, 0), t)));
  t = product(scaled(family->scale, family->scale, family->scale), product(moved(x, y, z), t));
  return product(moved(family->offset, -family->offset, 0.5 * family->offset), t);
}

static struct trax_view view_of(const struct family *family, double x, double y, double z, double forward, float fov) {
  const double s = family->scale, o = family->offset;
  return view_from((float)(o + s * x), (float)(-o + s * y), (float)(0.5 * o + s * z), 0.02f, 0.013f, (float)forward,
                   fov, (float)(o + 4 * s), (float)(-o + 5 * s), (float)(0.5 * o + 6 * s));
}

/* Some 100 of 2,560 pixels look at an edge or past a silhouette when coordinates are a million. */
static void test_families(void **state) {
  (void)state;
  for (int i = 0; i < FAMILIES; i++) {
    const struct family *family = &families[i];
    const uint64_t unsure = family->offset >= 1e6 ? 200 : 20;
    struct trax_mesh mesh = {0};
    mesh_sphere(&mesh, 1, 4, 0);
    end_part(&mesh);
    mesh_soup(&mesh, 300, 5);
    end_part(&mesh);
    place(&mesh, 0, whole(family, 0.4, 0, 0, 0));
    place(&mesh, 0, whole(family, 1.9, 1.4, 0.2, -0.8));
    place(&mesh, 1, whole(family, 2.3, -1.2, -0.3, 0.4));
    place(&mesh, 1, whole(family, -0.9, 0.3, 1.1, -1));
    check(family->name, &mesh, view_of(family, 0.1, 0.2, 4, -1, 45), PIXELS - unsure, false);
  }
}

static void test_inside(void **state) {
  (void)state;
  for (int i = 0; i < FAMILIES; i++) {
    struct family family = families[i];
    family.flat = false; /* the eye is inside */
    struct trax_mesh mesh = {0};
    mesh_sphere(&mesh, 1, 4, 0);
    end_part(&mesh);
    place(&mesh, 0, whole(&family, 0.4, 0, 0, 0));
    check(family.name, &mesh, view_of(&family, 0.05, -0.1, 0.02, -1, 120), PIXELS - (family.offset >= 1e6 ? 200 : 20),
          true);
  }
}

/* The mesh is a million away from its own origin, and its place is near the scene's. The ray in the mesh is then off by
   a thousandth of the sphere, which boxes must allow for. */
static void test_far_mesh(void **state) {
  (void)state;
  const struct matrix near = product(turned(0.4, 0), product(turned(1.1, 1), moved(-1e6, 1e6, -5e5)));
  for (int inside = 0; inside < 2; inside++) {
    struct trax_mesh mesh = {0};
    mesh_sphere(&mesh, 1, 4, 0);
    mesh_transform(&mesh, 100, 1e6f, -1e6f, 5e5f);
    end_part(&mesh);
    place(&mesh, 0, near);
    check(inside ? "far-mesh-inside" : "far-mesh", &mesh,
          inside ? view_from(5, -10, 2, 0.02f, 0.013f, -1, 120, 4, 5, 6)
                 : view_from(10, 20, 400, 0.02f, 0.013f, -1, 45, 4, 5, 6),
          PIXELS - 400, inside);
  }
}

/* Everything twice at one place: which of two instances is visible depends on neither tree nor traversal. */
static void test_ties(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 200, 3);
  end_part(&mesh);
  for (int i = 0; i < 4; i++)
    place(&mesh, 0, i % 2 ? scaled(0.5, 0.5, 0.5) : scaled(1, 1, 1));
  check("ties", &mesh, view_from(0.1f, 0.2f, 3, 0, 0, -1, 45, 2, 2, 2), PIXELS, false);
}

/* A lamp that is placed nowhere would light the scene unseen. */
static void test_lamp_nowhere(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene = {0};
  trax_error error = {.message = ""};
  mesh_sphere(&mesh, 1, 1, 0);
  end_part(&mesh);
  const uint32_t lamp = mesh_material(&mesh, 0, 0, 0);
  mesh.materials[lamp].surface.emission[0] = 1;
  mesh_box(&mesh, (float[]){-1, 2, -1}, (float[]){1, 3, 1}, lamp);
  end_part(&mesh);
  place(&mesh, 0, scaled(1, 1, 1));
  assert_int_equal(trax_scene_build(&scene, &mesh, &(struct trax_build_options){.max_leaf = 2}, &error), TRAX_ERROR);
  assert_non_null(strstr(error.message, "mesh 1 emits light and is placed nowhere"));
  place(&mesh, 1, scaled(1, 1, 1));
  build(&scene, &mesh, NULL);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* --- damaged files --- */

/* Two meshes at five places, with all that an instance may have. */
static struct trax_scene crowd(void) {
  struct trax_mesh mesh = {0};
  const uint32_t glass = mesh_material(&mesh, 1, 1, 1);
  mesh.materials[glass].surface.kind = TRAX_MATERIAL_GLASS;
  mesh.materials[glass].surface.ior = 1.5f;
  mesh_box(&mesh, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, mesh_material(&mesh, 0.5f, 0.6f, 0.7f));
  end_part(&mesh);
  mesh_soup(&mesh, 20, 5);
  end_part(&mesh);
  for (int i = 0; i < 5; i++) {
    place(&mesh, i % 2, product(moved(i - 2.0, 0.5 * i, 0.2), product(turned(i, 2), scaled(1, 1, i == 4 ? -0.5 : 1))));
    mesh.instances[i].material = i == 3 ? glass : TRAX_NO_MATERIAL;
  }
  return scene_of(&mesh, &(struct trax_build_options){.smooth = true, .max_leaf = 2});
}

static void change(uint32_t *words, uint32_t count, uint32_t *seed) {
  static const uint32_t steps[] = {1, 2, 4, 7, 8, 16, 40, 64, 128, 0x80000000u, 0x7F800000u, 0x00800000u, 0xFFFFFFFFu};
  const uint32_t structure = 64 + 80; /* the header, sections and first nodes */
  const uint32_t at = (uint32_t)(random_unit(seed) * (random_unit(seed) < 0.6f ? (float)count : (float)structure));
  const uint32_t step = steps[(uint32_t)(random_unit(seed) * 13)];
  switch ((uint32_t)(random_unit(seed) * 5)) {
  case 0:
    words[at] += step;
    break;
  case 1:
    words[at] -= step;
    break;
  case 2:
    words[at] ^= 1u << (uint32_t)(random_unit(seed) * 32);
    break;
  case 3:
    words[at] = words[(uint32_t)(random_unit(seed) * (float)count)];
    break;
  default:
    words[at] = step;
  }
}

/* Runs every part of the renderer on a file that was accepted, and compares the hits of some. */
static void render_changed(struct trax_scene *scene, unsigned number, bool compare) {
  struct trax_view view = view_from(0, 0.5f, 9, 0, 0, -1, 45, 4, 5, 6);
  const struct trax_frame_options options = {.width = 6,
                                             .height = 4,
                                             .samples = 1,
                                             .shadows = true,
                                             .smooth = number & 1,
                                             .paths = number & 2 ? 3 : 0,
                                             .one_sided = number & 4};
  struct trax_frame frame = {0};
  struct trax_picture picture = {0};
  struct trax_render_run run = {0};
  struct trax_hits hits[3];
  struct trax_hits_difference difference;
  trax_error error;
  int exponent;
  if (trax_normalise(scene, &view, &exponent, &error) == TRAX_OK &&
      trax_frame_init(&frame, scene, &view, &options, &error) == TRAX_OK) {
    assert_int_equal(trax_render_twin(&picture, &frame, 1, &run, &error), TRAX_OK);
    trax_picture_release(&picture);
    for (int finder = 0; finder < 3 && compare; finder++)
      find(&hits[finder], &frame, finder);
    if (compare)
      trax_hits_judge(&difference, &hits[0], &hits[2], &frame);
    for (int finder = 0; finder < 3 && compare; finder++)
      trax_hits_release(&hits[finder]);
    if (compare && difference.holes + difference.wrong)
      fail_msg("changed file %u: %llu holes and %llu wrong hits", number, (unsigned long long)difference.holes,
               (unsigned long long)difference.wrong);
  }
  trax_frame_release(&frame);
}

/* Words of a file are changed by chance, and the file is sealed: it is refused with its name and a reason, or
   renders. */
static void test_sealed_changes(void **state) {
  (void)state;
  struct trax_scene scene = crowd(), changed = {0};
  const char *const asked = getenv("TRAX_TEST_DAMAGES");
  const unsigned count = asked ? (unsigned)strtoul(asked, NULL, 10) : 10000;
  unsigned accepted = 0;
  uint32_t seed = 1;
  uint32_t *bytes = aligned_alloc(64, scene.size);
  assert_non_null(bytes);
  for (unsigned number = 0; number < count; number++) {
    memcpy(bytes, scene.bytes, scene.size);
    for (int changes = random_unit(&seed) < 0.5f ? 1 : 2; changes > 0; changes--)
      change(bytes, (uint32_t)(scene.size / 4), &seed);
    struct trax_scene_header *header = (struct trax_scene_header *)(void *)bytes;
    header->checksum = 0;
    header->checksum = (uint32_t)crc32_z(0, (unsigned char *)bytes, scene.size);
    trax_error error = {.message = ""};
    if (trax_scene_check(&changed, bytes, scene.size, "scene", &error) != TRAX_OK) {
      assert_true(strncmp(error.message, "scene: ", 7) == 0);
      continue;
    }
    changed.bytes = bytes;
    render_changed(&changed, number, accepted++ % 8 == 0);
  }
  if (getenv("TRAX_TEST_VERBOSE"))
    printf("%u of %u changed files accepted\n", accepted, count);
  assert_true(accepted > count / 20 && accepted < count / 4);
  free(bytes);
  trax_scene_release(&scene);
}

/* The reader computes the words that follow from the matrix and the mesh again, to the last bit. */
static void test_derived_words(void **state) {
  (void)state;
  static const size_t derived[] = {
      offsetof(struct trax_instance, to_object),    offsetof(struct trax_instance, to_object[2][2]),
      offsetof(struct trax_instance, root),         offsetof(struct trax_instance, stretch),
      offsetof(struct trax_instance, flags),        offsetof(struct trax_instance, spread),
      offsetof(struct trax_instance, first_number), offsetof(struct trax_instance, reserved)};
  struct trax_scene scene = crowd();
  struct trax_scene_header *header = scene.bytes;
  for (size_t i = 0; i < sizeof derived / sizeof *derived; i++) {
    uint32_t *word = (uint32_t *)(void *)((char *)scene.instances + derived[i]);
    trax_error error = {.message = ""};
    *word ^= 1;
    header->checksum = 0;
    header->checksum = (uint32_t)crc32_z(0, scene.bytes, scene.size);
    assert_int_equal(trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error), TRAX_ERROR);
    assert_non_null(strstr(error.message, "instance 0: "));
    *word ^= 1;
  }
  trax_scene_release(&scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_families),      cmocka_unit_test(test_inside),       cmocka_unit_test(test_far_mesh),
      cmocka_unit_test(test_ties),          cmocka_unit_test(test_lamp_nowhere), cmocka_unit_test(test_sealed_changes),
      cmocka_unit_test(test_derived_words),
  };
  return cmocka_run_group_tests_name("instances", tests, NULL, NULL);
}
