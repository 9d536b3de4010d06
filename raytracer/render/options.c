#include "options.h"

#include "trax/scene_options.h"
#include "values.h"
#include "views.h"

#include <stdlib.h>

/* The names of enum engine. */
static const char *const engines[] = {"fast", "reference", "native", "embree", "exact", NULL};
/* The order is that of enum trax_ray_order. */
static const char *const ray_orders[] = {"found", "morton", "treelet", "random", NULL};

#define FIELD(member) TRAX_OPTION_FIELD(struct options, member)
#define PARSED(function, member) .parse = (function), .offset = offsetof(struct options, member)
#define NUMBER(member, least_, most_) FIELD(member), .least = (least_), .most = (most_)
#define WRITTEN .file = TRAX_OPTION_WRITTEN
#define OUTPUT(member, endings_) FIELD(member), .file = TRAX_OPTION_OUTPUT, .endings = (endings_)

/* The numbers in the table's texts. */
_Static_assert(TRAX_RENDER_MAX_SIDE == 16384 && TRAX_RENDER_MAX_SAMPLES == 4096 && TRAX_RENDER_MAX_DEPTH == 64 &&
                   TRAX_RENDER_MAX_OCCLUSION == 64,
               "");
_Static_assert(TRAX_TEXTURE_MAX_LOG2 == 12 && TRAX_SCENE_MAX_DEPTH == 62 && TRAX_MAX_QUEUES == 64, "");

/* --- what the completion offers --- */

static void put_costs(FILE *out) {
  fputs("cycles instructions ", out);
  for (unsigned i = 0; trax_stats_cause(i); i++)
    fprintf(out, "%s ", trax_stats_cause(i));
}

