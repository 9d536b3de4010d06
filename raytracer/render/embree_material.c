/* Materials in binary64, for Embree's pictures: written from the publications, apart from raytracer/device. */
#include "embree.h"

#define PI 3.14159265358979323846

struct double3 embree_unit(struct double3 v) {
  const double length = sqrt(dot(v, v));
  return (struct double3){v.x / length, v.y / length, v.z / length};
}

static struct double3 combine(double a, struct double3 s, double b, struct double3 t, double c, struct double3 n) {
  return (struct double3){a * s.x + b * t.x + c * n.x, a * s.y + b * t.y + c * n.y, a * s.z + b * t.z + c * n.z};
}

static double largest_of(struct double3 v) {
  return fmax(v.x, fmax(v.y, v.z));
}

/* The tangents of the device program (Duff and others 2017), so that its points of the disk give the same directions.
 */
static void basis(struct double3 n, struct double3 *s, struct double3 *t) {
  const double sign = copysign(1, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  *s = (struct double3){1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  *t = (struct double3){b, sign + n.y * n.y * a, -n.y};
}

/* Shirley and Chiu 1997, in polar coordinates. */
static void disk(double x, double y, double *a, double *b) {
  const double u = 2 * x - 1, v = 2 * y - 1;
  double radius = u, angle = 0;
  if (fabs(u) >= fabs(v))
    angle = u != 0 ? PI / 4 * (v / u) : 0;
  else
    radius = v, angle = PI / 2 - PI / 4 * (u / v);
  *a = radius * cos(angle);
  *b = radius * sin(angle);
}

double embree_fresnel(double n1, double n2, double cosine1, double *cosine2) {
  const double sine2 = n1 / n2 * sqrt(fmax(0, 1 - cosine1 * cosine1));
  *cosine2 = 0;
  if (sine2 >= 1)
    return 1;
  *cosine2 = sqrt(1 - sine2 * sine2);
  const double s = (n1 * cosine1 - n2 * *cosine2) / (n1 * cosine1 + n2 * *cosine2);
  const double p = (n2 * cosine1 - n1 * *cosine2) / (n2 * cosine1 + n1 * *cosine2);
  return (s * s + p * p) / 2;
}

/* --- GGX --- */

/* Walter and others 2007, equation 33. */
static double distribution(double alpha, double cosine) {
  const double square = cosine * cosine, tangent = (1 - square) / square;
  const double sum = alpha * alpha + tangent;
  return alpha * alpha / (PI * square * square * sum * sum);
}

/* Heitz 2014, equation 72. */
static double lambda(double alpha, double cosine) {
  const double tangent = sqrt(fmax(0, 1 - cosine * cosine)) / cosine;
  return (-1 + sqrt(1 + alpha * alpha * tangent * tangent)) / 2;
}

/* Schlick, "An Inexpensive BRDF Model for Physically-based Rendering" (Computer Graphics Forum 13(3), 1994). */
static struct double3 schlick(struct double3 at_normal, double cosine) {
  const double rest = pow(fmax(1 - cosine, 0), 5);
  return combine(1 - rest, at_normal, rest, (struct double3){1, 1, 1}, 0, at_normal);
}

static double clamp_cosine(double cosine) {
  return fmin(fmax(cosine, 0x1p-10), 1);
}

static double layer_probability(const struct embree_surface *surface) {
  const double layer = largest_of(schlick(surface->specular, clamp_cosine(dot(surface->normal, surface->view))));
  const double below = largest_of(surface->diffuse);
  return below > 0 ? fmin(fmax(layer / (layer + below), 0.125), 0.875) : 1;
}

struct double3 embree_evaluate(const struct embree_surface *surface, struct double3 way, double *density) {
  const struct double3 zero = {0, 0, 0};
  const double cosine = dot(surface->normal, way);
  *density = 0;
  if (!(cosine > 0) || !(dot(surface->flat, way) > 0))
    return zero;
  if (!surface->layered) {
    *density = cosine / PI;
    return combine(cosine / PI, surface->diffuse, 0, zero, 0, zero);
  }
  const double view = clamp_cosine(dot(surface->normal, surface->view)), alpha = surface->roughness;
  const struct double3 half = embree_unit(plus_scaled(surface->view, 1, way));
  const double d = distribution(alpha, fmin(dot(surface->normal, half), 1));
  const double g1 = 1 / (1 + lambda(alpha, view));
  const double g2 = 1 / (1 + lambda(alpha, view) + lambda(alpha, cosine));
  const struct double3 f = schlick(surface->specular, dot(half, surface->view));
  const struct double3 in = schlick(surface->specular, cosine), out = schlick(surface->specular, view);
  const struct double3 below = {surface->diffuse.x * (1 - in.x) * (1 - out.x),
                                surface->diffuse.y * (1 - in.y) * (1 - out.y),
                                surface->diffuse.z * (1 - in.z) * (1 - out.z)};
  const double share = layer_probability(surface);
  *density = share * d * g1 / (4 * view) + (1 - share) * cosine / PI;
  return combine(d * g2 / (4 * view), f, cosine / PI, below, 0, below);
}

/* Heitz 2018, listing 1. */
static struct double3 visible_normal(const struct embree_surface *surface, double x, double y) {
  struct double3 s, t;
  basis(surface->normal, &s, &t);
  const double alpha = surface->roughness;
  const struct double3 v = embree_unit((struct double3){alpha * dot(surface->view, s), alpha * dot(surface->view, t),
                                                        clamp_cosine(dot(surface->view, surface->normal))});
  const double square = v.x * v.x + v.y * v.y;
  struct double3 first = {1, 0, 0};
  if (square >= 0x1p-40)
    first = (struct double3){-v.y / sqrt(square), v.x / sqrt(square), 0};
  const struct double3 second = cross(v, first);
  double a, b;
  disk(x, y, &a, &b);
  const double part = (1 + v.z) / 2;
  b = (1 - part) * sqrt(fmax(0, 1 - a * a)) + part * b;
  const struct double3 n = combine(a, first, b, second, sqrt(fmax(0, 1 - a * a - b * b)), v);
  const struct double3 m = embree_unit((struct double3){alpha * n.x, alpha * n.y, fmax(n.z, 0x1p-20)});
  return combine(m.x, s, m.y, t, m.z, surface->normal);
}

bool embree_sample(const struct embree_surface *surface, double x, double y, double choice, struct double3 *way) {
  if (surface->layered && choice < layer_probability(surface)) {
    const struct double3 m = visible_normal(surface, x, y);
    *way = embree_unit(combine(2 * dot(m, surface->view), m, -1, surface->view, 0, m));
  } else {
    struct double3 s, t;
    double a, b;
    basis(surface->normal, &s, &t);
    disk(x, y, &a, &b);
    *way = combine(a, s, b, t, sqrt(fmax(0, 1 - a * a - b * b)), surface->normal);
  }
  return dot(surface->normal, *way) >= 0x1p-20 && dot(surface->flat, *way) > 0;
}
