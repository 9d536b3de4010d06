#include "trax_scene.h"

#include "trax/scene_options.h"

#include <math.h>
#include <stdlib.h>

static trax_status take_cost(void *target, const trax_option *option, const char *value, trax_error *error) {
  char *end;
  const float number = strtof(value, &end);
  if (end == value || *end || !(number > 0) || !isfinite(number))
    return trax_option_refuse(option, value, error, "is not a positive number");
  *(float *)((char *)target + option->offset) = number;
  return TRAX_OK;
}

static trax_status take_crease(void *target, const trax_option *option, const char *value, trax_error *error) {
  char *end;
  const float number = strtof(value, &end);
  if (end == value || *end || !(number > 0) || number > 180)
    return trax_option_refuse(option, value, error, "is not an angle above 0 and up to 180 degrees");
  *(float *)((char *)target + option->offset) = number;
  return TRAX_OK;
}

#define FIELD(member) TRAX_OPTION_FIELD(struct arguments, member)
#define PARSED(function, member) .parse = (function), .offset = offsetof(struct arguments, member)
#define NUMBER(member, least_, most_) FIELD(member), .least = (least_), .most = (most_)
#define OUTPUT(member) FIELD(member), .file = TRAX_OPTION_OUTPUT

/* The numbers in the table's texts. */
_Static_assert(1 << TRAX_TEXTURE_MAX_LOG2 == 4096 && TRAX_SCENE_MAX_LEAF == 7 && TRAX_SCENE_MAX_DEPTH == 62, "");
_Static_assert(TRAX_DEFAULT_CREASE == 60 && TRAX_DEFAULT_PASSES == 2 && TRAX_SCENE_MAX_PASSES == 16, "");

