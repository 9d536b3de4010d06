/* A picture as it arrives: in a window (--show), and as a file that is written again and again (--progress-png). All
   functions but live_create take NULL, if nobody watches, and then do nothing. */
#ifndef TRAX_RENDER_LIVE_H
#define TRAX_RENDER_LIVE_H

#include "options.h"

struct live;

/* *live is NULL if the options ask for neither. Errors: --show, and there is no display. */
trax_status live_create(struct live **live, const struct options *options, trax_error *error);
void live_destroy(struct live *live);
/* Whether what pixels cost can be shown, so that it is to be counted. */
bool live_shows_costs(const struct live *live);

/* The frame's picture begins. costs: what is counted meanwhile, or NULL; until live_end. */
void live_begin(struct live *live, const struct trax_frame *frame, const struct trax_costs *costs);
/* What the program has written so far. Pixels without alpha are not there yet and are drawn as squares of two greys.
   Frames are so far apart that they take a tenth of the time at most. A file that cannot be written is an error of
   live_end. */
void live_show(struct live *live, const void *image);
/* The whole picture: the last frame. */
trax_status live_end(struct live *live, const struct trax_picture *picture, trax_error *error);
/* Shows the last picture until its window is closed or *interrupt is set. */
void live_wait(struct live *live, const volatile int *interrupt);

#endif
