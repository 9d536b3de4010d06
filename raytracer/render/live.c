#include "live.h"

#include "trax/progress.h"
#include "window.h"

#include <stdlib.h>
#include <string.h>

#define LEAST_SECONDS 0.1 /* between two frames */
#define SHARE 0.1         /* of the time, for frames */

struct live {
  struct window *window; /* NULL: there is none, or it was closed */
  const char *file;      /* NULL: none is wanted */
  const struct trax_frame *frame;
  const struct trax_costs *costs; /* of the picture that arrives */
  struct trax_picture picture, cost_picture;
  bool shows_cost; /* instead of the picture */
  double due;      /* when the next frame is, of trax_seconds */
  trax_status status;
  trax_error error;
};

trax_status live_create(struct live **made, const struct options *options, trax_error *error) {
  *made = NULL;
  if (!options->show && !options->progress_png)
    return TRAX_OK;
  struct live *live = calloc(1, sizeof *live);
  if (!live)
    return trax_fail(error, "out of memory");
  live->file = options->progress_png;
  if (options->show && window_open(&live->window, options->frame.width, options->frame.height, error) != TRAX_OK) {
    free(live);
    return TRAX_ERROR;
  }
  *made = live;
  return TRAX_OK;
}

void live_destroy(struct live *live) {
  if (!live)
    return;
  window_close(live->window);
  trax_picture_release(&live->picture);
  trax_picture_release(&live->cost_picture);
  free(live);
}

bool live_shows_costs(const struct live *live) {
  return live && live->window;
}

/* --- frames --- */

/* What is not there yet. */
static void draw_missing(struct trax_picture *picture) {
  enum { SQUARE = 8 };
  for (uint32_t y = 0; y < picture->height; y++)
    for (uint32_t x = 0; x < picture->width; x++) {
      uint32_t *pixel = &picture->pixels[(size_t)y * picture->width + x];
      if (*pixel >> 24 == 0)
        *pixel = (x / SQUARE + y / SQUARE) % 2 ? 0xFF505050u : 0xFF404040u;
    }
}

static void paint_costs(struct live *live) {
  struct trax_cost_summary summary;
  trax_picture_release(&live->cost_picture);
  if (live->costs && trax_costs_summarise(live->costs, &summary, NULL) == TRAX_OK)
    trax_costs_paint(live->costs, &summary, &live->cost_picture, NULL);
}

static void draw(struct live *live) {
  if (!live->window || !live->picture.pixels)
    return;
  const bool cost = live->shows_cost && live->cost_picture.pixels;
  window_draw(live->window, cost ? &live->cost_picture : &live->picture,
              cost               ? "trax-render: cost (c: picture, q: close)"
              : live->shows_cost ? "trax-render: no costs are known of this run (c: picture, q: close)"
                                 : "trax-render: picture (c: cost, q: close)");
}

static void take_keys(struct live *live) {
  for (int key; live->window && (key = window_key(live->window));) {
    if (key == 'c') {
      live->shows_cost = !live->shows_cost;
      if (live->shows_cost && live->costs)
        paint_costs(live);
      draw(live);
    } else if (key == WINDOW_EXPOSED) {
      draw(live);
    } else if (key == 'q') {
      window_close(live->window);
      live->window = NULL;
    }
  }
}

/* The file is of no more use than the picture, so that a failure does not end the run before its end. */
static void write_frame(struct live *live) {
  draw(live);
  if (live->file && live->status == TRAX_OK)
    live->status = trax_picture_write(&live->picture, live->file, &live->error);
}

void live_begin(struct live *live, const struct trax_frame *frame, const struct trax_costs *costs) {
  if (!live)
    return;
  live->frame = frame;
  live->costs = costs;
  live->due = 0;
  trax_picture_release(&live->picture);
  if (trax_picture_init(&live->picture, frame->params->width, frame->params->height, NULL) != TRAX_OK)
    return;
  draw_missing(&live->picture);
  write_frame(live);
}

void live_show(struct live *live, const void *image) {
  if (!live)
    return;
  take_keys(live);
  const double begun = trax_seconds();
  if (begun < live->due || (!live->window && !live->file))
    return;
  trax_picture_release(&live->picture);
  if (trax_picture_take(&live->picture, live->frame, image, NULL) != TRAX_OK)
    return;
  draw_missing(&live->picture);
  if (live->shows_cost)
    paint_costs(live);
  write_frame(live);
  const double end = trax_seconds(), pause = (end - begun) / SHARE;
  live->due = end + (pause > LEAST_SECONDS ? pause : LEAST_SECONDS);
}

trax_status live_end(struct live *live, const struct trax_picture *picture, trax_error *error) {
  if (!live)
    return TRAX_OK;
  paint_costs(live);
  live->costs = NULL;
  trax_picture_release(&live->picture);
  if (trax_picture_init(&live->picture, picture->width, picture->height, error) != TRAX_OK)
    return TRAX_ERROR;
  memcpy(live->picture.pixels, picture->pixels, (size_t)picture->width * picture->height * sizeof *picture->pixels);
  write_frame(live);
  return live->status == TRAX_OK ? TRAX_OK : trax_fail(error, "%s", live->error.message);
}

void live_wait(struct live *live, const volatile int *interrupt) {
  while (live && live->window && !*interrupt) {
    window_wait(live->window, 0.1);
    take_keys(live);
  }
}
