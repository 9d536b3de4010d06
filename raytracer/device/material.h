/* BRDFs, their sampling and their densities. All reflectances are pi times the BRDF, and all pdfs pi times those in
   solid angle, so that a white Lambert surface has the reflectance 1 and its pdf is the cosine. */
#ifndef TRAX_DEVICE_MATERIAL_H
#define TRAX_DEVICE_MATERIAL_H

#include "algebra.h"
#include "run.h"
#include "sampler.h"

#include <stdbool.h>

/* The point that is shaded. Directions have unit length and lead away from it. */
struct scatterer {
  struct vector view;   /* towards the origin of the ray */
  struct vector flat;   /* the triangle's normal, towards the view */
  struct vector normal; /* the shading normal */
  struct vector diffuse, specular;
  float roughness; /* of a GGX layer */
};

/* --- points of the disk --- */

/* sine and cosine of x * pi / 4, for x from -1 to 1: Taylor's polynomials, within 3e-7 and 4e-7. */
static inline float sine_of_eighth(float x) {
  float angle = 0.785398163f * x, square = angle * angle;
  return angle * (1 + square * (-0.166666667f + square * (0.00833333333f + square * -0.000198412698f)));
}

static inline float cosine_of_eighth(float x) {
  float angle = 0.785398163f * x, square = angle * angle;
  return 1 + square * (-0.5f + square * (0.0416666667f + square * (-0.00138888889f + square * 0.0000248015873f)));
}

/* Evenly over the unit disk: Shirley and Chiu, "A Low Distortion Map Between Disk and Square" (Journal of Graphics
   Tools 2(3), 1997). */
static inline struct place disk_point(struct place place) {
  float a = 2 * place.x - 1, b = 2 * place.y - 1;
  bool steep = magnitude(a) < magnitude(b);
  float radius = steep ? b : a, other = steep ? a : b;
  if (magnitude(radius) == 0)
    return (struct place){0, 0};
  float eighth = other / radius;
  float along = radius * cosine_of_eighth(eighth), across = radius * sine_of_eighth(eighth);
  return steep ? (struct place){across, along} : (struct place){along, across};
}

/* A cosine-distributed direction about n. */
static inline struct vector cosine_direction(struct vector n, struct place place) {
  struct place disk = disk_point(place);
  struct vector s, t;
  tangents(n, &s, &t);
  float height = root(1 - (disk.x * disk.x + disk.y * disk.y));
  return plus(plus(times(disk.x, s), times(disk.y, t)), times(height, n));
}

/* --- mirrors and glass --- */

static inline struct vector reflected(struct vector view, struct vector normal) {
  return minus(times(2 * dot(normal, view), normal), view);
}

/* Fresnel's reflectance of a dielectric for unpolarised light. cosine: on this side; ratio: of this side's index of
   refraction to the other's; *transmitted: the cosine on the other side. 1: total reflection. */
static inline float fresnel(float cosine, float ratio, float *transmitted) {
  float square = 1 - ratio * ratio * (1 - cosine * cosine);
  *transmitted = 0;
  if (float_bits(square) <= 0)
    return 1;
  float other = root(square);
  *transmitted = other;
  /* At least one cosine is positive. With index 1, a grazing ray is reflected completely. */
  float across_sum = at_least(ratio * cosine + other, 0x1p-40f), along_sum = at_least(cosine + ratio * other, 0x1p-40f);
  float across = (ratio * cosine - other) / across_sum, along = (cosine - ratio * other) / along_sum;
  return 0.5f * (across * across + along * along);
}

/* The mirrored direction, about the shading normal unless that leads into the surface. */
static inline struct vector mirror_direction(const struct scatterer *at) {
  struct vector way = reflected(at->view, at->normal);
  return float_bits(dot(at->flat, way)) > 0 ? way : reflected(at->view, at->flat);
}

/* Reflects if choice, from 0 to 1, is below Fresnel's reflectance, else refracts. ratio: of the index of refraction on
   the view's side to the other's. */
static inline struct vector glass_direction(const struct scatterer *at, float ratio, float choice, bool *through) {
  struct vector normal = at->normal;
  float cosine = dot(normal, at->view);
  for (bool last = false;; last = true) {
    float other;
    *through = choice >= fresnel(cosine, ratio, &other);
    struct vector way =
        *through ? minus(times(ratio * cosine - other, normal), times(ratio, at->view)) : reflected(at->view, normal);
    float side = dot(at->flat, way);
    bool right = *through ? float_bits(side) < 0 : float_bits(side) > 0;
    if (right || last)
      return unit(way);
    normal = at->flat;
    cosine = dot(normal, at->view);
  }
}

/* --- GGX: Walter and others, "Microfacet Models for Refraction through Rough Surfaces" (EGSR 2007); masking with
   correlated heights, Heitz, "Understanding the Masking-Shadowing Function" (JCGT 3(2), 2014); Fresnel's equations by
   Schlick's approximation. Light that the layer does not reflect reaches the Lambert surface below, on the way in and
   out. */

/* (1 - cosine)^5 */
static inline float schlick_weight(float cosine) {
  float rest = at_least(1 - cosine, 0x1p-24f), square = rest * rest;
  return square * square * rest;
}

static inline struct vector schlick(struct vector specular, float weight) {
  return (struct vector){specular.x + weight * (1 - specular.x), specular.y + weight * (1 - specular.y),
                         specular.z + weight * (1 - specular.z)};
}

