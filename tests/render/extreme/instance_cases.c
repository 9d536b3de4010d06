/* Cases of instances: a closed globe with triangles in it, two of whose groups contain one another, written as files
   and imported. The importer multiplies matrices, and rounds each product once: also that is checked. */
#include "../matrices.h"
#include "cases.h"
#include "temporary.h"

#include <stdlib.h>
#include <string.h>

static void fail(const char *what) {
  fprintf(stderr, "render-extreme: error: instances: %s\n", what);
  exit(1);
}

/* --- files --- */

static FILE *create(const char *name) {
  FILE *file = fopen(test_path(name), "w");
  if (!file)
    fail("no temporary file");
  return file;
}

static void write_mesh(const char *name, const struct trax_mesh *mesh) {
  FILE *file = create(name);
  for (uint32_t i = 0; i < mesh->vertex_count; i++)
    fprintf(file, "v %.9g %.9g %.9g\n", (double)mesh->vertices[i][0], (double)mesh->vertices[i][1],
            (double)mesh->vertices[i][2]);
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    const uint32_t *v = mesh->triangles[i].vertices;
    fprintf(file, "f %u %u %u\n", v[0] + 1, v[1] + 1, v[2] + 1);
  }
  fclose(file);
}

static void write_place(FILE *file, const char *name, const struct matrix *matrix) {
  fprintf(file, "place %s", name);
  for (int i = 0; i < 12; i++)
    fprintf(file, " %.17g", matrix->m[i / 4][i % 4]);
  fputc('\n', file);
}

/* --- families --- */

static const struct family {
  double scale, offset;
  double away; /* of the meshes from their own origin */
  bool turned, mirrored, flat, nested;
} families[] = {
    {.scale = 1e-3},
    {.scale = 1e3},
    {.scale = 1, .turned = true},
    {.scale = 1, .turned = true, .mirrored = true},
    {.scale = 1, .turned = true, .flat = true},
    {.scale = 1, .turned = true, .mirrored = true, .flat = true, .nested = true},
    {.scale = 100, .offset = 1e6},
    {.scale = 100, .away = 1e4, .turned = true},
    {.scale = 1e-3, .offset = 2, .turned = true, .mirrored = true, .flat = true, .nested = true},
    {.scale = 1e3, .offset = 1e6, .turned = true, .mirrored = true, .flat = true, .nested = true},
};

enum { SOUPS = 3, INSTANCES = 1 + SOUPS };

/* Where the room is, the group in it, and what the group has; and what each instance's matrix should be. */
struct places {
  struct matrix room, group, soups[SOUPS];
};

static void plan(struct places *places, const struct family *family) {
  const double s = family->scale, o = family->offset, away = family->away;
  struct matrix own = identity;
  if (family->turned)
    own = product(turned(0.4, 0), turned(1.1, 1));
  if (family->flat)
    own = product(product(own, scaled(1, 0.1, 0.7)), turned(0.7, 2));
  if (family->mirrored)
    own = product(own, scaled(-1, 1, 1));
  places->room = product(product(moved(o, -o, 0.5 * o), scaled(s, s, s)), product(own, moved(-away, away, -away / 2)));
  places->group = identity;
  if (family->nested) /* also what is not a rotation may be within another such */
    places->group = product(product(moved(0.02, -0.03, 0.01), turned(1, 2)), scaled(0.9, 1.1, 0.8));
  for (int i = 0; i < SOUPS; i++) {
    const double angle = 2.1 * i + 0.3;
    const struct matrix at = moved(away + 0.6 * cos(angle), -away + 0.6 * sin(angle), away / 2 + 0.2 * i - 0.2);
    places->soups[i] = product(at, product(product(turned(angle, 1), scaled(0.25, 0.25, 0.25)), moved(-away, 0, away)));
  }
}

/* The importer's matrix is the product, whose errors are those of binary64, rounded once. */
static void check_matrix(const double found[3][4], const struct matrix *const factors[3]) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++) {
      long double sum = 0, size = 0;
      for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
          const long double a = (long double)factors[0]->m[row][i],
                            b = i < 3 ? (long double)factors[1]->m[i][k] : (long double)(k == 3),
                            c = k < 3 ? (long double)factors[2]->m[k][column] : (long double)(column == 3);
          sum += a * b * c, size += fabsl(a * b * c);
        }
      const float rounded = (float)found[row][column];
      const long double ulp = (long double)nextafterf(fabsf(rounded), INFINITY) - (long double)fabsf(rounded);
      if (fabsl((long double)rounded - sum) > 0.5L * ulp + 0x1p-50L * size)
        fail("a matrix is not the product of its groups'");
    }
}

