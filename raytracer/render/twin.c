/* The native twin: the device program's main, compiled for the host under another name, run by host threads. */
#include "hits.h"
#include "layers.h"
#include "render.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <trax.h>

/* The program's own (raytracer/device/main.c). */
extern struct trax_buffer scene, params, image, paths, record;
extern unsigned next_slot[1];
int trax_twin(void);
struct trax_access_log *trax_access_log; /* device/access.h */

struct worker {
  pthread_t thread;
  unsigned number, count;
  struct crew *crew;
};

struct crew {
  pthread_mutex_t lock;
  pthread_cond_t changed;
  unsigned running;
  uint64_t rays, kinds[TRAX_RAY_KIND_COUNT];
};

static void *work(void *argument) {
  struct worker *worker = argument;
  trax_native = (struct trax_native){.thread = worker->number, .tp = worker->number, .threads = worker->count};
  trax_twin();
  pthread_mutex_lock(&worker->crew->lock);
  worker->crew->rays += trax_native.rays;
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
    worker->crew->kinds[kind] += trax_native.kinds[kind];
  worker->crew->running--;
  pthread_cond_signal(&worker->crew->changed);
  pthread_mutex_unlock(&worker->crew->lock);
  return NULL;
}

/* Waits for all workers. Every 0.1 s it reports progress and forwards an interrupt. Returns whether it was interrupted.
 */
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

static trax_status run_twin(struct trax_picture *picture, const struct trax_frame *frame, unsigned threads,
                            struct trax_render_run *run, trax_error *error) {
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
  if (run->accesses)
    threads = 1;

  struct crew crew = {.lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER, .running = threads};
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
  const uint64_t record_bytes = trax_record_bytes(frame->params);
  if (!run->layers)
    return run_twin(picture, frame, threads, run, error);
  if (record_bytes > UINT32_MAX)
    return trax_fail(error, "the record of the rays takes %.1f GB; 32-bit offsets end at 4.29",
                     (double)record_bytes * 1e-9);
  record = (struct trax_buffer){calloc(1, record_bytes), (unsigned)record_bytes};
  if (!record.data)
    return trax_fail(error, "out of memory for the record of the rays");
  trax_status status = run_twin(picture, frame, threads, run, error);
  if (status == TRAX_OK)
    status = trax_layers_take(picture, frame, record.data, error);
  free(record.data);
  record = (struct trax_buffer){0};
  return status;
}

trax_status trax_hits_native(struct trax_hits *hits, const struct trax_frame *frame, unsigned threads,
                             struct trax_render_run *run, trax_error *error) {
  const size_t pixels = (size_t)frame->params->width * frame->params->height;
  struct trax_frame plain = *frame;
  struct trax_picture picture = {0};
  struct trax_render_run recorded = *run;
  recorded.layers = true;
  *hits = (struct trax_hits){.width = frame->params->width, .height = frame->params->height};
  hits->triangles = malloc(pixels * sizeof *hits->triangles);
  plain.params = malloc(frame->params_size);
  trax_status status =
      hits->triangles && plain.params ? TRAX_OK : trax_fail(error, "out of memory for the hits of %zu pixels", pixels);
  if (status == TRAX_OK) {
    /* One ray a pixel and no shading that matters. */
    memcpy(plain.params, frame->params, frame->params_size);
    plain.params->features &= TRAX_FEATURE_BIT(EXACT) | TRAX_FEATURE_BIT(INSTANCES);
    plain.params->samples = 1;
    status = trax_render_twin(&picture, &plain, threads, &recorded, error);
    run->rays = recorded.rays;
  }
  for (size_t i = 0; status == TRAX_OK && i < pixels; i++)
    hits->triangles[i] = picture.layers[i].triangle;
  trax_picture_release(&picture);
  free(plain.params);
  if (status != TRAX_OK)
    trax_hits_release(hits);
  return status;
}
