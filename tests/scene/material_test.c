/* Materials, textures, texture coordinates, normals and cameras of mesh files. */
#include "support.h"

#include <jpeglib.h>
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- images made on the spot --- */

typedef unsigned char rgba[4];

static const char *write_png(const char *name, const rgba *pixels, uint32_t width, uint32_t height) {
  const char *path = test_path(name);
  png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = PNG_FORMAT_RGBA};
  assert_true(png_image_write_to_file(&image, path, 0, pixels, 0, NULL));
  return path;
}

static size_t png_bytes(void *bytes, size_t room, const rgba *pixels, uint32_t width, uint32_t height) {
  png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = PNG_FORMAT_RGBA};
  png_alloc_size_t size = room;
  assert_true(png_image_write_to_memory(&image, bytes, &size, 0, pixels, 0, NULL));
  return size;
}

/* An image of one colour. */
static void write_jpeg(const char *name, int red, int green, int blue, unsigned width, unsigned height) {
  struct jpeg_compress_struct jpeg;
  struct jpeg_error_mgr errors;
  FILE *file = fopen(test_path(name), "wb");
  assert_non_null(file);
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  jpeg_stdio_dest(&jpeg, file);
  jpeg.image_width = width;
  jpeg.image_height = height;
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  unsigned char *row = malloc(3 * (size_t)width);
  assert_non_null(row);
  for (unsigned x = 0; x < width; x++)
    row[3 * x] = (unsigned char)red, row[3 * x + 1] = (unsigned char)green, row[3 * x + 2] = (unsigned char)blue;
  while (jpeg.next_scanline < jpeg.image_height)
    jpeg_write_scanlines(&jpeg, &row, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  free(row);
  fclose(file);
}

/* The texel for an sRGB colour, by the standard's formula in the host's own arithmetic. */
static unsigned texel_value(double srgb) {
  const double value = srgb / 255, linear = value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
  return (unsigned)(255 * sqrt(linear) + 0.5);
}

static void assert_texel(uint32_t texel, double red, double green, double blue, unsigned alpha) {
  const unsigned expected[] = {texel_value(red), texel_value(green), texel_value(blue), alpha};
  for (int channel = 0; channel < 4; channel++)
    if ((texel >> 8 * channel & 255) != expected[channel])
      fail_msg("texel %08x: channel %d is not %u", texel, channel, expected[channel]);
}

static const struct trax_material *surface(const struct trax_mesh *mesh, const char *name) {
  for (uint32_t i = 0; i < mesh->material_count; i++)
    if (!strcmp(mesh->materials[i].name, name))
      return &mesh->materials[i].surface;
  fail_msg("no material is named %s", name);
  return NULL;
}

static void assert_colour(const float colour[3], float red, float green, float blue) {
  if (fabsf(colour[0] - red) > 1e-6f || fabsf(colour[1] - green) > 1e-6f || fabsf(colour[2] - blue) > 1e-6f)
    fail_msg("%g %g %g is not %g %g %g", (double)colour[0], (double)colour[1], (double)colour[2], (double)red,
             (double)green, (double)blue);
}

static void assert_near(float value, float expected) {
  if (!(fabsf(value - expected) <= 1e-6f * fmaxf(1, fabsf(expected))))
    fail_msg("%g is not %g", (double)value, (double)expected);
}

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

/* --- MTL --- */

static void test_mtl(void **state) {
  (void)state;
  test_text("kinds.mtl", "newmtl matte\nKd 0.5 0.25 0.125\nKs 0 0 0\nillum 2\n"
                         "newmtl dull\nKd 0.5 0.5 0.5\nKs 1 1 1\nillum 1\n"
                         "newmtl shiny\nKd 0.5 0.5 0.5\nKs 0.25 0.5 0.75\nNs 98\nillum 2\n"
                         "newmtl mirror\nKd 0.1 0.1 0.1\nKs 0.9 0.8 0.7\nillum 3\n"
                         "newmtl varnish\nKd 0.8 0.8 0.8\nKs 0.1 0.1 0.1\nNs 6\nillum 3\n"
                         "newmtl glass\nKd 1 1 1\nNi 1.25\nd 0.1\nillum 7\n"
                         "newmtl window\nillum 4\n"
                         "newmtl lamp\nKe 10 5 -1\n"
                         "newmtl veil\nKd 1 1 1\nTr 0.75\n"
                         "newmtl both\nd 0.5\nTr 0.9\n"
                         "newmtl wild\nNs -5\nKs 2 2 2\nNi 1e30\nillum 1e30\nd -halo 7\n");
  struct trax_mesh mesh;
  import_good(&mesh, test_text("kinds.obj", "mtllib kinds.mtl\n" TRIANGLE "f 1 2 3\n"), NULL);
  const struct trax_material *m = surface(&mesh, "matte");
  assert_int_equal(m->kind, TRAX_MATERIAL_LAMBERT);
  assert_colour(m->diffuse, 0.5f, 0.25f, 0.125f);
  assert_int_equal(surface(&mesh, "dull")->kind, TRAX_MATERIAL_LAMBERT);
  m = surface(&mesh, "shiny");
  assert_int_equal(m->kind, TRAX_MATERIAL_GGX);
  assert_near(m->roughness, sqrtf(0.02f)); /* 2 / (98 + 2) */
  assert_colour(m->specular, 0.25f, 0.5f, 0.75f);
  m = surface(&mesh, "mirror");
  assert_int_equal(m->kind, TRAX_MATERIAL_MIRROR);
  assert_colour(m->specular, 0.9f, 0.8f, 0.7f);
  m = surface(&mesh, "varnish");
  assert_int_equal(m->kind, TRAX_MATERIAL_GGX);
  assert_near(m->roughness, 0.5f);
  m = surface(&mesh, "glass");
  assert_int_equal(m->kind, TRAX_MATERIAL_GLASS);
  assert_true(m->ior == 1.25f && m->alpha_cutoff == 0);
  assert_colour(m->specular, 1, 1, 1);
  assert_true(surface(&mesh, "window")->ior == 1.5f);
  assert_colour(surface(&mesh, "lamp")->emission, 10, 5, 0);
  assert_true(surface(&mesh, "veil")->opacity == 0.25f && surface(&mesh, "veil")->alpha_cutoff == 0.5f);
  assert_true(surface(&mesh, "both")->opacity == 0.5f);
  m = surface(&mesh, "wild");
  assert_int_equal(m->kind, TRAX_MATERIAL_GGX);
  assert_colour(m->specular, 1, 1, 1);
  assert_true(m->roughness == 1 && m->opacity == 1 && m->alpha_cutoff == 0);
  trax_mesh_release(&mesh);
}

static void test_mtl_errors(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } bad[] = {{"newmtl a\nKs\n", "bad.mtl:2: Ks without a colour"},
             {"newmtl a\nKs 1 one 1\n", "bad.mtl:2: Ks: not a number: 'one'"},
             {"Ke 1 1 1\n", "bad.mtl:1: Ke before any newmtl"},
             {"newmtl a\n\nNs\n", "bad.mtl:3: Ns without a number"},
             {"newmtl a\nNi nan\n", "bad.mtl:2: Ni: not a number: 'nan'"},
             {"newmtl a\nd -halo\n", "bad.mtl:2: d without a number"},
             {"newmtl a\nillum two\n", "bad.mtl:2: illum: not a number: 'two'"},
             {"newmtl a\nmap_Kd -clamp on\n", "bad.mtl:2: map_Kd without a name"}};
  const char *path = test_text("bad.obj", "mtllib bad.mtl\n" TRIANGLE "f 1 2 3\n");
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    test_text("bad.mtl", bad[i].text);
    import_bad(path, NULL, bad[i].message);
  }
}

