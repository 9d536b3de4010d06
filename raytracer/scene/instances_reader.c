/* Instances as text, a statement a line; docs/instances.md has the format. Errors name line and column.

     mesh NAME FILE          a mesh, of a file beside this one
     material NAME WHAT      a material; WHAT as of --diffuse or --material
     group NAME ... end      places under one name
     place NAME [12 numbers] [material NAME]

   Groups and meshes are known behind their end, so that none contains itself. */
#define _GNU_SOURCE /* hsearch_r */
#include "placing.h"
#include "text.h"

#include <math.h>
#include <search.h>

enum { MOST_LEVELS = 64, SCENE_GROUP = 0, NONE = UINT32_MAX };
enum { BYTES_PER_INSTANCE = 512 }; /* here and in the builder */

struct place {
  double transform[3][4];
  uint32_t target; /* of groups and meshes together */
  uint32_t material;
  uint32_t next; /* of its group; NONE: it is the last */
  unsigned line;
};

/* A mesh, or a group. */
struct target {
  char *name;
  bool is_mesh;
  uint32_t part;        /* of a mesh */
  struct scene_box box; /* of a mesh */
  uint32_t first, last; /* of the group's places; NONE: there are none */
  uint64_t instances;   /* below it */
  unsigned levels;      /* of groups below it */
};

struct reader {
  const char *path;
  unsigned line;
  const char *line_begin;
  trax_error *error;
  const struct trax_import_options *options;
  struct trax_import_report *report;
  struct trax_mesh *mesh;
  struct target *targets; /* the first is the scene; the last may be open */
  uint32_t target_count;
  size_t target_capacity;
  struct hsearch_data names; /* of targets */
  struct place *places;
  uint32_t place_count;
  size_t place_capacity;
  uint32_t open; /* the group that places are added to */
};

/* at: where in the line. */
static trax_status fail_at(const struct reader *reader, const char *at, const char *reason, const char *word) {
  return trax_fail(reader->error, "%s:%u:%zu: %s%s%.60s%s", reader->path, reader->line,
                   (size_t)(at - reader->line_begin) + 1, reason, word ? " '" : "", word ? word : "", word ? "'" : "");
}

/* 0: none. */
static uint32_t find_target(struct reader *reader, char *name) {
  ENTRY *found;
  return hsearch_r((ENTRY){.key = name}, FIND, &found, &reader->names) ? (uint32_t)(uintptr_t)found->data : 0;
}

/* Adds a mesh or a group with a new name. */
static trax_status add_target(struct reader *reader, char *name, struct target **added) {
  ENTRY *entered;
  if (find_target(reader, name))
    return fail_at(reader, name, "there is a mesh or a group of this name already:", name);
  if (!scene_grow(&reader->targets, sizeof *reader->targets, reader->target_count, &reader->target_capacity))
    return scene_out_of_memory(reader->error, reader->path);
  struct target *target = *added = &reader->targets[reader->target_count];
  *target = (struct target){.name = strdup(name), .first = NONE, .last = NONE};
  const ENTRY entry = {target->name, (void *)(uintptr_t)reader->target_count};
  if (!target->name || !hsearch_r(entry, ENTER, &entered, &reader->names)) {
    free(target->name);
    return scene_out_of_memory(reader->error, reader->path);
  }
  reader->target_count++;
  return TRAX_OK;
}

/* --- statements --- */

