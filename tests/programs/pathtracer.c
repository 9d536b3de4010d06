/* A path tracer by the book: Kevin Beason's smallpt, 99 lines of C++, written out in C. As a program of somebody else
   would, it takes its samples and its file from the command line, counts on stderr, draws from erand48 and computes in
   binary64. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
  double x, y, z;
} Vec;

static Vec vec(double x, double y, double z) {
  return (Vec){x, y, z};
}
static Vec add(Vec a, Vec b) {
  return vec(a.x + b.x, a.y + b.y, a.z + b.z);
}
static Vec sub(Vec a, Vec b) {
  return vec(a.x - b.x, a.y - b.y, a.z - b.z);
}
static Vec scale(Vec a, double b) {
  return vec(a.x * b, a.y * b, a.z * b);
}
static Vec mult(Vec a, Vec b) {
  return vec(a.x * b.x, a.y * b.y, a.z * b.z);
}
static double dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static Vec cross(Vec a, Vec b) {
  return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static Vec norm(Vec a) {
  return scale(a, 1 / sqrt(dot(a, a)));
}

typedef struct {
  Vec o, d;
} Ray;

enum Refl { DIFF, SPEC, REFR };

typedef struct {
  double rad;
  Vec p, e, c;
  enum Refl refl;
} Sphere;

static const Sphere spheres[] = {
    {1e5, {1e5 + 1, 40.8, 81.6}, {0, 0, 0}, {.75, .25, .25}, DIFF},   /* left */
    {1e5, {-1e5 + 99, 40.8, 81.6}, {0, 0, 0}, {.25, .25, .75}, DIFF}, /* right */
    {1e5, {50, 40.8, 1e5}, {0, 0, 0}, {.75, .75, .75}, DIFF},         /* back */
    {1e5, {50, 40.8, -1e5 + 170}, {0, 0, 0}, {0, 0, 0}, DIFF},        /* front */
    {1e5, {50, 1e5, 81.6}, {0, 0, 0}, {.75, .75, .75}, DIFF},         /* bottom */
    {1e5, {50, -1e5 + 81.6, 81.6}, {0, 0, 0}, {.75, .75, .75}, DIFF}, /* top */
    {16.5, {27, 16.5, 47}, {0, 0, 0}, {.999, .999, .999}, SPEC},      /* mirror */
    {16.5, {73, 16.5, 78}, {0, 0, 0}, {.999, .999, .999}, REFR},      /* glass */
    {600, {50, 681.6 - .27, 81.6}, {12, 12, 12}, {0, 0, 0}, DIFF},    /* light */
};
enum { COUNT = sizeof spheres / sizeof *spheres };

static double hit(const Sphere *s, Ray r) {
  Vec op = sub(s->p, r.o);
  double t, eps = 1e-4, b = dot(op, r.d), det = b * b - dot(op, op) + s->rad * s->rad;
  if (det < 0)
    return 0;
  det = sqrt(det);
  return (t = b - det) > eps ? t : (t = b + det) > eps ? t : 0;
}

static int intersect(Ray r, double *t, int *id) {
  double d;
  *t = 1e20;
  for (int i = COUNT; i--;)
    if ((d = hit(&spheres[i], r)) && d < *t) {
      *t = d;
      *id = i;
    }
  return *t < 1e20;
}

