/* Programs for one picture: the device's source after a file of constants (device/run.h), compiled when needed and kept
   under a hash of all inputs of the compilation. */
#include "program_cache.h"
#include "render.h"
#include "trax/input.h"
#include "trax/output.h"
#include "trax/reads.h"
#include "trax/signals.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xxhash.h>

enum { PAPERS_CACHE = 4096 }; /* bytes: its instruction cache */

#define OWN_FLAGS "flags.txt" /* in the folder of --source */

/* The compiler's options that depend neither on the picture nor on the attempt. */
struct flags {
  const char *words[32];
  size_t count;
  char own[1024]; /* those of the source */
};

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

/* The installed files that a compiled program depends on. */
static const char *const ingredients[] = {
    "bin/trax-clang",    "bin/trax-ld",     "lib/trax/crt0.o",         "lib/trax/libc.a",
    "lib/trax/libgcc.a", "lib/trax/libm.a", "lib/trax/include/trax.h",
};
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

/* --- the key --- */

static trax_status hash_file(XXH3_state_t *state, const char *root, const char *name, trax_error *error) {
  char path[TRAX_PATH_SIZE];
  uint8_t *bytes;
  size_t size;
  if (!join_path(path, root, name, ""))
    return trax_fail(error, "%s: the path is too long", name);
  if (trax_read_file(path, (size_t)1 << 30, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  XXH3_128bits_update(state, name, strlen(name) + 1);
  XXH3_128bits_update(state, &size, sizeof size);
  XXH3_128bits_update(state, bytes, size);
  free(bytes);
  return TRAX_OK;
}

static int is_file(const struct dirent *entry) {
  return entry->d_name[0] != '.' && strchr(entry->d_name, '.') != NULL; /* folders of ours have no dot */
}

bool trax_is_source_name(const char *name) {
  static const char *const endings[] = {"c", "h", "inc", "def", "s", "cc", "cpp", "hpp"};
  bool found = false;
  for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
    found = found || trax_output_has_ending(name, endings[i]);
  return found;
}

/* Other files of the folder, such as pictures of earlier runs, are part of the key, but no inputs. */
static void drop_other(const char *folder, const char *name) {
  char path[TRAX_PATH_SIZE];
  if (!trax_is_source_name(name) && strcmp(name, OWN_FLAGS) != 0 && join_path(path, folder, name, ""))
    trax_reads_drop_path(path);
}

/* All files of a folder, by name. */
static trax_status hash_folder(XXH3_state_t *state, const char *folder, trax_error *error) {
  struct dirent **entries;
  const int count = scandir(folder, &entries, is_file, alphasort);
  if (count < 0)
    return trax_fail(error, "%s: %s", folder, strerror(errno));
  trax_status status = TRAX_OK;
  for (int i = 0; i < count; i++) {
    if (status == TRAX_OK)
      status = hash_file(state, folder, entries[i]->d_name, error);
    drop_other(folder, entries[i]->d_name);
    free(entries[i]);
  }
  free(entries);
  return status;
}

/* Size and date stand for the content of the compiler's library, which is large and belongs to the distribution. */
static void hash_library(XXH3_state_t *state, const char *path) {
  struct stat status = {0};
  stat(path, &status);
  const int64_t identity[] = {status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
  XXH3_128bits_update(state, identity, sizeof identity);
}

/* Increased whenever the same files are compiled in another way. */
#define WAYS_TO_COMPILE "4"

static trax_status make_key(char key[33], const char *root, const char *source, const char *constants,
                            const struct flags *flags, uint32_t icache_bytes, trax_error *error) {
  char headers[TRAX_PATH_SIZE];
  if (!join_path(headers, source, "trax", ""))
    return trax_fail(error, "%s: the path is too long", source);
  XXH3_state_t *state = XXH3_createState();
  if (!state)
    return trax_fail(error, "out of memory");
  XXH3_128bits_reset(state);
  XXH3_128bits_update(state, WAYS_TO_COMPILE, sizeof WAYS_TO_COMPILE);
  trax_status status = TRAX_OK;
  for (size_t i = 0; i < sizeof ingredients / sizeof *ingredients && status == TRAX_OK; i++)
    status = hash_file(state, root, ingredients[i], error);
  if (status == TRAX_OK)
    status = hash_folder(state, source, error);
  if (status == TRAX_OK)
    status = hash_folder(state, headers, error);
  hash_library(state, TRAX_LLVM_LIBRARY);
  for (size_t i = 0; i < flags->count; i++)
    XXH3_128bits_update(state, flags->words[i], strlen(flags->words[i]) + 1);
  if (icache_bytes != PAPERS_CACHE)
    XXH3_128bits_update(state, &icache_bytes, sizeof icache_bytes);
  XXH3_128bits_update(state, constants, strlen(constants));
  const XXH128_hash_t hash = XXH3_128bits_digest(state);
  snprintf(key, 33, "%016llx%016llx", (unsigned long long)hash.high64, (unsigned long long)hash.low64);
  XXH3_freeState(state);
  return status;
}

/* --- compiling --- */

/* Copies the first line that the compiler printed; if it printed none, says how it ended. */
static void first_line(char line[160], int descriptor, int status) {
  char text[160];
  ssize_t got = pread(descriptor, text, sizeof text - 1, 0);
  text[got > 0 ? got : 0] = '\0';
  text[strcspn(text, "\n")] = '\0';
  if (text[0])
    snprintf(line, 160, "%s", text);
  else if (WIFSIGNALED(status))
    snprintf(line, 160, "%s", strsignal(WTERMSIG(status)));
  else
    snprintf(line, 160, "exit status %d", WEXITSTATUS(status));
}

/* The places of data, and the size of the code. Some of these leave too little stack. */
struct places {
  bool params_in_memory; /* instead of constants, which may take registers */
  bool paths_local;      /* struct path in registers and on the stack, instead of in global memory */
  bool small;            /* -O2 */
  bool stack_in_memory;  /* for trees deeper than usual, and for exact hits, whose functions have frames of their own */
};

/* The inputs that all compilation attempts share. */
struct recipe {
  const char *root, *source;
  const char *main; /* the file in it that is compiled */
  bool own;         /* the source is the installation's */
  const struct cache_work *work;
  const struct flags *flags;
  const volatile int *interrupt;
};

/* A command line of the compiler. */
struct command {
  char maps[3][2 * TRAX_PATH_SIZE + 32];
  char clang[TRAX_PATH_SIZE], source[TRAX_PATH_SIZE];
  const char *words[64];
  size_t count;
};

static void add_word(struct command *command, const char *word) {
  command->words[command->count++] = word;
}

/* The program must not contain the names of temporary folders. */
static void map_folders(struct command *command, const struct recipe *recipe) {
  const char *folder = recipe->work->folder;
  const int cache = (int)(strrchr(folder, '/') - folder);
  for (int i = 0; i < 2; i++) { /* relative to the compilation's folder, it has a dot in front */
    const char *dot = i ? "./" : "";
    snprintf(command->maps[i], sizeof command->maps[i], "-fdebug-prefix-map=%s%s=%s%.*s", dot, folder, dot, cache,
             folder);
    add_word(command, command->maps[i]);
  }
  snprintf(command->maps[2], sizeof command->maps[2], "-fdebug-prefix-map=%s=source", recipe->source);
  if (!recipe->own)
    add_word(command, command->maps[2]);
}

static trax_status make_command(struct command *command, const struct recipe *recipe, const struct places *places,
                                trax_error *error) {
  command->count = 0;
  if (!join_path(command->clang, recipe->root, "bin/trax-clang", "") ||
      !join_path(command->source, recipe->source, recipe->main, ""))
    return trax_fail(error, "%s: the path is too long", recipe->source);
  add_word(command, command->clang);
  for (size_t i = 0; i < recipe->flags->count; i++)
    add_word(command, recipe->flags->words[i]);
  add_word(command, "-I");
  add_word(command, recipe->source);
  if (places->params_in_memory)
    add_word(command, "-DTRAX_PARAMS_IN_MEMORY");
  if (places->paths_local)
    add_word(command, "-DTRAX_PATHS_LOCAL");
  if (places->small)
    add_word(command, "-O2");
  if (places->stack_in_memory) {
    add_word(command, "-mstack=global");
    add_word(command, "-mstack-size=2k");
  }
  map_folders(command, recipe);
  add_word(command, "-include");
  add_word(command, recipe->work->header);
  add_word(command, command->source);
  add_word(command, "-o");
  add_word(command, recipe->work->program);
  add_word(command, NULL);
  return TRAX_OK;
}

/* TRAX_ERROR with the reason in *error if the compiler or the linker fails, as for lack of stack. */
static trax_status run_command(const struct command *command, const volatile int *interrupt, trax_error *error) {
  FILE *said = tmpfile();
  if (!said)
    return trax_fail(error, "no temporary file: %s", strerror(errno));
  const pid_t child = trax_fork(SIGTERM);
  if (child == 0) {
    dup2(fileno(said), STDERR_FILENO);
    dup2(fileno(said), STDOUT_FILENO);
    execv(command->clang, (char *const *)command->words);
    _exit(127);
  }
  trax_status result = TRAX_OK;
  int status = 0;
  if (child < 0)
    result = trax_fail(error, "the compiler does not start: %s", strerror(errno));
  else if ((result = trax_wait_for_child(child, SIGTERM, interrupt, &status)) == TRAX_ERROR)
    trax_fail(error, "the compiler is lost: %s", strerror(errno));
  if (result == TRAX_OK && (!WIFEXITED(status) || WEXITSTATUS(status) != 0)) {
    char line[160];
    first_line(line, fileno(said), status);
    result = trax_fail(error, "%s", line);
  }
  fclose(said);
  return result;
}

static trax_status compile(const struct recipe *recipe, const struct places *places, trax_error *error) {
  struct command command;
  if (make_command(&command, recipe, places, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_reads_share();                          /* what the source includes is an input, too */
  trax_reads_drop_path(recipe->work->program); /* the program of an earlier attempt, which was read */
  return run_command(&command, recipe->interrupt, error);
}

static bool fits_cache(const char *program, uint32_t icache_bytes) {
  struct trax_program_size size;
  trax_error ignored;
  return trax_program_measure(&size, program, &ignored) == TRAX_OK && size.code_bytes <= icache_bytes;
}

/* Whether the compiler has said of a function's frame that it would be too large with the parameters in memory, too:
   that frees 31 registers at most, so 124 bytes of the frame. */
static bool is_far_too_large(const trax_error *error) {
  const char *said = strstr(error->message, "stack frame size");
  unsigned size, limit;
  return said && sscanf(said, "stack frame size (%u) exceeds limit (%u)", &size, &limit) == 2 && size > limit + 128;
}

/* Compiles in the first of the ways whose stack suffices. A program larger than the instruction cache is compiled for
   less code, unless it traces paths and is larger in any case. */
static trax_status build(const struct recipe *recipe, const struct trax_frame *frame, uint32_t icache_bytes,
                         trax_error *error) {
  static const struct places ways[] = {{.paths_local = true},
                                       {.params_in_memory = true, .paths_local = true},
                                       {0},
                                       {.params_in_memory = true},
                                       {.stack_in_memory = true}};
  const bool paths = frame->params->features & TRAX_PATH_FEATURES;
  const bool large =
      frame->params->features & TRAX_FEATURE_BIT(EXACT) || frame->scene->header->max_depth > TRAX_SCENE_DEFAULT_DEPTH;
  const size_t count = sizeof ways / sizeof *ways - (large ? 0 : 1);
  trax_status status = TRAX_ERROR;
  for (size_t i = paths ? 0 : 2; i < count && status == TRAX_ERROR; i++) {
    struct places way = ways[i];
    status = compile(recipe, &way, error);
    if (status == TRAX_ERROR && !way.params_in_memory && is_far_too_large(error))
      i++;
    if (status != TRAX_OK || paths || fits_cache(recipe->work->program, icache_bytes))
      continue;
    way.small = true;
    status = compile(recipe, &way, error);
    if (status == TRAX_ERROR)
      status = compile(recipe, &ways[i], error);
  }
  return status;
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
                           ? make_key(key, options->root, source, constants, &flags, icache_bytes, &reason)
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
  const enum cache_entry entry = status == TRAX_OK ? cache_find(elf, key, options->transient) : CACHE_ABSENT;
  if (status == TRAX_OK && entry != CACHE_GOOD) {
    struct cache_work work;
    status = cache_begin(&work, cache, key, &reason);
    if (status == TRAX_OK) {
      status = trax_write_file(work.header, constants, strlen(constants), &reason);
      const struct recipe recipe = {.root = options->root,
                                    .source = source,
                                    .main = main_of(frame),
                                    .own = !options->source,
                                    .work = &work,
                                    .flags = &flags,
                                    .interrupt = options->interrupt};
      if (status == TRAX_OK)
        status = build(&recipe, frame, icache_bytes, &reason);
      if (status == TRAX_OK)
        status = cache_commit(&work, cache, key, options->transient, &reason);
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