static inline struct vector rest_of(struct vector part) {
  return (struct vector){1 - part.x, 1 - part.y, 1 - part.z};
}

/* Smith's: sqrt(cosine^2 + a^2 sine^2). */
static inline float smith(float cosine, float square_roughness) {
  return root(square_roughness + (1 - square_roughness) * cosine * cosine);
}

/* pi times the GGX distribution of normals at `half`, without the cancellation of 1 - cosine^2. */
static inline float facets(struct vector normal, struct vector half, float square_roughness) {
  float cosine = dot(normal, half);
  struct vector sine = cross(normal, half);
  float shape = cosine * cosine * square_roughness + dot(sine, sine);
  return square_roughness / (shape * shape);
}

#define LEAST_COSINE 0x1p-10f

/* The probability with which the layer is sampled, rather than the surface below. */
static inline float layer_share(const struct scatterer *at) {
  float cosine = at_least(dot(at->normal, at->view), LEAST_COSINE);
  float layer = bits_float(greatest_bits(schlick(at->specular, schlick_weight(cosine))));
  float below = bits_float(greatest_bits(at->diffuse));
  float share = layer / at_least(layer + below, 0x1p-20f);
  return float_bits(below) == 0 ? 1 : at_most(at_least(share, 0.125f), 0.875f);
}

/* pi times the BRDF for light from `way`, and pi times the pdf of that direction in scatter(). cosine: of the way,
   positive. */
static inline struct vector layered_reflectance(const struct scatterer *at, struct vector way, float cosine,
                                                float *pdf) {
  float view = at_least(dot(at->normal, at->view), LEAST_COSINE);
  float square = at->roughness * at->roughness;
  struct vector sum = plus(at->view, way);
  float length = dot(sum, sum);
  struct vector half = float_bits(length) < float_bits(0x1p-40f) ? at->normal : times(trax_rsqrt(length), sum);
  float d = facets(at->normal, half, square), smith_view = smith(view, square);
  float masked = 0.5f / (cosine * smith_view + view * smith(cosine, square));
  struct vector mirrored = schlick(at->specular, schlick_weight(at_least(dot(half, at->view), 0x1p-24f)));
  struct vector below = filtered(rest_of(schlick(at->specular, schlick_weight(view))),
                                 rest_of(schlick(at->specular, schlick_weight(cosine))));
  float share = layer_share(at);
  *pdf = share * (d * 0.5f / (view + smith_view)) + (1 - share) * cosine;
  return plus(times(d * masked, mirrored), filtered(at->diffuse, below));
}

/* Samples the distribution of visible normals: Heitz, "Sampling the GGX Distribution of Visible Normals" (JCGT 7(4),
   2018). */
static inline struct vector visible_facet(const struct scatterer *at, struct place place) {
  struct vector s, t;
  tangents(at->normal, &s, &t);
  float a = at->roughness;
  struct vector stretched = unit(
      (struct vector){a * dot(at->view, s), a * dot(at->view, t), at_least(dot(at->view, at->normal), LEAST_COSINE)});
  float square = stretched.x * stretched.x + stretched.y * stretched.y;
  struct vector first = {1, 0, 0};
  if (float_bits(square) >= float_bits(0x1p-40f)) {
    float inverse = trax_rsqrt(square);
    first = (struct vector){-stretched.y * inverse, stretched.x * inverse, 0};
  }
  struct vector second = cross(stretched, first);
  struct place disk = disk_point(place);
  float squeeze = 0.5f * (1 + stretched.z);
  float y = (1 - squeeze) * root(1 - disk.x * disk.x) + squeeze * disk.y;
  float z = root(1 - disk.x * disk.x - y * y);
  struct vector facet = plus(plus(times(disk.x, first), times(y, second)), times(z, stretched));
  struct vector half = {a * facet.x, a * facet.y, at_least(facet.z, 0x1p-20f)};
  half = unit(half);
  return plus(plus(times(half.x, s), times(half.y, t)), times(half.z, at->normal));
}

/* --- a layer, or Lambert's law alone --- */

/* pi times the BRDF for light from `way`, whose cosine is positive; *pdf: pi times that of scatter(). */
static inline struct vector reflectance(const struct scatterer *at, bool layered, struct vector way, float cosine,
                                        float *pdf) {
  if (layered)
    return layered_reflectance(at, way, cosine, pdf);
  *pdf = cosine;
  return at->diffuse;
}

/* Samples a direction of incident light; choice is from 0 to 1. Returns BRDF times cosine divided by the pdf; *pdf is
   pi times the pdf. {0, 0, 0} if there is no direction. */
static inline struct vector scatter(const struct scatterer *at, bool layered, struct place place, float choice,
                                    struct vector *way, float *pdf) {
  if (layered && choice < layer_share(at))
    *way = unit(reflected(at->view, visible_facet(at, place)));
  else
    *way = cosine_direction(at->normal, place);
  float cosine = dot(at->normal, *way);
  *pdf = 0;
  if (float_bits(cosine) < float_bits(LEAST_COSINE * LEAST_COSINE) || float_bits(dot(at->flat, *way)) <= 0)
    return (struct vector){0, 0, 0};
  if (!layered) {
    *pdf = cosine;
    return at->diffuse;
  }
  struct vector part = layered_reflectance(at, *way, cosine, pdf);
  return times(cosine / at_least(*pdf, 0x1p-40f), part);
}

#endif
