#define _GNU_SOURCE /* realpath, readlink, open_memstream, dladdr */
/* The sources that the page contains. A program's debug information may name any file of the host, so a file is copied
   only if, with links resolved, it lies

   - below a folder that the user or trax's installation gives, or
   - below the program's own folder or the current one, which are neither the root nor the user's home, there in no
     hidden folder, and below one of the folders in which the program was compiled. */
#include "explain/page.h"
#include "explain/places.h"
#include "explain/texts.h"
#include "trax/input.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_GIVEN = TRAX_EXPLAIN_MAX_SOURCE_FOLDERS + 1, INSTALLED = TRAX_EXPLAIN_MAX_SOURCE_FOLDERS };

struct sources {
  struct trax_explain *explain;
  char *given[MAX_GIVEN]; /* resolved paths; NULL: none. The last one is the installation's */
  char *own[2];           /* the program's folder and the current one; NULL: no project's */
  char **compiled;        /* the compilation folders */
  size_t compiled_count;
  struct trax_texts files; /* that the lines name */
  bool any;                /* a file has been written */
  FILE *note;              /* receives the names of the copied files, the installation's excepted, */
  FILE *left_out;          /* and of those that the rule leaves out; both begin with ", " */
};

trax_status trax_explain_add_source_folder(struct trax_explain_options *options, const char *folder,
                                           trax_error *error) {
  struct stat status;
  if (stat(folder, &status) != 0 || !S_ISDIR(status.st_mode))
    return trax_fail(error, "'%s' is no folder", folder);
  if (options->source_folder_count == TRAX_EXPLAIN_MAX_SOURCE_FOLDERS)
    return trax_fail(error, "'%s' is one too many: %d folders are possible", folder, TRAX_EXPLAIN_MAX_SOURCE_FOLDERS);
  options->source_folders[options->source_folder_count++] = folder;
  return TRAX_OK;
}

/* --- the rule --- */

/* Returns the part of a resolved path below a folder; NULL: it is not below. */
static const char *below(const char *path, const char *folder) {
  const size_t length = folder ? strlen(folder) : 0;
  if (length == 0 || strncmp(path, folder, length) != 0)
    return NULL;
  if (folder[length - 1] == '/') /* the root */
    return path + length;
  return path[length] == '/' ? path + length + 1 : NULL;
}

static bool is_given(const struct sources *sources, const char *path) {
  for (unsigned i = 0; i < MAX_GIVEN; i++)
    if (below(path, sources->given[i]))
      return true;
  return false;
}

static bool is_own(const struct sources *sources, const char *path) {
  bool own = false;
  for (unsigned i = 0; i < 2 && !own; i++) {
    const char *rest = below(path, sources->own[i]);
    own = rest && rest[0] != '.' && !strstr(rest, "/.");
  }
  for (size_t i = 0; own && i < sources->compiled_count; i++)
    if (below(path, sources->compiled[i]))
      return true;
  return false;
}

/* Returns the resolved folder of a file. */
static char *folder_of(const char *path) {
  char *resolved = realpath(path, NULL), *slash = resolved ? strrchr(resolved, '/') : NULL;
  if (slash)
    slash[slash == resolved] = 0;
  return resolved;
}

/* Returns the resolved lib/trax of the installation to which this code belongs: the shared library's folder, whatever
   program has loaded it, or else that beside the running program. */
static char *installed_folder(void) {
  static const char here;
  Dl_info object;
  const char *ending = dladdr(&here, &object) && object.dli_fname ? strrchr(object.dli_fname, '.') : NULL;
  if (ending && strcmp(ending, ".so") == 0)
    return folder_of(object.dli_fname);
  char path[PATH_MAX + 32];
  const ssize_t length = readlink("/proc/self/exe", path, PATH_MAX);
  if (length <= 0)
    return NULL;
  path[length] = 0;
  char *slash = strrchr(path, '/');
  if (!slash)
    return NULL;
  strcpy(slash, "/../lib/trax");
  return realpath(path, NULL);
}

/* Returns a folder that may be a project's, else NULL. All that a user has is below the root and the home. */
static char *unless_shared(char *folder) {
  const char *named = getenv("HOME");
  char *home = named ? realpath(named, NULL) : NULL;
  if (folder && (strcmp(folder, "/") == 0 || (home && strcmp(folder, home) == 0))) {
    free(folder);
    folder = NULL;
  }
  free(home);
  return folder;
}

static bool find_folders(struct sources *sources) {
  const struct trax_explain_options *options = &sources->explain->options;
  const struct trax_loaded *loaded = trax_loaded_of(sources->explain->machine);
  const char *const *compiled = NULL;
  const size_t count = loaded ? trax_image_folders(loaded->image, &compiled) : 0;
  for (unsigned i = 0; i < options->source_folder_count; i++)
    sources->given[i] = realpath(options->source_folders[i], NULL);
  sources->given[INSTALLED] = installed_folder();
  sources->own[0] = unless_shared(loaded ? folder_of(trax_image_path(loaded->image)) : NULL);
  sources->own[1] = unless_shared(realpath(".", NULL));
  if (!(sources->compiled = calloc(count + 1, sizeof *sources->compiled)))
    return false;
  for (size_t i = 0; i < count; i++)
    if (i == 0 || strcmp(compiled[i], compiled[i - 1]) != 0) {
      char *resolved = realpath(compiled[i], NULL);
      if (resolved)
        sources->compiled[sources->compiled_count++] = resolved;
    }
  return true;
}

