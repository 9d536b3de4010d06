/* Meshes in all formats, the odd corners of OBJ, and what must be refused. */
#include "support.h"

#include <inttypes.h>
#include <lzma.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>

/* The corners of triangle i of a mesh. */
static const float *corner(const struct trax_mesh *mesh, uint32_t triangle, int which) {
  assert_true(triangle < mesh->triangle_count);
  return mesh->vertices[mesh->triangles[triangle].vertices[which]];
}

static void assert_corner(const struct trax_mesh *mesh, uint32_t triangle, int which, float x, float y, float z) {
  const float *p = corner(mesh, triangle, which);
  if (p[0] != x || p[1] != y || p[2] != z)
    fail_msg("triangle %u corner %d: %g %g %g instead of %g %g %g", triangle, which, (double)p[0], (double)p[1],
             (double)p[2], (double)x, (double)y, (double)z);
}

/* --- the same two triangles, in every format: a unit square at z = 1 and a triangle at z = -2 --- */

static const char square_ply[] = "ply\nformat ascii 1.0\ncomment two faces\nelement vertex 7\nproperty float x\n"
                                 "property float y\nproperty float z\nelement face 2\n"
                                 "property list uchar int vertex_indices\nend_header\n"
                                 "0 0 1\n1 0 1\n1 1 1\n0 1 1\n.5 -0.25 -2\n1.5e0 0 -2\n0 3 -2\n4 0 1 2 3\n3 4 5 6\n";
static const char square_obj[] = "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv .5 -0.25 -2\nv 1.5e0 0 -2\nv 0 3 -2\n"
                                 "f 1 2 3 4\nf 5 6 7\n";

static void check_square(const char *path) {
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh, path, &report);
  assert_int_equal(mesh.triangle_count, 3);
  assert_int_equal(report.source_triangles, 3);
  float area = 0;
  for (uint32_t t = 0; t < 2; t++) {
    const float *a = corner(&mesh, t, 0), *b = corner(&mesh, t, 1), *c = corner(&mesh, t, 2);
    assert_true(a[2] == 1 && b[2] == 1 && c[2] == 1);
    float twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    assert_true(twice > 0); /* the winding stays */
    area += twice / 2;
  }
  assert_true(area == 1);
  assert_corner(&mesh, 2, 0, 0.5f, -0.25f, -2);
  assert_corner(&mesh, 2, 1, 1.5f, 0, -2);
  assert_corner(&mesh, 2, 2, 0, 3, -2);
  assert_int_equal(mesh.material_count, 1);
  for (int channel = 0; channel < 3; channel++)
    assert_true(mesh.materials[0].surface.diffuse[channel] == trax_default_material.diffuse[channel]);
  trax_mesh_release(&mesh);
}

static void test_text_formats(void **state) {
  (void)state;
  check_square(test_text("square.ply", square_ply));
  check_square(test_text("square.obj", square_obj));
  check_square(test_text("SQUARE.OBJ", square_obj));
}

static void test_binary_ply(void **state) {
  (void)state;
  static const char header[] = "ply\nformat binary_little_endian 1.0\nelement vertex 7\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 2\n"
                               "property list uchar int vertex_indices\nend_header\n";
  static const float vertices[7][3] = {{0, 0, 1},          {1, 0, 1},     {1, 1, 1}, {0, 1, 1},
                                       {0.5f, -0.25f, -2}, {1.5f, 0, -2}, {0, 3, -2}};
  static const int32_t quad[4] = {0, 1, 2, 3}, triangle[3] = {4, 5, 6};
  unsigned char bytes[1024];
  size_t size = 0;
  append(bytes, &size, header, strlen(header));
  append(bytes, &size, vertices, sizeof vertices);
  append(bytes, &size, "\4", 1);
  append(bytes, &size, quad, sizeof quad);
  append(bytes, &size, "\3", 1);
  append(bytes, &size, triangle, sizeof triangle);
  check_square(test_file("binary.ply", bytes, size));
}