/* --- textures --- */

static const rgba four[] = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {128, 128, 128, 255}};

static void test_textures(void **state) {
  (void)state;
  static const rgba mask[] = {{0, 0, 0, 255}, {255, 255, 255, 255}};
  write_png("four.png", four, 2, 2);
  write_png("mask of two.png", mask, 2, 1);
  write_jpeg("warm.jpg", 200, 100, 50, 16, 8);
  test_text("damaged.png", "\x89PNG\r\n\x1a\nno more");
  test_text("mapped.mtl", "newmtl four\nmap_Kd -s 1 1 1 -o 0 0 -blendu on ./four.png\n"
                          "newmtl tinted\nKd 0.5 0.5 0.5\nmap_Kd -clamp on sub\\..\\four.png\n"
                          "newmtl again\nmap_Kd ./four.png\n"
                          "newmtl holes\nmap_Kd four.png\nmap_d mask of two.png\n"
                          "newmtl stencil\nmap_d C:\\elsewhere\\mask of two.png\n"
                          "newmtl warm\nmap_Kd /nowhere/warm.jpg\n"
                          "newmtl lost\nKd 0.1 0.2 0.3\nmap_Kd lost.png\n"
                          "newmtl damaged\nmap_Kd damaged.png\n"
                          "newmtl device\nmap_Kd ../../dev/zero\n");
  test_text("sub.txt", "");
  const char *path = test_text("mapped.obj", "mtllib mapped.mtl\n" TRIANGLE "vt 0 0\nvt 1 0\nvt 0.5 1 0\n"
                                             "usemtl four\nf 1/1 2/2 3/3\nusemtl warm\nf 1/-1 3/2 2/1\n"
                                             "usemtl again\nf 1 2 3\nusemtl holes\nf 1/1 2/2 3/3\n");
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh, path, &report);
  const struct trax_material *m = surface(&mesh, "four");
  assert_colour(m->diffuse, 1, 1, 1);
  assert_int_equal(m->texture, 1);
  const struct trax_mesh_texture *texture = &mesh.textures[0];
  assert_true(texture->log2_width == 1 && texture->log2_height == 1 && texture->flags == 0);
  /* the lower row first */
  assert_texel(mesh.texels[texture->first_texel], 0, 0, 255, 255);
  assert_texel(mesh.texels[texture->first_texel + 1], 128, 128, 128, 255);
  assert_texel(mesh.texels[texture->first_texel + 2], 255, 0, 0, 255);
  assert_texel(mesh.texels[texture->first_texel + 3], 0, 255, 0, 255);
  assert_int_equal(surface(&mesh, "again")->texture, 1); /* once */

  m = surface(&mesh, "holes");
  assert_true(m->alpha_cutoff == 0.5f && m->opacity == 1);
  texture = &mesh.textures[m->texture - 1];
  assert_int_equal(texture->flags, TRAX_TEXTURE_ALPHA);
  assert_texel(mesh.texels[texture->first_texel], 0, 0, 255, 0);
  assert_texel(mesh.texels[texture->first_texel + 1], 128, 128, 128, 255);
  m = surface(&mesh, "stencil");
  texture = &mesh.textures[m->texture - 1];
  assert_true(texture->log2_width == 1 && texture->log2_height == 0);
  assert_texel(mesh.texels[texture->first_texel], 255, 255, 255, 0);
  assert_texel(mesh.texels[texture->first_texel + 1], 255, 255, 255, 255);
  assert_colour(m->diffuse, 0.75f, 0.75f, 0.75f);

  m = surface(&mesh, "warm");
  texture = &mesh.textures[m->texture - 1];
  assert_true(texture->log2_width == 4 && texture->log2_height == 3);
  for (int channel = 0; channel < 3; channel++) { /* JPEG is not exact */
    static const double colour[] = {200, 100, 50};
    const int value = (int)(mesh.texels[texture->first_texel + 17] >> 8 * channel & 255);
    assert_true(abs(value - (int)texel_value(colour[channel])) <= 3);
  }
  m = surface(&mesh, "lost");
  assert_int_equal(m->texture, 0);
  assert_colour(m->diffuse, 0.1f, 0.2f, 0.3f);
  assert_colour(surface(&mesh, "damaged")->diffuse, 0.75f, 0.75f, 0.75f);
  assert_int_equal(report.missing_files, 3); /* sub/../four.png has no sub, lost.png, and what is no file */
  assert_contains(report.first_missing_file, "sub/../four.png");
  assert_int_equal(report.bad_images, 1);
  assert_contains(report.first_bad_image, "damaged.png: not a readable PNG");

  const float expected[4][3][2] = {
      {{0, 0}, {1, 0}, {0.5f, 1}}, {{0.5f, 1}, {1, 0}, {0, 0}}, {{0}}, {{0, 0}, {1, 0}, {0.5f, 1}}};
  assert_memory_equal(mesh.uvs, expected, sizeof expected);

  /* The scene has what is in use. */
  struct trax_scene scene;
  trax_error error;
  build_good(&scene, &mesh, NULL);
  assert_int_equal(trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error), TRAX_OK);
  assert_int_equal(scene.texture_count, 3);
  assert_int_equal(scene.texel_count, 4 + 128 + 4);
  for (uint32_t i = 0; i < scene.triangle_count; i++)
    assert_memory_equal(scene.uvs[i].corner, expected[scene.source_ids[i]], sizeof expected[0]);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);

  const struct trax_import_options plain = {.no_textures = true};
  assert_int_equal(trax_mesh_import(&mesh, &path, 1, &plain, &report, &error), TRAX_OK);
  assert_true(mesh.texture_count == 0 && report.missing_files == 0 && report.bad_images == 0);
  build_good(&scene, &mesh, NULL);
  assert_true(scene.uvs == NULL && scene.textures == NULL);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* Through the child process and merged: numbers of textures and texels move. */
