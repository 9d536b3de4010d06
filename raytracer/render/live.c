#include "live.h"

#include "trax/progress.h"

#include <stdlib.h>
#include <string.h>

#define LEAST_SECONDS 0.1 /* between two frames */
#define SHARE 0.1         /* of the time, for frames */

struct live {
  const char *file;
  const struct trax_frame *frame;
  double due; /* of the next frame, in trax_seconds */
  trax_status status;
  trax_error error;
};

trax_status live_create(struct live **made, const struct options *options, trax_error *error) {
  *made = NULL;
  if (!options->progress_png)
    return TRAX_OK;
  *made = calloc(1, sizeof **made);
  if (!*made)
    return trax_fail(error, "out of memory");
  (*made)->file = options->progress_png;
  return TRAX_OK;
}

void live_destroy(struct live *live) {
  free(live);
}

static void draw_missing(struct trax_picture *picture) {
  enum { SQUARE = 8 };
  for (uint32_t y = 0; y < picture->height; y++)
    for (uint32_t x = 0; x < picture->width; x++) {
      uint32_t *pixel = &picture->pixels[(size_t)y * picture->width + x];
      if (*pixel >> 24 == 0)
        *pixel = (x / SQUARE + y / SQUARE) % 2 ? 0xFF505050u : 0xFF404040u;
    }
}

/* A failure does not end the run, because the picture matters more than its frames. */
static void write_frame(struct live *live, const struct trax_picture *picture) {
  if (live->status == TRAX_OK)
    live->status = trax_picture_write(picture, live->file, &live->error);
}

void live_begin(struct live *live, const struct trax_frame *frame) {
  struct trax_picture picture;
  if (!live)
    return;
  live->frame = frame;
  live->due = 0;
  if (trax_picture_init(&picture, frame->params->width, frame->params->height, NULL) != TRAX_OK)
    return;
  draw_missing(&picture);
  write_frame(live, &picture);
  trax_picture_release(&picture);
}

void live_show(struct live *live, const void *image) {
  struct trax_picture picture = {0};
  const double begun = trax_seconds();
  if (!live || begun < live->due || trax_picture_take(&picture, live->frame, image, NULL) != TRAX_OK)
    return;
  draw_missing(&picture);
  write_frame(live, &picture);
  trax_picture_release(&picture);
  const double end = trax_seconds(), pause = (end - begun) / SHARE;
  live->due = end + (pause > LEAST_SECONDS ? pause : LEAST_SECONDS);
}

trax_status live_end(struct live *live, const struct trax_picture *picture, trax_error *error) {
  if (!live)
    return TRAX_OK;
  const struct trax_picture pixels = {.width = picture->width, .height = picture->height, .pixels = picture->pixels};
  write_frame(live, &pixels);
  return live->status == TRAX_OK ? TRAX_OK : trax_fail(error, "%s", live->error.message);
}
