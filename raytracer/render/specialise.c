/* Programs for one picture: the device's source after a file of constants (device/run.h), compiled when needed and kept
   under a hash of all inputs of the compilation. */
#include "specialise.h"
#include "trax/input.h"
#include "trax/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static trax_status add_own_flags(struct flags *flags, const char *source, trax_error *error) {
  char path[TRAX_PATH_SIZE], *rest = NULL;
  uint8_t *bytes;
  size_t size;
  if (!join_path(path, source, OWN_FLAGS, "") || access(path, F_OK) != 0)
    return TRAX_OK;
  if (trax_read_file(path, sizeof flags->own - 1, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  memcpy(flags->own, bytes, size);
  flags->own[size] = '\0';
  free(bytes);
  for (char *word = strtok_r(flags->own, " \t\n", &rest); word; word = strtok_r(NULL, " \t\n", &rest)) {
    if (flags->count == sizeof flags->words / sizeof *flags->words)
      return trax_fail(error, "%s: too many options", path);
    flags->words[flags->count++] = word;
  }
  return TRAX_OK;
}

/* source: NULL for the installation's. A recording program needs more stack than local memory has. */
static trax_status choose_flags(struct flags *flags, const char *source, bool record, trax_error *error) {
  static const char *const always[] = {"--target=trax", "-std=c17", "-O3", "-g", "-fdebug-compilation-dir=."};
  flags->count = 0;
  for (size_t i = 0; i < sizeof always / sizeof *always; i++)
    flags->words[flags->count++] = always[i];
  if (record) {
    flags->words[flags->count++] = "-DTRAX_RECORD";
    flags->words[flags->count++] = "-mstack=global";
  }
  return source ? add_own_flags(flags, source, error) : TRAX_OK;
}

#define SOURCE "lib/trax/raytracer"

/* --- the constants --- */

static const char *main_of(const struct trax_frame *frame) {
  return frame->rays ? "rays.c" : "main.c";
}

/* The text of the file of constants, with the name of the source, so that the key depends on it. The constants are
   words, so that every bit and every field is kept. */
static char *constants_text(const struct trax_frame *frame, unsigned queues) {
  /* The part behind the parameters that every picture has. */
  const bool path = frame->params->features & TRAX_PATH_FEATURES;
  const size_t behind =
      path ? sizeof(struct trax_path_params) : sizeof(struct trax_palette_entry) * (frame->scene->material_count > 0);
  uint32_t words[(sizeof(struct trax_render_params) + sizeof(struct trax_path_params)) / 4] = {0};
  const size_t count =
      (sizeof *frame->params + (path ? sizeof(struct trax_path_params) : sizeof(struct trax_palette_entry))) / 4;
  memcpy(words, frame->params, sizeof *frame->params + behind);
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  const uint32_t depth = frame->scene->header->max_depth ? frame->scene->header->max_depth : 1;
  fprintf(out,
          "/* Constants of %s; device/run.h says what they are. */\n"
          "#include \"trax/render_params.h\"\n\n"
          "#define TRAX_SPECIALISED_FEATURES 0x%Xu /*",
          main_of(frame), frame->params->features);
  for (unsigned feature = 0; feature < TRAX_FEATURE_COUNT; feature++)
    if (frame->params->features >> feature & 1)
      fprintf(out, " %s", trax_feature_name(feature));
  fputs(" */\n", out);
  if (frame->params->features & TRAX_FEATURE_BIT(EXACT))
    fputs("#define TRAX_EXACT_HITS 1\n", out);
  if (frame->params->features & TRAX_FEATURE_BIT(INSTANCES))
    fputs("#define TRAX_INSTANCES 1\n", out);
  if (queues > 1)
    fprintf(out, "#define TRAX_QUEUES %u\n", queues < TRAX_MAX_QUEUES ? queues : TRAX_MAX_QUEUES);
  fprintf(out,
          "#define TRAX_TREE_DEPTH %u\n"
          "#define TRAX_NODE_LAYOUT %u\n\n"
          "static const union {\n"
          "  uint32_t words[%zu];\n"
          "  struct {\n"
          "    struct trax_render_params params;\n"
          "    %s behind;\n"
          "  };\n"
          "} trax_constants __attribute__((unused)) = {{",
          depth, frame->params->node_layout, count, path ? "struct trax_path_params" : "struct trax_palette_entry");
  for (size_t i = 0; i < count; i++)
    fprintf(out, "%s0x%08Xu,", i % 6 ? " " : "\n    ", words[i]);
  fputs("\n}};\n", out);
  return fclose(out) == 0 ? text : NULL;
}

/* The general program replaces one that cannot be compiled, if it can do the same. */
static trax_status note_or_error(const struct trax_frame *frame, const struct trax_specialise_options *options,
                                 const char *note, trax_error *error) {
  if (options->record)
    return trax_fail(error, "there is no program that records: %s", note);
  if (frame->rays)
    return trax_fail(error, "--rays: there is no program for it: %s", note);
  if (options->source)
    return trax_fail(error, "--source %s: there is no program: %s", options->source, note);
  if (frame->params->features & TRAX_FEATURE_BIT(INSTANCES))
    return trax_fail(error, "instances: there is no program for them: %s", note);
  if (!trax_node_formats[frame->params->node_layout].general)
    return trax_fail(error, "%s nodes: there is no program for them: %s",
                     trax_node_formats[frame->params->node_layout].name, note);
  if (frame->params->features & TRAX_FEATURE_BIT(RAY_KINDS))
    return trax_fail(error, "--mark-rays: there is no program for it: %s", note);
  return TRAX_OK;
}

trax_status trax_program_specialise(struct trax_program *program, const struct trax_frame *frame,
                                    const struct trax_specialise_options *options, char note[256], trax_error *error) {
  char cache[TRAX_PATH_SIZE], key[33], elf[TRAX_PATH_SIZE], own[TRAX_PATH_SIZE];
  const char *const source = options->source ? options->source : own;
  trax_error reason;
  struct flags flags;
  const uint32_t icache_bytes = options->icache_bytes ? options->icache_bytes : PAPERS_CACHE;
  note[0] = '\0';
  if (choose_flags(&flags, options->source, options->record, error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->cache && snprintf(cache, sizeof cache, "%s", options->cache) >= (int)sizeof cache)
    return trax_fail(error, "--cache: the path is too long");
  if (!options->cache && !trax_program_cache(cache)) {
    snprintf(note, 256, "no place for compiled programs: neither XDG_CACHE_HOME nor HOME is set");
    return note_or_error(frame, options, note, error);
  }
  char *constants = constants_text(frame, options->queues);
  if (!constants)
    return trax_fail(error, "out of memory");
  trax_status status = join_path(own, options->root, SOURCE, "")
                           ? trax_program_key(key, options->root, source, constants, &flags, icache_bytes, &reason)
                           : trax_fail(&reason, "%s: the path is too long", options->root);
  if (status == TRAX_OK && !cache_make_folders(cache)) {
    status = trax_fail(&reason, "%s cannot be written: %s", cache, strerror(errno));
    if (options->cache) {
      free(constants);
      return trax_fail(error, "--cache %s", reason.message);
    }
  }
  if (status == TRAX_OK && !join_path(elf, cache, key, ".elf"))
    status = trax_fail(&reason, "%s: the path is too long", cache);
  const enum cache_entry entry = status == TRAX_OK ? cache_find(elf, key) : CACHE_ABSENT;
  if (status == TRAX_OK && entry != CACHE_GOOD) {
    struct cache_work work;
    status = cache_begin(&work, cache, key, &reason);
    if (status == TRAX_OK) {
      status = trax_write_file(work.header, constants, strlen(constants), &reason);
      if (status == TRAX_OK)
        status = trax_program_compile(&(struct recipe){options->root, source, main_of(frame), !options->source, &work,
                                                       &flags, options->interrupt},
                                      frame, icache_bytes, &reason);
      if (status == TRAX_OK)
        status = cache_commit(&work, cache, key, &reason);
      cache_end(&work);
    }
    if (status == TRAX_OK)
      cache_prune(cache, key);
    if (status == TRAX_OK && entry == CACHE_BAD)
      snprintf(note, 256, "%.200s was damaged, and is made anew", elf);
  }
  free(constants);
  if (status == TRAX_INTERRUPTED)
    return status;
  if (status != TRAX_OK) {
    snprintf(note, 256, "%.255s", reason.message);
    return note_or_error(frame, options, note, error);
  }
  memcpy(program->path, elf, sizeof elf);
  program->specialised = true;
  return TRAX_OK;
}
