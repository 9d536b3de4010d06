/* Scene files that are not what they should be: every damage is found, and what is well-sealed but wrong is refused or
   harmless. */
#include "support.h"

#include "trax/signals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

static struct trax_scene good;

static void set_signal(int number) {
  trax_signal = number;
}

/* A scene with every section: the first and the last of three materials are textured. */
static int make_scene(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 23, 0.3f, 42);
  mesh.uvs = calloc(mesh.triangle_count, sizeof *mesh.uvs);
  mesh.texels = calloc(8 + 2, sizeof *mesh.texels);
  mesh.textures = calloc(2, sizeof *mesh.textures);
  assert_true(mesh.uvs && mesh.texels && mesh.textures);
  mesh.texel_count = 8 + 2;
  mesh.texture_count = 2;
  mesh.textures[0] = (struct trax_mesh_texture){0, 1, 2, TRAX_TEXTURE_ALPHA};
  mesh.textures[1] = (struct trax_mesh_texture){8, 1, 0, TRAX_TEXTURE_CLAMP};
  mesh.materials[0].surface.texture = 2;
  mesh.materials[2].surface.texture = 1;
  build_good(&good, &mesh, &(struct trax_build_options){.max_leaf = 2, .smooth = true});
  trax_mesh_release(&mesh);
  assert_true(good.node_count >= 8);
  return 0;
}

static int drop_scene(void **state) {
  (void)state;
  trax_scene_release(&good);
  return 0;
}

/* A copy in a block of exactly its size, so that a sanitizer sees every read beyond it. */
static unsigned char *copy_scene(size_t size) {
  void *bytes = NULL;
  assert_int_equal(posix_memalign(&bytes, TRAX_SCENE_ALIGNMENT, size ? size : 1), 0);
  memcpy(bytes, good.bytes, size);
  return bytes;
}

static void test_every_bit(void **state) {
  (void)state;
  unsigned char *bytes = copy_scene(good.size);
  trax_error error;
  assert_int_equal(trax_scene_check(NULL, bytes, good.size, "scene", &error), TRAX_OK);
  for (size_t at = 0; at < good.size; at++)
    for (int bit = 0; bit <= 8; bit++) {
      unsigned char flip = bit < 8 ? (unsigned char)(1 << bit) : 0xFF;
      bytes[at] ^= flip;
      if (trax_scene_check(NULL, bytes, good.size, "scene", &error) != TRAX_ERROR)
        fail_msg("byte %zu, changed by %02x, was not noticed", at, flip);
      bytes[at] ^= flip;
    }
  free(bytes);
}

static void test_every_length(void **state) {
  (void)state;
  for (size_t size = 0; size < good.size; size++) {
    unsigned char *bytes = copy_scene(size);
    trax_error error;
    assert_int_equal(trax_scene_check(NULL, bytes, size, "scene", &error), TRAX_ERROR);
    free(bytes);
  }
  /* and one that is too long */
  unsigned char *bytes = calloc(1, good.size + 64);
  memcpy(bytes, good.bytes, good.size);
  const char *path = test_file("long.trax", bytes, good.size + 64);
  free(bytes);
  struct trax_scene scene;
  trax_error error;
  assert_int_equal(trax_scene_read(&scene, path, 0, &error), TRAX_ERROR);
  assert_contains(error.message, "long.trax: ");
  assert_contains(error.message, "where its header says");
}

/* --- sealed after the change --- */

/* Follows every reference as a traversal would; the test ends if one leads out of the file or in a circle. */
static void follow(const unsigned char *bytes, size_t size, uint32_t ref, unsigned depth, unsigned limit) {
  uint32_t offset = ref & ~7u, count = ref & 7u;
  if (count) {
    assert_true(offset + 40 * (size_t)count <= size);
    return;
  }
  assert_true(depth < limit);
  assert_true(offset + 64 <= size);
  struct trax_bvh_node node;
  memcpy(&node, bytes + offset, sizeof node);
  follow(bytes, size, node.child[0], depth + 1, limit);
  follow(bytes, size, node.child[1], depth + 1, limit);
}

static void check_harmless(const unsigned char *bytes, size_t size, const struct trax_scene *scene) {
  const struct trax_scene_header *header = scene->header;
  if (header->root == 0)
    assert_int_equal(scene->triangle_count, 0);
  else
    follow(bytes, size, header->root, 0, header->max_depth);
  for (uint32_t i = 0; i < scene->triangle_count; i++)
    assert_true(scene->triangles[i].material < scene->material_count);
}