/* Records as in most large files, with one wrong number each. */
static void test_bad_binary_ply(void **state) {
  (void)state;
  static const char header[] = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 1\n"
                               "property list uchar int vertex_indices\nend_header\n";
  static const float vertices[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  static const struct {
    int32_t last;
    size_t cut; /* bytes */
    const char *message;
  } cases[] = {{3, 0, "face 0: vertex index 3 is out of range (3 vertices)"},
               {-1, 0, "face 0: vertex index -1 is out of range (3 vertices)"},
               {2, 1, "face 0: the file ends too early"},
               {2, 14, "cut off: too short for the 3 records of 'vertex'"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const int32_t triangle[3] = {0, 1, cases[i].last};
    unsigned char bytes[1024];
    size_t size = 0;
    append(bytes, &size, header, strlen(header));
    append(bytes, &size, vertices, sizeof vertices);
    append(bytes, &size, "\3", 1);
    append(bytes, &size, triangle, sizeof triangle);
    import_bad(test_file("bad.ply", bytes, size - cases[i].cut), NULL, cases[i].message);
  }
}

/* Big endian, coordinates of three types behind a property and an element that mean nothing, and triangle strips. */
static void test_ply_types(void **state) {
  (void)state;
  static const char header[] =
      "ply\r\nformat binary_big_endian 1.0\r\nobj_info x\r\nelement camera 1\r\nproperty list ushort double matrix\r\n"
      "element vertex 5\r\nproperty uchar red\r\nproperty short x\r\nproperty double y\r\nproperty float z\r\n"
      "element tristrips 1\r\nproperty list int int vertex_indices\r\nend_header\r\n";
  static const unsigned char one_double[] = {0x3F, 0xF0, 0, 0, 0, 0, 0, 0}, one_float[] = {0x3F, 0x80, 0, 0};
  unsigned char bytes[1024] = {0};
  size_t size = 0;
  append(bytes, &size, header, strlen(header));
  append(bytes, &size, "\0\2", 2);
  append(bytes, &size, one_double, 8);
  append(bytes, &size, one_double, 8);
  for (int i = 0; i < 5; i++) { /* x = -300 + i, y = 0 or 1, z = 1 */
    unsigned x = (unsigned)(-300 + i) & 0xFFFF;
    const unsigned char head[] = {200, (unsigned char)(x >> 8), (unsigned char)x};
    append(bytes, &size, head, 3);
    append(bytes, &size, i % 2 ? one_double : (const unsigned char[8]){0}, 8);
    append(bytes, &size, one_float, 4);
  }
  static const signed char strip[] = {0, 1, 2, 3, -1, 2, 3, 4};
  append(bytes, &size, "\0\0\0\10", 4);
  for (size_t i = 0; i < sizeof strip; i++) {
    const unsigned char index[] = {strip[i] < 0 ? 255 : 0, strip[i] < 0 ? 255 : 0, strip[i] < 0 ? 255 : 0,
                                   (unsigned char)strip[i]};
    append(bytes, &size, index, 4);
  }
  struct trax_mesh mesh;
  import_good(&mesh, test_file("types.ply", bytes, size), NULL);
  assert_int_equal(mesh.triangle_count, 3);
  static const int expected[3][3] = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}; /* all turn the same way */
  for (uint32_t t = 0; t < 3; t++)
    for (int c = 0; c < 3; c++)
      assert_corner(&mesh, t, c, -300.0f + (float)expected[t][c], (float)(expected[t][c] % 2), 1);
  trax_mesh_release(&mesh);
  /* Cut anywhere it is refused. */
  for (size_t length = 0; length < size; length++)
    import_bad(test_file("cut.ply", bytes, length), NULL, "cut.ply:");
}

/* Appends a number of one of many forms, of which some are beyond binary32. */
static size_t append_number(char *text, uint64_t random) {
  const int digits = (int)(random % 18) + 1, places = (int)(random >> 8 & 0xFF) % 20;
  const double value = (double)(random >> 11) * 0x1p-53;
  switch (random >> 5 & 7) {
  case 0: /* halfway between two floats, or nearly so */
    return (size_t)sprintf(text, "%.*f\n", random & 1 ? 15 : 30, 1 + ((double)(random >> 41 << 1 | 1) * 0x1p-24));
  case 1:
    return (size_t)sprintf(text, "%" PRIu64 "%s\n", (random >> 40 << 1 | 1) << (random >> 16 & 7),
                           random & 1 ? "" : ".");
  case 2:
    return (size_t)sprintf(text, "%.*e\n", digits, value * pow(10, places * 5 - 50));
  case 3:
    return (size_t)sprintf(text, "%.*E\n", digits, -value * pow(10, places - 10));
  case 4:
    return (size_t)sprintf(text, "+%.*g\n", digits, value);
  case 5:
    return (size_t)sprintf(text, "%.*f\n", places, -value * 1000);
  case 6:
    return (size_t)sprintf(text, "-.%" PRIu64 "e-%d\n", random >> 20, places * 2);
  default:
    return (size_t)sprintf(text, "%.*f\n", digits, value * 100);
  }
}

/* Numbers are those of the C library, however many digits they have. */
static void test_numbers(void **state) {
  (void)state;
  enum { COUNT = 60000 };
  char *text = malloc(256 + COUNT * (size_t)400);
  assert_non_null(text);
  size_t size = (size_t)sprintf(text,
                                "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                                "property float z\nelement face 1\nproperty list int int vertex_indices\nend_header\n",
                                COUNT / 3),
         at = size;
  uint64_t random = 1;
  for (int i = 0; i < COUNT; i++) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    size += append_number(text + size, random ^ random >> 32);
  }
  size += (size_t)sprintf(text + size, "+3 -0 000000000000000000000001 2\n");
  struct trax_mesh mesh;
  trax_error error;
  const char *path = test_file("numbers.ply", text, size);
  const struct trax_import_options options = {.drop_nonfinite = true};
  if (trax_mesh_import(&mesh, &path, 1, &options, NULL, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  assert_int_equal(mesh.vertex_count, COUNT / 3);
  for (int i = 0; i < COUNT; i++) {
    char *end;
    const float right = strtof(text + at, &end);
    if (memcmp(&right, &mesh.vertices[i / 3][i % 3], sizeof right) != 0)
      fail_msg("%.*s", (int)(end - text - (long)at), text + at);
    at = (size_t)(end - text);
  }
  trax_mesh_release(&mesh);
  free(text);
}

static void test_compressed(void **state) {
  (void)state;
  unsigned char packed[4096];
  size_t size = 0;
  assert_int_equal(lzma_easy_buffer_encode(6, LZMA_CHECK_CRC32, NULL, (const uint8_t *)square_ply, strlen(square_ply),
                                           packed, &size, sizeof packed),
                   LZMA_OK);
  check_square(test_file("square.ply.xz", packed, size));
  import_bad(test_file("cut.ply.xz", packed, size - 5), NULL, "cut.ply.xz: the .xz data ends too early");
  packed[size / 2] ^= 0x10;
  import_bad(test_file("bad.ply.xz", packed, size), NULL, "bad.ply.xz: the .xz data is corrupt");

  const char *path = test_path("square.obj.gz");
  gzFile file = gzopen(path, "wb");
  gzputs(file, square_obj);
  gzclose(file);
  file = gzopen(path, "ab"); /* a second member */
  gzputs(file, "# the end\n");
  gzclose(file);
  check_square(path);
  FILE *stream = fopen(path, "rb");
  size = fread(packed, 1, sizeof packed, stream);
  fclose(stream);
  import_bad(test_file("cut.obj.gz", packed, size - 9), NULL, "cut.obj.gz: the .gz data ends too early");
}

/* --- glTF: nodes, transforms, materials --- */

static const float gltf_positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const char gltf_start[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    /* node 1 is moved by 10 along x, then scaled by 2 with node 0; node 2 mirrors x */
    "\"nodes\":[{\"scale\":[2,2,2],\"children\":[1,2]},{\"translation\":[10,0,0],\"mesh\":0},"
    "{\"scale\":[-1,1,1],\"mesh\":0}],"
    "\"materials\":[{\"name\":\"red\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,0,1]}}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":36}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
    "\"min\":[0,0,0],\"max\":[1,1,0]}],";

static void check_gltf(const char *path) {
  struct trax_mesh mesh;
  import_good(&mesh, path, NULL);
  assert_int_equal(mesh.triangle_count, 2);
  assert_corner(&mesh, 0, 0, 20, 0, 0);
  assert_corner(&mesh, 0, 1, 22, 0, 0);
  assert_corner(&mesh, 0, 2, 20, 2, 0);
  assert_corner(&mesh, 1, 0, 0, 0, 0); /* mirrored: the winding is turned so that the outside stays outside */
  assert_corner(&mesh, 1, 1, 0, 2, 0);
  assert_corner(&mesh, 1, 2, -2, 0, 0);
  const struct trax_mesh_material *material = &mesh.materials[mesh.triangles[0].material];
  assert_string_equal(material->name, "red");
  assert_true(material->surface.diffuse[0] == 0.5f && material->surface.diffuse[1] == 0.25f &&
              material->surface.diffuse[2] == 0);
  trax_mesh_release(&mesh);
}

static void test_gltf(void **state) {
  (void)state;
  char json[2048];
  snprintf(json, sizeof json, "%s\"buffers\":[{\"byteLength\":36,\"uri\":\"gltf.bin\"}]}", gltf_start);
  test_file("gltf.bin", gltf_positions, sizeof gltf_positions);
  check_gltf(test_text("outside.gltf", json));
  snprintf(json, sizeof json, "%s\"buffers\":[{\"byteLength\":36,\"uri\":\"50%% be%%2D%%-1.bin\"}]}", gltf_start);
  test_file("50% be-%-1.bin", gltf_positions, sizeof gltf_positions);
  check_gltf(test_text("percent.gltf", json));

  int length = snprintf(json, sizeof json, "%s\"buffers\":[{\"byteLength\":36}]}", gltf_start);
  while (length % 4)
    json[length++] = ' ';
  uint32_t header[] = {0x46546C67u, 2, 12 + 8 + (uint32_t)length + 8 + 36, (uint32_t)length, 0x4E4F534Au};
  uint32_t chunk[] = {36, 0x004E4942u};
  unsigned char bytes[4096];
  size_t size = 0;
  append(bytes, &size, header, sizeof header);
  append(bytes, &size, json, (size_t)length);
  append(bytes, &size, chunk, sizeof chunk);
  append(bytes, &size, gltf_positions, sizeof gltf_positions);
  check_gltf(test_file("one.glb", bytes, size));
}

/* --- OBJ --- */

static void test_obj_syntax(void **state) {
  (void)state;
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh,
              test_text("syntax.obj", "# comment\r\n\tv\t.5 0 0 # trailing\r\nv 1 \\\r\n 0 0\r\n\r\nv 0 1. 0 1.0\n"
                                      "vt 0 0\nvn 0 0 1\ng a b\ns off\n  f  -3/1 -2//1 -1/1/1  # last three\n"
                                      "v 0 0 -5\nl 1 2\np 1\nf 1 2 4\nunknown words\nf 1 2 3"),
              &report);
  assert_int_equal(mesh.triangle_count, 3);
  assert_int_equal(report.other_primitives, 2);
  assert_corner(&mesh, 0, 0, 0.5f, 0, 0);
  assert_corner(&mesh, 0, 1, 1, 0, 0);
  assert_corner(&mesh, 0, 2, 0, 1, 0);
  assert_corner(&mesh, 1, 2, 0, 0, -5);
  assert_corner(&mesh, 2, 2, 0, 1, 0);
  trax_mesh_release(&mesh);
}

/* A comb of six teeth with a concave outline, on each of the three planes and from both sides. */
static void test_concave_polygons(void **state) {
  (void)state;
  static const float outline[][2] = {{0, 0}, {11, 0}, {11, 5}, {10, 5}, {10, 1}, {9, 1}, {9, 5}, {8, 5},
                                     {8, 1}, {7, 1},  {7, 5},  {6, 5},  {6, 1},  {5, 1}, {5, 5}, {4, 5},
                                     {4, 1}, {3, 1},  {3, 5},  {2, 5},  {2, 1},  {1, 1}, {1, 5}, {0, 5}};
  enum { count = sizeof outline / sizeof outline[0] };
  for (int plane = 0; plane < 6; plane++) {
    char text[4096], *to = text;
    for (int i = 0; i < count; i++) {
      float p[3] = {7, 7, 7};
      p[(plane + 1) % 3] = outline[i][0];
      p[(plane + 2) % 3] = outline[i][1];
      to += sprintf(to, "v %g %g %g\n", (double)p[0], (double)p[1], (double)p[2]);
    }
    to += sprintf(to, "f");
    for (int i = 0; i < count; i++)
      to += sprintf(to, " %d", plane < 3 ? i + 1 : count - i);
    struct trax_mesh mesh;
    import_good(&mesh, test_text("comb.obj", text), NULL);
    assert_int_equal(mesh.triangle_count, count - 2);
    float area = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
      const float *a = corner(&mesh, t, 0), *b = corner(&mesh, t, 1), *c = corner(&mesh, t, 2);
      int x = (plane + 1) % 3, y = (plane + 2) % 3;
      float twice = (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
      assert_true(plane < 3 ? twice > 0 : twice < 0); /* all turn as the polygon does: they cannot overlap */
      area += fabsf(twice) / 2;
    }
    assert_true(area == 11 + 6 * 4);
    trax_mesh_release(&mesh);
  }
}

/* As PLY. */
static const char *large_polygon(const float (*points)[2], unsigned count) {
  char *text = malloc(300 + (size_t)count * 48), *to = text;
  assert_non_null(text);
  to += sprintf(to,
                "ply\nformat ascii 1.0\nelement vertex %u\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uint uint vertex_indices\nend_header\n",
                count);
  for (unsigned i = 0; i < count; i++)
    to += sprintf(to, "%.9g %.9g 0\n", (double)points[i][0], (double)points[i][1]);
  to += sprintf(to, "%u", count);
  for (unsigned i = 0; i < count; i++)
    to += sprintf(to, " %u", i);
  *to++ = '\n';
  const char *path = test_file("large.ply", text, (size_t)(to - text));
  free(text);
  return path;
}

static double processor_seconds(void) {
  return (double)clock() / CLOCKS_PER_SEC;
}

/* A convex polygon of 20,000 corners is cut in a moment. One of more, and a comb, whose ears must be searched, are
   refused at their place when they have taken too long. */
static void test_large_polygons(void **state) {
  (void)state;
  static const struct {
    int corners;
    bool comb, cut;
  } cases[] = {{20000, false, true}, {200000, false, false}, {200000, true, false}};
  static float points[200000][2];
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const int count = cases[i].corners;
    for (int at = 0; at < count; at++) {
      const double angle = 6.283185307179586 * at / count;
      points[at][0] = cases[i].comb ? (float)at : (float)cos(angle);
      points[at][1] = cases[i].comb ? (float)(at % 2) : (float)sin(angle);
    }
    const char *path = large_polygon((const float(*)[2])points, (unsigned)count);
    struct trax_mesh mesh;
    const double began = processor_seconds();
    if (!cases[i].cut) {
      char place[100];
      snprintf(place, sizeof place, "large.ply:%d: a polygon that takes too long to be cut into triangles; export",
               count + 10);
      import_bad(path, NULL, place);
    } else {
      import_good(&mesh, path, NULL);
      double area = 0;
      for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        const float *a = corner(&mesh, t, 0), *b = corner(&mesh, t, 1), *c = corner(&mesh, t, 2);
        area += fabs(((double)b[0] - a[0]) * ((double)c[1] - a[1]) - ((double)b[1] - a[1]) * ((double)c[0] - a[0])) / 2;
      }
      assert_true(fabs(area - 3.14159265) < 1e-5); /* they cover it once */
      trax_mesh_release(&mesh);
    }
    assert_true(processor_seconds() - began < 10);
  }
}

