/* The native twin: the device program's main, compiled for the host under another name for each triangle test, run by
   host threads. */
#include "hits.h"
#include "render.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <trax.h>

/* The program's own (raytracer/device/main.c), the variables common to all. */
extern struct trax_buffer scene, params, image, paths, record;
extern unsigned next_slot[1];
int trax_twin_watertight(void);
int trax_twin_moller_trumbore(void);
int trax_twin_recording(void);
int trax_twin_watertight_accesses(void); /* these tell the log what they read (device/access.h) */
int trax_twin_moller_trumbore_accesses(void);
struct trax_access_log *trax_access_log;

static int (*const mains[TRAX_TRIANGLE_METHODS][2])(void) = {
    {trax_twin_watertight, trax_twin_watertight_accesses},
    {trax_twin_moller_trumbore, trax_twin_moller_trumbore_accesses}};

struct worker {
  pthread_t thread;
  unsigned number, count;
  struct crew *crew;
};

struct crew {
  pthread_mutex_t lock;
  pthread_cond_t changed;
  int (*main)(void);
  unsigned running;
  uint64_t rays, kinds[TRAX_RAY_KIND_COUNT];
};

static void *work(void *argument) {
  struct worker *worker = argument;
  trax_native = (struct trax_native){.thread = worker->number, .tp = worker->number, .threads = worker->count};
  worker->crew->main();
  pthread_mutex_lock(&worker->crew->lock);
  worker->crew->rays += trax_native.rays;
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
    worker->crew->kinds[kind] += trax_native.kinds[kind];
  worker->crew->running--;
  pthread_cond_signal(&worker->crew->changed);
  pthread_mutex_unlock(&worker->crew->lock);
  return NULL;
}

/* Until every worker is done: reports progress and passes an interrupt on, ten times a second. True: interrupted. */
static bool wait_for_crew(struct crew *crew, uint32_t slot_count, const struct trax_render_run *run) {
  bool interrupted = false;
  pthread_mutex_lock(&crew->lock);
  while (crew->running > 0) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += 100000000;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_cond_timedwait(&crew->changed, &crew->lock, &until);
    uint32_t begun = __atomic_load_n(next_slot, __ATOMIC_RELAXED);
    if (run->interrupt && *run->interrupt && !interrupted) {
      interrupted = true;
      __atomic_store_n(next_slot, slot_count, __ATOMIC_RELAXED); /* nothing left to hand out */
    } else if (run->progress && !interrupted) {
      run->progress(run->progress_context, begun < slot_count ? begun : slot_count, slot_count);
    }
  }
  pthread_mutex_unlock(&crew->lock);
  return interrupted;
}

static trax_status run_twin(struct trax_picture *picture, int (*twin)(void), const struct trax_frame *frame,
                            unsigned threads, struct trax_render_run *run, trax_error *error) {
  if (threads == 0)
    threads = trax_host_processors();
  const uint32_t image_bytes = trax_frame_image_bytes(frame);
  struct worker *workers = calloc(threads, sizeof *workers);
  void *pixels = calloc(1, image_bytes), *path_bytes = calloc(threads, TRAX_PATH_BYTES);
  if (!workers || !pixels || !path_bytes) {
    free(workers);
    free(pixels);
    free(path_bytes);
    return trax_fail(error, "out of memory for %u threads and a picture of %u bytes", threads, image_bytes);
  }
  scene = (struct trax_buffer){frame->scene->bytes, (unsigned)frame->scene->size};
  params = (struct trax_buffer){frame->params, frame->params_size};
  image = (struct trax_buffer){pixels, image_bytes};
  paths = (struct trax_buffer){path_bytes, threads * TRAX_PATH_BYTES};
  next_slot[0] = 0;
  trax_access_log = run->accesses;
  run->image = pixels;
  if (run->accesses)
    threads = 1;

  struct crew crew = {
      .lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER, .main = twin, .running = threads};
  unsigned started = 0;
  int failure = 0;
  for (; started < threads; started++) {
    workers[started] = (struct worker){.number = started, .count = threads, .crew = &crew};
    failure = pthread_create(&workers[started].thread, NULL, work, &workers[started]);
    if (failure)
      break;
  }
  pthread_mutex_lock(&crew.lock);
  crew.running -= threads - started;
  pthread_mutex_unlock(&crew.lock);
  bool interrupted = wait_for_crew(&crew, frame->params->slot_count, run);
  for (unsigned i = 0; i < started; i++)
    pthread_join(workers[i].thread, NULL);
  free(workers);
  free(path_bytes);
  run->rays = crew.rays;
  memcpy(run->kinds, crew.kinds, sizeof run->kinds);
  run->image = NULL;
  trax_status status = interrupted    ? TRAX_INTERRUPTED
                       : started == 0 ? trax_fail(error, "cannot start a thread: %s", strerror(failure))
                                      : TRAX_OK; /* fewer threads render the same picture */
  if (status == TRAX_OK)
    status = trax_picture_take(picture, frame, pixels, error);
  free(pixels);
  return status;
}