static void test_merged_textures(void **state) {
  (void)state;
  write_png("four.png", four, 2, 2);
  write_png("one.png", &four[1], 1, 1);
  test_text("a.mtl", "newmtl a\nmap_Kd four.png\n");
  test_text("b.mtl", "newmtl b\nmap_Kd one.png\n");
  const char *paths[] = {
      test_text("plain.obj", TRIANGLE "f 1 2 3\n"),
      test_text("a.obj", "mtllib a.mtl\n" TRIANGLE "vt 0 0\nvt 1 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 3/1/1\n"),
      test_text("b.obj", "mtllib b.mtl\n" TRIANGLE "vt 0.25 0.5\nusemtl b\nf 1/1 2/1 3/1\n")};
  struct trax_mesh mesh;
  trax_error error;
  assert_int_equal(trax_mesh_import(&mesh, paths, 3, NULL, NULL, &error), TRAX_OK);
  assert_int_equal(mesh.texture_count, 2);
  assert_int_equal(mesh.texel_count, 5);
  assert_int_equal(surface(&mesh, "a")->texture, 1);
  assert_int_equal(surface(&mesh, "b")->texture, 2);
  assert_int_equal(mesh.textures[1].first_texel, 4);
  assert_texel(mesh.texels[4], 0, 255, 0, 255);
  assert_true(mesh.uvs[0][1][0] == 0 && mesh.uvs[1][1][0] == 1 && mesh.uvs[2][0][1] == 0.5f);
  assert_true(mesh.normals[0][0][2] == 0 && mesh.normals[1][0][2] == 1 && mesh.normals[2][0][2] == 0);
  trax_mesh_release(&mesh);
}

/* A texture of one colour keeps it at any size; means keep the mean of the light. */
static void test_resampling(void **state) {
  (void)state;
  static rgba grey[100 * 37], board[64 * 64], edge[64 * 64], line[64 * 64];
  for (size_t i = 0; i < sizeof grey / sizeof *grey; i++)
    memcpy(grey[i], (const rgba){90, 160, 230, 255}, sizeof *grey);
  for (size_t i = 0; i < 64 * 64; i++) {
    const unsigned char value = (i + i / 64) % 2 ? 255 : 0;
    memcpy(board[i], (const rgba){value, value, value, 255}, sizeof *board);
    /* transparent texels have a colour that must not be seen */
    memcpy(edge[i], value ? (const rgba){0, 255, 255, 255} : (const rgba){255, 0, 0, 0}, sizeof *edge);
    memset(line[i], i % 64 == 32 || i % 64 == 63 ? 255 : 0, 3);
    line[i][3] = 255;
  }
  write_png("grey.png", grey, 100, 37);
  write_png("board.png", board, 64, 64);
  write_png("edge.png", edge, 64, 64);
  write_png("line.png", line, 64, 64);
  test_text("sizes.mtl", "newmtl grey\nmap_Kd grey.png\nnewmtl board\nmap_Kd board.png\n"
                         "newmtl edge\nmap_Kd edge.png\nmap_d edge.png\nnewmtl line\nmap_Kd line.png\n"
                         "newmtl clamped\nmap_Kd -clamp on line.png\n");
  const char *path = test_text("sizes.obj", "mtllib sizes.mtl\n" TRIANGLE "vt 0 0\nusemtl grey\nf 1/1 2/1 3/1\n");
  struct trax_mesh mesh;
  trax_error error;
  import_good(&mesh, path, NULL);
  assert_true(mesh.textures[0].log2_width == 7 && mesh.textures[0].log2_height == 5);
  for (uint32_t i = 0; i < 128 * 32; i++)
    assert_texel(mesh.texels[i], 90, 160, 230, 255);
  trax_mesh_release(&mesh);

  const struct trax_import_options small = {.texture_size = 8};
  assert_int_equal(trax_mesh_import(&mesh, &path, 1, &small, NULL, &error), TRAX_OK);
  assert_true(mesh.textures[1].log2_width == 3 && mesh.textures[1].log2_height == 3);
  for (uint32_t i = 0; i < 64; i++) {
    const uint32_t texel = mesh.texels[mesh.textures[1].first_texel + i];
    assert_true(abs((int)(texel & 255) - 180) <= 1); /* 255 * sqrt(1/2), not the 188 of a mean of sRGB */
    const uint32_t holed = mesh.texels[mesh.textures[2].first_texel + i];
    assert_true((holed & 0xFFFFFF) == 0xFFFF00);
    assert_true(abs((int)(holed >> 24) - 128) <= 1);
    /* A tent 16 columns wide: 255 * sqrt(0.4375 / 8) and 255 * sqrt(0.5625 / 8) on either side of a line. */
    static const uint32_t lined[2][8] = {{60, 0, 0, 60, 68, 0, 0, 68}, {0, 0, 0, 60, 68, 0, 0, 113}};
    for (int clamp = 0; clamp < 2; clamp++)
      assert_int_equal(mesh.texels[mesh.textures[3 + clamp].first_texel + i] & 255, lined[clamp][i % 8]);
  }
  trax_mesh_release(&mesh);
}