static Vec radiance(Ray r, int depth, unsigned short *Xi) {
  double t;
  int id = 0;
  if (!intersect(r, &t, &id))
    return vec(0, 0, 0);
  const Sphere *obj = &spheres[id];
  Vec x = add(r.o, scale(r.d, t)), n = norm(sub(x, obj->p)), nl = dot(n, r.d) < 0 ? n : scale(n, -1), f = obj->c;
  double p = f.x > f.y && f.x > f.z ? f.x : f.y > f.z ? f.y : f.z;
  if (++depth > 5) {
    if (depth < 40 && erand48(Xi) < p)
      f = scale(f, 1 / p);
    else
      return obj->e;
  }
  if (obj->refl == DIFF) {
    double r1 = 2 * M_PI * erand48(Xi), r2 = erand48(Xi), r2s = sqrt(r2);
    Vec w = nl, u = norm(cross(fabs(w.x) > .1 ? vec(0, 1, 0) : vec(1, 0, 0), w)), v = cross(w, u);
    Vec d = norm(add(add(scale(u, cos(r1) * r2s), scale(v, sin(r1) * r2s)), scale(w, sqrt(1 - r2))));
    return add(obj->e, mult(f, radiance((Ray){x, d}, depth, Xi)));
  }
  Ray reflected = {x, sub(r.d, scale(n, 2 * dot(n, r.d)))};
  if (obj->refl == SPEC)
    return add(obj->e, mult(f, radiance(reflected, depth, Xi)));
  int into = dot(n, nl) > 0;
  double nc = 1, nt = 1.5, nnt = into ? nc / nt : nt / nc, ddn = dot(r.d, nl), cos2t;
  if ((cos2t = 1 - nnt * nnt * (1 - ddn * ddn)) < 0)
    return add(obj->e, mult(f, radiance(reflected, depth, Xi)));
  Vec tdir = norm(sub(scale(r.d, nnt), scale(n, (into ? 1 : -1) * (ddn * nnt + sqrt(cos2t)))));
  double a = nt - nc, b = nt + nc, R0 = a * a / (b * b), c = 1 - (into ? -ddn : dot(tdir, n));
  double Re = R0 + (1 - R0) * c * c * c * c * c, Tr = 1 - Re, P = .25 + .5 * Re, RP = Re / P, TP = Tr / (1 - P);
  Ray refracted = {x, tdir};
  if (depth > 2)
    return add(obj->e, mult(f, erand48(Xi) < P ? scale(radiance(reflected, depth, Xi), RP)
                                               : scale(radiance(refracted, depth, Xi), TP)));
  Vec first = scale(radiance(reflected, depth, Xi), Re);
  return add(obj->e, mult(f, add(first, scale(radiance(refracted, depth, Xi), Tr))));
}

static double clamp(double x) {
  return x < 0 ? 0 : x > 1 ? 1 : x;
}
static int toInt(double x) {
  return (int)(pow(clamp(x), 1 / 2.2) * 255 + .5);
}

int main(int argc, char *argv[]) {
  int samps = argc > 1 ? atoi(argv[1]) / 4 : 1, w = argc > 2 ? atoi(argv[2]) : 8, h = w * 3 / 4;
  Ray cam = {{50, 52, 295.6}, norm(vec(0, -0.042612, -1))};
  Vec cx = vec(w * .5135 / h, 0, 0), cy = scale(norm(cross(cx, cam.d)), .5135), *c = calloc((size_t)w * h, sizeof *c);
  for (int y = 0; y < h; y++) {
    fprintf(stderr, "\rRendering (%d spp) %5.2f%%", samps * 4, 100. * y / (h - 1));
    unsigned short Xi[3] = {0, 0, (unsigned short)(y * y * y)};
    for (int x = 0; x < w; x++)
      for (int sy = 0, i = (h - y - 1) * w + x; sy < 2; sy++)
        for (int sx = 0; sx < 2; sx++) {
          Vec r = vec(0, 0, 0);
          for (int s = 0; s < samps; s++) {
            double r1 = 2 * erand48(Xi), dx = r1 < 1 ? sqrt(r1) - 1 : 1 - sqrt(2 - r1);
            double r2 = 2 * erand48(Xi), dy = r2 < 1 ? sqrt(r2) - 1 : 1 - sqrt(2 - r2);
            Vec d = add(add(scale(cx, ((sx + .5 + dx) / 2 + x) / w - .5), scale(cy, ((sy + .5 + dy) / 2 + y) / h - .5)),
                        cam.d);
            r = add(r, scale(radiance((Ray){add(cam.o, scale(d, 140)), norm(d)}, 0, Xi), 1. / samps));
          }
          c[i] = add(c[i], scale(vec(clamp(r.x), clamp(r.y), clamp(r.z)), .25));
        }
  }
  FILE *f = fopen(argc > 3 ? argv[3] : "image.ppm", "w");
  if (!f) {
    perror("image.ppm");
    return 1;
  }
  fprintf(f, "P3\n%d %d\n%d\n", w, h, 255);
  for (int i = 0; i < w * h; i++)
    fprintf(f, "%d %d %d ", toInt(c[i].x), toInt(c[i].y), toInt(c[i].z));
  fclose(f);
  free(c);
  return 0;
}