static void test_sealed_changes(void **state) {
  (void)state;
  unsigned char *bytes = copy_scene(good.size);
  uint32_t seed = 1;
  unsigned accepted = 0, rejected = 0;
  for (int round = 0; round < 60000; round++) {
    /* Mostly where the structure is: header and nodes. */
    size_t range = round % 4 ? sizeof(struct trax_scene_header) + good.node_count * 64 : good.size;
    size_t at = (size_t)(random_unit(&seed) * (float)(range / 4)) * 4;
    uint32_t word, old;
    memcpy(&old, bytes + at, 4);
    static const uint32_t steps[] = {1, 2, 4, 7, 8, 16, 40, 64, 128, 0x80000000u, 0x7F800000u};
    uint32_t step = steps[(size_t)(random_unit(&seed) * 11)];
    switch (round % 5) {
    case 0:
      word = old + step;
      break;
    case 1:
      word = old - step;
      break;
    case 2:
      word = old ^ step;
      break;
    case 3: /* a word of the file elsewhere */
      memcpy(&word, bytes + (size_t)(random_unit(&seed) * (float)(good.size / 4)) * 4, 4);
      break;
    default:
      word = round % 2 ? 0 : UINT32_MAX;
    }
    memcpy(bytes + at, &word, 4);
    seal(bytes, good.size);
    struct trax_scene scene;
    trax_error error;
    if (trax_scene_check(&scene, bytes, good.size, "scene", &error) == TRAX_OK) {
      accepted++;
      check_harmless(bytes, good.size, &scene);
    } else
      rejected++;
    memcpy(bytes, good.bytes, sizeof(struct trax_scene_header));
    memcpy(bytes + at, (const unsigned char *)good.bytes + at, 4);
  }
  assert_true(rejected > accepted && accepted > 100); /* colours, and vertices inside of their boxes, may change */
  free(bytes);
}

/* --- one change each, with its message --- */

/* Seals the changed scene and expects the message; then the scene is good again. */
static void expect(unsigned char *bytes, const char *message) {
  seal(bytes, good.size);
  trax_error error = {{0}};
  if (trax_scene_check(NULL, bytes, good.size, "scene", &error) != TRAX_ERROR)
    fail_msg("accepted, instead of: %s", message);
  assert_contains(error.message, "scene: ");
  assert_contains(error.message, message);
  memcpy(bytes, good.bytes, good.size);
}

