/* Embree's pictures of several lights, mirrors, glass, rough layers, textures, holes, and paths. They follow the
   description in device/path.h, in binary64 and in code of their own. Both programs take the same points from the
   sampler (device/sampler.h), so that their pictures can be compared pixel by pixel. */
#include "embree.h"

#define PI 3.14159265358979323846
#define MOST_HOLES 1024
#define SURE_DEPTH 3
#define MOST_CORRECTION 4
#define MOST_MIRRORS 8 /* without --paths */

struct sample {
  const struct embree *embree;
  const struct trax_render_params *params;
  const struct trax_frame_options *options;
  uint32_t number, key, depth;
  bool random; /* --paths */
  uint64_t *rays;
};

struct two {
  double x, y;
};

static struct two exactly(struct words words) {
  return (struct two){(words.x >> 8) * 0x1p-24, (words.y >> 8) * 0x1p-24};
}

static struct two point_for(const struct sample *sample, uint32_t dimension) {
  dimension += DIMENSIONS_OF_SURFACE * sample->depth;
  if (sample->random)
    return exactly(random_words(sample->number, dimension, sample->key));
  const struct place place = sample->number ? even_point(sample->number, dimension) : PIXEL_MIDDLE;
  return (struct two){(double)place.x, (double)place.y};
}

static struct double3 scaled(double factor, struct double3 v) {
  return (struct double3){factor * v.x, factor * v.y, factor * v.z};
}

