/* Rays that come from a file, and what the emulated program finds that they hit: trax-render --rays. */
#ifndef TRAX_RENDER_RAYS_H
#define TRAX_RENDER_RAYS_H

#include "ray_file.h"
#include "render.h"
#include "trax/ray_input.h"

struct trax_rays {
  struct trax_ray_file_header header;
  struct trax_ray_record *records; /* of the file, in its order */
  uint32_t *order;                 /* the program's ray i is this record */
  struct trax_ray_hit *hits;       /* of the program's rays, after the run */
  uint32_t count;
};

/* Reads a binary file of rays. Errors name the file and the ray, from 1: a cut file, coordinates that are not finite, a
   direction whose largest component is not within 2^-2 and 2^10, an interval that is empty or does not begin at 0, a
   kind that does not exist, no rays. */
trax_status trax_rays_read(struct trax_rays *rays, const char *path, trax_error *error);
void trax_rays_release(struct trax_rays *rays);

/* The frame whose slots are the rays. It scales the scene as that of the rays was. Errors: coordinates that this scene
   cannot have. */
trax_status trax_rays_frame(struct trax_frame *frame, struct trax_scene *scene, const struct trax_rays *rays,
                            trax_error *error);

/* rays_order.c. FOUND: as in the file. MORTON: by the cell of the origin on a grid of 32 cells along each axis, then by
   the signs of the direction, then by the place in the cell; cells along Morton's curve. TREELET: by the first treelet
   that the ray enters, going down to the nearer child; a treelet is a subtree of at most treelet_bytes with its
   triangles. Then as MORTON. RANDOM: shuffled, always alike. */
enum trax_ray_order { TRAX_RAYS_FOUND, TRAX_RAYS_MORTON, TRAX_RAYS_TREELET, TRAX_RAYS_RANDOM };
trax_status trax_rays_order(struct trax_rays *rays, enum trax_ray_order order, const struct trax_scene *scene,
                            uint32_t treelet_bytes, trax_error *error);

/* Binds the buffers `rays` and `hits` of the loaded program. */
trax_status trax_rays_bind(trax_machine *machine, const struct trax_rays *rays, trax_error *error);
/* Takes the hits after the run. */
trax_status trax_rays_take(struct trax_rays *rays, trax_machine *machine, trax_error *error);

/* Counts the rays that have another result than in the file, and finds the first. Of shadow and occlusion rays only
   `hit` is compared, of others every bit. */
uint32_t trax_rays_unequal(const struct trax_rays *rays, const struct trax_scene *scene, uint32_t *first);
/* Writes the file's rays with the run's results. */
trax_status trax_rays_write(const struct trax_rays *rays, const struct trax_scene *scene, const char *path,
                            trax_error *error);

#endif