static void test_messages(void **state) {
  (void)state;
  unsigned char *bytes = copy_scene(good.size);
  struct trax_scene_header *header = (struct trax_scene_header *)bytes;
  struct trax_scene_section *sections = header->sections;
  struct trax_bvh_node *nodes = (void *)(bytes + sections[TRAX_SCENE_NODES].offset);
  struct trax_triangle *triangles = (void *)(bytes + sections[TRAX_SCENE_TRIANGLES].offset);
  struct trax_triangle_normals *normals = (void *)(bytes + sections[TRAX_SCENE_NORMALS].offset);
  struct trax_triangle_uvs *uvs = (void *)(bytes + sections[TRAX_SCENE_UVS].offset);
  struct trax_material *materials = (void *)(bytes + sections[TRAX_SCENE_MATERIALS].offset);
  struct trax_texture *textures = (void *)(bytes + sections[TRAX_SCENE_TEXTURES].offset);
#define EXPECT(CHANGE, MESSAGE) ((CHANGE), expect(bytes, MESSAGE))
  EXPECT(header->version = 1, "scene file version 1; this program reads version 2: import the meshes again");
  EXPECT(header->magic = 0x464C457Fu, "not a scene file");
  EXPECT(header->root = 0, "is to no node");
  EXPECT(header->root += 8, "is to no node");
  EXPECT(header->root = nodes[0].child[0] & 7u ? nodes[0].child[1] : nodes[0].child[0], "nodes are not in the tree");
  EXPECT(nodes[1].child[0] = header->root, "node 0 is referred to twice");
  EXPECT(nodes[0].child[0] = nodes[0].child[1], "is to triangle");
  EXPECT(nodes[0].child[0] = sections[TRAX_SCENE_TRIANGLES].offset, "is to no node");
  EXPECT(nodes[0].child[0] = header->root | 1, "is to no triangle");
  /* It needs two triangles, and one is left. */
  EXPECT(nodes[0].child[0] = sections[TRAX_SCENE_TRIANGLES].offset + sections[TRAX_SCENE_TRIANGLES].size - 40 + 2,
         "is to triangles behind the last");
  EXPECT(nodes[0].box[1].max[2] = nextafterf(nodes[0].box[1].max[2], INFINITY),
         "node 0: box 1 is not that of its triangles");
  EXPECT(nodes[3].box[0].min[1] = nextafterf(nodes[3].box[0].min[1], INFINITY),
         "node 3: box 0 is not that of its triangles");
  EXPECT(nodes[2].box[0].min[0] = NAN, "node 2: box 0 is not that of its triangles");
  EXPECT(triangles[5].v1[1] = NAN, "triangle 5: a coordinate is not finite");
  EXPECT(triangles[0].v2[2] = -INFINITY, "triangle 0: a coordinate is not finite");
  EXPECT(triangles[7].material = 3, "triangle 7: material 3 is out of range (3 materials)");
  EXPECT(header->max_depth--, "where its header says");
  EXPECT(header->max_leaf++, "where its header says");
  EXPECT(header->bounds_max[0] = 0, "the bounds are not those of its triangles");
  EXPECT(header->triangle_count--, "23 triangles, where its header says 22");
  EXPECT(sections[TRAX_SCENE_SOURCE_IDS].offset = sections[TRAX_SCENE_NODES].offset,
         "the sections nodes and source ids overlap");
  EXPECT(sections[TRAX_SCENE_SOURCE_IDS].offset = header->file_size, "source ids: bytes");
  EXPECT(sections[TRAX_SCENE_NODES].offset += 32, "nodes: bytes");
  sections[TRAX_SCENE_SOURCE_IDS].count = 0x40000001;
  sections[TRAX_SCENE_SOURCE_IDS].size = 4;
  expect(bytes, "source ids: 1073741825 records do not make 4 bytes");
  EXPECT(sections[TRAX_SCENE_NODES].record_size = 32, "nodes: records of 32 bytes instead of 64");
  EXPECT(normals[3].corner[1][0] += 1, "triangle 3: a normal is not of length 1");
  EXPECT(normals[4].corner[2][1] = NAN, "triangle 4: a normal is not of length 1");
  sections[TRAX_SCENE_NORMALS].count--;
  sections[TRAX_SCENE_NORMALS].size -= sizeof(struct trax_triangle_normals);
  expect(bytes, "22 normals for 23 triangles");
  sections[TRAX_SCENE_NORMALS].offset += 64;
  for (unsigned kind = TRAX_SCENE_MATERIALS; kind < TRAX_SCENE_SECTIONS; kind++)
    if (kind != TRAX_SCENE_NORMALS)
      sections[kind] = (struct trax_scene_section){0};
  expect(bytes, "the normals are not right behind the triangles");
  EXPECT(header->base = 0x2000, "its references are addresses, for a device that has it at 00002000");
  EXPECT(nodes[4].reserved[1] = 1, "node 4: reserved words are not zero");
  EXPECT(header->node_layout = 77, "nodes of an unknown layout, 77");
  EXPECT(header->node_layout = TRAX_NODE_LAYOUTS, "nodes of an unknown layout, 5");
  EXPECT(uvs[6].corner[2][1] = NAN, "triangle 6: a texture coordinate is not within 8192");
  EXPECT(uvs[6].corner[0][0] = -8193, "triangle 6: a texture coordinate is not within 8192");
  EXPECT(sections[TRAX_SCENE_UVS] = (struct trax_scene_section){0}, "textures without texture coordinates");
  EXPECT(sections[TRAX_SCENE_NORMALS] = (struct trax_scene_section){0},
         "the texture coordinates are not right behind the triangles");
  EXPECT(materials[1].diffuse[2] = 1.5f, "material 1: a colour is not between 0 and 1");
  EXPECT(materials[1].specular[0] = NAN, "material 1: a colour is not between 0 and 1");
  EXPECT(materials[0].roughness = -1, "material 0: roughness, opacity or the alpha cutoff is not between 0 and 1");
  EXPECT(materials[0].alpha_cutoff = 2, "material 0: roughness, opacity or the alpha cutoff is not between 0 and 1");
  EXPECT(materials[2].emission[1] = INFINITY, "material 2: the emission is out of range");
  EXPECT(materials[2].ior = 0, "material 2: the index of refraction is out of range");
  EXPECT(materials[2].kind = TRAX_MATERIAL_KINDS, "material 2: it is of an unknown kind");
  EXPECT(materials[2].texture = 3, "material 2: its texture is out of range");
  EXPECT(materials[2].reserved = 1, "material 2: the reserved word is not zero");
  EXPECT(textures[1].log2_width = 13, "texture 1: its size or its flags are out of range");
  EXPECT(textures[1].flags = 4, "texture 1: its size or its flags are out of range");
  EXPECT(textures[1].texels += 4, "texture 1: its texels do not begin where those before it end");
  EXPECT(textures[1].log2_width++, "texture 1: its texels are beyond the last");
  EXPECT(textures[1].log2_width--, "texels of no texture");
#undef EXPECT
  free(bytes);
}

