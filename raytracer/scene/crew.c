#include "crew.h"
#include "trax/processors.h"

#include <pthread.h>
#include <stdlib.h>

enum { MOST_WORKERS = 64, FIRST_CHUNK = 1 << 14, LARGEST_CHUNK = 1 << 22, STACK = 16 << 20 };

struct chunk {
  struct chunk *next;
};

struct scene_worker {
  struct scene_crew *crew;
  unsigned number;
  struct chunk *chunks;
  char *at;
  size_t left, chunk_size;
  pthread_t thread;
};

struct scene_crew {
  pthread_mutex_t lock;
  pthread_cond_t changed;
  unsigned size, waiting, busy, added; /* workers that wait, work; tasks that nobody has taken */
  struct {
    scene_work *work;
    void *context;
  } tasks[MOST_WORKERS]; /* never more than workers that wait */
  bool ends;
  struct scene_worker workers[MOST_WORKERS];
};

/* Works until there is nothing left: for the first worker until nobody works, for others until the crew ends. The lock
   is held. */
static void serve(struct scene_worker *worker) {
  struct scene_crew *crew = worker->crew;
  for (;;) {
    if (crew->added) {
      crew->added--;
      scene_work *work = crew->tasks[crew->added].work;
      void *context = crew->tasks[crew->added].context;
      crew->busy++;
      pthread_mutex_unlock(&crew->lock);
      work(worker, context);
      pthread_mutex_lock(&crew->lock);
      if (--crew->busy == 0)
        pthread_cond_broadcast(&crew->changed);
    } else if (worker->number == 0 ? crew->busy == 0 : crew->ends)
      return;
    else {
      crew->waiting++;
      pthread_cond_wait(&crew->changed, &crew->lock);
      crew->waiting--;
    }
  }
}

static void *start(void *pointer) {
  struct scene_worker *worker = pointer;
  pthread_mutex_lock(&worker->crew->lock);
  serve(worker);
  pthread_mutex_unlock(&worker->crew->lock);
  return NULL;
}

struct scene_crew *scene_crew_new(unsigned threads) {
  struct scene_crew *crew = calloc(1, sizeof *crew);
  pthread_attr_t attributes;
  if (!crew)
    return NULL;
  if (threads == 0)
    threads = trax_host_processors();
  pthread_mutex_init(&crew->lock, NULL);
  pthread_cond_init(&crew->changed, NULL);
  const bool ready = pthread_attr_init(&attributes) == 0 && pthread_attr_setstacksize(&attributes, STACK) == 0;
  for (unsigned i = 0; i < threads && i < MOST_WORKERS; i++) {
    struct scene_worker *worker = &crew->workers[i];
    *worker = (struct scene_worker){.crew = crew, .number = i, .chunk_size = FIRST_CHUNK};
    if (i > 0 && (!ready || pthread_create(&worker->thread, &attributes, start, worker) != 0))
      break;
    crew->size++;
  }
  pthread_attr_destroy(&attributes);
  return crew;
}

void scene_crew_release(struct scene_crew *crew) {
  if (!crew)
    return;
  pthread_mutex_lock(&crew->lock);
  crew->ends = true;
  pthread_cond_broadcast(&crew->changed);
  pthread_mutex_unlock(&crew->lock);
  for (unsigned i = 0; i < crew->size; i++) {
    if (i > 0)
      pthread_join(crew->workers[i].thread, NULL);
    for (struct chunk *chunk = crew->workers[i].chunks, *next; chunk; chunk = next) {
      next = chunk->next;
      free(chunk);
    }
  }
  pthread_cond_destroy(&crew->changed);
  pthread_mutex_destroy(&crew->lock);
  free(crew);
}

unsigned scene_crew_size(const struct scene_crew *crew) {
  return crew->size;
}

bool scene_crew_add(struct scene_crew *crew, scene_work *work, void *context) {
  if (crew->size == 1)
    return false;
  pthread_mutex_lock(&crew->lock);
  const bool taken = crew->waiting > crew->added;
  if (taken) {
    crew->tasks[crew->added].work = work;
    crew->tasks[crew->added++].context = context;
    pthread_cond_broadcast(&crew->changed);
  }
  pthread_mutex_unlock(&crew->lock);
  return taken;
}

void scene_crew_run(struct scene_crew *crew, scene_work *work, void *context) {
  pthread_mutex_lock(&crew->lock);
  crew->busy++;
  pthread_mutex_unlock(&crew->lock);
  work(&crew->workers[0], context);
  pthread_mutex_lock(&crew->lock);
  crew->busy--;
  serve(&crew->workers[0]);
  pthread_mutex_unlock(&crew->lock);
}

unsigned scene_worker_number(const struct scene_worker *worker) {
  return worker->number;
}

void *scene_worker_take(struct scene_worker *worker, size_t size) {
  size = (size + 7) & ~(size_t)7;
  if (size > worker->left) {
    const size_t chunk_size =
        size + sizeof(struct chunk) > worker->chunk_size ? size + sizeof(struct chunk) : worker->chunk_size;
    struct chunk *chunk = malloc(chunk_size);
    if (!chunk)
      return NULL;
    chunk->next = worker->chunks;
    worker->chunks = chunk;
    worker->at = (char *)(chunk + 1);
    worker->left = chunk_size - sizeof *chunk;
    if (worker->chunk_size < LARGEST_CHUNK)
      worker->chunk_size *= 2;
  }
  void *taken = worker->at;
  worker->at += size, worker->left -= size;
  return taken;
}