static struct double3 times(struct double3 a, struct double3 b) {
  return (struct double3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static double largest_of(struct double3 v) {
  return fmax(v.x, fmax(v.y, v.z));
}

/* --- textures --- */

struct texel {
  struct double3 colour;
  double alpha;
};

static uint32_t wrap(double number, uint32_t size, bool clamp) {
  if (clamp)
    return number < 0 ? 0 : number > size - 1 ? size - 1 : (uint32_t)number;
  return (uint32_t)(number - size * floor(number / size));
}

static struct texel look_up(const struct trax_scene *scene, const struct trax_texture *texture, double u, double v) {
  const uint32_t width = 1u << texture->log2_width, height = 1u << texture->log2_height;
  const bool clamp = texture->flags & TRAX_TEXTURE_CLAMP;
  const uint32_t *texels = (const uint32_t *)((const char *)scene->bytes + texture->texels);
  const double x = u * width - 0.5, y = v * height - 0.5, column = floor(x), row = floor(y);
  struct texel sum = {{0, 0, 0}, 0};
  for (int down = 0; down < 2; down++)
    for (int right = 0; right < 2; right++) {
      const uint32_t word =
          texels[(size_t)wrap(row + down, height, clamp) * width + wrap(column + right, width, clamp)];
      const double weight = (right ? x - column : 1 - x + column) * (down ? y - row : 1 - y + row);
      const double red = (word & 255) / 255.0, green = (word >> 8 & 255) / 255.0, blue = (word >> 16 & 255) / 255.0;
      sum.colour = plus_scaled(sum.colour, weight, (struct double3){red * red, green * green, blue * blue});
      sum.alpha += weight * (word >> 24) / 255.0;
    }
  return sum;
}

static struct texel texel_of(const struct trax_scene *scene, const struct trax_material *material, uint32_t stored,
                             const struct exact_hit *hit) {
  if (!material->texture || !scene->uvs)
    return (struct texel){{1, 1, 1}, 1};
  const float(*corner)[2] = scene->uvs[stored].corner;
  double place[2];
  for (int i = 0; i < 2; i++)
    place[i] =
        (1 - hit->u - hit->v) * (double)corner[0][i] + hit->u * (double)corner[1][i] + hit->v * (double)corner[2][i];
  return look_up(scene, &scene->textures[material->texture - 1], place[0], place[1]);
}

/* --- surfaces --- */

struct surface {
  const struct trax_material *material;
  struct exact_hit hit;
  struct double3 point;         /* which light arrives at */
  struct double3 start, behind; /* where rays start */
  struct texel texel;
  struct embree_surface at;
  bool turned;
};

static struct double3 smooth_normal(const struct trax_scene *scene, const struct placed_triangle *placed,
                                    const struct exact_hit *hit, struct double3 flat) {
  double v[3][3];
  trax_place_normals(v, scene, placed);
  const struct double3 a = {v[0][0], v[0][1], v[0][2]}, b = {v[1][0], v[1][1], v[1][2]},
                       c = {v[2][0], v[2][1], v[2][2]};
  const struct double3 n = plus_scaled(plus_scaled(scaled(1 - hit->u - hit->v, a), hit->u, b), hit->v, c);
  return embree_unit(dot(n, flat) < 0 ? scaled(-1, n) : n);
}

static void describe(struct surface *surface, const struct sample *sample, const struct exact_hit *hit,
                     struct double3 origin, struct double3 direction) {
  const struct trax_scene *scene = sample->embree->frame->scene;
  struct placed_triangle placed;
  trax_place(&placed, scene, hit->triangle);
  const struct trax_triangle *triangle = &placed.triangle;
  const struct trax_material *material = &scene->materials[triangle->material];
  const struct double3 a = from(triangle->v0), e = minus(from(triangle->v1), a), f = minus(from(triangle->v2), a);
  const struct double3 on = plus_scaled(plus_scaled(a, hit->u, e), hit->v, f);
  surface->material = material;
  surface->hit = *hit;
  surface->texel = texel_of(scene, material, placed.stored, hit);
  struct double3 normal = embree_winding_normal(triangle);
  surface->turned = dot(normal, direction) > 0;
  normal = surface->turned ? scaled(-1, normal) : normal;
  surface->turned ^= placed.mirrored;
  surface->point = on;
  surface->start = embree_start(sample->embree, &placed, on, normal, origin);
  surface->behind = plus_scaled(on, -embree_start_bound(sample->embree, &placed, origin, minus(on, origin)), normal);

  struct embree_surface *at = &surface->at;
  const bool scatters = material->kind == TRAX_MATERIAL_LAMBERT || material->kind == TRAX_MATERIAL_GGX;
  *at = (struct embree_surface){.view = embree_unit(scaled(-1, direction)),
                                .flat = normal,
                                .normal = normal,
                                .diffuse = from(material->diffuse),
                                .specular = from(material->specular),
                                .roughness = fmax((double)material->roughness, (double)TRAX_LEAST_ROUGHNESS),
                                .layered = material->kind == TRAX_MATERIAL_GGX};
  if (embree_needs(sample->embree, TRAX_FEATURE_SMOOTH)) {
    const struct double3 smooth = smooth_normal(scene, &placed, hit, normal);
    if (scatters || dot(smooth, at->view) > 0)
      at->normal = smooth;
  }
  if (at->layered && largest_of(at->diffuse) == 0)
    at->specular = times(at->specular, surface->texel.colour);
  else
    at->diffuse = times(at->diffuse, surface->texel.colour);
}

static bool vanishes_behind(const struct sample *sample, const struct trax_material *material) {
  return embree_needs(sample->embree, TRAX_FEATURE_ONE_SIDED) && material->kind != TRAX_MATERIAL_GLASS;
}

static bool is_hole(const struct sample *sample, const struct surface *surface) {
  const struct trax_material *material = surface->material;
  if (surface->turned && vanishes_behind(sample, material))
    return true;
  return (double)material->opacity * surface->texel.alpha < (double)material->alpha_cutoff;
}

/* The nearest surface that is no hole. *distance: how far the ray went, over all of its pieces. */
static bool find_surface(struct surface *surface, const struct sample *sample, struct double3 origin,
                         struct double3 direction, double *distance) {
  struct exact_hit hit;
  *distance = 0;
  for (int holes = 0;; holes++) {
    ++*sample->rays;
    if (!embree_hit(sample->embree, origin, direction, &hit))
      return false;
    describe(surface, sample, &hit, origin, direction);
    if (holes == MOST_HOLES || !is_hole(sample, surface)) {
      *distance += hit.distance;
      return true;
    }
    *distance += hit.distance;
    origin = surface->behind;
  }
}

/* The ray is aimed at the target again behind each hole, so its result does not depend on where it starts. */
static bool light_reaches(const struct sample *sample, struct double3 origin, struct double3 direction,
                          double distance) {
  if (!embree_needs(sample->embree, TRAX_FEATURE_SHADOWS))
    return true;
  const struct double3 target = plus_scaled(origin, isfinite(distance) ? distance : 0, direction);
  const bool passes =
      embree_needs(sample->embree, TRAX_FEATURE_ALPHA) || embree_needs(sample->embree, TRAX_FEATURE_ONE_SIDED);
  for (int holes = 0; passes; holes++) {
    struct surface surface;
    struct exact_hit hit;
    ++*sample->rays;
    if (!embree_hit(sample->embree, origin, direction, &hit) || hit.distance > distance * (1 - 0x1p-18))
      return true;
    describe(&surface, sample, &hit, origin, direction);
    if (holes == MOST_HOLES || !is_hole(sample, &surface))
      return false;
    origin = surface.behind;
    if (isfinite(distance))
      distance = embree_towards(origin, target, &direction);
  }
  ++*sample->rays;
  return !embree_blocked(sample->embree, origin, direction, distance);
}

/* --- lights --- */

/* The light of one light of the view that the surface reflects. */
static struct double3 lit_by(const struct sample *sample, const struct surface *surface, uint32_t number,
                             struct two place) {
  const struct double3 nothing = {0, 0, 0};
  struct embree_arrival arrival;
  double density;
  if (!embree_light_at(sample->embree, number, surface->point, place.x, place.y, &arrival))
    return nothing;
  const struct double3 part = embree_evaluate(&surface->at, arrival.direction, &density);
  if (largest_of(part) <= 0)
    return nothing;
  if (isfinite(arrival.distance)) /* the ray does not start at the point */
    arrival.distance = embree_towards(surface->start, arrival.target, &arrival.direction);
  return light_reaches(sample, surface->start, arrival.direction, arrival.distance) ? times(part, arrival.irradiance)
                                                                                    : nothing;
}

/* The light of a sampled emitter, weighted by the balance heuristic. */
static struct double3 lit_by_emitter(const struct sample *sample, const struct surface *surface, uint32_t pick,
                                     struct two place) {
  const struct double3 nothing = {0, 0, 0};
  const struct trax_triangle *triangle = embree_pick_emitter(sample->embree, pick * 0x1p-32);
  const struct double3 a = from(triangle->v0), b = from(triangle->v1), c = from(triangle->v2);
  const double side = sqrt(place.x), v = side * (1 - place.y), w = side * place.y;
  const struct double3 target = plus_scaled(plus_scaled(scaled(1 - v - w, a), v, b), w, c);
  struct double3 direction = {0, 0, 0}, towards = {0, 0, 0};
  double density;
  const double distance = embree_towards(surface->point, target, &direction);
  const double facing = -dot(embree_winding_normal(triangle), direction);
  const struct trax_material *material = &sample->embree->frame->scene->materials[triangle->material];
  if (!(distance > 0) || !(fabs(facing) >= 0x1p-20) || (facing < 0 && vanishes_behind(sample, material)))
    return nothing;
  const struct double3 part = embree_evaluate(&surface->at, direction, &density);
  const double left = embree_towards(surface->start, target, &towards);
  if (largest_of(part) <= 0 || !light_reaches(sample, surface->start, towards, left * (1 - 0x1p-18)))
    return nothing;
  const double chosen = embree_emitter_density(sample->embree, triangle, distance, direction);
  return scaled(1 / (chosen + density), times(part, from(material->emission)));
}

/* The light of the environment, weighted likewise. */
static struct double3 lit_by_environment(const struct sample *sample, const struct surface *surface, uint32_t pick,
                                         struct two place) {
  const struct double3 direction = embree_pick_environment(sample->embree, pick, place.x, place.y);
  double density, chosen;
  const struct double3 light = embree_environment(sample->embree, direction, &chosen);
  const struct double3 part = embree_evaluate(&surface->at, direction, &density);
  if (largest_of(part) <= 0 || !(chosen > 0) || !light_reaches(sample, surface->start, direction, INFINITY))
    return (struct double3){0, 0, 0};
  return scaled(1 / (chosen + density), times(part, light));
}

/* --- paths --- */

static struct double3 lit_at_random(const struct sample *sample, const struct surface *surface) {
  const uint32_t choices = sample->embree->choices;
  if (choices == 0)
    return (struct double3){0, 0, 0};
  const struct words pick =
      random_words(sample->number, DIMENSION_PICK + DIMENSIONS_OF_SURFACE * sample->depth, sample->key);
  const struct two place = point_for(sample, DIMENSION_LIGHT);
  const uint32_t number = (uint32_t)((uint64_t)pick.x * choices >> 32);
  if (embree_needs(sample->embree, TRAX_FEATURE_ENVIRONMENT) && number == choices - 1)
    return lit_by_environment(sample, surface, pick.y, place);
  if (number == sample->embree->light_count)
    return lit_by_emitter(sample, surface, pick.y, place);
  return scaled(choices, lit_by(sample, surface, number, place));
}

/* The length of occlusion rays: a part of the diagonal of the scene's box. */
static double reach_of(const struct trax_frame *frame) {
  const float *low = frame->scene->header->bounds_min, *high = frame->scene->header->bounds_max;
  const struct double3 diagonal = minus(from(high), from(low));
  const double part = frame->options.occlusion_reach;
  return (part > 0 ? part : TRAX_DEFAULT_REACH) * sqrt(dot(diagonal, diagonal));
}

/* The part of the cosine-distributed rays towards the ambient light that nothing blocks. */
static double open_part(const struct sample *sample, const struct surface *surface) {
  struct embree_surface diffuse = surface->at;
  const uint32_t rays = sample->options->occlusion;
  const double reach = reach_of(sample->embree->frame);
  uint32_t open = 0;
  diffuse.layered = false;
  for (uint32_t i = 0; i < rays; i++) {
    const struct two place = exactly(random_words(
        rays * sample->number + i, DIMENSION_SCATTER + DIMENSIONS_OF_SURFACE * sample->depth, sample->key));
    struct double3 direction;
    open += embree_sample(&diffuse, place.x, place.y, 0, &direction) &&
            light_reaches(sample, surface->start, direction, reach);
  }
  return (double)open / rays;
}

static struct double3 lit_by_all(const struct sample *sample, const struct surface *surface) {
  const struct trax_render_params *params = sample->params;
  struct double3 albedo = surface->at.diffuse;
  if (surface->at.layered)
    albedo = plus_scaled(albedo, 1, surface->at.specular);
  struct double3 sum = scaled((double)params->ambient + dot(surface->at.normal, from(params->fill)), albedo);
  if (embree_needs(sample->embree, TRAX_FEATURE_OCCLUSION))
    sum = scaled(open_part(sample, surface), sum);
  for (uint32_t i = 0; i < sample->embree->light_count; i++)
    sum = plus_scaled(sum, 1, lit_by(sample, surface, i, point_for(sample, DIMENSION_LIGHT)));
  return sum;
}

static struct double3 mirrored(struct double3 view, struct double3 normal) {
  return plus_scaled(scaled(-1, view), 2 * dot(view, normal), normal);
}

/* A mirror's or a glass's next direction, about the smooth normal unless that leads to the wrong side. */
static struct double3 deflect(const struct sample *sample, const struct surface *surface, bool *through) {
  const struct embree_surface *at = &surface->at;
  struct double3 way = {0, 0, 0}, normal = at->normal;
  *through = false;
  if (surface->material->kind == TRAX_MATERIAL_MIRROR) {
    way = mirrored(at->view, normal);
    return dot(at->flat, way) > 0 ? way : mirrored(at->view, at->flat);
  }
  const double glass = (double)surface->material->ior, n1 = surface->turned ? glass : 1,
               n2 = surface->turned ? 1 : glass;
  for (int attempt = 0; attempt < 2; attempt++, normal = at->flat) {
    double cosine2;
    const double cosine1 = dot(at->view, normal);
    *through = point_for(sample, DIMENSION_CHOICE).x >= embree_fresnel(n1, n2, cosine1, &cosine2);
    way = *through ? plus_scaled(scaled(-n1 / n2, at->view), n1 / n2 * cosine1 - cosine2, normal)
                   : mirrored(at->view, normal);
    const double side = dot(at->flat, way);
    if (*through ? side < 0 : side > 0)
      break;
  }
  return embree_unit(way);
}

/* The weighted light of an emitter that a ray in `direction` found. scatterer scattered the ray with the density
   `density`. On a Lambert surface the ray stands for the way from point to point, which has another form factor. */
static double share_of_emission(const struct sample *sample, const struct surface *scatterer, double density,
                                const struct surface *surface, double distance, struct double3 direction) {
  struct placed_triangle placed;
  trax_place(&placed, sample->embree->frame->scene, surface->hit.triangle);
  const struct trax_triangle *triangle = &placed.triangle;
  double own = density, share = 1;
  struct double3 way = direction;
  const double straight = embree_towards(scatterer->point, surface->point, &way);
  if (straight > 0 && !scatterer->at.layered) {
    const double at_start = fabs(dot(surface->at.flat, direction)) / (distance * distance);
    own = fmax(dot(scatterer->at.normal, way), 0) / PI;
    share = fmin(own / density * fabs(dot(surface->at.flat, way)) / (straight * straight) / at_start, MOST_CORRECTION);
  }
  const double chosen = embree_emitter_density(sample->embree, triangle, straight > 0 ? straight : distance, way);
  return own > 0 ? share * own / (own + chosen) : 0;
}

struct double3 embree_path(const struct embree *embree, struct pixel pixel, uint32_t number, struct trax_layers *seen,
                           uint64_t *rays) {
  const struct trax_render_params *params = embree->frame->params;
  struct sample sample = {.embree = embree,
                          .params = params,
                          .options = &embree->frame->options,
                          .number = number,
                          .random = embree_needs(embree, TRAX_FEATURE_PATHS),
                          .rays = rays};
  sample.key = hash_word(pixel.packed ^ hash_word(sample.options->seed));
  const struct place place = sample.random ? random_point(number, DIMENSION_PIXEL, sample.key) : sample_place(number);
  const struct vector camera = camera_direction(params, pixel, place);
  struct double3 origin = from(params->eye), direction = {(double)camera.x, (double)camera.y, (double)camera.z};
  const uint32_t most = sample.options->paths ? sample.options->paths : MOST_MIRRORS + 1;
  struct double3 light = {0, 0, 0}, throughput = {1, 1, 1};
  struct surface scatterer = {0};
  double density = 0; /* of the direction in solid angle; 0: there was no choice */
  *seen = (struct trax_layers){.triangle = TRAX_NO_TRIANGLE, .shadow = TRAX_SHADOW_NOT_ASKED};

  for (;; sample.depth++) {
    struct surface surface;
    double distance;
    if (!find_surface(&surface, &sample, origin, direction, &distance))
      return plus_scaled(light, 1, times(throughput, embree_far_light(embree, direction, density)));
    if (sample.depth == 0)
      seen->triangle = surface.hit.triangle;

    const struct trax_material *material = surface.material;
    if (largest_of(from(material->emission)) > 0) {
      const double share =
          density > 0 ? share_of_emission(&sample, &scatterer, density, &surface, distance, direction) : 1;
      light = plus_scaled(light, share, times(throughput, from(material->emission)));
    }
    if (sample.depth >= most)
      return light;

    if (material->kind == TRAX_MATERIAL_MIRROR || material->kind == TRAX_MATERIAL_GLASS) {
      bool through;
      direction = deflect(&sample, &surface, &through);
      origin = through ? surface.behind : surface.start;
      if (through || material->kind == TRAX_MATERIAL_MIRROR)
        throughput = times(throughput, surface.at.specular);
      density = 0;
      continue;
    }
    if (!sample.random)
      return plus_scaled(light, 1, times(throughput, lit_by_all(&sample, &surface)));

    light = plus_scaled(light, 1, times(throughput, lit_at_random(&sample, &surface)));
    const struct two choice = point_for(&sample, DIMENSION_CHOICE), scatter = point_for(&sample, DIMENSION_SCATTER);
    if (!embree_sample(&surface.at, scatter.x, scatter.y, choice.x, &direction))
      return light;
    const struct double3 part = embree_evaluate(&surface.at, direction, &density);
    throughput = times(throughput, scaled(1 / density, part));
    if (!(largest_of(throughput) > 0))
      return light;
    if (sample.depth >= SURE_DEPTH) {
      const double chance = fmin(fmax(largest_of(throughput), 0x1p-10), 0.95);
      if (choice.y >= chance)
        return light;
      throughput = scaled(1 / chance, throughput);
    }
    origin = surface.start;
    scatterer = surface;
  }
}
