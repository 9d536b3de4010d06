#include "gallery.h"

#include <stdlib.h>
#include <string.h>

static void *bytes_of(size_t size) {
  void *memory = calloc(1, size);
  if (!memory)
    abort();
  return memory;
}

static struct trax_material *material_of(struct trax_mesh *mesh, uint32_t number) {
  return &mesh->materials[number].surface;
}

static void ball(struct trax_mesh *mesh, float x, float y, float z, float radius, uint32_t material) {
  struct trax_mesh one = {0};
  mesh_sphere(&one, radius, 3, 0);
  uint32_t first = mesh->vertex_count;
  for (uint32_t i = 0; i < one.vertex_count; i++)
    mesh_vertex(mesh, one.vertices[i][0] + x, one.vertices[i][1] + y, one.vertices[i][2] + z);
  for (uint32_t i = 0; i < one.triangle_count; i++) {
    const uint32_t *v = one.triangles[i].vertices;
    mesh_triangle(mesh, first + v[0], first + v[1], first + v[2], material);
  }
  trax_mesh_release(&one);
}

/* Two textures: tiles, and a leaf that is a disc with an opaque middle and a soft edge. */
enum { TILES_LOG2 = 5, LEAF_LOG2 = 4 };

static void textures(struct trax_mesh *mesh) {
  const uint32_t tiles = 1u << TILES_LOG2, leaf = 1u << LEAF_LOG2;
  mesh->textures = bytes_of(2 * sizeof *mesh->textures);
  mesh->texels = bytes_of((size_t)(tiles * tiles + leaf * leaf) * sizeof *mesh->texels);
  mesh->textures[0] = (struct trax_mesh_texture){0, TILES_LOG2, TILES_LOG2, 0};
  mesh->textures[1] =
      (struct trax_mesh_texture){tiles * tiles, LEAF_LOG2, LEAF_LOG2, TRAX_TEXTURE_ALPHA | TRAX_TEXTURE_CLAMP};
  mesh->texture_count = 2;
  mesh->texel_count = tiles * tiles + leaf * leaf;
  for (uint32_t y = 0; y < tiles; y++)
    for (uint32_t x = 0; x < tiles; x++) {
      uint32_t dark = (x / 8 ^ y / 8) & 1, grain = (x * 7 + y * 13) % 17;
      mesh->texels[y * tiles + x] =
          0xFF000000u | (dark ? 90 + grain : 220 + grain) << 16 | (dark ? 80 : 225) << 8 | (dark ? 60 + grain : 230);
    }
  for (uint32_t y = 0; y < leaf; y++)
    for (uint32_t x = 0; x < leaf; x++) {
      int dx = 2 * (int)x - (int)leaf + 1, dy = 2 * (int)y - (int)leaf + 1, square = dx * dx + dy * dy;
      uint32_t alpha = square < 120 ? 255 : square < 200 ? 130 : 0;
      mesh->texels[tiles * tiles + y * leaf + x] = alpha << 24 | 40u << 16 | (160u + 5 * y) << 8 | (90u + 4 * x);
    }
}

