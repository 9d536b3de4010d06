/* Instances as text under libFuzzer: a case's first file is read as one of instances, and refers to the others. A
   refusal names its place. What is accepted makes a scene with instances, or a flattened one, that passes every check;
   both have the same triangles. */
#include "files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TRIANGLES = 2000 }; /* with more no scene is built */

static const char path[] = "a.instances";

/* How many triangles it has when all instances are flattened; 0: refused. */
static uint64_t import(bool flatten) {
  const char *const paths[] = {path};
  const struct trax_import_options options = {.texture_size = 64, .flatten = flatten};
  struct trax_mesh mesh;
  trax_error error = {.message = ""};
  if (trax_mesh_import(&mesh, paths, 1, &options, NULL, &error) != TRAX_OK) {
    if (strncmp(error.message, path, strlen(path)) != 0) {
      fprintf(stderr, "a message without its place: %s\n", error.message);
      abort();
    }
    return 0;
  }
  uint64_t triangles = mesh.instance_count ? 0 : mesh.triangle_count;
  for (uint32_t i = 0; i < mesh.instance_count; i++)
    triangles += mesh.parts[mesh.instances[i].part].triangle_count;
  if (triangles <= MOST_TRIANGLES)
    fuzz_build(&mesh);
  trax_mesh_release(&mesh);
  return triangles;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  fuzz_files = &fuzz_case;
  if (fuzz_case.file_count)
    snprintf(fuzz_case.files[0].name, sizeof fuzz_case.files[0].name, "%s", path);
  const uint64_t instances = import(false), flattened = import(true);
  if (instances && flattened && flattened > instances) {
    fprintf(stderr, "%llu triangles, flattened %llu\n", (unsigned long long)instances, (unsigned long long)flattened);
    abort();
  }
  fuzz_case_free(&fuzz_case);
  return 0;
}

/* --- mutation: statements of the format --- */

static const char *one_of(fuzz_random *random, const char *const *words, uint32_t count) {
  return words[fuzz_below(random, count)];
}

static size_t write_statement(char line[400], fuzz_random *random) {
  static const char *const names[] = {"a", "b", "c", "m", "g"};
  static const char *const files[] = {"a.obj", "b.ply", "a.instances", "generate:fir", "none.obj", ""};
  static const char *const materials[] = {"mirror", "0.8,0.1,0.1", "ggx:0.5", "emit:1,2,3", "a=glass", "1,2"};
  static const char *const numbers[] = {"0",    "1",   "-1",   "0.5",   "2",      "1e-3",   "1e3",  "1e6",  "-1e-30",
                                        "1e30", "nan", "-inf", "1e300", "1e-300", "0x1p-4", "1e39", "1.5x", "-0"};
  enum { NAMES = 5, ANY = 2 };
  const char *name = one_of(random, names, NAMES);
  size_t size = 0;
  switch (fuzz_below(random, 8)) {
  case 0:
    return (size_t)sprintf(line, "mesh %s %s\n", name, one_of(random, files, 6));
  case 1:
    return (size_t)sprintf(line, "material %s %s\n", name, one_of(random, materials, 6));
  case 2:
    return (size_t)sprintf(line, "group %s\n", name);
  case 3:
    return (size_t)sprintf(line, "end%s\n", fuzz_below(random, 8) ? "" : " a");
  default:
    size = (size_t)sprintf(line, "place %s", name);
    for (uint32_t i = fuzz_below(random, ANY) ? 12 - (fuzz_below(random, 16) == 0) : 0; i > 0; i--)
      size += (size_t)sprintf(line + size, " %s", one_of(random, numbers, fuzz_below(random, 4) ? 7 : 18));
    if (fuzz_below(random, 3) == 0)
      size += (size_t)sprintf(line + size, " material %s", one_of(random, names, NAMES));
    return size + (size_t)sprintf(line + size, "\n");
  }
}

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t capacity, unsigned seed) {
  fuzz_random random = {seed + 1u};
  fuzz_case fuzz_case;
  char line[400];
  fuzz_case_read(&fuzz_case, bytes, size);
  if (fuzz_case.file_count == 0) {
    fuzz_case_free(&fuzz_case);
    return LLVMFuzzerMutate(bytes, size, capacity);
  }
  fuzz_file *file = &fuzz_case.files[fuzz_below(&random, 8) ? 0 : fuzz_below(&random, (uint32_t)fuzz_case.file_count)];
  if (!(file->bytes = realloc(file->bytes, file->size + sizeof line)))
    abort();
  if (fuzz_below(&random, 4)) { /* a statement in place of a line, or before one */
    const size_t length = write_statement(line, &random);
    size_t at = file->size ? fuzz_below(&random, (uint32_t)file->size + 1) : 0, end = at;
    while (at > 0 && file->bytes[at - 1] != '\n')
      at--;
    while (end < file->size && fuzz_below(&random, 2) == 0 && file->bytes[end++] != '\n')
      ;
    end = fuzz_below(&random, 2) ? at : end;
    memmove(file->bytes + at + length, file->bytes + end, file->size - end);
    memcpy(file->bytes + at, line, length);
    file->size += length - (end - at);
  } else {
    file->size = LLVMFuzzerMutate(file->bytes, file->size, file->size + sizeof line);
  }
  size = fuzz_case_write(&fuzz_case, bytes, capacity);
  fuzz_case_free(&fuzz_case);
  return size;
}
