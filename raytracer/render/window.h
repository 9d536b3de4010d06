/* A window of the X Window System that shows a picture. A build without libX11 has one that does not open. */
#ifndef TRAX_RENDER_WINDOW_H
#define TRAX_RENDER_WINDOW_H

#include "render.h"

struct window;

enum { WINDOW_EXPOSED = 1 }; /* what is shown must be drawn again */

/* For pictures of this size, which are drawn as large as the screen has room, by a whole factor or divisor. */
trax_status window_open(struct window **window, uint32_t width, uint32_t height, trax_error *error);
void window_close(struct window *window); /* or NULL */
void window_draw(struct window *window, const struct trax_picture *picture, const char *title);
/* The next key that was pressed, in lower case, with 'q' for Escape and for a window that was closed, or
   WINDOW_EXPOSED; 0: nothing has happened. */
int window_key(struct window *window);
/* Until something has happened, or the time is over. */
void window_wait(struct window *window, double seconds);

#endif