/* Opaque texels stay, however dark: an image that has alpha anywhere is a mask by its alpha, one that has none by its
   brightness. */
static void test_dark_masks(void **state) {
  (void)state;
  static const rgba leaf[2] = {{30, 90, 20, 255}, {200, 200, 200, 0}},
                    half[2] = {{30, 90, 20, 200}, {255, 255, 255, 100}},
                    grey[2] = {{30, 30, 20, 255}, {200, 10, 10, 255}};
  write_png("leaf.png", leaf, 2, 1);
  write_png("half.png", half, 2, 1);
  write_png("grey.png", grey, 2, 1);
  test_text("leaf.mtl", "newmtl leaf\nmap_Kd leaf.png\nmap_d leaf.png\nnewmtl half\nmap_d half.png\n"
                        "newmtl grey\nmap_d grey.png\n");
  const unsigned alphas[3][2] = {{255, 0}, {200, 100}, {30, 200}};
  struct trax_mesh mesh;
  import_good(&mesh, test_text("leaf.obj", "mtllib leaf.mtl\n" TRIANGLE "vt 0 0\nusemtl leaf\nf 1/1 2/1 3/1\n"), NULL);
  assert_int_equal(mesh.texture_count, 3);
  for (uint32_t i = 0; i < 3; i++)
    for (uint32_t texel = 0; texel < 2; texel++)
      assert_int_equal(mesh.texels[mesh.textures[i].first_texel + texel] >> 24, alphas[i][texel]);
  trax_mesh_release(&mesh);
}

/* Names of any length are different if they differ, and are found by all of their letters. */
static void test_long_names(void **state) {
  (void)state;
  char text[4096], names[3][160], diffuse[200];
  int size = 0;
  for (int i = 0; i < 3; i++) {
    snprintf(names[i], sizeof names[i], "%0*d", i == 2 ? 63 : 100, i + 1);
    size += snprintf(text + size, sizeof text - (size_t)size, "newmtl %s\nKd 0.%d 0 0\n", names[i], i + 1);
  }
  test_text("long.mtl", text);
  size = snprintf(text, sizeof text, "mtllib long.mtl\n" TRIANGLE);
  for (int i = 0; i < 3; i++)
    size += snprintf(text + size, sizeof text - (size_t)size, "usemtl %s\nf 1 2 3\n", names[i]);
  const char *path = test_text("long.obj", text);
  struct trax_mesh mesh;
  trax_error error;
  import_good(&mesh, path, NULL);
  assert_int_equal(mesh.material_count, 3);
  for (uint32_t i = 0; i < 3; i++)
    assert_true(fabsf(mesh.materials[mesh.triangles[i].material].surface.diffuse[0] - 0.1f * (float)(i + 1)) < 1e-6f);
  assert_string_equal(mesh.materials[2].name, names[2]);
  trax_mesh_release(&mesh);
  struct trax_material_override override;
  snprintf(diffuse, sizeof diffuse, "%s=1,1,1", names[1]);
  assert_int_equal(trax_override_diffuse(&override, diffuse, &error), TRAX_OK);
  const struct trax_import_options options = {.overrides = &override, .override_count = 1};
  assert_int_equal(trax_mesh_import(&mesh, &path, 1, &options, NULL, &error), TRAX_OK);
  assert_true(mesh.materials[0].surface.diffuse[1] == 0 && mesh.materials[1].surface.diffuse[1] == 1);
  trax_mesh_release(&mesh);
}

static void test_large_uvs(void **state) {
  (void)state;
  write_png("four.png", four, 2, 2);
  test_text("uv.mtl", "newmtl a\nmap_Kd four.png\n");
  const char *path = test_text("uv.obj", "mtllib uv.mtl\nusemtl a\n" TRIANGLE
                                         "vt 1000.25 -3\nvt 1001.5 -3\nvt nan 0\nvt 1e9 0\nvt -1e9 1e30\n"
                                         "f 1/1 2/2 3/2\nf 1/3 2/1 3/1\nf 1/4 2/5 3/4\n");
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh, path, &report);
  const float expected[3][2] = {{0.25f, -3}, {1.5f, -3}, {1.5f, -3}};
  assert_memory_equal(mesh.uvs[0], expected, sizeof expected);
  assert_int_equal(report.mended_uvs, 2);
  for (int i = 0; i < 18; i++)
    assert_true(fabsf(mesh.uvs[i / 6][i / 2 % 3][i % 2]) <= TRAX_SCENE_MAX_UV);
  struct trax_scene scene;
  trax_error error;
  build_good(&scene, &mesh, NULL);
  assert_int_equal(trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error), TRAX_OK);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* Properties that are not read are reported. */
