#include "options.h"

#include "trax/options.h"
#include "trax/version.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "Usage: trax-render [options] MESH [MESH ...] -o PICTURE.png\n"
    "\n"
    "Renders meshes, or one scene file (.trax), on the emulated ray-tracing accelerator: a ray from the eye through\n"
    "every pixel, and a shadow ray towards one point light. generate:forest[:SEED] is a mesh made on the spot.\n"
    "\n"
    "  -o, --output FILE       the picture: linear floats for .pfm and .exr, a PNG for .png\n"
    "      --size WxH          its size in pixels, 1x1 to 16384x16384 (default 1280x720)\n"
    "      --view FILE|NAME    eye, direction, field of view and light: a file, or one that comes with trax;\n"
    "                          without it the whole scene is framed; file:NAME is a camera of a glTF file, file: its\n"
    "                          first one\n"
    "      --eye X,Y,Z         the eye; --look-at X,Y,Z, --up X,Y,Z, --fov DEGREES the same: instead of the view's\n"
    "      --light X,Y,Z       a point light instead of the view's lights; repeated, they share the light\n"
    "      --orbit A[,E]       turns the eye by A degrees around the point that the view looks at, or the middle of "
    "the\n"
    "                          scene, and raises it by E degrees\n"
    "      --frames N          a turntable: N pictures of a whole turn, PICTURE-0001.png and so on\n"
    "      --write-view FILE   writes the view as a file\n"
    "      --id-picture FILE.png  which triangle each pixel shows: its number in the meshes, from 1, as\n"
    "                          R + 256 G + 65536 B; found natively, with --engine embree by Embree\n"
    "      --samples N         rays from the eye through every pixel, 1 to 4096 (default 1)\n"
    "      --material [NAME=]KIND  of the meshes: lambert, mirror[:R,G,B], glass[:IOR], ggx:ROUGHNESS[:R,G,B] or\n"
    "                          emit:R,G,B, for the material NAME or for all (repeatable)\n"
    "      --diffuse [NAME=]R,G,B  their colour, linear, 0 to 1 (repeatable)\n"
    "      --no-textures       reads no images; colours remain\n"
    "      --texture-size N    at most N texels a side, a power of two up to 4096\n"
    "      --unpack-limit SIZE  of packed files and of pipes, unpacked; K, M and G are powers of 1024 (default 1G)\n"
    "      --nodes KIND        of the meshes' tree: binary, quantised, quantised8, wide, wide-quantised,\n"
    "                          wide-quantised8 or auto, as trax-scene has them (default auto; for another\n"
    "                          --program binary)\n"
    "      --splits[=FACTOR]   splits large triangles, as trax-scene does (default auto; for another\n"
    "                          --program 1, which is none)\n"
    "      --normals WHICH     file: --smooth by the meshes' own normals, computed where there are none (default);\n"
    "                          smooth: by computed ones; flat: no --smooth\n"
    "      --paths DEPTH       path tracing: light that comes over up to DEPTH surfaces, 1 to 64; wants many samples\n"
    "      --seed N            of the paths' random numbers, 0 to 4294967295 (default 0)\n"
    "      --float             the program computes linear floats; the picture is made of them here\n"
    "      --one-sided         triangles are seen from the side where they are counterclockwise, and glass from both\n"
    "      --smooth            shades by normals that vary across triangles; edges sharper than 60 degrees stay edges\n"
    "                          (of a scene file: by the normals in it, made by trax-scene --smooth)\n"
    "      --no-shadows        the light shines through everything\n"
    "      --ambient X         light everywhere, 0 to 1 (default 0.12)\n"
    "      --background RRGGBB colour where there is nothing, hexadecimal (default 98a8b8)\n"
    "      --config CHIP|FILE  the chip: 1x32 to 8x64 as in the paper, or a file (default 4x32)\n"
    "      --set KEY=VALUE     changes one value of the configuration (trax-sim --help-config lists them)\n"
    "      --stats FILE.json   writes every statistic of the run\n"
    "      --profile FILE      writes thread-cycles by function and by source line\n"
    "      --profile-folded FILE  writes thread-cycles by call stack, for flame graphs\n"
    "      --cost-picture FILE.png  what each pixel cost, in false colours\n"
    "      --cost-values FILE  the same in numbers: PFM for FILE.pfm, else CSV\n"
    "      --cost WHAT         what costs: cycles (default), instructions, or one cause (trax-sim --help-stats)\n"
    "      --engine WHICH      fast (default): the emulator; reference: its reference engine, the same cycles, "
    "slowly;\n"
    "                          native: the same program compiled for this computer; embree: the reference picture\n"
    "      --threads N         host threads of engines fast and native (default: all processors)\n"
    "      --sampled           simulates only some parts of the picture and estimates the rest, with an interval; the\n"
    "                          picture itself is the native twin's\n"
    "      --sample-fraction X the share of the work that is simulated, above 0 to 1 (default 0.05; 1: all of it)\n"
    "      --sample-error X    instead: as much as it takes for an interval of plus and minus X per cent\n"
    "      --sample-seed N     another choice of parts (default 1)\n"
    "      --sample-unit N     pixels of a part (default 2 for each thread, at least 256)\n"
    "      --sample-warm-up N  pixels before it that are simulated, but not measured (default 4 for each thread)\n"
    "      --compare           renders the reference and the native twin too and prints the differences;\n"
    "                          exit status 1 if the twin's picture is not the same bit for bit, or less than\n"
    "                          99.9 % of the pixels are within 2/255 of the reference (of paths 99 %, and the light\n"
    "                          of the whole picture within 0.2 %)\n"
    "      --triangle METHOD   watertight (default) or moller-trumbore, which misses some rays between triangles\n"
    "      --queues N          how many queues the pixels wait in, 1 to 64; tms (default): one for each TM, whose\n"
    "                          threads then share tiles and the cache's lines\n"
    "      --fast-math         compiles the program with -ffast-math: its picture is not the twin's in every bit\n"
    "      --stack N           compiles the program with N entries on the stack of the traversal, 1 to 62; what it has "
    "no\n"
    "                          room for it finds again (default: as many as the tree is deep, 8 if deeper than 32)\n"
    "      --bench-accuracy    renders by each method and precision and prints what each costs and how wrong it is;\n"
    "                          -o DIR: where the table, CSV, JSON and diagrams go, and what was measured is kept,\n"
    "                          so that a run that was stopped goes on\n"
    "      --program FILE.elf  another program for the TPs than the one that comes with trax\n"
    "      --no-specialise     the program that can render every picture, instead of one compiled for this one\n"
    "      --cache DIR         where programs compiled for a picture are kept (default: XDG_CACHE_HOME/trax/programs,\n"
    "                          or .cache/trax/programs in the home directory)\n"
    "      --report            renders with both programs and prints what each takes; exit status 1 if the pictures\n"
    "                          are not the same bit for bit\n"
    "      --keep DIR          keeps what the program reads, and the trax-sim command that runs it\n"
    "      --prepare DIR       the same, and renders nothing\n"
    "  -q, --quiet             prints errors only\n"
    "  -h, --help\n"
    "      --version\n";

