/* Meshes under libFuzzer: a case's first file is a mesh or a file of instances, by its ending, and refers to the
   others. An accepted mesh makes a scene that passes every check. A refused file of instances has a message with its
   place. The words of the first line are materials as --material takes them. With "moves" the mesh is that of half a
   second of its animation, and the tree of its beginning is also refitted to it. */
#include "files.h"

#include <stdlib.h>
#include <string.h>

enum { most_triangles = 3000 }; /* with more no tree is built */

static void refit(const struct trax_mesh *mesh, const char *path, struct trax_import_options options) {
  struct trax_mesh first;
  trax_error error = {.message = ""};
  options.at = 0;
  if (trax_mesh_import(&first, &path, 1, &options, NULL, &error) != TRAX_OK)
    return;
  struct trax_scene base, scene;
  if (trax_scene_build(&base, &first, NULL, &error) == TRAX_OK) {
    const struct trax_build_options build = {.choose_nodes = true, .refit = &base, .refit_name = "base"};
    if (trax_scene_build(&scene, mesh, &build, &error) == TRAX_OK)
      fuzz_check_built(&scene);
    trax_scene_release(&base);
  }
  trax_mesh_release(&first);
}

static bool is_instances(const char *path) {
  const char *ending = strrchr(path, '.');
  return ending && strcmp(ending, ".instances") == 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  enum { most_words = 8 };
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  fuzz_files = &fuzz_case;
  char *words[most_words];
  const size_t count = fuzz_case_words(fuzz_case.options, words, most_words);
  struct trax_material_override overrides[most_words];
  struct trax_import_options options = {.overrides = overrides,
                                        .texture_size = 64,
                                        .drop_nonfinite = size % 2,
                                        .instances = size / 2 % 2,
                                        .flatten = size / 4 % 4 == 0};
  trax_error error = {.message = ""};
  for (size_t i = 0; i < count; i++)
    if (strcmp(words[i], "moves") == 0)
      options.moves = true, options.at = 0.5;
    else
      options.override_count += trax_override_material(&overrides[options.override_count], words[i], &error) == TRAX_OK;
  const char *path = fuzz_case.file_count ? fuzz_case.files[0].name : "none.obj";
  struct trax_mesh mesh;
  error.message[0] = 0;
  if (trax_mesh_import(&mesh, &path, 1, &options, NULL, &error) == TRAX_OK) {
    if (mesh.triangle_count <= most_triangles && mesh.instance_count <= most_triangles) {
      fuzz_build(&mesh);
      if (options.moves)
        refit(&mesh, path, options);
    }
    trax_mesh_release(&mesh);
  } else if (!error.message[0] || (is_instances(path) && strncmp(error.message, path, strlen(path)) != 0)) {
    abort(); /* an error without a reason or a place */
  }
  fuzz_case_free(&fuzz_case);
  return 0;
}

/* --- mutation: within files, by words of their formats --- */

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t capacity, unsigned seed) {
  static const char words[] = "moves mirror glass:2 a=ggx:0.5 emit:1,2,3 b=lambert";
  static const char *const lines[] = {"f 1/1/1 2/2/2 3/3/3\n",
                                      "f -1 -2 -3 -4 -5\n",
                                      "vt 0.5 1e9\n",
                                      "vn 0 0 1\n",
                                      "usemtl a\n",
                                      "mtllib a.mtl\n",
                                      "newmtl b\n",
                                      "map_Kd -clamp on a.png\n",
                                      "map_d a.png\n",
                                      "illum 7\n",
                                      "Ns 1e3\nKs 1 1 1\n",
                                      "v 1e30 nan -inf\n",
                                      "property float nx\n",
                                      "mesh a a.obj\n",
                                      "group b\n",
                                      "place a\n",
                                      "place b material a\n",
                                      "place a 0 -1 0 3  1 0 0 -4e5  0 0 2 0\n",
                                      "place a 1e-3 0 0 nan  0 1e300 0 -inf  0 0 0x1p-4 1e39\n",
                                      "end\n",
                                      "material a ggx:0.5\n",
                                      "property list uchar int vertex_indices\n",
                                      "element face 4294967295\n",
                                      "comment TextureFile a.png\n",
                                      "\"byteStride\":12,",
                                      "\"componentType\":5121,\"normalized\":true,",
                                      "\"mode\":5,",
                                      "\"matrix\":[1,0,0,0,0,-1,0,0,0,0,1,0,9,9,9,1],",
                                      "\"rotation\":[0,0,1,1],\"scale\":[1,-2,0],",
                                      "\"TEXCOORD_1\":1,\"COLOR_0\":0,",
                                      "\"byteOffset\":4294967295,\"count\":1e9,",
                                      "\"interpolation\":\"CUBICSPLINE\",",
                                      "\"target\":{\"node\":0,\"path\":\"weights\"},",
                                      "\"skin\":0,\"weights\":[1,-2],",
                                      "\"extensions\":{\"KHR_texture_transform\":{\"texCoord\":1}},"};
  fuzz_random random = {seed + 1u};
  fuzz_case fuzz_case;
  if (fuzz_below(&random, 4) == 0)
    return fuzz_case_mutate(bytes, size, capacity, seed, words);
  fuzz_case_read(&fuzz_case, bytes, size);
  if (fuzz_case.file_count == 0) {
    fuzz_case_free(&fuzz_case);
    return fuzz_case_mutate(bytes, size, capacity, seed, words);
  }
  fuzz_file *file = &fuzz_case.files[fuzz_below(&random, (uint32_t)fuzz_case.file_count)];
  const size_t room = file->size + 256;
  uint8_t *grown = realloc(file->bytes, room);
  if (!grown)
    abort();
  file->bytes = grown;
  if (fuzz_below(&random, 2)) { /* a line of the format, at the start of a line */
    const char *line = lines[fuzz_below(&random, sizeof lines / sizeof *lines)];
    size_t at = file->size ? fuzz_below(&random, (uint32_t)file->size) : 0;
    while (at > 0 && file->bytes[at - 1] != '\n')
      at--;
    memmove(file->bytes + at + strlen(line), file->bytes + at, file->size - at);
    memcpy(file->bytes + at, line, strlen(line));
    file->size += strlen(line);
  } else
    file->size = LLVMFuzzerMutate(file->bytes, file->size, room);
  size = fuzz_case_write(&fuzz_case, bytes, capacity);
  fuzz_case_free(&fuzz_case);
  return size;
}