static void test_unread(void **state) {
  (void)state;
  static const struct {
    const char *mtl;
    unsigned unread;
  } libraries[] = {{"map_Kd -s 1 1 1 -o 0 0 -t 0 -mm 0 2 four.png", 0},
                   {"map_Kd -s 2 2 1 four.png", TRAX_UNREAD_UV_TRANSFORMS},
                   {"map_Kd -o 0 0.5 four.png", TRAX_UNREAD_UV_TRANSFORMS},
                   {"map_Bump four.png", TRAX_UNREAD_NORMAL_MAPS},
                   {"norm four.png", TRAX_UNREAD_NORMAL_MAPS}};
  write_png("four.png", four, 2, 2);
  const char *path = test_text("unread.obj", "mtllib unread.mtl\nusemtl a\n" TRIANGLE "vt 0 0\nf 1/1 2/1 3/1\n");
  struct trax_mesh mesh;
  struct trax_import_report report;
  for (size_t i = 0; i < sizeof libraries / sizeof *libraries; i++) {
    char text[200];
    snprintf(text, sizeof text, "newmtl a\n%s\n", libraries[i].mtl);
    test_text("unread.mtl", text);
    import_good(&mesh, path, &report);
    trax_mesh_release(&mesh);
    if (report.unread != libraries[i].unread)
      fail_msg("%s: %u", libraries[i].mtl, report.unread);
  }
  import_good(&mesh, test_text("weighted.obj", "v 0 0 0 1\nv 1 0 0\nv 0 1 0 1\nf 1 2 3\n"), &report);
  assert_int_equal(report.unread, 0);
  trax_mesh_release(&mesh);
  import_good(&mesh, test_text("coloured.obj", "v 0 0 0\nv 1 0 0 0.5 0.25 1\nv 0 1 0\nf 1 2 3\n"), &report);
  assert_int_equal(report.unread, TRAX_UNREAD_COLOURS);
  trax_mesh_release(&mesh);
  char notes[400] = "";
  FILE *caught = tmpfile();
  const int standard_error = dup(STDERR_FILENO);
  dup2(fileno(caught), STDERR_FILENO);
  report.unread = TRAX_UNREAD_COLOURS | TRAX_UNREAD_NORMAL_MAPS | TRAX_UNREAD_UV_TRANSFORMS;
  trax_import_print_notes(&report, "test");
  trax_import_print_notes(&report, "test"); /* notes are printed once */
  dup2(standard_error, STDERR_FILENO);
  close(standard_error);
  rewind(caught);
  notes[fread(notes, 1, sizeof notes - 1, caught)] = '\0';
  fclose(caught);
  assert_string_equal(notes, "test: note: colours of vertices are not read\ntest: note: normal maps are not read\n"
                             "test: note: transforms of texture coordinates are not read\n");
}

/* --- corners --- */

/* A concave polygon is cut; its corners keep what belongs to them. */
static void test_polygon_corners(void **state) {
  (void)state;
  write_png("four.png", four, 2, 2);
  test_text("uv.mtl", "newmtl a\nmap_Kd four.png\n");
  struct trax_mesh mesh;
  import_good(&mesh,
              test_text("arrow.obj", "mtllib uv.mtl\nusemtl a\nv 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\n"
                                     "vt 0 0\nvt 4 0\nvt 1 1\nvt 0 4\nf 1/1 2/2 3/3 4/4\n"),
              NULL);
  assert_int_equal(mesh.triangle_count, 2);
  for (uint32_t t = 0; t < 2; t++)
    for (int corner = 0; corner < 3; corner++) {
      const float *place = mesh.vertices[mesh.triangles[t].vertices[corner]];
      assert_memory_equal(mesh.uvs[t][corner], place, sizeof mesh.uvs[t][corner]);
    }
  trax_mesh_release(&mesh);
}