/* clang-format off */
static const trax_option rows[] = {
    TRAX_OPTION_GROUP("Picture"),
    {"output", 'o', .argument = "FILE", FIELD(output), WRITTEN,
     .meaning = "the picture: linear floats for .pfm and .exr, a PNG for .png"},
    {"layers", FIELD(layers),
     .meaning = "with -o FILE.exr: also the triangle of each pixel (its number in the meshes, from 1), its\n"
                "distance from the eye (Z), normal (N.X, N.Y, N.Z) and shadow (0 no shadow ray, 1 lit, 2 in\n"
                "shadow), by the first ray; on the emulator a program that records renders, without times"},
    {"size", .argument = "WxH", PARSED(take_size, frame),
     .meaning = "size of the picture in pixels, 1x1 to 16384x16384 (default 1280x720)"},
    {"samples", .argument = "N", NUMBER(frame.samples, 1, TRAX_RENDER_MAX_SAMPLES),
     .meaning = "rays from the eye through every pixel, 1 to 4096 (default 1)"},
    {"float", FIELD(frame.floats), .meaning = "the program computes linear floats, of which the host makes the picture"},
    {"frames", .argument = "N", NUMBER(frames, 2, 9999),
     .meaning = "makes a sequence of N moments, with --at A:B: -o is a folder for picture and statistics of each\n"
                "frame, frames.csv, and report.html with curves of new trees and of the first tree, refitted.\n"
                "The same command continues an interrupted sequence"},
    {"no-refit", FIELD(no_refit), .meaning = "makes a sequence with new trees only"},
    {"id-picture", .instead = "-o FILE.exr --layers, whose channel triangle has the same numbers"},
    {"show", .instead = "--engine native, the same picture in a fraction of the time"},
    {"progress-png", .instead = "--engine native, the same picture in a fraction of the time"},
    TRAX_OPTION_GROUP("View"),
    {"view", .argument = "FILE|NAME", FIELD(view), .words = put_view_names,
     .meaning = "eye, direction, field of view and light: a file, or one that comes with trax;\n"
                "file:NAME is a camera of a glTF file, file: its first one; without it the view with\n"
                "the mesh's name, the inside of a closed room, or all of the scene is shown"},
    {"views", .kind = TRAX_OPTION_SHOW, .show = print_views, .meaning = "list the views that come with trax, and end"},
    {"eye", .argument = "X,Y,Z", PARSED(take_point, camera.eye), .meaning = "the eye, instead of the view's"},
    {"look-at", .argument = "X,Y,Z", PARSED(take_point, camera.look_at),
     .meaning = "the point it looks at, instead of the view's"},
    {"up", .argument = "X,Y,Z", PARSED(take_point, camera.up), .meaning = "the upward direction, instead of the view's; a default view turns with it"},
    {"fov", .argument = "DEGREES", PARSED(take_fov, camera.fov), .meaning = "the field of view, instead of the view's"},
    {"light", .argument = "X,Y,Z", PARSED(take_light, camera),
     .meaning = "a point light instead of the view's lights; repeated, they share the light"},
    {"orbit", .argument = "A[,E]", PARSED(take_orbit, camera.orbit),
     .meaning = "turns the eye by A degrees around the point that the view looks at, or the middle of the\n"
                "scene, and raises it by E degrees"},
    {"write-view", .argument = "FILE", OUTPUT(write_view, NULL), .meaning = "writes the view as a file"},
    TRAX_OPTION_GROUP("Meshes"),
    {"material", .argument = "[NAME=]KIND", PARSED(trax_take_material, import), .words = trax_put_material_kinds,
     .meaning = "gives the material NAME, or all, this kind: lambert, mirror[:R,G,B], glass[:IOR],\n"
                "ggx:ROUGHNESS[:R,G,B] or emit:R,G,B (repeatable)"},
    {"diffuse", .argument = "[NAME=]R,G,B", PARSED(trax_take_diffuse, import),
     .meaning = "gives it, or all, this linear colour, 0 to 1 (repeatable)"},
    {"at", .argument = "X[:Y]", PARSED(take_moments, import),
     .meaning = "a moment: frame X of meshes whose name has %d or %04d, second X of glTF's animation;\n"
                "X:Y: the moments of --frames, evenly from X to Y"},
    {"animation", .argument = "NAME", FIELD(import.animation), .meaning = "glTF's animation of this name instead of the first"},
    {"instances", FIELD(import.instances), .meaning = "keeps a mesh of several glTF nodes once, and places it"},
    {"flatten", FIELD(import.flatten), .meaning = "gives every instance triangles of its own"},
    {"no-textures", FIELD(import.no_textures), .meaning = "reads no images; colours remain"},
    {"texture-size", .argument = "N", PARSED(trax_take_texture_size, import.texture_size),
     .meaning = "at most N texels a side, a power of two up to 4096"},
    {"unpack-limit", .argument = "SIZE", PARSED(trax_take_unpack_limit, import.unpack_limit),
     .meaning = "most bytes of a packed file or a pipe, unpacked; K, M and G are powers of 1024 (default 1G)"},
    {"nodes", .argument = "KIND", PARSED(trax_take_nodes, nodes), .choices = trax_node_words,
     .meaning = "nodes of the meshes' tree: binary, quantised, wide4, wide4-quantised, wide8 or auto, as trax-scene\n"
                "has them (default auto; for another --program binary)"},
    {"splits", .argument = "[=FACTOR]", PARSED(trax_take_splits, splits),
     .meaning = "splits large triangles, as trax-scene does (default auto; for another\n"
                "--program 1, which is none)"},
    {"normals", .argument = "WHICH", PARSED(trax_take_normals, build), .choices = trax_normals_words,
     .meaning = "file: --smooth uses the meshes' own normals, computed where there are none (default);\n"
                "smooth: it uses computed normals; flat: no --smooth"},
    TRAX_OPTION_GROUP("Rays instead of a picture"),
    {"rays", .argument = "FILE", FIELD(rays), .file = TRAX_OPTION_INPUT,
     .meaning = "traces the rays of a binary file that --ray-trace wrote; with --compare exit status 1 if a\n"
                "result is not the file's"},
    {"ray-order", .argument = "ORDER", FIELD(ray_order), .choices = ray_orders,
     .meaning = "found (default): as in the file; morton: by origin and direction; treelet: by the first\n"
                "treelet of the data cache's size that a ray enters; random"},
    {"ray-results", .argument = "FILE", OUTPUT(ray_results, NULL),
     .meaning = "writes the same rays with the run's results, in the order of the file"},
    TRAX_OPTION_GROUP("Shading"),
    {"paths", .argument = "DEPTH", NUMBER(frame.paths, 1, TRAX_RENDER_MAX_DEPTH),
     .meaning = "path tracing: light over up to DEPTH surfaces, 1 to 64; needs many samples"},
    {"occlusion", .argument = "N", NUMBER(frame.occlusion, 1, TRAX_RENDER_MAX_OCCLUSION),
     .meaning = "ambient occlusion: N rays a sample, 1 to 64, find how much of the ambient light arrives"},
    {"occlusion-reach", .argument = "X", PARSED(take_share, frame.occlusion_reach),
     .meaning = "length of these rays, above 0 to 1 times the diagonal of the scene's box (default 0.1)"},
    {"seed", .argument = "N", NUMBER(frame.seed, 0, UINT32_MAX),
     .meaning = "seed of the random numbers of --paths and --occlusion, 0 to 4294967295 (default 0)"},
    {"smooth", FIELD(build.smooth),
     .meaning = "shades by normals that vary across triangles; edges sharper than 60 degrees stay edges\n"
                "(a scene file needs normals, made by trax-scene --smooth)"},
    {"one-sided", FIELD(frame.one_sided),
     .meaning = "triangles are seen from the side where they are counterclockwise, and glass from both"},
    {"no-shadows", FIELD(frame.shadows), .off = true, .meaning = "the light shines through everything"},
    {"ambient", .argument = "X", PARSED(take_fraction, frame.ambient),
     .meaning = "ambient light, 0 to 1 (default 0.12)"},
    {"environment", .argument = "FILE", FIELD(environment), .file = TRAX_OPTION_INPUT,
     .meaning = "takes light of all directions from a picture of longitude and latitude (EXR, HDR, PFM, PNG),\n"
                "instead of the background; with --paths it lights the scene instead of the plain light"},
    {"environment-strength", .argument = "X", PARSED(take_strength, environment_strength),
     .meaning = "factor of the picture's light (default 1)"},
    {"environment-turn", .argument = "DEGREES", PARSED(take_turn, environment_turn),
     .meaning = "turns the picture about the y axis; its middle is -z, its right half +x"},
    {"background", .argument = "RRGGBB", PARSED(take_colour, frame.background),
     .meaning = "colour of rays that hit nothing, hexadecimal (default 98a8b8)"},
    TRAX_OPTION_GROUP("Machine"),
    {"config", .argument = "CHIP|FILE", FIELD(config), .words = trax_config_list_presets,
     .meaning = "the chip: 1x32 to 8x64 as in the paper, or a file (default 4x32)"},
    {"set", .argument = "KEY=VALUE", .parse = take_setting, .words = trax_config_list_keys,
     .meaning = "changes one value of the configuration (trax-sim --help-config lists them)"},
    {"engine", .argument = "WHICH", FIELD(engine), .choices = engines,
     .meaning = "fast (default): the emulator; reference: its reference engine, the same cycles, slowly;\n"
                "native: the same program compiled for this computer; embree: an independent renderer;\n"
                "exact: the same with hits without error"},
    {"threads", .argument = "N", NUMBER(threads, 1, 4096),
     .meaning = "host threads of engines fast and native (default: all processors)"},
    TRAX_OPTION_GROUP("What the run took"),
    {"stats", .argument = "FILE.json", OUTPUT(stats, NULL), .meaning = "writes every statistic of the run"},
    {"ray-cycles", .argument = "FILE.csv", OUTPUT(ray_cycles, NULL),
     .meaning = "writes thread-cycles of the rays of each kind, by cause; also with --sampled. Needs --mark-rays\n"
                "unless the program counts its rays anyway"},
    {"explore", .argument = "FILE.html", OUTPUT(explain.explore, NULL),
     .meaning = "writes a page that explains the whole run, pixel by pixel too, for a browser"},
    {"explore-against", .argument = "FILE", FIELD(explain.against), .file = TRAX_OPTION_INPUT,
     .meaning = "lets that page also show the differences to the run of FILE, from --stats or --explore"},
    {"pixel", .argument = "X,Y", PARSED(take_pixel, pixels),
     .meaning = "prints the story of a pixel: its rays, functions, lines, waits and time line; also for the\n"
                "page of --explore (repeatable)"},
    {"source-folder", .argument = "FOLDER", PARSED(take_source_folder, explain),
     .meaning = "lets that page contain the sources in FOLDER, too (repeatable)"},
    {"ray-trace", .argument = "FILE", OUTPUT(ray_trace, NULL),
     .meaning = "writes every ray and its result, by the native twin; CSV for FILE.csv, else binary; alone,\n"
                "it renders nothing"},
    {"memory-trace", .argument = "FILE", OUTPUT(explain.memory_trace, NULL),
     .meaning = "writes every transfer from and to off-chip memory; CSV for FILE.csv, else binary"},
    {"cost-picture", .argument = "FILE.png", OUTPUT(cost_picture, "png"),
     .meaning = "writes the cost of each pixel, in false colours"},
    {"cost-values", .argument = "FILE", OUTPUT(cost_values, "csv pfm"),
     .meaning = "writes these costs as numbers: PFM for FILE.pfm, else CSV"},
    {"cost", .argument = "WHAT", PARSED(take_cost, cost), .words = put_costs,
     .meaning = "the cost: cycles (default), instructions, or one cause (trax-sim --help-stats)"},
    {"memory-trace-format", .instead = "--memory-trace FILE.csv, or FILE and memory_trace_for.py of docs/traces.md"},
    {"profile", .instead = "--explore FILE.html, or trax-sim --profile with what --keep writes"},
    {"profile-folded", .instead = "--explore FILE.html, or trax-sim --profile-folded with what --keep writes"},
    {"report", .instead = "run twice with --stats, once with --no-specialise, or trax-eval's sweep lean"},
    {"compare", FIELD(compare),
     .meaning = "renders by Embree and by the native twin too and prints the differences;\n"
                "exit status 1 if the twin's picture is not the same bit for bit, or less than\n"
                "99.9 % of the pixels are within 2/255 of Embree's (of paths 99 %, and the light\n"
                "of the whole picture within 0.2 %)"},
    {"hits", .argument = "FILE.json", OUTPUT(hits, "json"),
     .meaning = "writes how many pixels hit the nearest triangle, by the native twin, against exact arithmetic\n"
                "and Embree; alone, it renders nothing"},
    {"error", .argument = "FILE.json",
     .instead = "--layers writes what trax-compare --json compares; trax-eval's sweep accuracy does both"},
    {"converged", .argument = "DIR", .instead = "--engine exact --samples 1024 renders that picture"},
    {"bench-accuracy", .instead = "trax-eval's sweep accuracy measures errors and run time"},
    TRAX_OPTION_GROUP("Program"),
    {"mark-rays", FIELD(frame.mark_rays),
     .meaning = "compiles the program so that it counts each ray where it begins, for trax-sim --ray-kinds\n"
                "(with lights, materials, --paths and the like it does so anyway)"},
    {"program", .argument = "FILE.elf", FIELD(program), .file = TRAX_OPTION_INPUT,
     .meaning = "runs this program on the TPs instead of the one that comes with trax"},
    {"no-specialise", FIELD(no_specialise),
     .meaning = "runs the program for all pictures instead of one compiled for this picture"},
    {"source", .argument = "DIR", FIELD(source),
     .meaning = "compiles the source in DIR, with its main.c, instead of the program that comes with trax;\n"
                "to change a copy of lib/trax/raytracer; options of the compiler are in its flags.txt"},
    {"cache", .argument = "DIR", FIELD(cache), WRITTEN,
     .meaning = "where programs compiled for a picture are kept (default: XDG_CACHE_HOME/trax/programs,\n"
                "or .cache/trax/programs in the home directory)"},
    {"triangle", .argument = "METHOD",
     .instead = "trax-eval has other tests as experiments, lib/trax/evaluation/experiments/triangles"},
    {"queues", .argument = "N", .parse = take_queues,
     .meaning = "the number of queues of pixels, 1 to 64; tms (default): one for each TM, whose threads\n"
                "then share tiles and the cache's lines"},
    {"fast-math", .instead = "-ffast-math in a file flags.txt of --source DIR, or trax-eval's experiment "
                             "lib/trax/evaluation/experiments/triangles/fast-math.json"},
    {"stack", .argument = "N",
     .instead = "a stack has an entry for each level of the tree; shorter ones take more cycles"},
    TRAX_OPTION_GROUP("Sampled simulation"),
    {"sampled", FIELD(sampled),
     .meaning = "simulates only some parts of the picture and estimates the rest, with an interval; the\n"
                "picture itself is the native twin's"},
    {"sample-fraction", .argument = "X", PARSED(take_share, sampling.fraction),
     .meaning = "the share of the work that is simulated, above 0 to 1 (default 0.05; 1: all of it)"},
    {"sample-error", .argument = "X", PARSED(take_percent, sampling.error),
     .meaning = "simulates enough for an interval of plus and minus X per cent, above 1"},
    {"sample-seed", .argument = "N", NUMBER(sampling.seed, 1, UINT32_MAX),
     .meaning = "number of the choice of parts (default 1)"},
    {"sample-unit", .argument = "N", NUMBER(sampling.unit, 1, 1u << 24),
     .meaning = "pixels of a part (default 2 for each thread, at least 256)"},
    {"sample-warm-up", .argument = "N", NUMBER(sampling.warm_up, 1, 1u << 24),
     .meaning = "pixels before a part that are simulated, but not measured (default 4 for each thread)"},
    TRAX_OPTION_GROUP("Files of the run"),
    {"keep", .argument = "DIR", FIELD(keep), WRITTEN,
     .meaning = "keeps the program and its inputs, with a manifest that trax-sim runs"},
    {"prepare", .argument = "DIR", .parse = take_prepare, WRITTEN, .meaning = "keeps the same files, and renders nothing"},
    TRAX_OPTION_GROUP("Other"),
    {"quiet", 'q', FIELD(quiet), .meaning = "prints errors only"},
    TRAX_OPTION_HELP('h'),
    TRAX_OPTION_VERSION,
    {0}};