/* The quad added last gets texture coordinates from 0 to `repeats`. */
static void map_quad(struct trax_mesh *mesh, float (*uvs)[3][2], float repeats) {
  static const float corners[2][3][2] = {{{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {1, 1}, {0, 1}}};
  for (int t = 0; t < 2; t++)
    for (int k = 0; k < 6; k++)
      uvs[mesh->triangle_count - 2 + (uint32_t)t][k / 2][k % 2] = repeats * corners[t][k / 2][k % 2];
}

void gallery_mesh(struct trax_mesh *mesh, unsigned parts) {
  uint32_t white = mesh_material(mesh, 0.75f, 0.75f, 0.75f), red = mesh_material(mesh, 0.63f, 0.06f, 0.05f),
           green = mesh_material(mesh, 0.14f, 0.45f, 0.09f), floor = mesh_material(mesh, 0.8f, 0.7f, 0.6f),
           leaf = mesh_material(mesh, 0.3f, 0.8f, 0.2f), mirror = mesh_material(mesh, 0.5f, 0.5f, 0.6f),
           glass = mesh_material(mesh, 0.6f, 0.6f, 0.5f), gold = mesh_material(mesh, 0.7f, 0.5f, 0.2f),
           lacquer = mesh_material(mesh, 0.1f, 0.15f, 0.6f), lamp = mesh_material(mesh, 0.9f, 0.9f, 0.9f);
  float(*uvs)[3][2] = bytes_of(8192 * sizeof *uvs);
  static const float room[5][4][3] = {{{-1.5f, 0, -1}, {1.5f, 0, -1}, {1.5f, 2, -1}, {-1.5f, 2, -1}},
                                      {{-1.5f, 2, 1}, {1.5f, 2, 1}, {1.5f, 2, -1}, {-1.5f, 2, -1}},
                                      {{-1.5f, 0, 1}, {-1.5f, 0, -1}, {-1.5f, 2, -1}, {-1.5f, 2, 1}},
                                      {{1.5f, 0, 1}, {1.5f, 2, 1}, {1.5f, 2, -1}, {1.5f, 0, -1}},
                                      {{-1.5f, 0, 1}, {1.5f, 0, 1}, {1.5f, 0, -1}, {-1.5f, 0, -1}}};
  const uint32_t walls[5] = {white, white, red, green, floor};
  for (int i = 0; i < 5; i++)
    mesh_quad(mesh, room[i], walls[i]);
  map_quad(mesh, uvs, 3);
  mesh_quad(
      mesh,
      (const float[4][3]){{-0.35f, 1.97f, -0.3f}, {0.35f, 1.97f, -0.3f}, {0.35f, 1.97f, 0.3f}, {-0.35f, 1.97f, 0.3f}},
      lamp);
  for (int i = 0; i < 3; i++) {
    float x = -1.2f + 0.35f * (float)i, z = 0.55f + 0.1f * (float)i, y = 0.75f + 0.25f * (float)i;
    mesh_quad(mesh,
              (const float[4][3]){
                  {x, y, z}, {x + 0.4f, y + 0.05f, z - 0.1f}, {x + 0.4f, y + 0.5f, z - 0.2f}, {x, y + 0.45f, z - 0.1f}},
              leaf);
    map_quad(mesh, uvs, 1);
  }
  ball(mesh, -0.85f, 0.45f, -0.4f, 0.44f, mirror);
  ball(mesh, 0.15f, 0.36f, 0.45f, 0.35f, glass);
  ball(mesh, 0.9f, 0.35f, -0.3f, 0.34f, gold);
  ball(mesh, 0.1f, 0.28f, -0.5f, 0.27f, lacquer);

  if (parts & (GALLERY_TEXTURES | GALLERY_HOLES)) {
    textures(mesh);
    mesh->uvs = uvs;
  } else {
    free(uvs);
  }
  if (parts & GALLERY_TEXTURES)
    material_of(mesh, floor)->texture = 1;
  if (parts & GALLERY_HOLES)
    material_of(mesh, leaf)->texture = 2, material_of(mesh, leaf)->alpha_cutoff = 0.5f;
  if (parts & GALLERY_MIRROR) {
    material_of(mesh, mirror)->kind = TRAX_MATERIAL_MIRROR;
    memcpy(material_of(mesh, mirror)->specular, (float[]){0.95f, 0.93f, 0.9f}, 12);
  }
  if (parts & GALLERY_GLASS) {
    material_of(mesh, glass)->kind = TRAX_MATERIAL_GLASS;
    material_of(mesh, glass)->ior = 1.5f;
    memcpy(material_of(mesh, glass)->specular, (float[]){0.95f, 1, 0.97f}, 12);
  }
  if (parts & GALLERY_GGX) {
    struct trax_material *one = material_of(mesh, gold), *other = material_of(mesh, lacquer);
    one->kind = other->kind = TRAX_MATERIAL_GGX;
    one->roughness = 0.25f, other->roughness = 0.1f;
    memset(one->diffuse, 0, sizeof one->diffuse);
    one->texture = parts & GALLERY_TEXTURES ? 1 : 0; /* the same texel everywhere: the ball has no coordinates */
    memcpy(one->specular, (float[]){1.0f, 0.76f, 0.33f}, 12);
    memcpy(other->specular, (float[]){0.04f, 0.04f, 0.04f}, 12);
  }
  if (parts & GALLERY_LAMP)
    memcpy(material_of(mesh, lamp)->emission, (float[]){9, 8, 6}, 12);
}

struct trax_scene gallery_scene(unsigned parts) {
  struct trax_mesh mesh = {0};
  gallery_mesh(&mesh, parts);
  return scene_of(&mesh, &(struct trax_build_options){.smooth = true, .crease_degrees = 40});
}

struct trax_view gallery_view(unsigned lights) {
  struct trax_view view = view_from(0.05f, 1.05f, 3.9f, 0, -0.03f, -1, 38, 0.2f, 1.7f, 0.9f);
  static const struct trax_light all[3] = {{.kind = TRAX_LIGHT_POINT,
                                            .position = {0.2f, 1.7f, 0.9f},
                                            .colour = {1, 0.9f, 0.7f},
                                            .strength = 0.5f,
                                            .falloff = 1.2f},
                                           {.kind = TRAX_LIGHT_DIRECTIONAL,
                                            .direction = {0.36f, -0.48f, -0.8f},
                                            .colour = {0.7f, 0.8f, 1},
                                            .strength = 0.4f},
                                           {.kind = TRAX_LIGHT_RECTANGLE,
                                            .position = {-0.3f, 1.9f, 0.4f},
                                            .direction = {0, -1, 0},
                                            .edges = {{0.6f, 0, 0}, {0, 0, 0.4f}},
                                            .colour = {1, 1, 1},
                                            .strength = 4}};
  view.light_count = lights;
  memcpy(view.lights, all, lights * sizeof *all);
  return view;
}