/* Points of triangles as they are placed: vertices, points of edges, and others. */
static void random_point(struct setup *setup, double at[3]) {
  const struct trax_mesh *mesh = &setup->mesh;
  const struct trax_mesh_instance *instance = &mesh->instances[one_of(setup, mesh->instance_count)];
  const struct trax_mesh_part *part = &mesh->parts[instance->part];
  const uint32_t *v = mesh->triangles[part->first_triangle + one_of(setup, part->triangle_count)].vertices;
  const uint32_t kind = one_of(setup, 4);
  const double w1 = kind == 0 ? 0 : kind == 1 ? 0.5 : (double)random_unit(&setup->seed);
  const double w2 = kind == 3 ? (1 - w1) * (double)random_unit(&setup->seed) : 0;
  double inside[3];
  for (int i = 0; i < 3; i++) {
    const double a = (double)mesh->vertices[v[0]][i];
    inside[i] = a + w1 * ((double)mesh->vertices[v[1]][i] - a) + w2 * ((double)mesh->vertices[v[2]][i] - a);
  }
  for (int row = 0; row < 3; row++) {
    at[row] = instance->transform[row][3];
    for (int i = 0; i < 3; i++)
      at[row] += instance->transform[row][i] * inside[i];
  }
}

/* A point of the room, given in the globe of radius 1. */
static void point_in_room(float out[3], const struct places *places, const struct family *family, double x, double y,
                          double z) {
  const double inside[3] = {x + family->away, y - family->away, z + family->away / 2};
  for (int row = 0; row < 3; row++) {
    double sum = places->room.m[row][3];
    for (int i = 0; i < 3; i++)
      sum += places->room.m[row][i] * inside[i];
    out[row] = (float)sum;
  }
}

static void import(struct setup *setup, const struct places *places, const struct family *family) {
  struct setup globe = {0}, soup = {0};
  const float away = (float)family->away;
  add_globe(&globe, 4, &(struct globe){{0, 0, 0}, 1, 0.1f});
  mesh_transform(&globe.mesh, 1, away, -away, away / 2);
  mesh_soup(&soup.mesh, 40, 5);
  mesh_transform(&soup.mesh, 1, away, 0, -away);
  write_mesh("globe.obj", &globe.mesh);
  write_mesh("soup.obj", &soup.mesh);
  setup_release(&globe);
  setup_release(&soup);
  FILE *file = create("room.instances");
  fprintf(file, "mesh globe globe.obj\nmesh soup soup.obj\ngroup some\n");
  for (int i = 0; i < SOUPS; i++)
    write_place(file, "soup", &places->soups[i]);
  fprintf(file, "end\ngroup room\nplace globe\n");
  write_place(file, "some", &places->group);
  fprintf(file, "end\n");
  write_place(file, "room", &places->room);
  fclose(file);
  const char *const paths[] = {test_path("room.instances")};
  const struct trax_import_options options = {0};
  struct trax_import_report report;
  trax_error error;
  if (trax_mesh_import(&setup->mesh, paths, 1, &options, &report, &error) != TRAX_OK)
    fail(error.message);
  if (setup->mesh.instance_count != INSTANCES)
    fail("not every instance was read");
  for (int i = 0; i < INSTANCES; i++)
    check_matrix(setup->mesh.instances[i].transform,
                 (const struct matrix *const[]){&places->room, i ? &places->group : &identity,
                                                i ? &places->soups[i - 1] : &identity});
}

/* numbers: that of the family. */
static void make(struct setup *setup, uint32_t rays) {
  const struct family *family = &families[(unsigned)setup->numbers[0]];
  struct places places;
  plan(&places, family);
  import(setup, &places, family);
  point_in_room(setup->light, &places, family, 0.1, 0.15, -0.2);
  for (uint32_t i = 0; i < rays; i++) {
    float from[3];
    double at[3];
    point_in_room(from, &places, family, 0.25 * (double)any(setup), 0.25 * (double)any(setup),
                  0.25 * (double)any(setup));
    random_point(setup, at);
    const float target[3] = {(float)at[0], (float)at[1], (float)at[2]};
    aim(setup, from, target);
  }
}

#define LIT (CASE_CLOSED | CASE_SHADOWS)

/* Flat globes have edges that are too sharp for shadow rays from there (docs/robustness.md, "Where shadow rays start"),
   also as meshes of their own, and so have these triangles at 10^6. */
const struct extreme_case instance_cases[] = {
    {"instances-1e-3", "instances scaled by 10^-3", BY(make, 0), LIT},
    {"instances-1e3", "instances scaled by 10^3", BY(make, 1), LIT},
    {"instances-turned", "instances that are turned", BY(make, 2), LIT},
    {"instances-mirrored", "the same, mirrored", BY(make, 3), LIT},
    {"instances-flat", "the same, flattened to a tenth", BY(make, 4), CASE_CLOSED},
    {"instances-nested", "instances in groups that are flat, mirrored, and in another group", BY(make, 5), CASE_CLOSED},
    {"instances-1e6", "instances of 100 at 10^6 from the origin", BY(make, 6), CASE_CLOSED},
    {"instances-away", "instances of 100, whose meshes are 10^6 from their own origin", BY(make, 7), CASE_CLOSED},
    {"instances-all-1e-3", "all of this, scaled by 10^-3, at 2 from the origin", BY(make, 8), CASE_CLOSED},
    {"instances-all-1e3", "all of this, scaled by 10^3, at 10^6 from the origin", BY(make, 9), CASE_CLOSED},
};
const unsigned instance_case_count = sizeof instance_cases / sizeof *instance_cases;