/* A packed file is refused where its contents become too large, whatever its header says. */
static void test_unpack_limit(void **state) {
  (void)state;
  static const char head[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const char *path = test_file("bomb.ply.gz", "", 0);
  gzFile file = gzopen(path, "wb1");
  assert_non_null(file);
  assert_int_equal(gzwrite(file, head, sizeof head - 1), (int)sizeof head - 1);
  static const char blanks[1 << 16];
  for (int i = 0; i < 20 * 16; i++) /* 20 MiB behind the mesh, where nobody looks */
    assert_int_equal(gzwrite(file, blanks, sizeof blanks), (int)sizeof blanks);
  assert_int_equal(gzclose(file), Z_OK);
  const struct trax_import_options options = {.unpack_limit = 19 << 20};
  struct rusage before, after;
  getrusage(RUSAGE_SELF, &before);
  import_bad(path, &options, "bomb.ply.gz: unpacks to more than 19922944 bytes (--unpack-limit)");
  getrusage(RUSAGE_SELF, &after);
  assert_true(after.ru_maxrss - before.ru_maxrss < 3 * 19 << 10);
  size_t size;
  static const struct {
    const char *text;
    size_t size;
  } sizes[] = {{"1", 1},
               {"700M", (size_t)700 << 20},
               {"4G", (size_t)4 << 30},
               {"65536", 65536},
               {"3K", 3072},
               {"0", 0},
               {"", 0},
               {"5G", 0},
               {"-1", 0},
               {"1X", 0},
               {"1MB", 0},
               {"99999999999999999999", 0},
               {" 1", 0},
               {"1.5G", 0}};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    assert_int_equal(trax_parse_size(sizes[i].text, &size), sizes[i].size != 0);
    if (sizes[i].size)
      assert_int_equal(size, sizes[i].size);
  }
}