static trax_status import_mesh(struct reader *reader, const char *at, const char *path) {
  struct trax_import_options options = *reader->options;
  struct trax_import_report report = {0};
  struct trax_mesh mesh;
  options.instances = options.flatten = false;
  char *name = scene_unpacked_name(path);
  const bool nested = name && scene_has_extension(name, ".instances");
  free(name);
  if (nested)
    return fail_at(reader, at, "a mesh cannot be a file of instances; groups nest", NULL);
  trax_error reason;
  trax_status result = scene_import_meshes(&mesh, &path, 1, &options, &report, &reason);
  if (result != TRAX_OK)
    return result == TRAX_INTERRUPTED ? result : fail_at(reader, at, reason.message, NULL);
  mesh.camera_count = 0;
  if (mesh.triangle_count == 0)
    result = fail_at(reader, at, "a mesh without triangles:", path);
  if (result == TRAX_OK) {
    reader->targets[reader->target_count - 1].box = scene_part_box(&mesh, 0, mesh.triangle_count);
    struct trax_mesh_part *part = malloc(sizeof *part);
    if (part)
      *part = (struct trax_mesh_part){0, mesh.triangle_count, (uint32_t)report.source_triangles};
    mesh.parts = part, mesh.part_count = part != NULL;
    result = part ? scene_append_mesh(reader->mesh, &mesh, 0, 0, path, reader->error)
                  : scene_out_of_memory(reader->error, path);
  }
  trax_mesh_release(&mesh);
  scene_add_report(reader->report, &report);
  return result;
}

static trax_status read_mesh(struct reader *reader, char *rest) {
  struct target *target;
  char *name = next_word(&rest);
  const char *file = name ? remainder_of(rest) : NULL;
  if (!file || !*file)
    return fail_at(reader, reader->line_begin, "expected 'mesh NAME FILE'", NULL);
  if (reader->open != SCENE_GROUP)
    return fail_at(reader, reader->line_begin, "a mesh within a group", NULL);
  trax_status result = add_target(reader, name, &target);
  if (result != TRAX_OK)
    return result;
  target->is_mesh = true;
  target->part = reader->mesh->part_count;
  target->instances = 1;
  const bool is_whole = trax_mesh_is_generated(file) || file[0] == '/';
  char *path = is_whole ? strdup(file) : scene_referred_path(reader->path, file);
  result = path ? import_mesh(reader, file, path) : scene_out_of_memory(reader->error, reader->path);
  free(path);
  return result;
}

/* A material's kind, or its colour alone. */
static trax_status read_material(struct reader *reader, char *rest) {
  const char *name = next_word(&rest);
  char *what = name ? next_word(&rest) : NULL;
  if (!what || strchr(what, '=') || next_word(&rest))
    return fail_at(reader, reader->line_begin,
                   "expected 'material NAME WHAT', where WHAT is as of --material or --diffuse", NULL);
  struct trax_mesh *mesh = reader->mesh;
  struct trax_mesh_material *grown =
      realloc(mesh->materials, (mesh->material_count + (size_t)1) * sizeof *mesh->materials);
  if (!grown)
    return scene_out_of_memory(reader->error, reader->path);
  mesh->materials = grown;
  struct trax_mesh_material *material = &mesh->materials[mesh->material_count];
  *material = (struct trax_mesh_material){.surface = trax_default_material};
  trax_mesh_name(material->name, name);
  if (!scene_set_material(&material->surface, what))
    return fail_at(reader, what, "neither a kind of material nor R,G,B:", what);
  mesh->material_count++;
  return TRAX_OK;
}

static trax_status read_numbers(const struct reader *reader, struct place *place, char **word, char **rest) {
  const char *const first = *word;
  for (int i = 0; i < 12; i++) {
    char *end;
    if (!*word)
      return fail_at(reader, *rest, "a transform has 12 numbers, the rows of a matrix", NULL);
    const double number = strtod(*word, &end);
    if (end == *word || *end || !isfinite(number))
      return fail_at(reader, *word, "not a finite number:", *word);
    place->transform[i / 4][i % 4] = number;
    *word = next_word(rest);
  }
  if (scene_determinant((const double(*)[4])place->transform) == 0)
    return fail_at(reader, first, "the transform is singular", NULL);
  return TRAX_OK;
}