/* A chain deeper than the device's stack is refused, however well it is made. */
static void test_deep_chain(void **state) {
  (void)state;
  for (unsigned depth = TRAX_SCENE_MAX_DEPTH; depth <= TRAX_SCENE_MAX_DEPTH + 1; depth++) {
    struct trax_mesh mesh = {0};
    struct trax_scene built;
    mesh_soup(&mesh, depth + 1, 0.5f, 3);
    build_good(&built, &mesh, &(struct trax_build_options){.max_leaf = 1, .without_source_ids = true});
    struct trax_scene_header *header = built.bytes;
    struct trax_bvh_node *nodes = (struct trax_bvh_node *)built.nodes;
    assert_int_equal(built.node_count, depth);
    header->root = header->sections[TRAX_SCENE_NODES].offset;
    header->max_depth = depth;
    for (unsigned i = depth; i-- > 0;) { /* node i: triangle i, and below it the rest */
      uint32_t triangle = header->sections[TRAX_SCENE_TRIANGLES].offset + 40 * i;
      nodes[i].child[0] = triangle | 1;
      nodes[i].child[1] = i + 1 < depth ? header->root + 64 * (i + 1) : (triangle + 40) | 1;
      for (unsigned side = 0; side < 2; side++) {
        float *min = nodes[i].box[side].min, *max = nodes[i].box[side].max;
        for (int axis = 0; axis < 3; axis++) {
          min[axis] = INFINITY;
          max[axis] = -INFINITY;
          for (unsigned t = i + side; t < (side ? built.triangle_count : i + 1); t++) {
            const struct trax_triangle *tri = &built.triangles[t];
            min[axis] = fminf(min[axis], fminf(tri->v0[axis], fminf(tri->v1[axis], tri->v2[axis])));
            max[axis] = fmaxf(max[axis], fmaxf(tri->v0[axis], fmaxf(tri->v1[axis], tri->v2[axis])));
          }
        }
      }
    }
    seal(built.bytes, built.size);
    trax_error error = {{0}};
    trax_status result = trax_scene_check(NULL, built.bytes, built.size, "scene", &error);
    if (depth <= TRAX_SCENE_MAX_DEPTH)
      assert_int_equal(result, TRAX_OK);
    else {
      assert_int_equal(result, TRAX_ERROR);
      char message[64];
      snprintf(message, sizeof message, "node %u is deeper than %u", TRAX_SCENE_MAX_DEPTH, TRAX_SCENE_MAX_DEPTH);
      assert_contains(error.message, message);
    }
    trax_scene_release(&built);
    trax_mesh_release(&mesh);
  }
}

static void test_not_scenes(void **state) {
  (void)state;
  struct trax_scene scene;
  trax_error error;
  const struct {
    const char *path, *message;
  } bad[] = {{test_path("nowhere.trax"), "nowhere.trax: cannot be read: No such file"},
             {test_directory(), "cannot be read: Is a directory"},
             {test_text("empty.trax", ""), "empty.trax: not a scene file"},
             {test_text("tiny.trax", "TRXS"), "tiny.trax: cut off: 4 bytes"},
             {test_text("text.trax", "This is not a scene."), "text.trax: not a scene file"}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    assert_int_equal(trax_scene_read(&scene, bad[i].path, 0, &error), TRAX_ERROR);
    assert_contains(error.message, bad[i].message);
    assert_null(scene.bytes);
  }
}

/* A file of so many bytes that takes no room on the disk. */
static const char *sparse_file(const char *name, off_t size) {
  const char *path = test_text(name, "TRXS");
  assert_int_equal(truncate(path, size), 0);
  return path;
}

/* A file that is too large is not read at all, and a signal ends the reading of one that is not. */
static void test_large_files(void **state) {
  (void)state;
  struct trax_scene scene;
  trax_error error;
  struct rlimit before;
  const char *path = sparse_file("vast.trax", (off_t)10 << 30);
  getrlimit(RLIMIT_AS, &before);
  setrlimit(RLIMIT_AS, &(struct rlimit){(rlim_t)1 << 30, before.rlim_max});
  const trax_status status = trax_scene_read(&scene, path, 0, &error);
  setrlimit(RLIMIT_AS, &before);
  assert_int_equal(status, TRAX_ERROR);
  assert_contains(error.message, "vast.trax: more than 4294967296 bytes");
  remove(path);

  path = sparse_file("large.trax", (off_t)1 << 30);
  struct sigaction action = {.sa_handler = set_signal}, old;
  const struct itimerval soon = {.it_value = {.tv_usec = 1000}};
  sigaction(SIGALRM, &action, &old);
  setitimer(ITIMER_REAL, &soon, NULL);
  assert_int_equal(trax_scene_read(&scene, path, 0, &error), TRAX_INTERRUPTED);
  sigaction(SIGALRM, &old, NULL);
  trax_signal = 0;
  remove(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_every_bit),   cmocka_unit_test(test_every_length), cmocka_unit_test(test_sealed_changes),
      cmocka_unit_test(test_messages),    cmocka_unit_test(test_deep_chain),   cmocka_unit_test(test_not_scenes),
      cmocka_unit_test(test_large_files),
  };
  return cmocka_run_group_tests_name("corrupt scenes", tests, make_scene, drop_scene);
}