enum {
  OPT_SIZE = 256,
  OPT_VIEW,
  OPT_EYE,
  OPT_LOOK_AT,
  OPT_UP,
  OPT_FOV,
  OPT_LIGHT,
  OPT_ORBIT,
  OPT_FRAMES,
  OPT_WRITE_VIEW,
  OPT_ID_PICTURE,
  OPT_SAMPLES,
  OPT_MATERIAL,
  OPT_DIFFUSE,
  OPT_NO_TEXTURES,
  OPT_TEXTURE_SIZE,
  OPT_UNPACK_LIMIT,
  OPT_NODES,
  OPT_SPLITS,
  OPT_NORMALS,
  OPT_PATHS,
  OPT_SEED,
  OPT_FLOAT,
  OPT_ONE_SIDED,
  OPT_SMOOTH,
  OPT_NO_SHADOWS,
  OPT_AMBIENT,
  OPT_BACKGROUND,
  OPT_CONFIG,
  OPT_SET,
  OPT_STATS,
  OPT_PROFILE,
  OPT_PROFILE_FOLDED,
  OPT_COST_PICTURE,
  OPT_COST_VALUES,
  OPT_COST,
  OPT_ENGINE,
  OPT_THREADS,
  OPT_SAMPLED,
  OPT_SAMPLE_FRACTION,
  OPT_SAMPLE_ERROR,
  OPT_SAMPLE_SEED,
  OPT_SAMPLE_UNIT,
  OPT_SAMPLE_WARM_UP,
  OPT_COMPARE,
  OPT_PROGRAM,
  OPT_NO_SPECIALISE,
  OPT_CACHE,
  OPT_REPORT,
  OPT_TRIANGLE,
  OPT_QUEUES,
  OPT_FAST_MATH,
  OPT_STACK,
  OPT_BENCH_ACCURACY,
  OPT_KEEP,
  OPT_PREPARE,
  OPT_VERSION
};