/* clang-format off */
static const trax_option rows[] = {
    TRAX_OPTION_GROUP("Files"),
    {"output", 'o', .argument = "SCENE", OUTPUT(output),
     .meaning = "where to write; an existing file is replaced at once or stays as it is"},
    {"check", .argument = "SCENE", FIELD(check), .file = TRAX_OPTION_INPUT,
     .meaning = "check a scene file completely, and import nothing"},
    {"stats", FIELD(stats), .meaning = "print what was read and built"},
    {"stats-json", .argument = "FILE", OUTPUT(stats_json), .meaning = "write the same as JSON"},
    {"list-files", .argument = "FILE", OUTPUT(list_files),
     .meaning = "write hash and name of every file that was read, as xxhsum -H2 does; - for a missing one"},
    TRAX_OPTION_GROUP("Meshes"),
    {"material", .argument = "[NAME=]KIND", PARSED(trax_take_material, import), .words = trax_put_material_kinds,
     .meaning = "give the material NAME, or all, this kind: lambert, mirror[:R,G,B], glass[:IOR],\n"
                "ggx:ROUGHNESS[:R,G,B] or emit:R,G,B (repeatable)"},
    {"diffuse", .argument = "[NAME=]R,G,B", PARSED(trax_take_diffuse, import),
     .meaning = "give the material NAME, or all, this linear colour, 0 to 1 (repeatable)"},
    {"no-textures", FIELD(import.no_textures), .meaning = "read no images; colours remain"},
    {"texture-size", .argument = "N", PARSED(trax_take_texture_size, import.texture_size),
     .meaning = "at most N texels a side, a power of two (default 4096)"},
    {"unpack-limit", .argument = "SIZE", PARSED(trax_take_unpack_limit, import.unpack_limit),
     .meaning = "most bytes of a packed file or a pipe, unpacked; K, M and G are powers of 1024 (default 1G)"},
    {"at", .argument = "X", PARSED(trax_take_at, import),
     .meaning = "take the meshes of a moment: frame X of a name with %d or %04d, second X of glTF's animation"},
    {"animation", .argument = "NAME", FIELD(import.animation), .meaning = "glTF's animation of this name instead of the first"},
    {"instances", FIELD(import.instances),
     .meaning = "keep a mesh of several glTF nodes once, and place it; files of instances are always kept so"},
    {"flatten", FIELD(import.flatten), .meaning = "give every instance triangles of its own"},
    {"drop-nonfinite", FIELD(import.drop_nonfinite),
     .meaning = "leave triangles with NaN or infinite vertices out instead of refusing the mesh"},
    {"keep-degenerate", .instead = "no ray hits triangles of zero area"},
    {"allow-empty", .instead = "a mesh without triangles is an error"},
    TRAX_OPTION_GROUP("Tree"),
    {"nodes", .argument = "KIND", PARSED(trax_take_nodes, nodes), .choices = trax_node_words,
     .meaning = "binary: two boxes a line of memory; quantised: four, on a grid of 2^16 planes an axis;\n"
                "wide4, wide4-quantised: up to four children; wide8: up to eight, with planes of 8 bits;\n"
                "auto (default): quantised, if the grid is fine enough for each large part of the tree, else binary"},
    {"leaf", .argument = "N", NUMBER(build.max_leaf, 1, TRAX_SCENE_MAX_LEAF),
     .meaning = "at most N triangles in a leaf, 1 to 7"},
    {"splits", .argument = "[=FACTOR]", PARSED(trax_take_splits, splits),
     .meaning = "split large triangles over several leaves: memory for FACTOR times the triangles,\n"
                "1 (none) to 8, 1.5 without FACTOR; =auto (default): that, if many are oblique"},
    {"passes", .argument = "N", NUMBER(build.passes, 0, TRAX_SCENE_MAX_PASSES),
     .meaning = "improve the tree after it was built by N passes that move its parts, 0 to 16\n"
                "(default 2)"},
    {"depth", .argument = "N", NUMBER(build.max_depth, 1, TRAX_SCENE_MAX_DEPTH),
     .meaning = "at most N nodes from the root to a leaf, 1 to 62"},
    {"traversal-cost", .argument = "X", PARSED(take_cost, build.traversal_cost),
     .meaning = "cost of a node in the surface-area heuristic, relative to a triangle's"},
    {"intersection-cost", .argument = "X", .instead = "--traversal-cost is relative to it"},
    {"cache-lines", .argument = "N", NUMBER(build.cache_lines, 1, 4096),
     .meaning = "order nodes for a direct-mapped cache of N lines, 1 to 4096; 1: depth first"},
    {"no-source-ids", .instead = "every scene file has the triangles' numbers in the mesh"},
    TRAX_OPTION_GROUP("Another builder's tree"),
    {"tree", .argument = "FILE.npy", FIELD(build.tree_nodes), .file = TRAX_OPTION_INPUT,
     .meaning = "nodes of a tree to use instead of building one: rows of left, right, count"},
    {"tree-triangles", .argument = "FILE.npy", FIELD(build.tree_triangles), .file = TRAX_OPTION_INPUT,
     .meaning = "triangles of this tree's leaves"},
    {"tree-boxes", .argument = "FILE.npy", FIELD(build.tree_boxes), .file = TRAX_OPTION_INPUT,
     .meaning = "boxes of this tree's nodes, for triangles that stand in several leaves"},
    {"refit", .argument = "SCENE", FIELD(refit), .file = TRAX_OPTION_INPUT,
     .meaning = "refit the tree of a scene file whose mesh has moved since, instead of building one:\n"
                "boxes are new; layout and order of nodes stay"},
    {"refit-from", .argument = "X", PARSED(trax_take_at, base),
     .meaning = "refit the tree of another moment, as --at names it, which is built first"},
    {"write-triangles", .argument = "FILE.npy", OUTPUT(write_triangles),
     .meaning = "write the meshes' triangles as such a tree numbers them; needs no -o"},
    TRAX_OPTION_GROUP("Normals"),
    {"smooth", FIELD(build.smooth), .meaning = "the same as --normals file: normals for smooth shading"},
    {"normals", .argument = "WHICH", PARSED(trax_take_normals, build), .choices = trax_normals_words,
     .meaning = "file: the mesh's own, computed where it has none; smooth: computed; flat: none"},
    {"crease", .argument = "DEGREES", PARSED(take_crease, build.crease_degrees),
     .meaning = "edges sharper than this stay edges, up to 180 (default 60)"},
    TRAX_OPTION_GROUP("Other"),
    {"quiet", 'q', FIELD(quiet), .meaning = "no progress and no notes"},
    TRAX_OPTION_HELP('h'),
    TRAX_OPTION_VERSION,
    {0}};
