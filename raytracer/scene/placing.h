/* Instances on the host: what follows from a transform, and where an instance is. */
#ifndef TRAX_SCENE_PLACING_H
#define TRAX_SCENE_PLACING_H

#include "internal.h"

extern const double scene_identity[3][4];

/* Derives all members but stretch from to_world and origin. Returns NULL, or why the instance is impossible. */
const char *scene_derive_instance(struct trax_instance *instance);

/* Sets to_world and origin, and derives the others. Returns NULL, or why the instance is impossible. */
const char *scene_place_instance(struct trax_instance *instance, const double transform[3][4]);

/* The box of a mesh's triangles from number `first` on, without those that have a coordinate which is too large. */
struct scene_box scene_part_box(const struct trax_mesh *mesh, uint32_t first, uint32_t count);

/* Why triangles in the box cannot be placed so; NULL: they can. */
const char *scene_misplaced(const struct scene_box *box, const double transform[3][4]);

/* The stretch of an instance in a scene with these bounds. */
float scene_stretch_of(const struct trax_instance *instance, const struct scene_box *bounds);

/* The box of an instance, as the tree over instances has it: around the boxes of the mesh's nodes a few levels below
   its root. */
struct scene_box scene_instance_box(const struct trax_scene *scene, const struct trax_instance *instance);

/* Refuses lamps at more than one place or at none, and lamps that are moved: shadow rays go to the triangles as they
 * are stored.
 */
trax_status scene_check_lamps(const struct trax_scene *scene, const char *name, trax_error *error);

/* out = a b, of the first three rows of matrices. */
void scene_multiply(double out[3][4], const double a[3][4], const double b[3][4]);

/* The determinant of the first three columns. */
double scene_determinant(const double m[3][4]);

/* Transforms a normal, whose length may change: by the cofactors of the matrix, which are the inverse's transpose but
   for the length. */
void scene_place_normal(float out[3], const float n[3], const double m[3][4]);

/* placing.c: gives every instance triangles of its own. */
trax_status scene_flatten_mesh(struct trax_mesh *mesh, trax_error *error);

/* two_levels.c: the scene of a mesh with instances. */
trax_status scene_build_two_levels(struct trax_scene *scene, const struct trax_mesh *mesh,
                                   const struct trax_build_options *options, trax_error *error);

/* mesh.c: reads one file, and appends a mesh to another, whose arrays are released. */
trax_status scene_append_mesh(struct trax_mesh *mesh, struct trax_mesh *part, uint32_t first_source_id,
                              uint32_t part_sources, const char *path, trax_error *error);

/* Removes instances of parts without triangles, these parts, and those that no instance places. */
trax_status scene_drop_parts(struct trax_mesh *mesh, trax_error *error);

/* material.c: sets a material by what --material or --diffuse takes, without a name; false: it is neither. */
bool scene_set_material(struct trax_material *surface, const char *what);

/* instances_reader.c */
trax_status scene_read_instances(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                                 struct trax_import_report *report, trax_error *error);

#endif
