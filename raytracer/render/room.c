#include "room.h"

#include "embree.h"
#include "rtc_query.h"

#include <stdlib.h>
#include <string.h>

enum {
  GRID = 7, /* places along each axis of the box */
  PLACES = GRID * GRID * GRID,
  PROBES = 256, /* rays of a sphere */
  WAYS = 16,    /* level directions in which the eye may look */
  COLUMNS = 16, /* rays through a coarse picture */
  ROWS = 9,
  FOV = 60 /* degrees, in a room */
};

#define CLOSED (15.0 / 16) /* of the probe rays hit something */
#define FACING (1.0 / 2)   /* of these hit the front of a triangle */
#define MANY (1.0 / 4)     /* of the places are enclosed */
#define SHOWN (1.0 / 10)   /* of a coarse picture's rays hit something */
#define CLEARANCE 0.01     /* of the eye and the light from everything, of the box's diagonal */
#define CONE 0.85          /* cosine to a direction, of the rays that measure the depth of a view */
#define NOTABLY (1 + 0x1p-10)

struct spot {
  struct double3 at;
  double nearest; /* distance of what is hit first */
  bool enclosed;
  float distances[PROBES]; /* 0: nothing is hit */
};

struct room {
  RTCDevice device;
  RTCScene scene;
  const struct trax_scene *source;
  struct double3 up, middle, probes[PROBES], ways[WAYS];
  double diagonal;
  struct spot places[PLACES];
};

static struct double3 scaled(double factor, struct double3 v) {
  return (struct double3){factor * v.x, factor * v.y, factor * v.z};
}

/* --- rays --- */