static const struct option long_options[] = {{"output", required_argument, NULL, 'o'},
                                             {"size", required_argument, NULL, OPT_SIZE},
                                             {"view", required_argument, NULL, OPT_VIEW},
                                             {"eye", required_argument, NULL, OPT_EYE},
                                             {"look-at", required_argument, NULL, OPT_LOOK_AT},
                                             {"up", required_argument, NULL, OPT_UP},
                                             {"fov", required_argument, NULL, OPT_FOV},
                                             {"light", required_argument, NULL, OPT_LIGHT},
                                             {"orbit", required_argument, NULL, OPT_ORBIT},
                                             {"frames", required_argument, NULL, OPT_FRAMES},
                                             {"write-view", required_argument, NULL, OPT_WRITE_VIEW},
                                             {"id-picture", required_argument, NULL, OPT_ID_PICTURE},
                                             {"samples", required_argument, NULL, OPT_SAMPLES},
                                             {"material", required_argument, NULL, OPT_MATERIAL},
                                             {"diffuse", required_argument, NULL, OPT_DIFFUSE},
                                             {"no-textures", no_argument, NULL, OPT_NO_TEXTURES},
                                             {"splits", optional_argument, NULL, OPT_SPLITS},
                                             {"nodes", required_argument, NULL, OPT_NODES},
                                             {"texture-size", required_argument, NULL, OPT_TEXTURE_SIZE},
                                             {"unpack-limit", required_argument, NULL, OPT_UNPACK_LIMIT},
                                             {"normals", required_argument, NULL, OPT_NORMALS},
                                             {"paths", required_argument, NULL, OPT_PATHS},
                                             {"seed", required_argument, NULL, OPT_SEED},
                                             {"float", no_argument, NULL, OPT_FLOAT},
                                             {"one-sided", no_argument, NULL, OPT_ONE_SIDED},
                                             {"smooth", no_argument, NULL, OPT_SMOOTH},
                                             {"no-shadows", no_argument, NULL, OPT_NO_SHADOWS},
                                             {"ambient", required_argument, NULL, OPT_AMBIENT},
                                             {"background", required_argument, NULL, OPT_BACKGROUND},
                                             {"config", required_argument, NULL, OPT_CONFIG},
                                             {"set", required_argument, NULL, OPT_SET},
                                             {"stats", required_argument, NULL, OPT_STATS},
                                             {"profile", required_argument, NULL, OPT_PROFILE},
                                             {"profile-folded", required_argument, NULL, OPT_PROFILE_FOLDED},
                                             {"cost-picture", required_argument, NULL, OPT_COST_PICTURE},
                                             {"cost-values", required_argument, NULL, OPT_COST_VALUES},
                                             {"cost", required_argument, NULL, OPT_COST},
                                             {"engine", required_argument, NULL, OPT_ENGINE},
                                             {"threads", required_argument, NULL, OPT_THREADS},
                                             {"sampled", no_argument, NULL, OPT_SAMPLED},
                                             {"sample-fraction", required_argument, NULL, OPT_SAMPLE_FRACTION},
                                             {"sample-error", required_argument, NULL, OPT_SAMPLE_ERROR},
                                             {"sample-seed", required_argument, NULL, OPT_SAMPLE_SEED},
                                             {"sample-unit", required_argument, NULL, OPT_SAMPLE_UNIT},
                                             {"sample-warm-up", required_argument, NULL, OPT_SAMPLE_WARM_UP},
                                             {"compare", no_argument, NULL, OPT_COMPARE},
                                             {"program", required_argument, NULL, OPT_PROGRAM},
                                             {"no-specialise", no_argument, NULL, OPT_NO_SPECIALISE},
                                             {"cache", required_argument, NULL, OPT_CACHE},
                                             {"report", no_argument, NULL, OPT_REPORT},
                                             {"triangle", required_argument, NULL, OPT_TRIANGLE},
                                             {"queues", required_argument, NULL, OPT_QUEUES},
                                             {"fast-math", no_argument, NULL, OPT_FAST_MATH},
                                             {"stack", required_argument, NULL, OPT_STACK},
                                             {"bench-accuracy", no_argument, NULL, OPT_BENCH_ACCURACY},
                                             {"keep", required_argument, NULL, OPT_KEEP},
                                             {"prepare", required_argument, NULL, OPT_PREPARE},
                                             {"quiet", no_argument, NULL, 'q'},
                                             {"help", no_argument, NULL, 'h'},
                                             {"version", no_argument, NULL, OPT_VERSION},
                                             {NULL, 0, NULL, 0}};

