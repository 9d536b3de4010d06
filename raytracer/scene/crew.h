/* Host threads that share the work of an import. */
#ifndef TRAX_SCENE_CREW_H
#define TRAX_SCENE_CREW_H

#include <stdbool.h>
#include <stddef.h>

struct scene_crew;
struct scene_worker;

typedef void scene_work(struct scene_worker *worker, void *context);

/* threads: with the caller; 0: one for each processor. Fewer if they cannot be started; NULL when out of memory. */
struct scene_crew *scene_crew_new(unsigned threads);
/* Frees the workers' memory too. */
void scene_crew_release(struct scene_crew *crew);
unsigned scene_crew_size(const struct scene_crew *crew);

/* Leaves the work to a thread that waits. False if none does. */
bool scene_crew_add(struct scene_crew *crew, scene_work *work, void *context);
/* Does this work as the first worker, and all that was added meanwhile with the others. */
void scene_crew_run(struct scene_crew *crew, scene_work *work, void *context);

/* The number of a worker; 0: the thread that called scene_crew_run. */
unsigned scene_worker_number(const struct scene_worker *worker);
/* Memory that lives as long as the crew; aligned to 8 bytes. NULL when out of memory. */
void *scene_worker_take(struct scene_worker *worker, size_t size);

#endif