trax_status trax_render_twin(struct trax_picture *picture, const struct trax_frame *frame, unsigned threads,
                             struct trax_render_run *run, trax_error *error) {
  int (*const twin)(void) = mains[frame->method.triangle][run->accesses != NULL];
  return run_twin(picture, twin, frame, threads, run, error);
}

/* What says where holes are. */
#define HOLES                                                                                                          \
  (TRAX_FEATURE_BIT(ALPHA) | TRAX_FEATURE_BIT(ONE_SIDED) | TRAX_FEATURE_BIT(TEXTURES) | TRAX_FEATURE_BIT(MATERIALS))

static bool has_holes(const struct trax_frame *frame) {
  return frame->params->features & (TRAX_FEATURE_BIT(ALPHA) | TRAX_FEATURE_BIT(ONE_SIDED));
}

trax_status trax_hits_native(struct trax_hits *hits, const struct trax_frame *frame, unsigned threads,
                             struct trax_render_run *run, trax_error *error) {
  const size_t pixels = (size_t)frame->params->width * frame->params->height;
  const size_t record_bytes = pixels * (sizeof(struct trax_pixel_record) + sizeof(struct trax_sample_record));
  const uint32_t triangles_at = frame->scene->header->sections[TRAX_SCENE_TRIANGLES].offset;
  struct trax_frame plain = *frame;
  struct trax_picture picture = {0};
  *hits = (struct trax_hits){.width = frame->params->width, .height = frame->params->height};
  hits->triangles = malloc(pixels * sizeof *hits->triangles);
  plain.params = malloc(frame->params_size);
  record = (struct trax_buffer){record_bytes > UINT32_MAX ? NULL : calloc(1, record_bytes), (unsigned)record_bytes};
  trax_status status = TRAX_OK;
  if (record_bytes > UINT32_MAX)
    status = trax_fail(error, "what %zu pixels hit takes %.1f GB to record; 32-bit offsets end at 4.29", pixels,
                       (double)record_bytes * 1e-9);
  else if (!hits->triangles || !plain.params || !record.data)
    status = trax_fail(error, "out of memory for what %zu pixels hit", pixels);
  else {
    /* One ray a pixel and no shading that matters. */
    memcpy(plain.params, frame->params, frame->params_size);
    plain.params->features &= TRAX_FEATURE_BIT(EXACT) | (run->holes && has_holes(frame) ? HOLES : 0);
    plain.params->samples = 1;
    status = run_twin(&picture, trax_twin_recording, &plain, threads, run, error);
  }
  const struct trax_pixel_record *channels = record.data;
  const struct trax_sample_record *samples = (const struct trax_sample_record *)(channels + pixels);
  for (size_t i = 0; status == TRAX_OK && i < pixels; i++)
    hits->triangles[i] = samples[i].triangle
                             ? (samples[i].triangle - triangles_at) / (uint32_t)sizeof(struct trax_triangle)
                             : TRAX_NO_TRIANGLE;
  trax_picture_release(&picture);
  free(plain.params);
  free(record.data);
  record = (struct trax_buffer){0};
  if (status != TRAX_OK)
    trax_hits_release(hits);
  return status;
}