/* clang-format on */

const trax_command scene_command = {
    .name = "trax-scene",
    .synopsis = "[options] MESH... -o SCENE\n--check SCENE [--stats] [--stats-json FILE]",
    .description = "Imports meshes (PLY, OBJ with MTL, glTF, GLB, instances, also as .xz or .gz), merges them, "
                   "builds\n"
                   "the BVH and writes a scene file. The mesh generate:forest[:SEED] is made by the program itself.",
    .rows = rows,
    .examples = "trax-scene room.glb -o room.trax                  # a scene file for trax-render\n"
                "trax-scene bunny.ply.xz --smooth --stats -o bunny.trax\n"
                "trax-scene --check room.trax --stats              # is the file whole?",
    .column = 31};

trax_parsed arguments_parse(struct arguments *arguments, int argc, char **argv, trax_error *error) {
  *arguments = (struct arguments){.build = {.passes = TRAX_DEFAULT_PASSES}};
  const trax_parsed parsed = trax_command_parse(&scene_command, arguments, &argc, argv, error);
  if (parsed != TRAX_PARSED_RUN)
    return parsed;
  trax_node_layout_choose(arguments->nodes ? arguments->nodes : "auto", &arguments->build);
  trax_splits_choose(arguments->splits ? arguments->splits : "auto", &arguments->build);
  arguments->meshes = argv;
  arguments->mesh_count = (size_t)argc;
  if (arguments->check && (arguments->mesh_count || arguments->output))
    trax_fail(error, "--check takes neither meshes nor an output");
  else if (arguments->build.crease_degrees > 0 && !arguments->build.smooth)
    trax_fail(error, "--crease without --smooth or --normals");
  else if (!arguments->check && !arguments->mesh_count)
    trax_fail(error, "no mesh; try --help");
  else if (arguments->check && (arguments->build.tree_nodes || arguments->write_triangles))
    trax_fail(error, "--check takes neither --tree nor --write-triangles");
  else if (!arguments->build.tree_nodes != !arguments->build.tree_triangles)
    trax_fail(error, "--tree and --tree-triangles need each other");
  else if (arguments->build.tree_boxes && !arguments->build.tree_nodes)
    trax_fail(error, "--tree-boxes without --tree");
  else if (arguments->build.tree_nodes &&
           (arguments->build.max_leaf || arguments->splits || arguments->build.passes != TRAX_DEFAULT_PASSES ||
            arguments->build.traversal_cost > 0))
    trax_fail(error, "--tree is a tree that is built: --leaf, --splits, --passes and --traversal-cost are for "
                     "trax-scene's builder");
  else if (arguments->base.moves && (arguments->refit || !arguments->import.moves))
    trax_fail(error, "--refit-from needs --at, and excludes --refit");
  else if (arguments->import.animation && !arguments->import.moves)
    trax_fail(error, "--animation without --at");
  else if (arguments->base.moves && (arguments->splits || arguments->build.tree_nodes))
    trax_fail(error, "--refit-from builds a tree without splits: --splits and --tree are not for it");
  else if (arguments->refit &&
           (arguments->build.max_leaf || arguments->splits || arguments->build.passes != TRAX_DEFAULT_PASSES ||
            arguments->build.traversal_cost > 0 || arguments->build.tree_nodes || arguments->build.max_depth ||
            arguments->build.cache_lines || arguments->check))
    trax_fail(error, "--refit keeps a tree that is built: --leaf, --splits, --passes, --traversal-cost, --depth, "
                     "--cache-lines, --tree and --check are not for it");
  else if (!arguments->check && !arguments->output &&
           (!arguments->write_triangles || arguments->stats || arguments->stats_json))
    trax_fail(error, "no output; give one with -o");
  else
    return TRAX_PARSED_RUN;
  return TRAX_PARSED_WRONG;
}