static const struct trax_mesh_material *material_of(const struct trax_mesh *mesh, uint32_t triangle) {
  return &mesh->materials[mesh->triangles[triangle].material];
}

static void test_materials(void **state) {
  (void)state;
  test_text("two words.mtl", "newmtl Material #3\n Kd 0.5 0.25 2\nNs 10\nnewmtl grey\nKd 0.125\nnewmtl none\n");
  struct trax_mesh mesh;
  struct trax_import_report report;
  const char *path = test_text("coloured.obj", "mtllib two words.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
                                               "usemtl Material #3\nf 1 2 3\nusemtl grey\nf 1 2 3\nusemtl none\n"
                                               "f 1 2 3\nusemtl nowhere\nf 1 2 3\n");
  import_good(&mesh, path, &report);
  assert_int_equal(report.missing_files, 0);
  assert_int_equal(mesh.triangle_count, 5);
  assert_string_equal(material_of(&mesh, 1)->name, "Material #3");
  const float expected[5][3] = {
      {0.75f, 0.75f, 0.75f}, {0.5f, 0.25f, 1}, {0.125f, 0.125f, 0.125f}, {0.75f, 0.75f, 0.75f}, {0.75f, 0.75f, 0.75f}};
  for (uint32_t t = 0; t < 5; t++)
    assert_memory_equal(material_of(&mesh, t)->surface.diffuse, expected[t], sizeof expected[t]);
  trax_mesh_release(&mesh);

  const struct trax_material_override overrides[] = {{.colour = {0.25f, 0.25f, 0.25f}},
                                                     {.name = "grey", .colour = {1}}};
  struct trax_import_options options = {.overrides = overrides, .override_count = 2};
  trax_error error;
  assert_int_equal(trax_mesh_import(&mesh, &path, 1, &options, NULL, &error), TRAX_OK);
  assert_true(material_of(&mesh, 1)->surface.diffuse[1] == 0.25f);
  assert_true(material_of(&mesh, 2)->surface.diffuse[0] == 1 && material_of(&mesh, 2)->surface.diffuse[1] == 0);
  /* The scene has what is used, each colour once. */
  struct trax_scene scene;
  build_good(&scene, &mesh, NULL);
  assert_int_equal(scene.material_count, 2);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
  const struct trax_material_override wrong = {.name = "gray", .colour = {1}};
  options = (struct trax_import_options){.overrides = &wrong, .override_count = 1};
  import_bad(path, &options, "no material is named 'gray'");

  import_good(&mesh, test_text("lost.obj", "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"), &report);
  assert_int_equal(report.missing_files, 1);
  assert_contains(report.first_missing_file, "lost.mtl");
  trax_mesh_release(&mesh);
}

/* --- several files --- */