/* clang-format on */

const trax_command render_command = {
    .name = "trax-render",
    .synopsis = "[options] MESH [MESH ...] -o PICTURE.png",
    .description =
        "Renders meshes, or one scene file (.trax), on the emulated ray-tracing accelerator: a ray from the eye "
        "through\n"
        "every pixel, and a shadow ray towards one point light. generate:forest[:SEED] is a mesh made on the spot.",
    .rows = rows,
    .examples = "trax-render bunny.obj -o bunny.png                          # a mesh on the paper's 4x32 chip\n"
                "trax-render generate:forest --view forest --size 320x180 -o forest.png --explore run.html\n"
                "trax-render room.glb --paths 4 --samples 16 --engine native -o room.exr   # computed by this host\n"
                "trax-render bunny.obj --config 8x64 --set memory.bandwidth_gbps=16 --stats b.json",
    .column = 26};

trax_parsed options_parse(struct options *options, int argc, char **argv, trax_error *error) {
  *options = (struct options){.environment_strength = 1,
                              .frame = {.width = 1280,
                                        .height = 720,
                                        .ambient = TRAX_DEFAULT_AMBIENT,
                                        .background = TRAX_DEFAULT_BACKGROUND,
                                        .samples = 1,
                                        .shadows = true}};
  const trax_parsed parsed = trax_command_parse(&render_command, options, &argc, argv, error);
  if (parsed != TRAX_PARSED_RUN)
    return parsed;
  options->meshes = (const char **)argv;
  options->mesh_count = (size_t)argc;
  options->frame.smooth = options->build.smooth;
  options->frame.floats =
      options->frame.floats || (options->output && trax_picture_is_float(options->output) && !options->layers);
  if (options->pixels.count)
    options->explain.story = "-";
  if (options_check(options, error) != TRAX_OK)
    return TRAX_PARSED_WRONG;
  if (options->explain.explore && options->source)
    return trax_explain_add_source_folder(&options->explain, options->source, error) == TRAX_OK ? TRAX_PARSED_RUN
                                                                                                : TRAX_PARSED_WRONG;
  return TRAX_PARSED_RUN;
}

void options_release(struct options *options) {
  for (size_t i = 0; i < options->setting_count; i++)
    free((char *)options->settings[i].key);
  free(options->settings);
  free((struct trax_material_override *)options->import.overrides);
}
