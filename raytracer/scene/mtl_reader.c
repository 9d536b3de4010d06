/* Material libraries of OBJ files (Wavefront, "Advanced Visualizer Manual", appendix B2; Bourke's notes on MTL).

   Read: newmtl, Kd, Ks, Ke, Ns, Ni, d, Tr, illum, map_Kd and map_d with the option -clamp. Everything else is skipped.
   The end of this file converts them to materials of the scene file. */
#include "text.h"

#include <math.h>

struct source {
  float kd[3], ks[3], ke[3];
  float ns, ni, opacity, transparency; /* negative: not given */
  int illum;                           /* negative: not given */
  bool has_kd;
  const char *map_kd, *map_d;
  bool clamp;
};

struct library {
  const char *path;
  unsigned line;
  trax_error *error;
  struct scene_material_list *list;
  struct scene_textures *textures;
  uint32_t material; /* current */
  struct source source;
};

uint32_t scene_find_material(const struct trax_mesh *mesh, const char *name) {
  char cut[TRAX_MESH_NAME];
  trax_mesh_name(cut, name);
  for (uint32_t i = 0; i < mesh->material_count; i++)
    if (!strcmp(mesh->materials[i].name, cut))
      return i;
  return SCENE_NO_MATERIAL;
}

uint32_t scene_add_material(struct scene_material_list *list, const char *name) {
  struct trax_mesh *mesh = list->mesh;
  if (!scene_grow(&mesh->materials, sizeof *mesh->materials, mesh->material_count, &list->capacity))
    return SCENE_NO_MATERIAL;
  struct trax_mesh_material *material = &mesh->materials[mesh->material_count];
  *material = (struct trax_mesh_material){.surface = trax_default_material};
  trax_mesh_name(material->name, name);
  return mesh->material_count++;
}

static trax_status fail_here(const struct library *library, const char *keyword, const char *reason, const char *what) {
  return trax_fail(library->error, "%s:%u: %.20s%s%s%.100s%s", library->path, library->line, keyword, reason,
                   what ? " '" : "", what ? what : "", what ? "'" : "");
}

static struct source unknown_source(void) {
  return (struct source){.ns = -1, .ni = -1, .opacity = -1, .transparency = -1, .illum = -1};
}

/* --- statements --- */

static trax_status read_colour(const struct library *library, const char *keyword, char *rest, float colour[3],
                               bool *read) {
  char *words[3];
  for (int i = 0; i < 3; i++)
    words[i] = next_word(&rest);
  if (!words[0])
    return fail_here(library, keyword, " without a colour", NULL);
  *read = strcmp(words[0], "spectral") != 0 && strcmp(words[0], "xyz") != 0;
  for (int i = 0; *read && i < 3; i++) {
    const char *word = words[i] ? words[i] : words[0]; /* one number stands for three */
    if (!parse_float(word, &colour[i]))
      return fail_here(library, keyword, ": not a number:", word);
  }
  return TRAX_OK;
}

static trax_status read_value(const struct library *library, const char *keyword, char *rest, float *value) {
  const char *word = next_word(&rest);
  if (word && !strcmp(word, "-halo")) /* of d: thinner towards the edge */
    word = next_word(&rest);
  if (!word)
    return fail_here(library, keyword, " without a number", NULL);
  if (!parse_float(word, value) || isnan(*value))
    return fail_here(library, keyword, ": not a number:", word);
  *value = fminf(fmaxf(*value, 0), 1e6f);
  return TRAX_OK;
}

/* The most words that follow an option of a map; a word that is not a number ends it. */
static unsigned option_words(const char *option, bool *numbers) {
  static const struct {
    const char *name;
    unsigned words;
    bool numbers;
  } options[] = {{"-blendu", 1, false},  {"-blendv", 1, false}, {"-cc", 1, false},    {"-clamp", 1, false},
                 {"-imfchan", 1, false}, {"-type", 1, false},   {"-mm", 2, true},     {"-o", 3, true},
                 {"-s", 3, true},        {"-t", 3, true},       {"-texres", 1, true}, {"-bm", 1, true},
                 {"-boost", 1, true}};
  for (size_t i = 0; i < sizeof options / sizeof *options; i++)
    if (!strcmp(option, options[i].name)) {
      *numbers = options[i].numbers;
      return options[i].words;
    }
  return 0;
}