static void test_merge(void **state) {
  (void)state;
  test_text("a.mtl", "newmtl a\nKd 1 0 0\n");
  const char *paths[] = {test_text("a.obj", "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n"),
                         test_text("b.ply", square_ply)};
  struct trax_mesh mesh;
  struct trax_import_report report;
  trax_error error;
  assert_int_equal(trax_mesh_import(&mesh, paths, 2, NULL, &report, &error), TRAX_OK);
  assert_int_equal(mesh.triangle_count, 4);
  assert_int_equal(report.source_triangles, 5);
  assert_int_equal(report.degenerate, 1);
  const uint32_t ids[] = {0, 2, 3, 4}; /* 1 was dropped */
  for (uint32_t t = 0; t < 4; t++)
    assert_int_equal(mesh.triangles[t].source_id, ids[t]);
  assert_corner(&mesh, 3, 0, 0.5f, -0.25f, -2);
  assert_true(material_of(&mesh, 0)->surface.diffuse[1] == 0);
  assert_true(material_of(&mesh, 1)->surface.diffuse[1] == 0.75f);
  trax_mesh_release(&mesh);
}

/* --- triangles that cannot be traced --- */

static bool is_dropped(const char *a, const char *b, const char *c) {
  char text[256];
  snprintf(text, sizeof text, "v %s\nv %s\nv %s\nf 1 2 3\n", a, b, c);
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh, test_text("one.obj", text), &report);
  assert_int_equal(report.degenerate + mesh.triangle_count, 1);
  trax_mesh_release(&mesh);
  return report.degenerate == 1;
}

static void test_degenerate(void **state) {
  (void)state;
  assert_true(is_dropped("1 2 3", "1 2 3", "4 5 6"));
  assert_true(is_dropped("1 2 3", "4 5 6", "1 2 3"));
  assert_true(is_dropped("4 5 6", "1 2 3", "1 2 3"));
  assert_true(is_dropped("1 2 3", "2 4 6", "-3 -6 -9"));
  assert_true(is_dropped("0.1 0.1 0.1", "0.2 0.2 0.2", "0.4 0.4 0.4"));
  assert_true(is_dropped("1e-30 0 0", "3e-30 0 0", "-1e-30 0 0"));
  assert_true(is_dropped("1e-44 0 0", "3e-44 0 0", "-1e-44 0 0"));
  /* The least that binary32 can tell from a line. */
  assert_false(is_dropped("1 2 3", "2 4 6", "-3 -6 -9.000001"));
  assert_false(is_dropped("1e-30 0 0", "3e-30 0 0", "-1e-30 1e-44 0"));
  assert_false(is_dropped("0 0 0", "1 0 0", "0.5 1e-45 0"));
  assert_false(is_dropped("0 0 0", "1e15 0 0", "5e14 1e-45 0"));
  /* The products of the edges agree in binary64 but not exactly. */
  assert_false(is_dropped("0 0 0", "1.00000012 1 0", "1 0.99999988 0"));
}

static void test_nonfinite(void **state) {
  (void)state;
  const char *path = test_text("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 0 inf 0\nv 0 0 1e30\nv 0 0 1e39\n"
                                          "f 1 2 3\nf 1 2 4\nf 3 2 1\nf 1 5 2\nf 6 1 2\nf 1 2 7\n");
  struct trax_mesh mesh;
  struct trax_import_report report;
  trax_error error;
  import_bad(path, NULL, "nan.obj: 4 of 6 triangles");
  import_bad(path, NULL, "the first is triangle 1 ");
  struct trax_import_options drop = {.drop_nonfinite = true};
  assert_int_equal(trax_mesh_import(&mesh, &path, 1, &drop, &report, &error), TRAX_OK);
  assert_int_equal(mesh.triangle_count, 2);
  assert_int_equal(mesh.triangles[1].source_id, 2);
  assert_int_equal(report.nonfinite, 4);
  trax_mesh_release(&mesh);
  /* A vertex that no triangle has does not matter. */
  import_good(&mesh, test_text("large.obj", "v 0 0 0\nv 1.2e18 0 0\nv 0 -1.7e18 0\nf 1 2 3\n"), NULL); /* 2^60 fits */
  assert_int_equal(mesh.triangle_count, 1);
  trax_mesh_release(&mesh);
  import_good(&mesh, test_text("unused.obj", "v nan 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n"), NULL);
  trax_mesh_release(&mesh);
}

/* --- what is refused --- */

#define PLY_START "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
#define PLY_FACES "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"

#define POSITIONS "{\"attributes\":{\"POSITION\":0}}"
#define GLTF_MESH(primitives) GLTF("[0]") "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[" primitives "]}]"
#define GLTF_ACCESSOR(more) ",\"accessors\":[{\"componentType\":5126,\"type\":\"VEC3\"," more "}]"
#define GLTF_BYTES(length)                                                                                             \
  "\"bufferViews\":[{\"buffer\":0,\"byteLength\":" length "}],\"buffers\":[{\"byteLength\":36,\"uri\":"                \
  "\"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA\"}]}"
#define GLTF(roots) "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":" roots "}],"

