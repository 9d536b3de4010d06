/* Small meshes made on the spot, and the pictures that tests take of them. */
#ifndef TRAX_TEST_MESHES_H
#define TRAX_TEST_MESHES_H

#include "render.h"

/* Everything that is added belongs to the mesh; release with trax_mesh_release. Out of memory ends the test. */
uint32_t mesh_vertex(struct trax_mesh *mesh, float x, float y, float z);
void mesh_triangle(struct trax_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t material);
uint32_t mesh_material(struct trax_mesh *mesh, float red, float green, float blue);

void mesh_quad(struct trax_mesh *mesh, const float corners[4][3], uint32_t material);
/* Twelve triangles that share eight vertices. */
void mesh_box(struct trax_mesh *mesh, const float low[3], const float high[3], uint32_t material);
/* A closed surface about the origin of 8 * 4^levels triangles with shared vertices, counterclockwise from outside. */
void mesh_sphere(struct trax_mesh *mesh, float radius, unsigned levels, uint32_t material);
/* count triangles of random places and sizes within [-1, 1]^3. */
void mesh_soup(struct trax_mesh *mesh, unsigned count, uint32_t seed);
void mesh_transform(struct trax_mesh *mesh, float scale, float x, float y, float z);

/* Uniform in [0, 1). */
float random_unit(uint32_t *state);

/* A view along a direction, not necessarily of unit length. */
struct trax_view view_from(float ex, float ey, float ez, float dx, float dy, float dz, float fov, float lx, float ly,
                           float lz);

/* A BVH as deep as there may be: a chain of TRAX_SCENE_MAX_DEPTH inner nodes over parallel triangles, the nearer
   ones deeper for a ray along -z. */
void chain_scene(struct trax_scene *scene);

void build(struct trax_scene *scene, const struct trax_mesh *mesh, const struct trax_build_options *options);
/* Builds the scene of a mesh, which is released. */
struct trax_scene scene_of(struct trax_mesh *mesh, const struct trax_build_options *options);
/* Returns the exponent. */
int normalise(struct trax_scene *scene, struct trax_view *view);
struct trax_picture take(const struct trax_scene *scene, const struct trax_view *view, uint32_t width, uint32_t height,
                         bool reference, unsigned threads);
unsigned background_pixels(const struct trax_picture *picture);

#endif