static void test_corner_errors(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } bad[] = {{TRIANGLE "vt 0 0\nf 1/2 2/1 3/1\n", "bad.obj:5: texture coordinate index 2 is out of range (1 so far)"},
             {TRIANGLE "vt 0 0\nf 1/0 2/1 3/1\n", "bad.obj:5: not a texture coordinate index: '1/0'"},
             {TRIANGLE "vn 0 0 1\nf 1//1 2//1 3//-2\n", "bad.obj:5: normal index -2 is out of range (1 so far)"},
             {TRIANGLE "vn 0 0 1\nf 1//1 2//1 3//1/1\n", "bad.obj:5: not a vertex: '3//1/1'"},
             {"vt\n", "bad.obj:1: a texture coordinate needs a number"},
             {"vt 0 x\n", "bad.obj:1: not a number: 'x'"},
             {"vn 0 0\n", "bad.obj:1: a normal needs three numbers"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    import_bad(test_text("bad.obj", bad[i].text), NULL, bad[i].message);
}

/* The normals of the scene's triangle that was number `id`. */
static const float *normal_of(const struct trax_scene *scene, uint32_t id, int corner) {
  for (uint32_t i = 0; i < scene->triangle_count; i++)
    if (scene->source_ids[i] == id)
      return scene->normals[i].corner[corner];
  fail_msg("no triangle %u", id);
  return NULL;
}

static void assert_normal(const struct trax_scene *scene, uint32_t id, int corner, float x, float y, float z) {
  assert_colour(normal_of(scene, id, corner), x, y, z);
}

static void test_file_normals(void **state) {
  (void)state;
  /* 0: as they are, but for their lengths; 1: all away; 2: one zero, one NaN, one away; 3: none */
  const char *path =
      test_text("normals.obj", TRIANGLE "vn 0 3 4\nvn 0 0 -2\nvn 0 0 0\nvn nan 0 0\nvn 0 -3 -4\n"
                                        "f 1//1 2//1 3//1\nf 1//2 2//5 3//2\nf 1//3 2//4 3//2\nf 1 2 3\n");
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh, path, &report);
  assert_int_equal(report.turned_normals, 1);
  assert_int_equal(report.mended_normals, 1);
  struct trax_scene scene;
  trax_error error;
  build_good(&scene, &mesh, &(struct trax_build_options){.smooth = true});
  assert_int_equal(trax_scene_check(NULL, scene.bytes, scene.size, "scene", &error), TRAX_OK);
  assert_normal(&scene, 0, 0, 0, 0.6f, 0.8f);
  assert_normal(&scene, 1, 0, 0, 0, 1);
  assert_normal(&scene, 1, 1, 0, 0.6f, 0.8f);
  for (int corner = 0; corner < 3; corner++) {
    assert_normal(&scene, 2, corner, 0, 0, 1);
    assert_normal(&scene, 3, corner, 0, 0, 1);
  }
  trax_scene_release(&scene);
  build_good(&scene, &mesh, &(struct trax_build_options){.smooth = true, .compute_normals = true});
  assert_normal(&scene, 0, 0, 0, 0, 1);
  trax_scene_release(&scene);
  build_good(&scene, &mesh, NULL);
  assert_null(scene.normals);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

static void test_ply(void **state) {
  (void)state;
  write_png("skin of it.png", four, 2, 2);
  const char *path = test_text(
      "skinned.ply", "ply\nformat ascii 1.0\ncomment TextureFile skin of it.png\nelement vertex 4\nproperty float x\n"
                     "property float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                     "property float s\nproperty float t\nproperty uchar red\nelement face 1\n"
                     "property list uchar int vertex_indices\nend_header\n0 0 0 0 0 1 0 0 9\n1 0 0 0 0 1 1 0 9\n"
                     "1 1 0 0 0 1 1 0.5 9\n0 1 0 0 3 4 0 0.5 9\n4 0 1 2 3\n");
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh, path, &report);
  assert_int_equal(report.missing_files, 0);
  assert_int_equal(report.unread, TRAX_UNREAD_COLOURS);
  assert_int_equal(mesh.triangle_count, 2);
  assert_int_equal(mesh.materials[0].surface.texture, 1);
  assert_colour(mesh.materials[0].surface.diffuse, 1, 1, 1);
  for (uint32_t t = 0; t < 2; t++)
    for (int corner = 0; corner < 3; corner++) {
      const uint32_t vertex = mesh.triangles[t].vertices[corner];
      assert_true(mesh.uvs[t][corner][0] == mesh.vertices[vertex][0]);
      assert_true(mesh.uvs[t][corner][1] == mesh.vertices[vertex][1] / 2);
      assert_colour(mesh.normals[t][corner], 0, vertex == 3 ? 0.6f : 0, vertex == 3 ? 0.8f : 1);
    }
  trax_mesh_release(&mesh);
}

/* --- glTF --- */