static const struct bad_mesh {
  const char *name, *text, *message;
} bad_meshes[] = {
    {"high.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n", "high.obj:5: vertex index 4 is out of range (3 so far"},
    {"low.obj", "v 0 0 0\nv 1 0 0\nf 1 2 -3\n", "low.obj:3: vertex index -3 is out of range (2 so far"},
    {"zero.obj", "v 0 0 0\nf 0 1 1\n", "zero.obj:2: not a vertex index: '0'"},
    {"huge.obj", "v 0 0 0\nf 1 1 99999999999999999999\n", "huge.obj:2: vertex index 9999"},
    /* The numbers of what the file does not have mean nothing, but they are numbers, and three at most. */
    {"slashes.obj", "v 0 0 0\nf 1//// 1 1\n", "slashes.obj:2: not a vertex: '1////'"},
    {"three.obj", "v 0 0 0\nf 1 1/// 1\n", "three.obj:2: not a vertex: '1///'"},
    {"fourth.obj", "v 0 0 0\nf 1/2/3/4 1 1\n", "fourth.obj:2: not a vertex: '1/2/3/4'"},
    {"fourth2.obj", "v 0 0 0\nvt 0 0\nf 1/1//2 1 1\n", "fourth2.obj:3: not a vertex: '1/1//2'"},
    {"letter.obj", "v 0 0 0\nf 1/a 1 1\n", "letter.obj:2: not a texture coordinate index: '1/a'"},
    {"letter2.obj", "v 0 0 0\nf 1//a 1 1\n", "letter2.obj:2: not a normal index: '1//a'"},
    {"word.obj", "v 0 0 0\nf 1 1 one\n", "word.obj:2: not a vertex index: 'one'"},
    {"tail.obj", "v 0 0 0\nf 1 1 1x\n", "tail.obj:2: not a vertex index: '1x'"},
    {"short.obj", "v 0 0 0\nf 1 1\n", "short.obj:2: a face needs at least three vertices"},
    {"flat.obj", "v 0 0\n", "flat.obj:1: a vertex needs three coordinates"},
    {"letter.obj", "v 0 0 \\\n0\nv 0 x 0\n", "letter.obj:3: a vertex's coordinate is not a number: 'x'"},
    {"comma.obj", "v 0,5 0 0\n", "comma.obj:1: a vertex's coordinate is not a number: '0,5'"},
    {"nothing.obj", "# nothing\n", "nothing.obj: not a mesh: no vertices"},
    {"prose.obj", "What is this?\n", "prose.obj: not a mesh"},
    {"empty.obj", "", "empty.obj: not a mesh: no vertices"},
    {"empty.ply", "", "empty.ply: not a mesh"},
    {"empty.glb", "", "empty.glb: the file is empty"},
    {"text.txt", "hello\n", "text.txt: not a mesh that can be read"},
    {"half.gltf", "{\"asset\":", "half.gltf: not a mesh that can be read"},
    {"twice.gltf", GLTF("[0]") "\"nodes\":[{\"children\":[1,1]},{}]}",
     "twice.gltf: node 1 is a child of node 0 and again of node 0: nodes must form trees"},
    {"parents.gltf", GLTF("[0,1]") "\"nodes\":[{\"children\":[2]},{\"children\":[2]},{}]}",
     "parents.gltf: node 2 is a child of node 0 and again of node 1"},
    {"circle.gltf", GLTF("[2]") "\"nodes\":[{\"children\":[1]},{\"children\":[0]},{}]}",
     "circle.gltf: node 0 is below more than 1024 others, or below itself"},
    {"roots.gltf", GLTF("[0,0]") "\"nodes\":[{}]}", "roots.gltf: a scene has node 0 twice"},
    {"inner.gltf", GLTF("[0,1]") "\"nodes\":[{\"children\":[1]},{}]}", "inner.gltf: a scene has node 1 as its own and"},
    {"absent.gltf", GLTF("[1]") "\"nodes\":[{}]}", "absent.gltf: a scene has a node that is not there"},
    {"child.gltf", GLTF("[0]") "\"nodes\":[{\"children\":[7]}]}", "child.gltf: node 0 has a child that is not there"},
    {"old.gltf", "{\"asset\":{\"version\":\"1.0\"}}", "old.gltf: glTF of version 1.0; only 2.0 is read"},
    {"none.gltf", "{}", "none.gltf: glTF of version (none); only 2.0 is read"},
    {"scene.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scene\":1,\"scenes\":[{}]}",
     "scene.gltf: its scene is not there"},
    {"mesh.gltf", GLTF("[0]") "\"nodes\":[{\"mesh\":0}]}", "mesh.gltf: a node has a mesh that is not there"},
    {"places.gltf", GLTF_MESH("{\"attributes\":{}}") "}", "places.gltf: mesh 0: its vertices have no positions"},
    {"mode.gltf", GLTF_MESH("{\"mode\":7}") "}", "mode.gltf: mesh 0: mode 7 is unknown"},
    {"paint.gltf", GLTF_MESH("{\"material\":0}") "}", "paint.gltf: mesh 0: its material is not there"},
    {"lost.gltf", GLTF_MESH(POSITIONS) "}", "lost.gltf: a mesh has an accessor that is not there"},
    {"bare.gltf", GLTF_MESH(POSITIONS) GLTF_ACCESSOR("\"count\":2000000000") "}",
     "bare.gltf: accessor 0 is without data"},
    {"sparse.gltf", GLTF_MESH(POSITIONS) GLTF_ACCESSOR("\"count\":3,\"sparse\":{}") "}", "accessor 0 is sparse, which"},
    {"kind.gltf", GLTF_MESH(POSITIONS) ",\"accessors\":[{\"componentType\":5130,\"count\":3,\"type\":\"VEC3\"}]}",
     "kind.gltf: accessor 0 has a type or a count that is not read"},
    {"flat.gltf",
     GLTF_MESH(POSITIONS) ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}]"
                          "," GLTF_BYTES("36"),
     "flat.gltf: an accessor of POSITION has 3 elements of 2 numbers"},
    {"count.gltf", GLTF_MESH(POSITIONS) GLTF_ACCESSOR("\"bufferView\":0,\"count\":1e30") "," GLTF_BYTES("36"),
     "accessor 0 has a type"},
    {"much.gltf", GLTF_MESH(POSITIONS) GLTF_ACCESSOR("\"bufferView\":0,\"count\":4") "," GLTF_BYTES("36"),
     "much.gltf: accessor 0 is beyond its buffer view of 36 bytes"},
    {"behind.gltf",
     GLTF_MESH(POSITIONS) GLTF_ACCESSOR("\"bufferView\":0,\"byteOffset\":4,\"count\":3") "," GLTF_BYTES("36"),
     "behind.gltf: accessor 0 is beyond its buffer view"},
    {"view.gltf", GLTF_MESH(POSITIONS) GLTF_ACCESSOR("\"bufferView\":0,\"count\":3") "," GLTF_BYTES("37"),
     "view.gltf: buffer view 0 is beyond its buffer of 36 bytes"},
    {"index.gltf",
     GLTF_MESH(
         "{\"attributes\":{\"POSITION\":0},\"indices\":1}") ",\"accessors\":[{\"bufferView\":0,"
                                                            "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},{"
                                                            "\"bufferView\":0,\"componentType\":5121,\"count\":36,"
                                                            "\"type\":\"SCALAR\"}]," GLTF_BYTES("36"),
     "index.gltf: mesh 0: vertex index 128 is out of range (3 vertices)"},
    {"file.gltf",
     GLTF_MESH(POSITIONS) GLTF_ACCESSOR(
         "\"bufferView\":0,\"count\":3") ",\"bufferViews\":[{\"buffer\":0,"
                                         "\"byteLength\":36}],\"buffers\":[{\"uri\":\"no%20where.bin\"}]}",
     "no where.bin cannot be read"},
    {"base.gltf",
     GLTF_MESH(POSITIONS) GLTF_ACCESSOR(
         "\"bufferView\":0,\"count\":3") ",\"bufferViews\":[{\"buffer\":0,"
                                         "\"byteLength\":36}],\"buffers\":[{\"uri\":\"data:;base64,AA!A\"}]}",
     "base.gltf: a data URI has a byte that is not base64"},
    {"cut.glb", "glTF\2\1\1\1\60\1\1\1", "cut.glb: GLB of version 16843010; only 2 is read"},
    {"model.stl", "solid",
     "model.stl: not a mesh that can be read: its name ends in none of .ply, .obj, .gltf, .glb and .instances"},
    {"draco.gltf", GLTF("[0]") "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"nodes\":[{}]}",
     "draco.gltf: it requires the extension KHR_draco_mesh_compression, which is not read"},
    {"prose.ply", "plywood\n", "prose.ply: not a mesh"},
    {"cut.ply", PLY_START, "cut.ply:7: the file ends in its header"},
    {"format.ply", "ply\nend_header\n", "format.ply:2: the header has no format"},
    {"middle.ply", "ply\nformat binary_middle_endian 1.0\n", "middle.ply:2: the format is none of"},
    {"version.ply", "ply\nformat ascii 2.0\n", "version.ply:2: the format's version"},
    {"count.ply", "ply\nformat ascii 1.0\nelement vertex many\n", "count.ply:3: an element's count is not a number"},
    {"minus.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", "minus.ply:3: an element's count is not a number"},
    {"many.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\n", "many.ply:3: an element's count is too large"},
    {"early.ply", "ply\nproperty float x\n", "early.ply:2: a property before any element"},
    {"type.ply", PLY_START "property quad q\n", "type.ply:7: unknown type of a property"},
    {"list.ply", PLY_START "property list float int q\n", "list.ply:7: the type of a list's length"},
    {"real.ply", PLY_START "element face 1\nproperty list int float vertex_indices\n",
     "real.ply:8: the type of vertex"},
    {"keyword.ply", PLY_START "elephant face 1\n", "keyword.ply:7: unknown keyword in the header"},
    {"flat.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n",
     "flat.ply: no vertices with"},
    {"faceless.ply", PLY_START "end_header\n0 0 0\n1 0 0\n0 1 0\n", "faceless.ply: no faces"},
    {"large.ply",
     "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
     "property float z\n" PLY_FACES "3 0 1 2\n",
     "large.ply: cut off: too short for the 4000000000 records"},
    {"few.ply", PLY_START PLY_FACES "3 0", "few.ply:13: a list is longer than the file"},
    {"blank.ply", PLY_START PLY_FACES "3 0 1     \n", "blank.ply:14: the file ends too early"},
    {"long.ply", PLY_START PLY_FACES "100 0 1 2\n", "long.ply:13: a list is longer than the file"},
    {"negative.ply", PLY_START PLY_FACES "-3 0 1 2\n", "negative.ply:13: a list's length is negative"},
    {"high.ply", PLY_START PLY_FACES "3 0 1 3\n", "high.ply:13: vertex index 3 is out of range (3 vertices)"},
    {"low.ply", PLY_START PLY_FACES "3 0 1 -1\n", "low.ply:13: vertex index -1 is out of range (3 vertices)"},
    {"more.ply", PLY_START PLY_FACES "3 0 1 2 0\n", "more.ply:13: more values than the header says"},
    {"half.ply", PLY_START PLY_FACES "3 0 1 1.5\n", "half.ply:13: not an integer"},
    {"word.ply",
     PLY_START "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n",
     "word.ply:11: not a number"},
    {"order.ply",
     "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n"
     "property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n",
     "order.ply:10: faces before the vertices"},
};