/* The name is what follows the options: it may hold spaces. */
static trax_status read_map(struct library *library, const char *keyword, char *rest, const char **name) {
  for (;;) {
    rest = skip_blanks(rest);
    char option[16] = {0};
    bool numbers;
    memcpy(option, rest, strcspn(rest, " \t") < sizeof option ? strcspn(rest, " \t") : 0);
    unsigned words = option_words(option, &numbers);
    if (words == 0)
      break;
    next_word(&rest);
    for (; words > 0; words--) {
      rest = skip_blanks(rest);
      char *at = rest, *end;
      const float value = strtof(at, &end);
      const bool scale = !strcmp(option, "-s"), shift = !strcmp(option, "-o") || !strcmp(option, "-t");
      if (end != at && ((scale && value != 1) || (shift && value != 0)))
        library->textures->report->unread |= TRAX_UNREAD_UV_TRANSFORMS;
      if (numbers && (end == at || (*end && !is_blank(*end))))
        break;
      const char *word = next_word(&rest);
      if (word && !strcmp(option, "-clamp"))
        library->source.clamp = !strcmp(word, "on");
    }
  }
  *name = remainder_of(rest);
  return **name ? TRAX_OK : fail_here(library, keyword, " without a name", NULL);
}

static trax_status read_statement(struct library *library, const char *keyword, char *rest) {
  struct source *source = &library->source;
  const struct {
    const char *name;
    float *colour, *value;
    const char **map;
  } statements[] = {{"Kd", source->kd, NULL, NULL},
                    {"Ks", source->ks, NULL, NULL},
                    {"Ke", source->ke, NULL, NULL},
                    {"Ns", NULL, &source->ns, NULL},
                    {"Ni", NULL, &source->ni, NULL},
                    {"d", NULL, &source->opacity, NULL},
                    {"Tr", NULL, &source->transparency, NULL},
                    {"map_Kd", NULL, NULL, &source->map_kd},
                    {"map_d", NULL, NULL, &source->map_d}};
  for (size_t i = 0; i < sizeof statements / sizeof *statements; i++) {
    if (strcmp(keyword, statements[i].name) != 0)
      continue;
    if (library->material == (uint32_t)SCENE_NO_MATERIAL)
      return fail_here(library, keyword, " before any newmtl", NULL);
    if (statements[i].value)
      return read_value(library, keyword, rest, statements[i].value);
    if (statements[i].map)
      return read_map(library, keyword, rest, statements[i].map);
    bool read = false;
    trax_status result = read_colour(library, keyword, rest, statements[i].colour, &read);
    source->has_kd = source->has_kd || (read && statements[i].colour == source->kd);
    return result;
  }
  static const char *const normal_maps[] = {"norm", "bump", "Bump", "map_bump", "map_Bump", "map_Kn"};
  for (size_t i = 0; i < sizeof normal_maps / sizeof *normal_maps; i++)
    if (!strcmp(keyword, normal_maps[i]) && !library->textures->options->no_textures)
      library->textures->report->unread |= TRAX_UNREAD_NORMAL_MAPS;
  if (!strcmp(keyword, "illum")) {
    float value = -1;
    trax_status result = read_value(library, keyword, rest, &value);
    source->illum = value <= 10 ? (int)value : -1;
    return result;
  }
  return TRAX_OK;
}

/* --- conversion to our materials --- */

static float greatest(const float colour[3]) {
  return fmaxf(fmaxf(colour[0], colour[1]), colour[2]);
}

/* Converts a Phong exponent to the roughness with an equally wide highlight (Walter, Marschner, Li, Torrance,
   "Microfacet models for refraction through rough surfaces", 2007, section 5.2). */
static float roughness_of(float exponent) {
  return sqrtf(2 / (fmaxf(exponent, 0) + 2));
}

/* illum 4, 6, 7 and 9 are glass. 3, 5 and 8 are mirrors if they reflect more than they scatter. Otherwise a specular
   colour makes a rough layer, unless illum excludes highlights. */