static void test_gltf(void **state) {
  (void)state;
  static const struct {
    float points[3][3], normals[3][3], uvs[3][2]; /* v down */
  } corners = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0.6f, 0.8f}, {0, 0, 1}, {0, 0, 1}}, {{0, 0}, {1, 0}, {0, 1}}};
  unsigned char bytes[8192], image[1024];
  const size_t image_size = (png_bytes(image, sizeof image, four, 2, 2) + 3) & ~(size_t)3;
  write_png("four of it.png", four, 2, 2);
  char json[6000];
  int length = snprintf(
      json, sizeof json,
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2,3,4,5,6,7]}],\"nodes\":["
      "{\"mesh\":0},{\"mesh\":1},{\"mesh\":2},{\"mesh\":3},{\"mesh\":4},{\"mesh\":5,\"scale\":[1,2,-1]},{\"mesh\":6},"
      "{\"name\":\"eye\",\"camera\":0,\"translation\":[1,2,3]}],"
      "\"cameras\":[{\"type\":\"perspective\",\"name\":\"eye\",\"perspective\":{\"yfov\":0.7853981,\"znear\":0.1}}],"
      "\"images\":[{\"bufferView\":1,\"mimeType\":\"image/png\"},{\"uri\":\"four%%20of%%20it.png\"}],"
      "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33071}],"
      "\"textures\":[{\"source\":0},{\"source\":1,\"sampler\":0}],\"materials\":["
      "{\"name\":\"inner\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"baseColorFactor\":[1,0.5,1,1]"
      "}},"
      "{\"name\":\"outer\",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25,"
      "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":1},\"roughnessFactor\":1}},"
      "{\"name\":\"gold\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.8,0.4,1],\"metallicFactor\":1,"
      "\"roughnessFactor\":0.5}},"
      "{\"name\":\"plastic\",\"emissiveFactor\":[1,0.5,0.25],\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0."
      "5,1],"
      "\"metallicFactor\":0,\"roughnessFactor\":0.5}},"
      "{\"name\":\"chrome\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.9,0.9,1],\"metallicFactor\":1,"
      "\"roughnessFactor\":0}},"
      "{\"name\":\"clear\",\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}},"
      "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0}},"
      "{\"name\":\"faint\",\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.25]}}],"
      "\"extensionsUsed\":[\"KHR_materials_transmission\"],\"meshes\":[");
  for (int i = 0; i < 7; i++)
    length += snprintf(json + length, sizeof json - (size_t)length,
                       "%s{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},"
                       "\"material\":%d}]}",
                       i ? "," : "", i);
  length += snprintf(
      json + length, sizeof json - (size_t)length,
      "],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":96},"
      "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":%zu}],\"accessors\":["
      "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},"
      "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
      "{\"bufferView\":0,\"byteOffset\":72,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
      "\"buffers\":[{\"byteLength\":%zu}]}",
      image_size, 96 + image_size);
  while (length % 4)
    json[length++] = ' ';
  assert_true((size_t)length < sizeof json);
  const uint32_t all = 12 + 8 + (uint32_t)length + 8 + 96 + (uint32_t)image_size;
  const uint32_t header[] = {0x46546C67u, 2, all, (uint32_t)length, 0x4E4F534Au};
  const uint32_t chunk[] = {96 + (uint32_t)image_size, 0x004E4942u};
  size_t size = 0;
  append(bytes, &size, header, sizeof header);
  append(bytes, &size, json, (size_t)length);
  append(bytes, &size, chunk, sizeof chunk);
  append(bytes, &size, &corners, sizeof corners);
  append(bytes, &size, image, image_size);
  struct trax_mesh mesh;
  struct trax_import_report report;
  import_good(&mesh, test_file("kinds.glb", bytes, size), &report);
  assert_int_equal(report.missing_files, 0);
  assert_int_equal(report.bad_images, 0);
  assert_int_equal(report.turned_normals, 0);
  assert_int_equal(mesh.triangle_count, 7);

  const struct trax_material *m = surface(&mesh, "inner");
  assert_int_equal(m->kind, TRAX_MATERIAL_LAMBERT);
  assert_colour(m->diffuse, 1, 0.5f, 1);
  const struct trax_mesh_texture *texture = &mesh.textures[m->texture - 1];
  assert_texel(mesh.texels[texture->first_texel], 0, 0, 255, 255);
  assert_true(texture->flags == 0 && m->alpha_cutoff == 0);
  /* v is up with us */
  assert_true(mesh.uvs[0][0][1] == 1 && mesh.uvs[0][2][1] == 0 && mesh.uvs[0][1][0] == 1);
  assert_colour(mesh.normals[0][0], 0, 0.6f, 0.8f);

  m = surface(&mesh, "outer");
  assert_true(m->alpha_cutoff == 0.25f && m->texture != surface(&mesh, "inner")->texture && m->texture > 0);
  assert_int_equal(mesh.textures[m->texture - 1].flags, TRAX_TEXTURE_CLAMP);

  m = surface(&mesh, "gold");
  assert_int_equal(m->kind, TRAX_MATERIAL_GGX);
  assert_true(m->roughness == 0.25f);
  assert_colour(m->specular, 1, 0.8f, 0.4f);
  assert_colour(m->diffuse, 0, 0, 0);
  m = surface(&mesh, "plastic");
  assert_int_equal(m->kind, TRAX_MATERIAL_GGX);
  assert_colour(m->specular, 0.04f, 0.04f, 0.04f);
  assert_colour(m->diffuse, 0.5f, 0.5f, 0.5f);
  assert_colour(m->emission, 1, 0.5f, 0.25f);
  m = surface(&mesh, "chrome");
  assert_int_equal(m->kind, TRAX_MATERIAL_MIRROR);
  assert_colour(m->specular, 0.9f, 0.9f, 0.9f);
  m = surface(&mesh, "clear");
  assert_int_equal(m->kind, TRAX_MATERIAL_GLASS);
  assert_true(m->ior == 1.5f);
  m = surface(&mesh, "faint");
  assert_true(m->opacity == 0.25f && m->alpha_cutoff == 0.5f);

  /* Mirrored and stretched: the normal stays perpendicular to what was its plane, on the outside. */
  const struct trax_mesh_triangle *turned = &mesh.triangles[5];
  assert_true(mesh.vertices[turned->vertices[1]][1] == 2 && mesh.vertices[turned->vertices[2]][0] == 1);
  assert_colour(mesh.normals[5][0], 0, 0.3f / sqrtf(0.73f), -0.8f / sqrtf(0.73f));
  assert_true(mesh.uvs[5][1][1] == 0 && mesh.uvs[5][2][0] == 1);

  assert_int_equal(mesh.camera_count, 1);
  assert_string_equal(mesh.cameras[0].name, "eye");
  assert_colour(mesh.cameras[0].eye, 1, 2, 3);
  assert_colour(mesh.cameras[0].direction, 0, 0, -1);
  assert_colour(mesh.cameras[0].up, 0, 1, 0);
  assert_true(fabsf(mesh.cameras[0].fov - 45) < 1e-3f);
  trax_mesh_release(&mesh);
}

/* One pixel of 188, 0, 0. */
#define RED_PNG                                                                                                        \
  "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADE"                                           \
  "lEQVR4nGPYw8AAAAI4AL0jbUIJAAAAAElFTkSuQmCC"

/* The extension's own example shows the lower left quarter of an image, turned clockwise by 90 degrees. */
static void test_gltf_uv_transforms(void **state) {
  (void)state;
  static const struct {
    const char *transform;
    float expected[4][2]; /* of a quad's corners, in the image, v up */
  } cases[] = {
      {"", {{0, 1}, {1, 1}, {1, 0}, {0, 0}}},
      {"\"offset\":[0,1],\"rotation\":1.57079632679,\"scale\":[0.5,0.5]", {{0, 0}, {0, 0.5f}, {0.5f, 0.5f}, {0.5f, 0}}},
      {"\"offset\":[0,1],\"scale\":[1,-1]", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
      {"\"offset\":[0.25,-0.5]", {{0.25f, 1.5f}, {1.25f, 1.5f}, {1.25f, 0.5f}, {0.25f, 0.5f}}},
      {"\"texCoord\":1", {{0, 0}, {0, 0}, {1, 1}, {1, 1}}},
      /* scaled first, then turned by atan(3/4) */
      {"\"rotation\":0.643501109,\"scale\":[5,10]", {{0, 1}, {4, 4}, {10, -4}, {6, -7}}}};
  static const float corners[] = {0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 0, 0, /* uvs, v down */ 0, 0, 1, 0, 1, 1, 0, 1};
  static const uint16_t indices[] = {0, 3, 2, 0, 2, 1};
  unsigned char buffer[sizeof corners + sizeof indices];
  memcpy(buffer, corners, sizeof corners);
  memcpy(buffer + sizeof corners, indices, sizeof indices);
  test_file("quad.bin", buffer, sizeof buffer);
  write_png("four.png", four, 2, 2);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char json[3000];
    const int length = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"extensionsUsed\":[\"KHR_texture_transform\"],\"images\":[{\"uri\":\"four.png\"},{\"uri\":\"" RED_PNG "\"}],"
        "\"textures\":[{\"source\":0},{\"source\":1}],\"materials\":[{\"normalTexture\":{\"index\":0},"
        "\"emissiveFactor\":[0.5,1,1],\"emissiveTexture\":{\"index\":1},"
        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"extensions\":"
        "{\"KHR_texture_transform\":{%s}}}}}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"TEXCOORD_0\":1,\"TEXCOORD_1\":3,\"COLOR_0\":0},\"indices\":2,\"material\":0}]}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":80},"
        "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":12}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":48,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"}],"
        "\"buffers\":[{\"byteLength\":92,\"uri\":\"quad.bin\"}]}",
        cases[i].transform);
    assert_true((size_t)length < sizeof json);
    struct trax_mesh mesh;
    struct trax_import_report report;
    import_good(&mesh, test_text("quad.gltf", json), &report);
    assert_int_equal(report.unread, TRAX_UNREAD_COLOURS | TRAX_UNREAD_NORMAL_MAPS);
    assert_int_equal(mesh.triangle_count, 2);
    assert_colour(mesh.materials[0].surface.emission, 0.5f * 0.502886f, 0, 0);
    for (uint32_t t = 0; t < 2; t++)
      for (int corner = 0; corner < 3; corner++) {
        const float *place = mesh.vertices[mesh.triangles[t].vertices[corner]], *uv = mesh.uvs[t][corner];
        const float *expected = cases[i].expected[place[1] > 0 ? (int)place[0] : 3 - (int)place[0]];
        if (fabsf(uv[0] - expected[0]) > 2e-5f || fabsf(uv[1] - expected[1]) > 2e-5f)
          fail_msg("%s: (%g, %g) has %g %g, not %g %g", cases[i].transform, (double)place[0], (double)place[1],
                   (double)uv[0], (double)uv[1], (double)expected[0], (double)expected[1]);
      }
    trax_mesh_release(&mesh);
  }
}

