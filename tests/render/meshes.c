#include "meshes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *grown(void *memory, size_t count, size_t size) {
  if (count & (count - 1)) /* capacity is the next power of two */
    return memory;
  memory = realloc(memory, (count ? 2 * count : 1) * size);
  if (!memory)
    abort();
  return memory;
}

uint32_t mesh_vertex(struct trax_mesh *mesh, float x, float y, float z) {
  mesh->vertices = grown(mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
  float *vertex = mesh->vertices[mesh->vertex_count];
  vertex[0] = x, vertex[1] = y, vertex[2] = z;
  return mesh->vertex_count++;
}

void mesh_triangle(struct trax_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t material) {
  if (mesh->material_count == 0)
    mesh_material(mesh, 0.8f, 0.8f, 0.8f);
  mesh->triangles = grown(mesh->triangles, mesh->triangle_count, sizeof *mesh->triangles);
  mesh->triangles[mesh->triangle_count] = (struct trax_mesh_triangle){{a, b, c}, material, mesh->triangle_count};
  mesh->triangle_count++;
}

uint32_t mesh_material(struct trax_mesh *mesh, float red, float green, float blue) {
  mesh->materials = grown(mesh->materials, mesh->material_count, sizeof *mesh->materials);
  mesh->materials[mesh->material_count] = (struct trax_mesh_material){.surface = trax_default_material};
  memcpy(mesh->materials[mesh->material_count].surface.diffuse, (float[]){red, green, blue}, 3 * sizeof(float));
  return mesh->material_count++;
}

void mesh_quad(struct trax_mesh *mesh, const float corners[4][3], uint32_t material) {
  const uint32_t first = mesh->vertex_count;
  for (int i = 0; i < 4; i++)
    mesh_vertex(mesh, corners[i][0], corners[i][1], corners[i][2]);
  mesh_triangle(mesh, first, first + 1, first + 2, material);
  mesh_triangle(mesh, first, first + 2, first + 3, material);
}

void mesh_box(struct trax_mesh *mesh, const float low[3], const float high[3], uint32_t material) {
  static const unsigned char faces[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                                             {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 7, 3}, {1, 5, 7}};
  uint32_t first = mesh->vertex_count;
  for (int i = 0; i < 8; i++)
    mesh_vertex(mesh, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
  for (int i = 0; i < 12; i++)
    mesh_triangle(mesh, first + faces[i][0], first + faces[i][1], first + faces[i][2], material);
}

/* The vertex half way between two on the sphere; the same for both triangles that share the edge. */
static uint32_t middle(struct trax_mesh *mesh, float radius, uint32_t a, uint32_t b) {
  float p[3], length = 0;
  for (int i = 0; i < 3; i++) {
    p[i] = mesh->vertices[a][i] + mesh->vertices[b][i];
    length += p[i] * p[i];
  }
  length = radius / sqrtf(length);
  for (uint32_t i = 0; i < mesh->vertex_count; i++)
    if (mesh->vertices[i][0] == length * p[0] && mesh->vertices[i][1] == length * p[1] &&
        mesh->vertices[i][2] == length * p[2])
      return i;
  return mesh_vertex(mesh, length * p[0], length * p[1], length * p[2]);
}

static void divide(struct trax_mesh *mesh, float radius, unsigned levels, uint32_t a, uint32_t b, uint32_t c,
                   uint32_t material, bool turned) {
  if (levels == 0) {
    mesh_triangle(mesh, a, turned ? c : b, turned ? b : c, material);
    return;
  }
  uint32_t ab = middle(mesh, radius, a, b), bc = middle(mesh, radius, b, c), ca = middle(mesh, radius, c, a);
  divide(mesh, radius, levels - 1, a, ab, ca, material, turned);
  divide(mesh, radius, levels - 1, ab, b, bc, material, turned);
  divide(mesh, radius, levels - 1, ca, bc, c, material, turned);
  divide(mesh, radius, levels - 1, ab, bc, ca, material, turned);
}

void mesh_sphere(struct trax_mesh *mesh, float radius, unsigned levels, uint32_t material) {
  uint32_t tips[6];
  for (int i = 0; i < 6; i++) {
    float p[3] = {0, 0, 0};
    p[i / 2] = i & 1 ? -radius : radius;
    tips[i] = mesh_vertex(mesh, p[0], p[1], p[2]);
  }
  for (int octant = 0; octant < 8; octant++)
    divide(mesh, radius, levels, tips[octant & 1], tips[2 + (octant >> 1 & 1)], tips[4 + (octant >> 2)], material,
           __builtin_parity((unsigned)octant));
}

float random_unit(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return (float)(*state >> 8) * 0x1p-24f;
}

void mesh_soup(struct trax_mesh *mesh, unsigned count, uint32_t seed) {
  for (unsigned i = 0; i < count; i++) {
    float size = ldexpf(1, -(int)(8 * random_unit(&seed)));
    float centre[3] = {2 * random_unit(&seed) - 1, 2 * random_unit(&seed) - 1, 2 * random_unit(&seed) - 1};
    for (int corner = 0; corner < 3; corner++) {
      float x = centre[0] + size * (random_unit(&seed) - 0.5f);
      float y = centre[1] + size * (random_unit(&seed) - 0.5f);
      mesh_vertex(mesh, x, y, centre[2] + size * (random_unit(&seed) - 0.5f));
    }
    mesh_triangle(mesh, 3 * i, 3 * i + 1, 3 * i + 2, 0);
  }
}

void mesh_transform(struct trax_mesh *mesh, float scale, float x, float y, float z) {
  for (uint32_t i = 0; i < mesh->vertex_count; i++) {
    float *vertex = mesh->vertices[i];
    vertex[0] = scale * vertex[0] + x, vertex[1] = scale * vertex[1] + y, vertex[2] = scale * vertex[2] + z;
  }
}

struct trax_view view_from(float ex, float ey, float ez, float dx, float dy, float dz, float fov, float lx, float ly,
                           float lz) {
  struct trax_view view = {.eye = {ex, ey, ez}, .fov = fov, .light = {lx, ly, lz}};
  float length = sqrtf(dx * dx + dy * dy + dz * dz);
  float d[3] = {dx / length, dy / length, dz / length}, up[3] = {0, 0, 0};
  up[fabsf(d[1]) > 0.9f ? 2 : 1] = 1;
  float along = up[0] * d[0] + up[1] * d[1] + up[2] * d[2], square = 0;
  for (int i = 0; i < 3; i++) {
    view.direction[i] = d[i];
    view.up[i] = up[i] - along * d[i];
    square += view.up[i] * view.up[i];
  }
  for (int i = 0; i < 3; i++)
    view.up[i] /= sqrtf(square);
  return view;
}

void build(struct trax_scene *scene, const struct trax_mesh *mesh, const struct trax_build_options *options) {
  const struct trax_build_options defaults = {.allow_empty = true};
  trax_error error;
  if (trax_scene_build(scene, mesh, options ? options : &defaults, &error)) {
    fprintf(stderr, "build: %s\n", error.message);
    abort();
  }
}

struct trax_scene scene_of(struct trax_mesh *mesh, const struct trax_build_options *options) {
  struct trax_scene scene = {0};
  build(&scene, mesh, options);
  trax_mesh_release(mesh);
  return scene;
}

int normalise(struct trax_scene *scene, struct trax_view *view) {
  trax_error error;
  int exponent;
  if (trax_normalise(scene, view, &exponent, &error)) {
    fprintf(stderr, "normalise: %s\n", error.message);
    abort();
  }
  return exponent;
}

struct trax_picture take(const struct trax_scene *scene, const struct trax_view *view, uint32_t width, uint32_t height,
                         bool reference, unsigned threads) {
  struct trax_frame_options options = {.width = width,
                                       .height = height,
                                       .ambient = TRAX_DEFAULT_AMBIENT,
                                       .background = TRAX_DEFAULT_BACKGROUND,
                                       .samples = 1,
                                       .shadows = true};
  struct trax_frame frame = {0};
  struct trax_picture picture = {0};
  struct trax_render_run run = {0};
  trax_error error;
  trax_status status = trax_frame_init(&frame, scene, view, &options, &error);
  if (status == TRAX_OK)
    status = reference ? trax_render_embree(&picture, &frame, &run, &error)
                       : trax_render_twin(&picture, &frame, threads, &run, &error);
  if (status != TRAX_OK) {
    fprintf(stderr, "take: %s\n", error.message);
    abort();
  }
  trax_frame_release(&frame);
  return picture;
}

unsigned background_pixels(const struct trax_picture *picture) {
  unsigned count = 0;
  for (uint32_t i = 0; i < picture->width * picture->height; i++)
    count += picture->pixels[i] == TRAX_DEFAULT_BACKGROUND;
  return count;
}

void chain_scene(struct trax_scene *scene) {
  enum { NODES = TRAX_SCENE_MAX_DEPTH, TRIANGLES = NODES + 1 };
  uint32_t nodes_at = sizeof(struct trax_scene_header), triangles_at = nodes_at + 64 * NODES;
  uint32_t triangles_size = TRIANGLES * sizeof(struct trax_triangle);
  uint32_t materials_at = (triangles_at + triangles_size + 63) / 64 * 64, size = materials_at + 64;
  char *bytes = aligned_alloc(64, size);
  if (!bytes)
    abort();
  memset(bytes, 0, size);
  struct trax_bvh_node *nodes = (struct trax_bvh_node *)(bytes + nodes_at);
  struct trax_triangle *triangles = (struct trax_triangle *)(bytes + triangles_at);
  for (int i = 0; i < TRIANGLES; i++) {
    float z = (float)(i - TRIANGLES);
    triangles[i] = (struct trax_triangle){{-1, -1, z}, {3, -1, z}, {-1, 3, z}, 0};
  }
  for (int i = 0; i < NODES; i++) {
    float z = (float)(i - TRIANGLES);
    bool last = i == NODES - 1;
    nodes[i] = (struct trax_bvh_node){
        .box = {{{-1, -1, z}, {3, 3, z}}, {{-1, -1, z + 1}, {3, 3, -1}}},
        .child = {(triangles_at + (uint32_t)i * 40) | 1,
                  last ? (triangles_at + (uint32_t)(i + 1) * 40) | 1 : nodes_at + 64 * (uint32_t)(i + 1)}};
  }
  *(struct trax_material *)(bytes + materials_at) = trax_default_material;
  struct trax_scene_header *header = (struct trax_scene_header *)bytes;
  *header = (struct trax_scene_header){.magic = TRAX_SCENE_MAGIC,
                                       .version = TRAX_SCENE_VERSION,
                                       .file_size = size,
                                       .root = nodes_at,
                                       .max_depth = NODES,
                                       .max_leaf = 1,
                                       .triangle_count = TRIANGLES,
                                       .bounds_min = {-1, -1, -(float)TRIANGLES},
                                       .bounds_max = {3, 3, -1}};
  header->sections[TRAX_SCENE_NODES] = (struct trax_scene_section){nodes_at, 64 * NODES, NODES, 64};
  header->sections[TRAX_SCENE_TRIANGLES] =
      (struct trax_scene_section){triangles_at, triangles_size, TRIANGLES, sizeof(struct trax_triangle)};
  header->sections[TRAX_SCENE_MATERIALS] = (struct trax_scene_section){materials_at, 64, 1, 64};
  *scene = (struct trax_scene){.bytes = bytes,
                               .size = size,
                               .header = header,
                               .nodes = nodes,
                               .triangles = triangles,
                               .materials = (struct trax_material *)(bytes + materials_at),
                               .node_count = NODES,
                               .triangle_count = TRIANGLES,
                               .material_count = 1};
}
