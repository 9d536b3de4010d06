/* A picture as it arrives, in a file that is written again and again (--progress-png). All functions but live_create
   accept NULL, and then do nothing. */
#ifndef TRAX_RENDER_LIVE_H
#define TRAX_RENDER_LIVE_H

#include "options.h"

struct live;

/* *live is NULL without --progress-png. */
trax_status live_create(struct live **live, const struct options *options, trax_error *error);
void live_destroy(struct live *live);

/* The frame's picture begins. */
void live_begin(struct live *live, const struct trax_frame *frame);
/* image: the device program's buffer so far. Missing pixels have an alpha of 0, and are drawn as squares of two greys.
   Frames take at most a tenth of the time. A file that cannot be written is an error of live_end. */
void live_show(struct live *live, const void *image);
/* The whole picture: the last frame. */
trax_status live_end(struct live *live, const struct trax_picture *picture, trax_error *error);

#endif
