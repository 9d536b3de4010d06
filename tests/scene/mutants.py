#!/usr/bin/env python3
"""Breaks splits, reinsertion, textures and the reader of glTF, one line at a time, and says whether the tests notice.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there
"""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from mutation import ROOT, Mutant, failure, main, relinked  # noqa: E402

SOURCE = ROOT / "raytracer/scene"
TREES = ("scene-builder-test", "scene-scene-test", "scene-layout-test")
READERS = ("scene-material-test", "scene-import-test")
TESTS = {"bvh.c": TREES, "clip.c": TREES, "rank.c": TREES, "ply_values.c": READERS[1:],
         "ply_reader.c": READERS[1:], "../layouts/grid.c": TREES, "splits.c": TREES,
         "reinsert.c": TREES, "reinsert.h": TREES, "reinsert_search.c": TREES, "sah.c": TREES, "sah_spatial.c": TREES,
         "texture.c": READERS[:1], "placing.c": READERS,
         "gltf_reader.c": READERS,
         "gltf_materials.c": READERS[:1], "gltf_meshes.c": READERS, "gltf_nodes.c": READERS}
SECONDS = 30

# Name, file of raytracer/scene, text, what it becomes.
MUTANTS = [
    ("splits-of-duplicates", "splits.c", "    if (duplicates->first[i] != i)\n      continue;\n", ""),
    ("splits-of-lamps", "splits.c", "if (emits(mesh, &mesh->triangles[i]))\n      return false;",
     "if (false)\n      return false;"),
    ("splits-of-equals", "splits.c", "2 * of_few >= all", "2 * of_few >= 0"),
    ("splits-never", "splits.c", "#define BOXES_IN_VAIN 2", "#define BOXES_IN_VAIN 1000000"),
    ("splits-always", "splits.c", "#define BOXES_IN_VAIN 2", "#define BOXES_IN_VAIN 0"),
    ("splits-whole-box", "splits.c", "area -= fabs(", "area -= 0 * fabs("),
    ("duplicates-unseen", "bvh.c", "TRAX_OK && !duplicates.any;\n  scene", "TRAX_OK;\n  scene"),
    ("one-focus", "reinsert.h", "MOST_FOCI = 8", "MOST_FOCI = 1"),
    ("close-foci", "reinsert.c", "FOCUS_STEP = 4", "FOCUS_STEP = 2"),
    ("foci-of-few", "reinsert.c", "LEAST_OF_TRIANGLES = 16", "LEAST_OF_TRIANGLES = 2"),
    ("smaller-child", "reinsert.c", "b->triangles > a->triangles ? b : a", "b->triangles > a->triangles ? a : b"),
    ("focus-weight", "reinsert.c", "foci->scale[foci->count++] = 1 / area;", "foci->scale[foci->count++] = 1;"),
    ("short-search", "reinsert.h", "MOST_LOOKED_AT = 1000", "MOST_LOOKED_AT = 10"),
    ("stale-boxes", "reinsert.c", "    refit_from(improver, nodes[beside].parent);\n", ""),
    ("stale-visits", "reinsert.c", "    node->visits = visits_of(&improver->foci, &box);\n", ""),
    ("stale-above", "reinsert.c", "    refit_from(improver, nodes[parent].parent);\n", ""),
    ("clip-one-side", "clip.c", "(side ? da >= 0 : da <= 0)", "(side ? da >= 0 : da < 0)"),
    ("clip-inwards", "clip.c", "next_float((float)bounds->min[axis], false)",
     "next_float((float)bounds->min[axis], true)"),
    ("clip-no-cut", "clip.c", "        add_value(&sides[1], other, value);\n", ""),
    ("too-deep", "reinsert_search.c", "height <= search->links->max_depth", "height <= 64"),
    ("order-of-parts", "rank.c", "= ~records->keys[i] &", "= records->keys[i] &"),
    ("order-of-few", "rank.c", "insert(records, first, end);", "insert(records, first, first);"),
    ("order-of-many", "rank.c", "  scatter(&run, room, count, 2 * BITS);\n", ""),
    ("boxes-transposed", "reinsert_search.c", "links[i] = &nodes[queue[first + i].node]",
     "links[i] = &nodes[queue[first].node]"),
    ("digits-rounded-twice", "ply_values.c", "== 0x10000000)", "== 0x10000001)"),
    ("digits-of-power", "ply_values.c", "power = (int64_t)whole - (int64_t)count;",
     "power = (int64_t)whole - (int64_t)count - 1;"),
    ("plain-index", "ply_reader.c", "if (list[i] >= reader->vertex_count || ", "if ("),
    ("plain-big-endian", "ply_reader.c", "bool plain = reader->format == little_endian &&", "bool plain ="),
    ("cell-above", "../layouts/grid.c", "(float)(whole + (whole < place))", "(float)whole"),
    ("large-subtrees-unbounded", "bvh.c", "    bound_large(&all, 0);\n", ""),
    ("changes-unseen", "reinsert.c", "return any & 1;", "return false;"),
    ("stale-visits-above", "reinsert_search.c", "changed ? above->visits : node->visits", "node->visits"),
    ("leaves-unseen", "reinsert_search.c", "_mm_cmplt_pd(cost, all_limit)",
     "_mm_cmplt_pd(cost, _mm_mul_pd(_mm_set1_pd(0.9), all_limit))"),
    ("parts-uncertain", "sah_spatial.c", "0x1p-48 * largest", "0 * largest"),
    ("triangles-uncertain", "sah_spatial.c", "0x1p-46 *", "0 *"),
    ("budget-of-two", "sah_spatial.c", "prim->budget <= 1) {", "prim->budget <= 2) {"),
    ("overlap", "sah.c", "0.1f * sah_area", "0.11f * sah_area"),
    ("one-pass", "reinsert.c", "pass < passes && result", "pass < 1 && result"),
    ("texture-gamma", "texture.c", "(uint32_t)(255 * sqrtf(scene_clamp_colour(linear)) + 0.5f)",
     "(uint32_t)(255 * scene_clamp_colour(linear) + 0.5f)"),
    ("texture-linear", "texture.c", "value / 12.92 : base * base * fifth_root(base * base)",
     "value / 12.92 : base * base"),
    ("texture-upside-down", "texture.c", "(size_t)(height - 1 - y) * width + x", "(size_t)y * width + x"),
    ("texture-narrow", "texture.c", "*radius = scale > 1 ? scale : 1;", "*radius = 1;"),
    ("texture-edge", "texture.c", "tap >= axis->from ? axis->from - 1 : (uint32_t)tap",
     "tap >= axis->from ? 0 : (uint32_t)tap"),
    ("texture-begins-again", "texture.c", "rest < 0 ? rest + axis->from : rest", "rest < 0 ? 0 : rest"),
    ("texture-alpha-weight", "texture.c", "share * (alpha * linear[texel[channel]])", "share * linear[texel[channel]]"),
    ("texture-transparent", "texture.c", "sums[3] > 0 ? sums[channel] / sums[3] : sums[4 + channel] / total",
     "sums[channel] / sums[3]"),
    ("texture-nearest-side", "texture.c", "< 3 * (uint64_t)side", "< 4 * (uint64_t)side"),
    ("texture-mask", "texture.c", "const bool alpha = has_alpha(mask);", "const bool alpha = mask->rgba[3] < 255;"),
    ("texture-mean", "texture.c", "encoded ? linear[", "false ? linear["),
    ("gltf-view-length", "gltf_reader.c", "offset > bytes->size || length > bytes->size - offset",
     "offset > bytes->size"),
    ("gltf-accessor-end", "gltf_reader.c", "(count - 1) > (view.size - offset - element) / stride",
     "(count - 1) > (view.size - offset) / stride"),
    ("gltf-normalised", "gltf_reader.c", "if (accessor->normalised)", "if (0)"),
    ("gltf-base64", "gltf_reader.c", "if (bits >= 8)", "if (bits > 8)"),
    ("gltf-second-chunk", "gltf_reader.c", "number == 0 ? JSON : BIN", "JSON"),
    ("gltf-strip", "gltf_meshes.c", "triangle + 1 + odd, corners[2] = triangle + 2 - odd",
     "triangle + 1, corners[2] = triangle + 2"),
    ("gltf-index", "gltf_meshes.c", "if (index >= primitive->positions.count)", "if (index > 255)"),
    ("gltf-shared", "gltf_meshes.c", "shared ? first + index : mesh->vertex_count - 1", "first + index"),
    ("gltf-mirror", "gltf_meshes.c", "mirror = scene_determinant(placing->matrix) < 0", "mirror = false"),
    ("gltf-normal-side", "placing.c", "mirror ? -sum : sum", "sum"),
    ("gltf-v", "gltf_meshes.c", "(1 - uv[1])", "uv[1]"),
    ("gltf-order", "gltf_nodes.c", "scene_multiply(matrix, above, own);", "scene_multiply(matrix, own, above);"),
    ("gltf-quaternion", "gltf_nodes.c", "q[row] * q[next] - q[3] * q[last]", "q[row] * q[next] + q[3] * q[last]"),
    ("gltf-parents", "gltf_nodes.c", "if (nodes->parents[child])", "if (0)"),
    ("gltf-levels", "gltf_nodes.c", "if (levels > MOST_LEVELS)", "if (0)"),
    ("gltf-bomb", "gltf_nodes.c", " || bytes > scene_memory_for(gltf->bytes_read)", ""),
    ("gltf-nothing-bomb", "gltf_nodes.c", "size->primitives * BYTES_PER_PRIMITIVE", "0"),
    ("gltf-fov", "gltf_nodes.c", "fov * (180 / 3.14159265358979323846)", "fov * 90"),
    ("gltf-metal", "gltf_materials.c", "surface->diffuse[channel] *= 1 - metal;", ""),
    ("gltf-roughness", "gltf_materials.c", "surface->roughness = roughness * roughness;",
     "surface->roughness = roughness;"),
    ("gltf-cutoff", "gltf_materials.c", 'gltf_number(material, "alphaCutoff", 0.5)', "0.5"),
    ("gltf-clamp", "gltf_materials.c", "          ? TRAX_TEXTURE_CLAMP\n          : 0;",
     "          ? 0\n          : 0;"),
    ("gltf-turn", "gltf_materials.c", "{-s * scale[0], c * scale[1], offset[1]}",
     "{s * scale[0], c * scale[1], offset[1]}"),
]


def noticed(folder, build, mutant):
    """The first test that fails."""
    programs = relinked(folder, build, "raytracer/scene/CMakeFiles/traxscene.dir", (SOURCE / mutant.file).resolve(),
                        mutant.changed(SOURCE), TESTS[mutant.file])
    failures = (failure(SECONDS, program) for program in programs)
    return list(itertools.islice(filter(None, failures), 1))


if __name__ == "__main__":
    LIST = [Mutant(file, text, other, name) for name, file, text, other in MUTANTS]
    sys.exit(main(__doc__, SOURCE, LIST, noticed, unchanged=lambda mutant: mutant.file))