/* An unsigned decimal number without sign or space, at *text, which moves behind it. */
static bool parse_number(const char **text, unsigned long limit, unsigned *value) {
  if (**text < '0' || **text > '9')
    return false;
  char *end;
  errno = 0;
  unsigned long number = strtoul(*text, &end, 10);
  *text = end;
  *value = (unsigned)number;
  return errno == 0 && number <= limit;
}

static bool parse_size(const char *text, struct trax_frame_options *frame) {
  if (!parse_number(&text, TRAX_RENDER_MAX_SIDE, &frame->width) || *text++ != 'x')
    return false;
  return parse_number(&text, TRAX_RENDER_MAX_SIDE, &frame->height) && *text == '\0' && frame->width > 0 &&
         frame->height > 0;
}

static bool parse_colour(const char *text, uint32_t *pixel) {
  if (strlen(text) != 6 || strspn(text, "0123456789abcdefABCDEF") != 6)
    return false;
  uint32_t rgb = (uint32_t)strtoul(text, NULL, 16);
  *pixel = 0xFF000000u | (rgb & 0xFF) << 16 | (rgb & 0xFF00) | rgb >> 16;
  return true;
}

static bool parse_fraction(const char *text, float *value) {
  char *end;
  *value = strtof(text, &end);
  return end != text && *end == '\0' && *value >= 0 && *value <= 1;
}

/* Above 0 and to `most`. */
static bool parse_share(const char *text, double most, double *value) {
  char *end;
  *value = strtod(text, &end);
  return end != text && *end == '\0' && *value > 0 && *value <= most;
}