static void test_bad_meshes(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof bad_meshes / sizeof bad_meshes[0]; i++)
    import_bad(test_text(bad_meshes[i].name, bad_meshes[i].text), NULL, bad_meshes[i].message);
}

static long most_memory(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024;
}

#define TRIANGLE_ACCESSOR "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}"
/* Small files that would fill the memory or take hours: many nodes have a mesh of many triangles, or of many primitives
   without any. */
static void test_bombs(void **state) {
  (void)state;
  enum { MOST = 4 << 20 };
  char *text = malloc(MOST);
  assert_non_null(text);
  for (int kind = 0; kind < 2; kind++) {
    static const char triangles[] = "{\"attributes\":{\"POSITION\":0},\"indices\":1}",
                      nothing[] = "{\"attributes\":{\"POSITION\":0},\"mode\":0}";
    const int nodes = 20000, primitives = kind ? 2000 : 1, indices = 300000;
    size_t size = (size_t)sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[");
    for (int i = 0; i < primitives; i++)
      size += (size_t)sprintf(text + size, "%s%s", i ? "," : "", kind ? nothing : triangles);
    size += (size_t)sprintf(text + size, "]}],\"nodes\":[{\"mesh\":0}");
    for (int i = 1; i < nodes; i++)
      size += (size_t)sprintf(text + size, ",{\"mesh\":0}");
    size += (size_t)sprintf(text + size,
                            "],\"accessors\":[" TRIANGLE_ACCESSOR ",{\"bufferView\":1,\"componentType\":5121,"
                            "\"count\":%d,\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},"
                            "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":%d}],\"buffers\":[{\"uri\":\"data:;base64,",
                            indices, indices);
    memset(text + size, 'A', (36 + (size_t)indices) / 3 * 4);
    size += (36 + (size_t)indices) / 3 * 4;
    size += (size_t)sprintf(text + size, "\"}]}");
    assert_true(size < MOST);
    import_bad(test_text("bomb.gltf", text), NULL, "bomb.gltf: too large: ");
  }
  free(text);
  assert_true(most_memory() < 1500L << 20);
}

/* Accessors of any kind of component, strips and fans, meshes that several nodes have, and indices that use a few of
   many vertices. */
