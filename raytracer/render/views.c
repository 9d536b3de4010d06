#include "views.h"

#include "emulated.h"
#include "installation.h"
#include "room.h"
#include "trax/names.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char folder[] = "share/trax/views", ending[] = ".view", camera_prefix[] = "file:";

/* --- by name --- */

struct names {
  char **names; /* in the order of the alphabet */
  size_t count;
};

static int compare_names(const void *a, const void *b) {
  return strcmp(*(char *const *)a, *(char *const *)b);
}

static void list_views(struct names *list) {
  char path[TRAX_PATH_SIZE], root[TRAX_PATH_SIZE - sizeof folder];
  *list = (struct names){0};
  if (!installation(path) || snprintf(root, sizeof root, "%s", path) >= (int)sizeof root)
    return;
  snprintf(path, sizeof path, "%s/%s", root, folder);
  DIR *stream = opendir(path);
  for (struct dirent *entry; stream && (entry = readdir(stream));) {
    const size_t length = strlen(entry->d_name), tail = sizeof ending - 1;
    char **more = length > tail && strcmp(entry->d_name + length - tail, ending) == 0
                      ? realloc(list->names, (list->count + 1) * sizeof *more)
                      : NULL;
    if (!more)
      continue;
    list->names = more;
    list->names[list->count] = strndup(entry->d_name, length - tail);
    list->count += list->names[list->count] != NULL;
  }
  if (stream)
    closedir(stream);
  if (list->count)
    qsort(list->names, list->count, sizeof *list->names, compare_names);
}

static void release_names(struct names *list) {
  for (size_t i = 0; i < list->count; i++)
    free(list->names[i]);
  free(list->names);
}

static const char *name_of(const void *context, size_t i) {
  return ((const struct names *)context)->names[i];
}

/* Prints the first sentence of the comment at the beginning of the file. */
static void print_sentence(FILE *out, const char *path) {
  char line[400];
  FILE *file = fopen(path, "r");
  for (bool ended = false; file && !ended && fgets(line, sizeof line, file) && strncmp(line, "//", 2) == 0;) {
    line[strcspn(line, "\n")] = '\0';
    char *end = line;
    while ((end = strpbrk(end, ".;")) && end[1] != ' ' && end[1] != '\0')
      end++;
    ended = end != NULL;
    if (ended)
      *end = '\0';
    fprintf(out, " %s", line + 2 + strspn(line + 2, " "));
  }
  if (file)
    fclose(file);
}

void put_view_names(FILE *out) {
  struct names list;
  list_views(&list);
  for (size_t i = 0; i < list.count; i++)
    fprintf(out, "%s ", list.names[i]);
  release_names(&list);
}

void print_views(FILE *out) {
  struct names list;
  list_views(&list);
  for (size_t i = 0; i < list.count; i++) {
    char path[TRAX_PATH_SIZE];
    fprintf(out, "%-14s", list.names[i]);
    if (installed_file(path, folder, list.names[i], ending))
      print_sentence(out, path);
    fputc('\n', out);
  }
  release_names(&list);
}

bool is_camera(const char *view, const char **camera) {
  if (strncmp(view, camera_prefix, sizeof camera_prefix - 1) != 0)
    return false;
  *camera = view + sizeof camera_prefix - 1;
  return true;
}

/* A folder is no view: `--prepare bunny --view bunny` twice is to give the same. */
static bool is_file(const char *path) {
  struct stat status;
  return stat(path, &status) == 0 && !S_ISDIR(status.st_mode);
}

trax_status find_view(char path[TRAX_PATH_SIZE], const char *view, trax_error *error) {
  if (!is_file(view) && !strchr(view, '/')) {
    if (installed_file(path, folder, view, ending))
      return TRAX_OK;
    struct names list;
    list_views(&list);
    const char *nearest = trax_nearest_name(view, list.count, name_of, &list);
    const char *const question = "; did you mean ";
    trax_fail(error, "--view %s: there is no such file, and trax comes with no such view%s%s%s (--views lists them)",
              view, nearest ? question : "", nearest ? nearest : "", nearest ? "?" : "");
    release_names(&list);
    return TRAX_ERROR;
  }
  if (snprintf(path, TRAX_PATH_SIZE, "%s", view) >= TRAX_PATH_SIZE)
    return trax_fail(error, "--view: the path is too long");
  return TRAX_OK;
}

/* --- by the scene --- */

bool known_view(char path[TRAX_PATH_SIZE], const struct options *options) {
  const struct camera_options *camera = &options->camera;
  if (options->view || camera->eye.given || camera->look_at.given || camera->up.given)
    return false;
  for (size_t i = 0; i < options->mesh_count; i++) {
    const char *mesh = options->meshes[i], *slash = strrchr(mesh, '/');
    const char *name = trax_mesh_is_generated(mesh) ? strchr(mesh, ':') + 1 : slash ? slash + 1 : mesh;
    char stem[256];
    snprintf(stem, sizeof stem, "%.*s", (int)strcspn(name, ".:"), name);
    if (*stem && installed_file(path, folder, stem, ending))
      return true;
  }
  return false;
}

/* Makes a view look at the middle of the scene's box. */
static void look_at_middle(struct trax_view *view, const struct trax_scene_header *header) {
  for (int axis = 0; axis < 3; axis++)
    view->look_at[axis] = header->bounds_min[axis] * 0.5f + header->bounds_max[axis] * 0.5f;
}

trax_status default_view(struct trax_view *view, bool *inside, char choice[VIEW_CHOICE_SIZE],
                         const struct trax_scene *scene, const struct options *options, trax_error *error) {
  const struct camera_options *camera = &options->camera;
  const float y[3] = {0, 1, 0}, *up = camera->up.given ? camera->up.at : y;
  const float aspect = (float)options->frame.width / (float)options->frame.height;
  const bool told = camera->eye.given || camera->look_at.given || options->view;
  char path[TRAX_PATH_SIZE];
  *inside = false;
  *choice = '\0';
  if (known_view(path, options)) {
    struct trax_view known;
    bool shows = false;
    trax_status status = trax_view_read(&known, path, error);
    if (status == TRAX_OK)
      status = trax_view_shows(&shows, &known, scene, aspect, error);
    if (status == TRAX_OK && shows) {
      *view = known;
      const char *name = strrchr(path, '/') + 1;
      snprintf(choice, VIEW_CHOICE_SIZE, "%.*s, by the name of the mesh", (int)(strlen(name) - sizeof ending + 1),
               name);
    }
    if (status != TRAX_OK || shows)
      return status;
  }
  trax_view_frame(view, scene, up, camera->fov, aspect);
  if (told) {
    look_at_middle(view, scene->header);
    return TRAX_OK;
  }
  const trax_status status = trax_view_room(view, inside, scene, up, aspect, error);
  if (status == TRAX_OK && *inside)
    snprintf(choice, VIEW_CHOICE_SIZE, "from inside of the closed room");
  return status;
}
