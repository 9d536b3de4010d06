/* The converged picture of a view, computed once and kept in a file. */
#include "picture_error.h"
#include "trax/input.h"
#include "trax/output.h"
#include "trax/reads.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <xxhash.h>

/* --- the key --- */

/* The sum of the triangles' hashes, each once however many leaves it stands in: the same whatever the tree. */
static trax_status hash_triangles(uint64_t *sum, const struct trax_scene *scene, trax_error *error) {
  uint32_t most = 0;
  for (uint32_t i = 0; i < scene->triangle_count && scene->source_ids; i++)
    most = scene->source_ids[i] > most ? scene->source_ids[i] : most;
  unsigned char *seen = calloc((size_t)most / 8 + 1, 1);
  if (!seen)
    return trax_fail(error, "out of memory for %u triangles", scene->triangle_count);
  *sum = 0;
  for (uint32_t i = 0; i < scene->triangle_count; i++) {
    const uint32_t id = scene->source_ids ? scene->source_ids[i] : 0;
    if (scene->source_ids && seen[id / 8] >> id % 8 & 1)
      continue;
    seen[id / 8] |= (unsigned char)(1 << id % 8);
    *sum += XXH3_64bits_withSeed(&scene->triangles[i], sizeof *scene->triangles,
                                 scene->normals ? XXH3_64bits(&scene->normals[i], sizeof *scene->normals) : 0);
  }
  free(seen);
  return TRAX_OK;
}

/* The parameters without what depends on the tree; this program, which computes the picture. */
static trax_status make_key(char key[17], const struct trax_frame *frame, trax_error *error) {
  struct trax_render_params params = *frame->params;
  uint8_t *self;
  size_t self_bytes;
  uint64_t parts[4];
  params.box_margin = 0;
  params.normals_distance = 0;
  params.node_layout = 0;
  memset(&params.grid, 0, sizeof params.grid);
  if (hash_triangles(&parts[0], frame->scene, error) != TRAX_OK ||
      trax_read_file("/proc/self/exe", (size_t)1 << 30, &self, &self_bytes, error) != TRAX_OK)
    return TRAX_ERROR;
  parts[1] = XXH3_64bits(self, self_bytes);
  parts[2] = XXH3_64bits(&params, sizeof params);
  parts[3] = XXH3_64bits(frame->params + 1, frame->params_size - sizeof params); /* the palette */
  free(self);
  snprintf(key, 17, "%016llx", (unsigned long long)XXH3_64bits(parts, sizeof parts));
  return TRAX_OK;
}

/* --- the file: the channels, rough_rmse, and a checksum of both --- */

static bool read_converged(struct trax_converged *converged, const struct trax_frame *frame, const char *path) {
  const size_t count = 3 * (size_t)frame->params->width * frame->params->height, size = (count + 1) * sizeof(double);
  uint8_t *bytes;
  size_t got;
  uint64_t sum;
  trax_error unread;
  if (trax_read_file(path, size + sizeof sum, &bytes, &got, &unread) != TRAX_OK)
    return false;
  if (got == size + sizeof sum) {
    memcpy(&sum, bytes + size, sizeof sum);
    if (sum == XXH3_64bits(bytes, size)) {
      *converged = (struct trax_converged){.picture = {.width = frame->params->width,
                                                       .height = frame->params->height,
                                                       .samples = frame->params->samples,
                                                       .channels = (double *)(void *)bytes}};
      converged->rough_rmse = converged->picture.channels[count];
      return true;
    }
  }
  free(bytes);
  trax_reads_drop_path(path); /* damaged: it is made anew */
  return false;
}

static trax_status write_converged(const struct trax_converged *converged, const char *path, trax_error *error) {
  const size_t count = 3 * (size_t)converged->picture.width * converged->picture.height;
  double *values = malloc((count + 2) * sizeof *values);
  if (!values)
    return trax_fail(error, "out of memory");
  memcpy(values, converged->picture.channels, count * sizeof *values);
  values[count] = converged->rough_rmse;
  const uint64_t sum = XXH3_64bits(values, (count + 1) * sizeof *values);
  memcpy(&values[count + 1], &sum, sizeof sum);
  const trax_status status = trax_write_file(path, values, (count + 2) * sizeof *values, error);
  free(values);
  return status;
}

static trax_status compute(struct trax_converged *converged, const struct trax_frame *frame,
                           const struct trax_frame *rough, struct trax_render_run *run, trax_error *error) {
  struct trax_exact coarse = {0};
  trax_status status = trax_render_exact(&converged->picture, frame, false, run, error);
  if (status == TRAX_OK)
    status = trax_render_exact(&coarse, rough, false, run, error);
  if (status == TRAX_OK) {
    struct trax_channel_errors errors;
    trax_channel_errors(&errors, coarse.channels, converged->picture.channels, (size_t)coarse.width * coarse.height);
    converged->rough_rmse = errors.rmse;
  }
  trax_exact_release(&coarse);
  return status;
}

/* Waits until no other process computes a picture for this folder, since each takes all processors. The lock ends with
   its descriptor; where the file system has none, -1, several compute the same. */
static int lock_folder(const char *folder, const volatile int *interrupt) {
  const struct timespec pause = {.tv_nsec = 50000000};
  const int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  while (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK &&
         !(interrupt && *interrupt))
    nanosleep(&pause, NULL);
  return descriptor;
}

trax_status trax_converge(struct trax_converged *converged, const struct trax_frame *frame,
                          const struct trax_frame *rough, const char *folder, struct trax_render_run *run,
                          trax_error *error) {
  char key[17], path[TRAX_PATH_SIZE];
  *converged = (struct trax_converged){.rough_rmse = 0};
  if (!folder)
    return compute(converged, frame, rough, run, error);
  if (make_key(key, frame, error) != TRAX_OK)
    return TRAX_ERROR;
  if (snprintf(path, sizeof path, "%s/converged-%s", folder, key) >= (int)sizeof path)
    return trax_fail(error, "%s: the path is too long", folder);
  if (mkdir(folder, 0777) != 0 && errno != EEXIST)
    return trax_fail(error, "%s: %s", folder, strerror(errno));
  if (read_converged(converged, frame, path))
    return TRAX_OK;
  if (trax_output_check(path, error) != TRAX_OK)
    return TRAX_ERROR;
  const int lock = lock_folder(folder, run->interrupt);
  trax_status status = TRAX_OK;
  if (!read_converged(converged, frame, path)) { /* nobody else has made it meanwhile */
    status = compute(converged, frame, rough, run, error);
    if (status == TRAX_OK)
      status = write_converged(converged, path, error);
  }
  if (lock >= 0)
    close(lock);
  return status;
}