static void test_gltf_primitives(void **state) {
  (void)state;
  static const struct {
    int mode;
    uint32_t triangles, others, first[3], second[3]; /* indices of the vertices */
  } modes[] = {{0, 0, 6, {0}, {0}},
               {1, 0, 3, {0}, {0}},
               {2, 0, 6, {0}, {0}},
               {3, 0, 5, {0}, {0}},
               {4, 2, 0, {5, 4, 3}, {2, 1, 0}},
               {5, 4, 0, {5, 4, 3}, {4, 2, 3}},
               {6, 4, 0, {4, 3, 5}, {3, 2, 5}}};
  unsigned char bytes[80] = {0};
  for (int i = 0; i < 16; i++) /* three bytes each, and one between them */
    bytes[4 * i] = (unsigned char)i, bytes[4 * i + 1] = (unsigned char)(i * i),
              bytes[4 * i + 2] = (unsigned char)(255 - i);
  for (int i = 0; i < 6; i++)
    bytes[70 + i] = (unsigned char)(5 - i);
  test_file("parts.bin", bytes, sizeof bytes);
  for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
    char json[2048];
    snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,7],"
        "\"rotation\":[0,0,1,1],\"scale\":[2,2,2]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"mode\":%d}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5121,\"normalized\":true,\"count\":16,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"byteOffset\":2,\"componentType\":5121,\"count\":6,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":64,\"byteStride\":4},"
        "{\"buffer\":0,\"byteOffset\":68,\"byteLength\":12}],\"buffers\":[{\"byteLength\":80,\"uri\":\"parts.bin\"}]}",
        modes[i].mode);
    struct trax_mesh mesh;
    struct trax_import_report report;
    import_good(&mesh, test_text("parts.gltf", json), &report);
    assert_int_equal(mesh.triangle_count, 2 * modes[i].triangles);
    assert_int_equal(report.other_primitives, 2 * modes[i].others);
    for (uint32_t t = 0; t < 2 && modes[i].triangles; t++)
      for (uint32_t corner = 0; corner < 3; corner++) {
        const uint32_t index = (t ? modes[i].second : modes[i].first)[corner];
        const float x = (float)index / 255, y = (float)(index * index) / 255, z = (float)(255 - index) / 255;
        assert_corner(&mesh, t, corner, x, y, z);
        assert_corner(&mesh, modes[i].triangles + t, corner, -2 * y, 2 * x, (float)(2 * (double)z + 7));
      }
    trax_mesh_release(&mesh);
  }
}

/* PLY files: faces of two vertices are lines, and only the first list of indices counts. */
static void test_odd_faces(void **state) {
  (void)state;
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh,
              test_text("line.ply", PLY_START "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
                                              "0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n1 0\n0\n"),
              &report);
  assert_int_equal(mesh.triangle_count, 1);
  assert_int_equal(report.other_primitives, 3);
  trax_mesh_release(&mesh);
  import_good(&mesh,
              test_text("both.ply", PLY_START "element face 1\nproperty list uchar int vertex_index\n"
                                              "property list uchar int vertex_indices\nend_header\n"
                                              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 2 1 0\n"),
              &report);
  assert_int_equal(mesh.triangle_count, 1);
  assert_int_equal(mesh.triangles[0].vertices[0], 0);
  trax_mesh_release(&mesh);
}

static void test_bad_files(void **state) {
  (void)state;
  import_bad(test_path("nowhere.ply"), NULL, "nowhere.ply: cannot be read: No such file");
  import_bad(test_path("nowhere"), NULL, "nowhere: cannot be read: No such file");
  const char *path = test_path("folder.obj");
  assert_int_equal(mkdir(path, 0700), 0);
  import_bad(path, NULL, "folder.obj: cannot be read: Is a directory");
  assert_int_equal(rmdir(path), 0);
  import_bad(test_file("zeros.obj", "v 0 0 0\n\0\0", 10), NULL, "zeros.obj: not a mesh: binary data");
}

static void test_interrupt(void **state) {
  (void)state;
  const char *path = test_text("square.ply", square_ply);
  const volatile int interrupt = 1;
  struct trax_import_options options = {.interrupt = &interrupt};
  struct trax_mesh mesh;
  trax_error error;
  assert_int_equal(trax_mesh_import(&mesh, &path, 1, &options, NULL, &error), TRAX_INTERRUPTED);
  assert_null(mesh.vertices);
}

/* The forest has as many triangles as the fairy forest, none degenerate, and the same bits on every host.
 */
static void test_forest(void **state) {
  (void)state;
  const struct {
    const char *path;
    uint32_t vertices; /* CRC-32 of their coordinates */
  } forests[] = {{"generate:forest", 0x8B33E0BC}, {"generate:forest:18446744073709551615", 0x9EAB12FB}};
  for (size_t i = 0; i < sizeof forests / sizeof forests[0]; i++) {
    struct trax_mesh mesh;
    struct trax_import_report report;
    import_good(&mesh, forests[i].path, &report);
    assert_int_equal(mesh.triangle_count, 174117);
    assert_int_equal(report.source_triangles, 174117);
    assert_int_equal(report.degenerate, 0);
    uint32_t vertices = (uint32_t)crc32(0, (const void *)mesh.vertices, mesh.vertex_count * sizeof *mesh.vertices);
    assert_int_equal(vertices, forests[i].vertices);
    trax_mesh_release(&mesh);
  }
  static const char *const wrong[] = {
      "generate:",         "generate:wood",      "generate:forests",   "generate:forest:",
      "generate:forest:x", "generate:forest:1x", "generate:forest:-1", "generate:forest:18446744073709551616"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
    import_bad(wrong[i], NULL, "expected generate:forest");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_forest),
      cmocka_unit_test(test_text_formats),
      cmocka_unit_test(test_binary_ply),
      cmocka_unit_test(test_bad_binary_ply),
      cmocka_unit_test(test_ply_types),
      cmocka_unit_test(test_numbers),
      cmocka_unit_test(test_compressed),
      cmocka_unit_test(test_gltf),
      cmocka_unit_test(test_bombs),
      cmocka_unit_test(test_gltf_primitives),
      cmocka_unit_test(test_odd_faces),
      cmocka_unit_test(test_obj_syntax),
      cmocka_unit_test(test_concave_polygons),
      cmocka_unit_test(test_large_polygons),
      cmocka_unit_test(test_unpack_limit),
      cmocka_unit_test(test_materials),
      cmocka_unit_test(test_merge),
      cmocka_unit_test(test_degenerate),
      cmocka_unit_test(test_nonfinite),
      cmocka_unit_test(test_bad_meshes),
      cmocka_unit_test(test_bad_files),
      cmocka_unit_test(test_interrupt),
  };
  return cmocka_run_group_tests_name("scene import", tests, NULL, NULL);
}