static trax_status read_place(struct reader *reader, char *rest) {
  char *name = next_word(&rest), *word = name ? next_word(&rest) : NULL;
  struct place place = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, 0, TRAX_NO_MATERIAL, NONE, reader->line};
  if (!name)
    return fail_at(reader, reader->line_begin, "expected 'place NAME [12 numbers] [material NAME]'", NULL);
  place.target = find_target(reader, name);
  if (place.target == 0 || (place.target == reader->open))
    return fail_at(reader, name, "no mesh and no group has this name before here:", name);
  if (word && strcmp(word, "material") != 0 && read_numbers(reader, &place, &word, &rest) != TRAX_OK)
    return TRAX_ERROR;
  if (word && strcmp(word, "material") == 0) {
    char known[TRAX_MESH_NAME];
    word = next_word(&rest);
    if (!word)
      return fail_at(reader, rest, "expected the material's name", NULL);
    trax_mesh_name(known, word);
    place.material = scene_find_material(reader->mesh, known);
    if (place.material == (uint32_t)SCENE_NO_MATERIAL)
      return fail_at(reader, word, "no material has this name before here:", word);
    word = next_word(&rest);
  }
  if (word)
    return fail_at(reader, word, "one word too many:", word);
  struct target *group = &reader->targets[reader->open];
  const struct target *target = &reader->targets[place.target];
  if (!scene_grow(&reader->places, sizeof place, reader->place_count, &reader->place_capacity))
    return scene_out_of_memory(reader->error, reader->path);
  *(group->first == NONE ? &group->first : &reader->places[group->last].next) = reader->place_count;
  group->last = reader->place_count;
  reader->places[reader->place_count++] = place;
  group->instances += target->instances;
  group->levels = target->levels + 1 > group->levels ? target->levels + 1 : group->levels;
  if (group->levels > MOST_LEVELS)
    return fail_at(reader, name, "more than 64 levels of groups", NULL);
  if (group->instances * BYTES_PER_INSTANCE > scene_memory_for(scene_bytes_read()))
    return fail_at(reader, name, "too large: more instances than memory in proportion to the files", NULL);
  return TRAX_OK;
}

static trax_status read_group(struct reader *reader, char *rest) {
  struct target *target;
  char *name = next_word(&rest);
  if (!name || next_word(&rest))
    return fail_at(reader, reader->line_begin, "expected 'group NAME'", NULL);
  if (reader->open != SCENE_GROUP)
    return fail_at(reader, name, "a group within a group; place one in the other instead", NULL);
  const trax_status result = add_target(reader, name, &target);
  if (result == TRAX_OK)
    reader->open = reader->target_count - 1;
  return result;
}

static trax_status read_end(struct reader *reader, char *rest) {
  if (next_word(&rest))
    return fail_at(reader, reader->line_begin, "expected nothing behind 'end'", NULL);
  if (reader->open == SCENE_GROUP)
    return fail_at(reader, reader->line_begin, "no group is open here", NULL);
  if (reader->targets[reader->open].first == NONE) /* so that work is in proportion to the instances */
    return fail_at(reader, reader->line_begin, "a group without a place:", reader->targets[reader->open].name);
  reader->open = SCENE_GROUP;
  return TRAX_OK;
}

static trax_status read_statement(struct reader *reader, char *line) {
  static const struct {
    const char *name;
    trax_status (*read)(struct reader *, char *);
  } statements[] = {{"mesh", read_mesh},
                    {"material", read_material},
                    {"group", read_group},
                    {"place", read_place},
                    {"end", read_end}};
  char *rest = line;
  const char *word = next_word(&rest);
  if (!word)
    return TRAX_OK;
  for (size_t i = 0; i < sizeof statements / sizeof *statements; i++)
    if (strcmp(word, statements[i].name) == 0)
      return statements[i].read(reader, rest);
  return fail_at(reader, word, "expected mesh, material, group, place or end, not", word);
}