static void set_kind(struct trax_material *surface, const struct source *source) {
  const int illum = source->illum;
  const bool shiny = greatest(source->ks) > 0, reflects = illum == 3 || illum == 5 || illum == 8;
  for (int channel = 0; channel < 3; channel++)
    surface->specular[channel] = scene_clamp_colour(source->ks[channel]);
  if (illum == 4 || illum == 6 || illum == 7 || illum == 9) {
    surface->kind = TRAX_MATERIAL_GLASS;
    surface->ior = source->ni >= 1 ? fminf(source->ni, TRAX_SCENE_MAX_IOR) : 1.5f;
    for (int channel = 0; channel < 3; channel++)
      surface->specular[channel] = 1;
  } else if (reflects && shiny && greatest(source->ks) > greatest(surface->diffuse)) {
    surface->kind = TRAX_MATERIAL_MIRROR;
  } else if (shiny && illum != 0 && illum != 1) {
    surface->kind = TRAX_MATERIAL_GGX;
    surface->roughness = roughness_of(source->ns);
  }
}

static trax_status finish_material(struct library *library) {
  const struct source *source = &library->source;
  if (library->material == (uint32_t)SCENE_NO_MATERIAL)
    return TRAX_OK;
  const struct scene_texture wanted = {
      .base = source->map_kd, .mask = source->map_d, .flags = source->clamp ? TRAX_TEXTURE_CLAMP : 0};
  const struct scene_texture *texture;
  trax_status result = scene_find_texture(library->textures, &wanted, library->path, &texture, library->error);
  if (result != TRAX_OK)
    return result;
  struct trax_material *surface = &library->list->mesh->materials[library->material].surface;
  *surface = trax_default_material;
  surface->texture = texture->number;
  for (int channel = 0; channel < 3; channel++) {
    if (source->has_kd)
      surface->diffuse[channel] = scene_clamp_colour(source->kd[channel]);
    else if (texture->good && source->map_kd)
      surface->diffuse[channel] = 1;
    surface->emission[channel] = source->ke[channel] > 0 ? fminf(source->ke[channel], TRAX_SCENE_MAX_EMISSION) : 0;
  }
  set_kind(surface, source);
  if (surface->kind != TRAX_MATERIAL_GLASS) {
    surface->opacity = scene_clamp_colour(source->opacity >= 0        ? source->opacity
                                          : source->transparency >= 0 ? 1 - source->transparency
                                                                      : 1);
    if (surface->opacity < 1 || (texture->number && source->map_d))
      surface->alpha_cutoff = 0.5f;
  }
  return TRAX_OK;
}

static trax_status begin_material(struct library *library, char *rest) {
  trax_status result = finish_material(library);
  if (result != TRAX_OK)
    return result;
  const char *name = remainder_of(rest);
  library->source = unknown_source();
  library->material = scene_find_material(library->list->mesh, name);
  if (library->material == (uint32_t)SCENE_NO_MATERIAL)
    library->material = scene_add_material(library->list, name);
  return library->material == (uint32_t)SCENE_NO_MATERIAL ? scene_out_of_memory(library->error, library->path)
                                                          : TRAX_OK;
}

trax_status scene_read_mtl(struct scene_material_list *list, struct scene_textures *textures, const char *path,
                           trax_error *error) {
  struct scene_bytes file;
  if (scene_load_referred(&file, path, SCENE_TEXT_LIMITS) != TRAX_OK || scene_terminate(&file) != TRAX_OK) {
    if (textures->report->missing_files++ == 0)
      snprintf(textures->report->first_missing_file, sizeof textures->report->first_missing_file, "%s", path);
    return TRAX_OK;
  }
  trax_status result = trax_files_check_input(textures->options->files, path, error);
  if (result != TRAX_OK) {
    free(file.data);
    return result;
  }
  result = check_text(&file, path, error);
  if (result != TRAX_OK)
    return result;
  struct library library = {.path = path,
                            .line = 1,
                            .error = error,
                            .list = list,
                            .textures = textures,
                            .material = SCENE_NO_MATERIAL,
                            .source = unknown_source()};
  char *text = (char *)file.data, *line;
  for (unsigned lines; result == TRAX_OK && (lines = next_line(&text, &line)) > 0; library.line += lines) {
    const char *keyword = next_word(&line);
    if (keyword)
      result = strcmp(keyword, "newmtl") ? read_statement(&library, keyword, line) : begin_material(&library, line);
  }
  if (result == TRAX_OK)
    result = finish_material(&library);
  free(file.data);
  return result;
}
