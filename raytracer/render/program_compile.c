/* The compilation of a program for one picture, in several attempts. */
#include "specialise.h"
#include "trax/reads.h"
#include "trax/signals.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

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

/* Whether the message is about a frame that stays too large with the parameters in memory: that frees at most 31
   registers, so 124 bytes of the frame. */
static bool is_far_too_large(const trax_error *error) {
  const char *said = strstr(error->message, "stack frame size");
  unsigned size, limit;
  return said && sscanf(said, "stack frame size (%u) exceeds limit (%u)", &size, &limit) == 2 && size > limit + 128;
}

trax_status trax_program_compile(const struct recipe *recipe, const struct trax_frame *frame, uint32_t icache_bytes,
                                 trax_error *error) {
  static const struct places ways[] = {{.paths_local = true},
                                       {.params_in_memory = true, .paths_local = true},
                                       {0},
                                       {.params_in_memory = true},
                                       {.stack_in_memory = true}};
  const bool paths = frame->params->features & TRAX_PATH_FEATURES;
  const bool large = frame->params->features & (TRAX_FEATURE_BIT(EXACT) | TRAX_FEATURE_BIT(INSTANCES)) ||
                     frame->scene->header->max_depth > TRAX_SCENE_DEFAULT_DEPTH;
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