static trax_status read_lines(struct reader *reader, char *text) {
  trax_status result = TRAX_OK;
  while (*text && result == TRAX_OK) {
    char *line = text;
    text += strcspn(text, "\n");
    if (*text)
      *text++ = 0;
    reader->line++;
    reader->line_begin = line;
    result = scene_is_interrupted(reader->options->interrupt) ? TRAX_INTERRUPTED : read_statement(reader, line);
  }
  if (result == TRAX_OK && reader->open != SCENE_GROUP)
    result = trax_fail(reader->error, "%s:%u:1: the group '%.60s' has no end", reader->path, reader->line,
                       reader->targets[reader->open].name);
  return result;
}

/* --- from places to instances --- */

/* The places through which an instance is placed, the innermost first. */
struct chain {
  const struct chain *outer;
  unsigned line;
};

/* A transform of its own may be good where its product with those of the groups around it is not. */
static trax_status refuse_instance(const struct reader *reader, const struct chain *chain, const char *reason) {
  char through[128] = "";
  int length = 0;
  for (const struct chain *outer = chain->outer; outer && length < 100; outer = outer->outer)
    length += snprintf(through + length, sizeof through - (size_t)length, "%s%u", length ? ", " : "", outer->line);
  return trax_fail(reader->error, "%s:%u: instance %u (from 0)%s%s: %s", reader->path, chain->line,
                   reader->mesh->instance_count - 1, length ? ", in the group that is placed by line " : "", through,
                   reason);
}

static trax_status expand(struct reader *reader, const struct target *group, const double above[3][4],
                          uint32_t material, const struct chain *outer) {
  for (uint32_t i = group->first; i != NONE; i = reader->places[i].next) {
    const struct place *place = &reader->places[i];
    const struct target *target = &reader->targets[place->target];
    const uint32_t own = material == TRAX_NO_MATERIAL ? place->material : material;
    const struct chain chain = {outer, place->line};
    double transform[3][4];
    scene_multiply(transform, above, place->transform);
    if (target->is_mesh) {
      struct trax_mesh_instance *out = &reader->mesh->instances[reader->mesh->instance_count++];
      *out = (struct trax_mesh_instance){.part = target->part, .material = own};
      memcpy(out->transform, transform, sizeof transform);
      const char *wrong =
          reader->options->flatten ? NULL : scene_misplaced(&target->box, (const double(*)[4])transform);
      if (wrong)
        return refuse_instance(reader, &chain, wrong);
    } else if (expand(reader, target, (const double(*)[4])transform, own, &chain) != TRAX_OK) {
      return TRAX_ERROR;
    }
  }
  return TRAX_OK;
}

trax_status scene_read_instances(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                                 struct trax_import_report *report, trax_error *error) {
  struct reader reader = {.path = path, .error = error, .options = options, .report = report, .mesh = mesh};
  struct scene_bytes file;
  trax_status result = scene_load_text(&file, path, scene_limits_of(options->unpack_limit), error);
  if (result == TRAX_OK)
    result = check_text(&file, path, error);
  if (result != TRAX_OK)
    return result;
  struct target *scene;
  size_t lines = 2;
  for (size_t i = 0; i < file.size; i++)
    lines += file.data[i] == '\n';
  if (!hcreate_r(lines, &reader.names))
    result = scene_out_of_memory(error, path);
  if (result == TRAX_OK)
    result = add_target(&reader, (char[]){""}, &scene);
  if (result == TRAX_OK)
    result = read_lines(&reader, (char *)file.data);
  free(file.data);
  if (result == TRAX_OK && reader.targets[SCENE_GROUP].first == NONE)
    result = trax_fail(error, "%s: nothing is placed", path);
  if (result == TRAX_OK) {
    mesh->instances = malloc(reader.targets[SCENE_GROUP].instances * sizeof *mesh->instances);
    if (mesh->instances)
      result = expand(&reader, &reader.targets[SCENE_GROUP], scene_identity, TRAX_NO_MATERIAL, NULL);
    else
      result = scene_out_of_memory(error, path);
  }
  for (uint32_t i = 0; i < reader.target_count; i++)
    free(reader.targets[i].name);
  hdestroy_r(&reader.names);
  free(reader.targets);
  free(reader.places);
  return result;
}