/* --- writing --- */

/* Lists the files of those names that are lines, "FILE:LINE". */
static bool list_files(struct sources *sources, const uint32_t *names, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) {
    const char *line = trax_places_name(sources->explain->places, names[i]), *colon = strrchr(line, ':');
    if (!colon || line[0] == '(' || !colon[1] || strspn(colon + 1, "0123456789") != strlen(colon + 1))
      continue;
    char *file = strdup(line);
    if (file)
      file[colon - line] = 0;
    const bool added = file && trax_texts_number(&sources->files, file);
    free(file);
    if (!added)
      return false;
  }
  return true;
}

/* Returns the resolved path of a file, whose name may be relative to one of the compilation folders; NULL: none. */
static char *resolve(const struct sources *sources, const char *name) {
  char joined[PATH_MAX], *path = NULL;
  for (size_t i = 0; name[0] != '/' && !path && i < sources->compiled_count; i++)
    if (snprintf(joined, sizeof joined, "%s/%s", sources->compiled[i], name) < (int)sizeof joined)
      path = realpath(joined, NULL);
  return path ? path : realpath(name, NULL);
}

/* A file that is missing, too long or no file is left out. */
static void put_source(struct sources *sources, const char *name, FILE *out) {
  char *path = resolve(sources, name);
  const bool wanted = path && (is_given(sources, path) || is_own(sources, path));
  trax_error ignored;
  trax_input input = {.descriptor = -1};
  if (path && trax_input_open(&input, path, &ignored) == TRAX_OK && input.is_regular &&
      input.expected <= TRAX_TEXT_LIMIT) {
    if (!wanted) {
      fprintf(sources->left_out, ", %s", name);
    } else if (trax_input_read(&input, TRAX_TEXT_LIMIT, &ignored) == TRAX_OK) {
      fputs(sources->any ? ",\n" : "", out);
      sources->any = true;
      trax_page_quote(out, name, strlen(name));
      fputs(": ", out);
      trax_page_quote(out, (const char *)input.bytes, input.size);
      if (!below(path, sources->given[INSTALLED]))
        fprintf(sources->note, ", %s", name);
    }
  }
  trax_input_close(&input);
  free(path);
}

static void tell(const struct trax_explain_options *options, const char *copied, const char *left_out) {
  char *text = NULL;
  size_t size;
  FILE *out = options->note && (*copied || *left_out) ? open_memstream(&text, &size) : NULL;
  if (!out)
    return;
  if (*copied)
    fprintf(out, "%s contains %s%s", options->explore, copied + 2, *left_out ? "; " : "");
  if (*left_out)
    fprintf(out, "%s lacks %s, which --source-folder FOLDER can allow", *copied ? "it" : options->explore,
            left_out + 2);
  if (fclose(out) == 0)
    options->note(text);
  free(text);
}

static void release(struct sources *sources) {
  for (unsigned i = 0; i < MAX_GIVEN; i++)
    free(sources->given[i]);
  free(sources->own[0]);
  free(sources->own[1]);
  for (size_t i = 0; i < sources->compiled_count; i++)
    free(sources->compiled[i]);
  free(sources->compiled);
  trax_texts_free(&sources->files);
}

trax_status trax_sources_put(struct trax_explain *explain, const uint32_t *names, uint32_t count, FILE *out,
                             trax_error *error) {
  struct sources sources = {.explain = explain};
  char *note = NULL, *left_out = NULL;
  size_t note_size, left_out_size;
  sources.note = open_memstream(&note, &note_size);
  sources.left_out = open_memstream(&left_out, &left_out_size);
  bool complete = sources.note && sources.left_out && find_folders(&sources) && list_files(&sources, names, count);
  fputs("\"sources\": {\n", out);
  for (uint32_t i = 1; complete && i <= sources.files.count; i++)
    put_source(&sources, trax_texts_at(&sources.files, i), out);
  fputs("},\n", out);
  complete =
      (!sources.note || fclose(sources.note) == 0) && (!sources.left_out || fclose(sources.left_out) == 0) && complete;
  if (complete) {
    fputs("\"left_out\": ", out);
    trax_page_quote(out, *left_out ? left_out + 2 : "", *left_out ? strlen(left_out) - 2 : 0);
    fputs(",\n", out);
    tell(&explain->options, note, left_out);
  }
  release(&sources);
  free(note);
  free(left_out);
  return complete ? TRAX_OK : trax_fail(error, "out of memory for the page's sources");
}
