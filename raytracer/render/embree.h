/* What embree*.c share: how it finds hits, as Embree does or without error. */
#ifndef TRAX_RENDER_REFERENCE_H
#define TRAX_RENDER_REFERENCE_H

#include "exact.h"
#include "hits.h"
#include "render.h"

#include "../device/camera.h"

#include <pthread.h>

struct embree {
  RTCScene scene;
  const struct trax_frame *frame;
  struct trax_picture *picture; /* to fill, or else one of the next two */
  struct trax_exact *exact;
  struct trax_hits *hits; /* of one ray a pixel, and nothing is shaded */
  bool exactly;           /* hits are those of exact.h, else Embree's own */
  struct trax_render_run *run;
  pthread_mutex_t lock; /* of what follows */
  uint32_t next_row, finished_rows;
  uint64_t rays;
};

/* Builds the scene of the triangles, with vertices of their own each, so that primID is the triangle's number. */
trax_status embree_commit(RTCDevice device, RTCScene scene, const struct trax_scene *source, trax_error *error);

bool embree_hit(const struct embree *embree, struct double3 origin, struct double3 direction, struct exact_hit *hit);
bool embree_blocked(const struct embree *embree, struct double3 origin, struct double3 direction, double distance);

static inline bool embree_needs(const struct embree *embree, enum trax_feature feature) {
  return embree->frame->params->features >> feature & 1;
}

/* embree_path.c: the light of one sample, linear, of a picture with one of TRAX_PATH_FEATURES. */
struct double3 embree_path(const struct embree *embree, struct pixel pixel, uint32_t sample,
                           struct trax_exact_sample *seen, uint64_t *rays);

/* Of a ray from the eye: the nearest hit that is no hole. */
bool embree_seen(const struct embree *embree, struct double3 eye, struct double3 direction, struct exact_hit *hit);

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
/* A direction; x, y and choice are from 0 to 1. False: none. */
bool embree_sample(const struct embree_surface *surface, double x, double y, double choice, struct double3 *way);
/* Reflectance of a smooth boundary between indices n1 (the view's side) and n2; *cosine2: of the refracted ray. */
double embree_fresnel(double n1, double n2, double cosine1, double *cosine2);

#endif