/* --- the command line --- */

static void test_overrides(void **state) {
  (void)state;
  static const struct {
    const char *text, *name;
    enum trax_override_kind kind;
    float value, red;
  } good[] = {
      {"lambert", NULL, TRAX_OVERRIDE_LAMBERT, 0, 0},          {"a b=mirror", "a b", TRAX_OVERRIDE_MIRROR, 0, 1},
      {"mirror:0.5,1,1", NULL, TRAX_OVERRIDE_MIRROR, 0, 0.5f}, {"x=y=glass", "x=y", TRAX_OVERRIDE_GLASS, 1.5f, 1},
      {"glass:1.25", NULL, TRAX_OVERRIDE_GLASS, 1.25f, 1},     {"ggx:0.125", NULL, TRAX_OVERRIDE_GGX, 0.125f, 0.04f},
      {"m=ggx:1:0.75,0,0", "m", TRAX_OVERRIDE_GGX, 1, 0.75f},  {"emit:20,1,1", NULL, TRAX_OVERRIDE_EMISSION, 0, 20}};
  static const char *const bad[] = {"",         "wood",        "glass:",       "glass:0.5", "glass:nan",
                                    "ggx",      "ggx:2",       "ggx:1:",       "ggx:1:2,0", "emit",
                                    "emit:1,1", "emit:-1,0,0", "mirror:2,0,0", "lambert:1", "glass:1.5x"};
  trax_error error;
  struct trax_material_override override;
  char text[64];
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    snprintf(text, sizeof text, "%s", good[i].text);
    assert_int_equal(trax_override_material(&override, text, &error), TRAX_OK);
    assert_int_equal(override.kind, good[i].kind);
    assert_true(override.value == good[i].value && override.colour[0] == good[i].red);
    if (good[i].name)
      assert_string_equal(override.name, good[i].name);
    else
      assert_null(override.name);
  }
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    snprintf(text, sizeof text, "%s", bad[i]);
    if (trax_override_material(&override, text, &error) != TRAX_ERROR)
      fail_msg("accepted: %s", bad[i]);
    assert_contains(error.message, "--material: '");
  }

  char glass[] = "a=glass:2", lamp[] = "emit:3,0,0", red[] = "a=1,0,0";
  struct trax_material_override all[3];
  assert_int_equal(trax_override_material(&all[0], glass, &error), TRAX_OK);
  assert_int_equal(trax_override_material(&all[1], lamp, &error), TRAX_OK);
  assert_int_equal(trax_override_diffuse(&all[2], red, &error), TRAX_OK);
  const char *path = test_text("two.obj", TRIANGLE "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
  struct trax_mesh mesh;
  const struct trax_import_options options = {.overrides = all, .override_count = 3};
  assert_int_equal(trax_mesh_import(&mesh, &path, 1, &options, NULL, &error), TRAX_OK);
  const struct trax_material *a = surface(&mesh, "a"), *b = surface(&mesh, "b");
  assert_true(a->kind == TRAX_MATERIAL_GLASS && a->ior == 2 && a->emission[0] == 3 && a->diffuse[1] == 0);
  assert_true(b->kind == TRAX_MATERIAL_LAMBERT && b->emission[0] == 3 && b->diffuse[1] == 0.75f);
  trax_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_mtl),
      cmocka_unit_test(test_mtl_errors),
      cmocka_unit_test(test_textures),
      cmocka_unit_test(test_merged_textures),
      cmocka_unit_test(test_resampling),
      cmocka_unit_test(test_dark_masks),
      cmocka_unit_test(test_long_names),
      cmocka_unit_test(test_large_uvs),
      cmocka_unit_test(test_polygon_corners),
      cmocka_unit_test(test_corner_errors),
      cmocka_unit_test(test_file_normals),
      cmocka_unit_test(test_ply),
      cmocka_unit_test(test_gltf),
      cmocka_unit_test(test_gltf_uv_transforms),
      cmocka_unit_test(test_unread),
      cmocka_unit_test(test_overrides),
  };
  return cmocka_run_group_tests_name("materials", tests, NULL, NULL);
}