/* The distance in units of the direction; 0: nothing is hit. */
static float hit(const struct room *room, struct double3 origin, struct double3 way, bool *front) {
  rtc_context context;
  struct RTCRayHit ray = {.ray = rtc_ray(origin, way, INFINITY), .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
  rtc_intersect(room->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return 0;
  const struct trax_instance *instance = room->source->instances ? &room->source->instances[ray.hit.instID[0]] : NULL;
  const struct double3 normal = {ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z}; /* in the instance's mesh */
  *front = (dot(normal, trax_to_object(instance, way)) < 0) != (instance && instance->flags & TRAX_INSTANCE_MIRRORED);
  return ray.ray.tfar;
}

static bool reaches(const struct room *room, struct double3 from_place, struct double3 point) {
  rtc_context context;
  struct RTCRay ray = rtc_ray(from_place, minus(point, from_place), 0.999f);
  rtc_occluded(room->scene, &context, &ray);
  return ray.tfar >= 0;
}

/* Through the middle of a cell of a coarse picture. */
static struct double3 picture_ray(const struct trax_view *view, float aspect, int column, int row) {
  const struct double3 into = from(view->direction), up = from(view->up);
  const double tangent = tan(view->fov * 3.14159265358979323846 / 360);
  const struct double3 level =
      plus_scaled(into, ((2 * column + 1.0) / COLUMNS - 1) * tangent * aspect, cross(into, up));
  return plus_scaled(level, (1 - (2 * row + 1.0) / ROWS) * tangent, up);
}

/* One thread and one instruction set, as for the tree: the same hits on every host. */
static trax_status begin(struct room **made, const struct trax_scene *scene, trax_error *error) {
  struct room *room = calloc(1, sizeof *room);
  if (!room)
    return trax_fail(error, "out of memory");
  *made = room;
  room->source = scene;
  room->device = rtcNewDevice("threads=1,isa=sse2,start_threads=0,set_affinity=0");
  if (!room->device)
    return trax_fail(error, "Embree does not start (error %d)", (int)rtcGetDeviceError(NULL));
  room->scene = rtcNewScene(room->device);
  rtcSetSceneBuildQuality(room->scene, RTC_BUILD_QUALITY_LOW);
  return embree_commit(room->device, room->scene, scene, error);
}

static void end(struct room *room) {
  if (room && room->scene)
    rtcReleaseScene(room->scene);
  if (room && room->device)
    rtcReleaseDevice(room->device);
  free(room);
}

/* --- the places --- */

static void make_directions(struct room *room, const struct trax_view *view, const float up[3]) {
  const double pi = 3.14159265358979323846, turn = pi * (3 - sqrt(5)); /* a spiral covers a sphere evenly */
  for (int i = 0; i < PROBES; i++) {
    const double z = 1 - (2 * i + 1.0) / PROBES, r = sqrt(1 - z * z);
    room->probes[i] = (struct double3){r * cos(turn * i), r * sin(turn * i), z};
  }
  room->up = embree_unit(from(up));
  const struct double3 into = from(view->direction);
  const struct double3 level = embree_unit(plus_scaled(into, -dot(into, room->up), room->up));
  const struct double3 right = cross(level, room->up);
  for (int i = 0; i < WAYS; i++)
    room->ways[i] = plus_scaled(scaled(cos(2 * pi * i / WAYS), level), sin(2 * pi * i / WAYS), right);
}

/* Returns how many are enclosed. */
static int probe_places(struct room *room, const struct trax_scene_header *header) {
  const struct double3 low = from(header->bounds_min), size = minus(from(header->bounds_max), low);
  int enclosed = 0;
  room->diagonal = sqrt(dot(size, size));
  room->middle = plus_scaled(low, 0.5, size);
  for (int i = 0; i < PLACES; i++) {
    struct spot *place = &room->places[i];
    int hits = 0, fronts = 0;
    place->at =
        (struct double3){low.x + size.x * (i % GRID + 0.5) / GRID, low.y + size.y * (i / GRID % GRID + 0.5) / GRID,
                         low.z + size.z * (i / (GRID * GRID) + 0.5) / GRID};
    place->nearest = INFINITY;
    for (int probe = 0; probe < PROBES; probe++) {
      bool front = false;
      const float distance = place->distances[probe] = hit(room, place->at, room->probes[probe], &front);
      hits += distance > 0;
      fronts += front;
      if (distance > 0)
        place->nearest = fmin(place->nearest, distance);
    }
    place->enclosed = hits >= CLOSED * PROBES && fronts >= FACING * hits;
    enclosed += place->enclosed;
  }
  return enclosed;
}

/* The geometric mean of the distances around a direction; where nothing is hit, the room has a hole. */
static double depth_of_view(const struct room *room, const struct spot *place, struct double3 way) {
  double sum = 0;
  int count = 0;
  for (int i = 0; i < PROBES; i++)
    if (dot(room->probes[i], way) > CONE) {
      sum += log(place->distances[i] > 0 ? place->distances[i] : CLEARANCE * room->diagonal);
      count++;
    }
  return count ? exp(sum / count) : 0;
}

static bool choose_eye(const struct room *room, const struct spot **eye, struct double3 *way) {
  double best = 0;
  for (int i = 0; i < PLACES; i++) {
    const struct spot *place = &room->places[i];
    if (!place->enclosed || place->nearest < CLEARANCE * room->diagonal ||
        dot(minus(place->at, room->middle), room->up) > 1e-3 * room->diagonal)
      continue;
    for (int w = 0; w < WAYS; w++) {
      const double depth = depth_of_view(room, place, room->ways[w]);
      if (depth > best * NOTABLY) {
        best = depth;
        *eye = place;
        *way = room->ways[w];
      }
    }
  }
  return best > 0;
}

/* Chooses the place that lights most of the picture, the highest of several. The eye is excluded, because no shadow is
   visible from the light. */
static struct double3 choose_light(const struct room *room, const struct spot *eye, const struct trax_view *view,
                                   float aspect) {
  struct double3 seen[COLUMNS * ROWS], light = eye->at;
  int count = 0, most = 0;
  double height = -INFINITY;
  for (int cell = 0; cell < COLUMNS * ROWS; cell++) {
    bool front;
    const struct double3 way = picture_ray(view, aspect, cell % COLUMNS, cell / COLUMNS);
    const float distance = hit(room, eye->at, way, &front);
    if (distance > 0)
      seen[count++] = plus_scaled(eye->at, distance, way);
  }
  for (int i = 0; i < PLACES; i++) {
    const struct spot *place = &room->places[i];
    if (!place->enclosed || place == eye || place->nearest < CLEARANCE * room->diagonal)
      continue;
    int lit = 0;
    for (int point = 0; point < count; point++)
      lit += reaches(room, place->at, seen[point]);
    const double high = dot(minus(place->at, room->middle), room->up);
    if (lit > most || (lit == most && high > height + 1e-3 * room->diagonal)) {
      most = lit;
      height = high;
      light = place->at;
    }
  }
  return light;
}

/* Whether products of coordinates are finite floats. Other scenes are scaled later, when the view is known. */
static bool is_ordinary(const struct trax_scene *scene) {
  const struct trax_scene_header *header = scene->header;
  const double size = fmax(greatest(from(header->bounds_min)), greatest(from(header->bounds_max)));
  return scene->triangle_count > 0 && size > 1e-6 && size < 1e6;
}

static void to_floats(float to[3], struct double3 v) {
  to[0] = (float)v.x, to[1] = (float)v.y, to[2] = (float)v.z;
}

trax_status trax_view_room(struct trax_view *view, bool *inside, const struct trax_scene *scene, const float up[3],
                           float aspect, trax_error *error) {
  struct room *room = NULL;
  const struct spot *eye = NULL;
  struct double3 way = {0, 0, 0};
  *inside = false;
  if (!is_ordinary(scene))
    return TRAX_OK;
  const trax_status status = begin(&room, scene, error);
  if (status == TRAX_OK) {
    make_directions(room, view, up);
    *inside = probe_places(room, scene->header) >= MANY * PLACES && choose_eye(room, &eye, &way);
  }
  if (*inside) {
    *view = (struct trax_view){.fov = FOV};
    to_floats(view->eye, eye->at);
    to_floats(view->direction, way);
    to_floats(view->up, room->up);
    to_floats(view->light, choose_light(room, eye, view, aspect));
  }
  end(room);
  return status;
}

trax_status trax_view_shows(bool *shows, const struct trax_view *view, const struct trax_scene *scene, float aspect,
                            trax_error *error) {
  struct room *room = NULL;
  int hits = 0;
  *shows = false;
  if (!is_ordinary(scene))
    return TRAX_OK;
  const trax_status status = begin(&room, scene, error);
  for (int cell = 0; status == TRAX_OK && cell < COLUMNS * ROWS; cell++) {
    bool front;
    hits += hit(room, from(view->eye), picture_ray(view, aspect, cell % COLUMNS, cell / COLUMNS), &front) > 0;
  }
  *shows = hits >= SHOWN * COLUMNS * ROWS;
  end(room);
  return status;
}