static bool parse_engine(const char *text, enum engine *engine) {
  static const char *const names[] = {"fast", "reference", "native", "embree"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (strcmp(text, names[i]) == 0) {
      *engine = (enum engine)i;
      return true;
    }
  return false;
}

static bool parse_triangle(const char *text, enum trax_triangle_method *method) {
  for (*method = 0; *method < TRAX_TRIANGLE_METHODS; ++*method)
    if (strcmp(text, trax_triangle_names[*method]) == 0)
      return true;
  return false;
}

static trax_status add_setting(struct options *options, const char *text, trax_error *error) {
  const char *equals = strchr(text, '=');
  if (!equals || equals == text)
    return trax_fail(error, "--set %s: expected KEY=VALUE", text);
  struct setting *settings = realloc(options->settings, (options->setting_count + 1) * sizeof *settings);
  if (settings)
    options->settings = settings;
  char *key = strndup(text, (size_t)(equals - text));
  if (!settings || !key) {
    free(key);
    return trax_fail(error, "out of memory");
  }
  settings[options->setting_count++] = (struct setting){key, equals + 1};
  return TRAX_OK;
}

static trax_status add_override(struct options *options, const char *text, trax_error *error,
                                trax_status (*parse)(struct trax_material_override *, char *, trax_error *)) {
  const size_t count = options->import.override_count;
  struct trax_material_override *overrides = realloc(options->overrides, (count + 1) * sizeof *overrides);
  if (!overrides)
    return trax_fail(error, "out of memory");
  options->import.overrides = options->overrides = overrides;
  /* The text is of argv, whose strings may be changed; the name is cut off there. */
  trax_status status = parse(&overrides[count], (char *)text, error);
  options->import.override_count += status == TRAX_OK;
  return status;
}

static trax_status take_normals(struct options *options, const char *value, trax_error *error) {
  options->frame.smooth = strcmp(value, "flat") != 0;
  options->compute_normals = strcmp(value, "smooth") == 0;
  if (strcmp(value, "file") == 0 || options->compute_normals || !options->frame.smooth)
    return TRAX_OK;
  return trax_fail(error, "--normals %s: expected file, smooth or flat", value);
}

/* As many numbers as fit between commas, none beyond `most`; returns how many, 0 if anything else is there. */
static unsigned parse_floats(const char *text, float *values, unsigned count, float most) {
  for (unsigned i = 0; i < count; i++) {
    char *end;
    values[i] = strtof(text, &end);
    if (end == text || !(values[i] >= -most && values[i] <= most))
      return 0;
    if (*end == '\0')
      return i + 1;
    if (*end != ',')
      return 0;
    text = end + 1;
  }
  return 0;
}

static trax_status take_point(float point[3], bool *given, const char *name, const char *value, trax_error *error) {
  if (given)
    *given = true;
  return parse_floats(value, point, 3, 1e18f) == 3
             ? TRAX_OK
             : trax_fail(error, "--%s %s: expected three numbers, X,Y,Z", name, value);
}

static trax_status take_camera_option(struct options *options, int which, const char *value, trax_error *error) {
  struct camera_options *camera = &options->camera;
  switch (which) {
  case OPT_EYE:
    return take_point(camera->eye, &camera->has_eye, "eye", value, error);
  case OPT_LOOK_AT:
    return take_point(camera->look_at, &camera->has_look_at, "look-at", value, error);
  case OPT_UP:
    return take_point(camera->up, &camera->has_up, "up", value, error);
  case OPT_FOV:
    if (parse_floats(value, &camera->fov, 1, 179.9f) != 1 || camera->fov < 0.01f)
      return trax_fail(error, "--fov %s: expected a number of degrees from 0.01 to 179.9", value);
    return TRAX_OK;
  case OPT_LIGHT:
    if (camera->light_count == TRAX_VIEW_MAX_LIGHTS)
      return trax_fail(error, "--light: there may be at most %d lights", TRAX_VIEW_MAX_LIGHTS);
    return take_point(camera->lights[camera->light_count++], NULL, "light", value, error);
  case OPT_ORBIT:
    if (parse_floats(value, camera->orbit, 2, 36000) == 0)
      return trax_fail(error, "--orbit %s: expected degrees, ANGLE or ANGLE,ELEVATION", value);
    return TRAX_OK;
  case OPT_FRAMES:
    if (!parse_number(&value, 9999, &options->frames) || *value != '\0' || options->frames == 0)
      return trax_fail(error, "--frames: expected a number from 1 to 9999");
    return TRAX_OK;
  case OPT_WRITE_VIEW:
    options->write_view = value;
    return TRAX_OK;
  default: /* OPT_ID_PICTURE */
    options->id_picture = value;
    return TRAX_OK;
  }
}

static trax_status take_option(struct options *options, int which, const char *value, trax_error *error) {
  unsigned number;
  if (which >= OPT_EYE && which <= OPT_ID_PICTURE)
    return take_camera_option(options, which, value, error);
  switch (which) {
  case 'o':
    options->output = value;
    return TRAX_OK;
  case 'q':
    options->quiet = true;
    return TRAX_OK;
  case OPT_SIZE:
    if (!parse_size(value, &options->frame))
      return trax_fail(error, "--size %s: expected WIDTHxHEIGHT, each 1 to %u", value, TRAX_RENDER_MAX_SIDE);
    return TRAX_OK;
  case OPT_VIEW:
    options->view = value;
    return TRAX_OK;
  case OPT_SAMPLES:
    if (!parse_number(&value, TRAX_RENDER_MAX_SAMPLES, &options->frame.samples) || *value != '\0' ||
        options->frame.samples == 0)
      return trax_fail(error, "--samples: expected a number from 1 to %u", TRAX_RENDER_MAX_SAMPLES);
    return TRAX_OK;
  case OPT_MATERIAL:
    return add_override(options, value, error, trax_override_material);
  case OPT_DIFFUSE:
    return add_override(options, value, error, trax_override_diffuse);
  case OPT_NO_TEXTURES:
    options->import.no_textures = true;
    return TRAX_OK;
  case OPT_SPLITS: {
    struct trax_build_options build;
    if (!trax_splits_choose(value, &build))
      return trax_fail(error, "--splits=%s: expected auto or a number from 1 to %g", value,
                       (double)TRAX_SCENE_MAX_SPLITS);
    options->splits = value ? value : "1.5";
    return TRAX_OK;
  }
  case OPT_NODES: {
    struct trax_build_options build;
    if (!trax_node_layout_choose(value, &build))
      return trax_fail(
          error, "--nodes %s: expected auto, binary, quantised, quantised8, wide, wide-quantised or wide-quantised8",
          value);
    options->nodes = value;
    return TRAX_OK;
  }
  case OPT_TEXTURE_SIZE: {
    const char *text = value;
    if (!parse_number(&text, 1u << TRAX_TEXTURE_MAX_LOG2, &options->import.texture_size) || *text != '\0' ||
        options->import.texture_size == 0 || (options->import.texture_size & (options->import.texture_size - 1)))
      return trax_fail(error, "--texture-size %s: expected a power of two up to %u", value,
                       1u << TRAX_TEXTURE_MAX_LOG2);
    return TRAX_OK;
  }
  case OPT_UNPACK_LIMIT:
    return trax_parse_size(value, &options->import.unpack_limit)
               ? TRAX_OK
               : trax_fail(error, "--unpack-limit %s: expected a size from 1 byte to 4G", value);
  case OPT_NORMALS:
    return take_normals(options, value, error);
  case OPT_PATHS:
    if (!parse_number(&value, TRAX_RENDER_MAX_DEPTH, &options->frame.paths) || *value != '\0' ||
        options->frame.paths == 0)
      return trax_fail(error, "--paths: expected a number from 1 to %u", TRAX_RENDER_MAX_DEPTH);
    return TRAX_OK;
  case OPT_SEED:
    if (!parse_number(&value, UINT32_MAX, &options->frame.seed) || *value != '\0')
      return trax_fail(error, "--seed: expected a number from 0 to %u", UINT32_MAX);
    return TRAX_OK;
  case OPT_ONE_SIDED:
    options->frame.one_sided = true;
    return TRAX_OK;
  case OPT_FLOAT:
    options->frame.floats = true;
    return TRAX_OK;
  case OPT_SMOOTH:
    options->frame.smooth = true;
    return TRAX_OK;
  case OPT_NO_SHADOWS:
    options->frame.shadows = false;
    return TRAX_OK;
  case OPT_NO_SPECIALISE:
    options->no_specialise = true;
    return TRAX_OK;
  case OPT_CACHE:
    options->cache = value;
    return TRAX_OK;
  case OPT_REPORT:
    options->report = true;
    return TRAX_OK;
  case OPT_QUEUES: {
    const char *text = value;
    options->choose_queues = true;
    options->queues = 0;
    if (strcmp(value, "tms") != 0 &&
        (!parse_number(&text, TRAX_MAX_QUEUES, &options->queues) || *text != '\0' || options->queues == 0))
      return trax_fail(error, "--queues %s: expected 1 to %d, or tms", value, TRAX_MAX_QUEUES);
    return TRAX_OK;
  }
  case OPT_TRIANGLE:
    if (!parse_triangle(value, &options->frame.method.triangle))
      return trax_fail(error, "--triangle %s: expected watertight or moller-trumbore", value);
    return TRAX_OK;
  case OPT_FAST_MATH:
    options->frame.method.fast_math = true;
    return TRAX_OK;
  case OPT_STACK:
    if (!parse_number(&value, TRAX_SCENE_MAX_DEPTH, &options->frame.method.stack) || *value != '\0' ||
        options->frame.method.stack == 0)
      return trax_fail(error, "--stack: expected a number from 1 to %u", TRAX_SCENE_MAX_DEPTH);
    return TRAX_OK;
  case OPT_BENCH_ACCURACY:
    options->bench_accuracy = true;
    return TRAX_OK;
  case OPT_AMBIENT:
    if (!parse_fraction(value, &options->frame.ambient))
      return trax_fail(error, "--ambient %s: expected a number from 0 to 1", value);
    return TRAX_OK;
  case OPT_BACKGROUND:
    if (!parse_colour(value, &options->frame.background))
      return trax_fail(error, "--background %s: expected six hexadecimal digits, RRGGBB", value);
    return TRAX_OK;
  case OPT_CONFIG:
    options->config = value;
    return TRAX_OK;
  case OPT_SET:
    return add_setting(options, value, error);
  case OPT_STATS:
    options->stats = value;
    return TRAX_OK;
  case OPT_PROFILE:
    options->explain.profile = value;
    return TRAX_OK;
  case OPT_PROFILE_FOLDED:
    options->explain.folded = value;
    return TRAX_OK;
  case OPT_COST_PICTURE:
    options->cost_picture = value;
    return TRAX_OK;
  case OPT_COST_VALUES:
    options->cost_values = value;
    return TRAX_OK;
  case OPT_COST: {
    unsigned what;
    options->cost = value;
    return trax_cost_find(value, &what, error);
  }
  case OPT_ENGINE:
    if (!parse_engine(value, &options->engine))
      return trax_fail(error, "--engine %s: expected fast, reference, native or embree", value);
    return TRAX_OK;
  case OPT_THREADS:
    if (!parse_number(&value, 4096, &options->threads) || *value != '\0' || options->threads == 0)
      return trax_fail(error, "--threads: expected a number from 1 to 4096");
    return TRAX_OK;
  case OPT_SAMPLED:
    options->sampled = true;
    return TRAX_OK;
  case OPT_SAMPLE_FRACTION:
    if (!parse_share(value, 1, &options->sampling.fraction))
      return trax_fail(error, "--sample-fraction %s: expected a number above 0 to 1", value);
    return TRAX_OK;
  case OPT_SAMPLE_ERROR:
    if (!parse_share(value, 50, &options->sampling.error))
      return trax_fail(error, "--sample-error %s: expected per cent, above 0 to 50", value);
    options->sampling.error /= 100;
    return TRAX_OK;
  case OPT_SAMPLE_SEED:
  case OPT_SAMPLE_UNIT:
  case OPT_SAMPLE_WARM_UP: {
    const unsigned most = which == OPT_SAMPLE_SEED ? UINT32_MAX : 1u << 24;
    if (!parse_number(&value, most, &number) || *value != '\0' || number == 0)
      return trax_fail(error, "--sample-seed, --sample-unit, --sample-warm-up: expected a number from 1 to %u", most);
    if (which == OPT_SAMPLE_SEED)
      options->sampling.seed = number;
    else
      *(which == OPT_SAMPLE_UNIT ? &options->sampling.unit : &options->sampling.warm_up) = number;
    return TRAX_OK;
  }
  case OPT_COMPARE:
    options->compare = true;
    return TRAX_OK;
  case OPT_PROGRAM:
    options->program = value;
    return TRAX_OK;
  case OPT_PREPARE:
    options->prepare = true;
    options->keep = value;
    return TRAX_OK;
  default: /* OPT_KEEP */
    options->keep = value;
    return TRAX_OK;
  }
}

static trax_status check(const struct options *options, trax_error *error) {
  if (options->mesh_count == 0)
    return trax_fail(error, "no mesh given; trax-render --help shows how");
  if (options->prepare &&
      (options->output || options->stats || options->compare || options->report || options->id_picture ||
       options->cost_picture || options->cost_values || trax_explain_wanted(&options->explain)))
    return trax_fail(error, "--prepare renders nothing, so there is nothing to write, explain or compare");
  if (!options->output && !options->prepare)
    return trax_fail(error, "no picture given: -o PICTURE.png");
  if (options->bench_accuracy) {
    if (options->engine != ENGINE_FAST || options->program || options->no_specialise)
      return trax_fail(error, "--bench-accuracy chooses engines and programs itself");
    if (options->frame.samples != 1 || options->frame.method.triangle != TRAX_TRIANGLE_WATERTIGHT ||
        options->frame.method.fast_math)
      return trax_fail(error, "--bench-accuracy varies --samples, --triangle and --fast-math itself");
    if (options->frame.method.stack)
      return trax_fail(error, "--bench-accuracy is about pictures, which --stack leaves as they are");
    if (options->stats || options->cost_picture || options->cost_values || options->compare || options->report ||
        options->keep || options->prepare || options->frames > 1 || options->id_picture ||
        trax_explain_wanted(&options->explain))
      return trax_fail(error, "--bench-accuracy makes tables and diagrams of its own, and nothing else");
  }
  const trax_slot_sampling *sampling = &options->sampling;
  if (!options->sampled &&
      (sampling->fraction > 0 || sampling->error > 0 || sampling->seed || sampling->unit || sampling->warm_up))
    return trax_fail(error, "--sample-fraction, --sample-error and the like are for --sampled");
  if (sampling->fraction > 0 && sampling->error > 0)
    return trax_fail(error, "--sample-fraction and --sample-error: one follows from the other");
  if (options->sampled && options->engine != ENGINE_FAST)
    return trax_fail(error, "--sampled needs engine fast");
  if (options->sampled &&
      (options->compare || options->report || options->bench_accuracy || options->prepare || options->frames > 1 ||
       options->cost_picture || options->cost_values || trax_explain_wanted(&options->explain)))
    return trax_fail(error, "--sampled leaves out most of the run: there is nothing to compare, explain or prepare");
  if (options->sampled && options->frame.method.fast_math)
    return trax_fail(error, "--sampled: with --fast-math the native twin's picture would be another one");
  if (options->engine > ENGINE_REFERENCE) {
    if (options->stats)
      return trax_fail(error, "--stats needs the emulator: the other engines have no machine to tell about");
    if (options->cost_picture || options->cost_values || trax_explain_wanted(&options->explain))
      return trax_fail(error, "--profile, --profile-folded, --cost-picture and --cost-values need the emulator");
    if (options->keep || options->program || options->config || options->setting_count)
      return trax_fail(error, "--config, --set, --program, --keep and --prepare need the emulator");
    if (options->choose_queues)
      return trax_fail(error, "--queues needs the emulator: other engines have no TMs");
    if (options->cache || options->report || options->no_specialise)
      return trax_fail(error, "--cache, --report and --no-specialise need the emulator");
    if (options->frame.method.fast_math)
      return trax_fail(error, "--fast-math needs the emulator: it is about the program that is compiled for it");
    if (options->frame.method.stack)
      return trax_fail(error, "--stack needs the emulator: it is about the program that is compiled for it");
    if (options->frame.method.triangle != TRAX_TRIANGLE_WATERTIGHT && options->engine == ENGINE_EMBREE)
      return trax_fail(error, "--triangle: engine embree has a test of its own");
  }
  if (options->choose_queues && (options->no_specialise || options->program))
    return trax_fail(error, "--queues needs a program compiled for the picture; %s asks for another",
                     options->program ? "--program" : "--no-specialise");
  const struct trax_method *method = &options->frame.method;
  if (method->stack && (options->no_specialise || options->program))
    return trax_fail(error, "--stack needs a program compiled for the picture; %s asks for another",
                     options->program ? "--program" : "--no-specialise");
  if (method->triangle != TRAX_TRIANGLE_WATERTIGHT || method->fast_math) {
    const char *name = method->fast_math ? "--fast-math" : "--triangle";
    if (options->no_specialise || options->program)
      return trax_fail(error, "%s needs a program compiled for the picture; %s asks for another", name,
                       options->program ? "--program" : "--no-specialise");
    if (options->report)
      return trax_fail(error, "--report compares with the general program, which %s does not change", name);
  }
  if (options->no_specialise && (options->cache || options->report))
    return trax_fail(error, "--cache and --report are about the specialised program; --no-specialise asks for none");
  if (options->program && (options->cache || options->report))
    return trax_fail(error, "--cache and --report are about the specialised program; --program asks for another");
  if (options->cost && !options->cost_picture && !options->cost_values)
    return trax_fail(error, "--cost without --cost-picture or --cost-values");
  if (options->frames > 1 &&
      (options->stats || options->keep || options->cost_picture || options->cost_values || options->report ||
       options->compare || options->id_picture || trax_explain_wanted(&options->explain)))
    return trax_fail(error, "--frames makes pictures only: --stats, --keep, --compare and the like are for one");
  if (options->frame.seed && !options->frame.paths)
    return trax_fail(error, "--seed is for --paths: nothing else is random");
  if (options->threads && options->engine != ENGINE_NATIVE && options->engine != ENGINE_FAST)
    return trax_fail(error, "--threads is for engines fast and native");
  return TRAX_OK;
}

enum options_result options_parse(struct options *options, int argc, char **argv, trax_error *error) {
  *options = (struct options){.frames = 1,
                              .frame = {.width = 1280,
                                        .height = 720,
                                        .ambient = TRAX_DEFAULT_AMBIENT,
                                        .background = TRAX_DEFAULT_BACKGROUND,
                                        .samples = 1,
                                        .shadows = true}};
  opterr = 0;
  for (int which, index = 0; (which = getopt_long(argc, argv, ":o:qh", long_options, &index)) != -1;) {
    if (which == '?' || which == ':') {
      trax_wrong_option(long_options, argv, which, error);
      return OPTIONS_WRONG;
    }
    if (optarg && !*optarg) {
      trax_fail(error, "--%s: the value is empty", which == 'o' ? "output" : long_options[index].name);
      return OPTIONS_WRONG;
    }
    if (which == 'h' || which == OPT_VERSION) {
      fputs(which == 'h' ? usage : "trax-render " TRAX_VERSION "\n", stdout);
      return OPTIONS_DONE;
    }
    if (take_option(options, which, optarg, error))
      return OPTIONS_WRONG;
  }
  options->meshes = (const char **)(argv + optind);
  options->mesh_count = (size_t)(argc - optind);
  options->frame.floats = options->frame.floats || (options->output && trax_picture_is_float(options->output));
  return check(options, error) ? OPTIONS_WRONG : OPTIONS_RUN;
}

void options_release(struct options *options) {
  for (size_t i = 0; i < options->setting_count; i++)
    free((char *)options->settings[i].key);
  free(options->settings);
  free(options->overrides);
}
