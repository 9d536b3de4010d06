/* Makes the sections of a scene file from a mesh and its tree. */
#ifndef TRAX_SCENE_LAYOUT_H
#define TRAX_SCENE_LAYOUT_H

#include "internal.h"

enum { SCENE_CACHE_LINES = 256 }; /* 16 kB of 64-byte lines, the paper's TM: where no chip is known */

struct layout {
  const struct trax_mesh *mesh;
  const struct scene_tree *tree;
  const uint32_t *materials;     /* of the mesh to the file's */
  const uint32_t *positions;     /* of the tree's inner nodes in the file */
  const struct scene_wide *wide; /* NULL: nodes are the tree's */
  enum trax_node_layout node_layout;
  struct trax_scene_grid grid;
  /* the file's sections */
  unsigned char *bytes;
  unsigned char *nodes; /* those of this tree */
  struct trax_triangle *triangles;
  struct trax_triangle_normals *normals; /* NULL: left out */
  struct trax_triangle_uvs *uvs;         /* NULL: left out */
  uint32_t *source_ids;                  /* NULL: left out */
  bool file_normals;                     /* those of the mesh, where it has some */
  uint32_t nodes_offset, triangles_offset;
  uint32_t next_triangle;
  bool has_triangles; /* all are in their places already */
  uint32_t *numbers;  /* in the mesh, of the file's triangles; NULL: nothing needs them */
};

/* The file has the materials in use, each once, and their textures. */
struct palette {
  uint32_t *of_mesh; /* for each material of the mesh its number in the file */
  struct trax_material *materials;
  uint32_t *textures; /* of the file: the mesh's numbers */
  uint32_t count, texture_count;
  uint64_t texel_count;
};

/* --- palette.c --- */

trax_status scene_make_palette(struct palette *palette, const struct trax_mesh *mesh, bool textures, trax_error *error);
void scene_palette_release(struct palette *palette);
/* Plans their sections, and all behind them. */
trax_status scene_plan_materials(struct trax_scene_section *sections, uint64_t *end, const struct palette *palette,
                                 uint32_t source_ids, trax_error *error);
void scene_copy_materials(unsigned char *bytes, const struct trax_scene_section *sections,
                          const struct palette *palette, const struct trax_mesh *mesh);

/* --- place_tree.c --- */

/* Places the triangles of a tree whose nodes are binary, which needs no positions of nodes. */
void scene_place_triangles(struct layout *layout);
/* Places a subtree depth first; returns its reference, and its stored box. */
trax_scene_ref scene_place_subtree(struct layout *layout, uint32_t index, struct scene_box *box);
/* Places a wide node and what is below it. */
trax_scene_ref scene_place_wide_node(struct layout *layout, uint32_t number, struct scene_box *box);

/* --- layout.c --- */

/* Appends a section at *end; a section without records stays absent. */
void scene_plan_section(struct trax_scene_section *section, uint64_t *end, uint32_t count, size_t record_size);
void *scene_section_bytes(unsigned char *bytes, const struct trax_scene_section *section);
double scene_crease_cosine(const struct trax_build_options *options);

#endif
