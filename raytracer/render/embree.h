/* Declarations shared by embree*.c. Hits are Embree's, or found without error. */
#ifndef TRAX_RENDER_EMBREE_H
#define TRAX_RENDER_EMBREE_H

#include "exact.h"
#include "hits.h"
#include "layers.h"
#include "placed.h"
#include "render.h"

#include "../device/camera.h"

#include <pthread.h>

/* A triangle that shadow rays of paths may go to, and the power of those before it. */
struct embree_emitter {
  const struct trax_triangle *triangle;
  double before;
};

struct embree {
  RTCScene scene;
  const struct trax_frame *frame;
  struct trax_picture *picture;                   /* to fill, or else: */
  struct trax_hits *hits;                         /* of one ray a pixel, and nothing is shaded */
  bool exactly;                                   /* hits are those of exact.h, else Embree's own */
  struct exact_part *parts;                       /* of exact.h; from malloc */
  struct trax_light lights[TRAX_VIEW_MAX_LIGHTS]; /* those that shine */
  uint32_t light_count;
  struct embree_emitter *emitters; /* from malloc */
  uint32_t emitter_count;
  double power;     /* of all emitters: area times luminance */
  uint32_t choices; /* of a path's shadow ray: the lights, all emitters as one, and the environment */
  struct trax_render_run *run;
  pthread_mutex_t lock; /* of what follows */
  uint32_t next_row, finished_rows;
  uint64_t rays;
};

/* Builds the scene of the triangles, with vertices of their own each, so that primID is the triangle's number; with
   instances, that in its mesh, and instID[0] the instance's. */
trax_status embree_commit(RTCDevice device, RTCScene scene, const struct trax_scene *source, trax_error *error);

bool embree_hit(const struct embree *embree, struct double3 origin, struct double3 direction, struct exact_hit *hit);
bool embree_blocked(const struct embree *embree, struct double3 origin, struct double3 direction, double distance);

/* The distance from a triangle at which rays that leave it start, as in device/shade.h. The hit was found by a ray from
   `origin`, `sight` away. */
double embree_start_bound(const struct embree *embree, const struct placed_triangle *triangle, struct double3 origin,
                          struct double3 sight);
/* A point where rays start on the viewer's side. normal: towards the viewer, of unit length. */
struct double3 embree_start(const struct embree *embree, const struct placed_triangle *triangle, struct double3 point,
                            struct double3 normal, struct double3 origin);

static inline bool embree_needs(const struct embree *embree, enum trax_feature feature) {
  return embree->frame->params->features >> feature & 1;
}

/* embree_path.c: the light of one sample, linear, of a picture with one of TRAX_PATH_FEATURES. */
struct double3 embree_path(const struct embree *embree, struct pixel pixel, uint32_t sample, struct trax_layers *seen,
                           uint64_t *rays);

/* embree_light.c: light that arrives at a point. */
struct embree_arrival {
  struct double3 direction, target; /* towards the light; a directional light has no target */
  double distance;
  struct double3 irradiance; /* of a surface perpendicular to the direction */
};
/* False: out of memory. */
bool embree_prepare_lights(struct embree *embree);
/* Samples a point of a light by x and y; false: no light arrives. */
bool embree_light_at(const struct embree *embree, uint32_t number, struct double3 point, double x, double y,
                     struct embree_arrival *arrival);
/* The emitter at a part, from 0 to 1, of the cumulative power. */
const struct trax_triangle *embree_pick_emitter(const struct embree *embree, double part);
/* The density in solid angle with which a shadow ray goes to the point of a triangle at a distance in a direction. */
double embree_emitter_density(const struct embree *embree, const struct trax_triangle *triangle, double distance,
                              struct double3 direction);
/* The environment's light from a direction, and the density in solid angle with which shadow rays go there. */
struct double3 embree_environment(const struct embree *embree, struct double3 direction, double *density);
/* The direction of a shadow ray into the environment; pick chooses its texel, x and y the place in it. */
struct double3 embree_pick_environment(const struct embree *embree, uint32_t pick, double x, double y);
/* The light of a ray that hits nothing. density: with which the surface before chose the direction; 0: there was no
   choice. */
struct double3 embree_far_light(const struct embree *embree, struct double3 direction, double density);
/* Sets the direction to a point; returns its distance, 0 if it is too near to have one. */
double embree_towards(struct double3 point, struct double3 target, struct double3 *direction);
/* The triangle's unit normal on the side of v0, v1, v2 counterclockwise. */
struct double3 embree_winding_normal(const struct trax_triangle *triangle);

/* embree_material.c: what surfaces do with light, in the formulas of the publications. Directions are of unit length
   and lead away from the surface. */
struct embree_surface {
  struct double3 view, flat, normal; /* flat: the triangle's normal, towards the view; normal: the shading's */
  struct double3 diffuse, specular;
  double roughness;
  bool layered; /* GGX over Lambert; else Lambert */
};

struct double3 embree_unit(struct double3 v);
/* The BRDF times the cosine, and the density in solid angle with which embree_sample chooses `way`. */
struct double3 embree_evaluate(const struct embree_surface *surface, struct double3 way, double *density);
/* Samples a direction; x, y and choice are from 0 to 1. False if there is none. */
bool embree_sample(const struct embree_surface *surface, double x, double y, double choice, struct double3 *way);
/* Reflectance of a smooth boundary between indices n1 (the view's side) and n2; *cosine2: of the refracted ray. */
double embree_fresnel(double n1, double n2, double cosine1, double *cosine2);

#endif
