/* Instead of window.c where libX11 is missing. */
#include "window.h"

trax_status window_open(struct window **window, uint32_t width, uint32_t height, trax_error *error) {
  (void)window, (void)width, (void)height;
  return trax_fail(error,
                   "--show: this trax-render was built without libX11; --progress-png FILE writes the same frames");
}

void window_close(struct window *window) {
  (void)window;
}

void window_draw(struct window *window, const struct trax_picture *picture, const char *title) {
  (void)window, (void)picture, (void)title;
}

int window_key(struct window *window) {
  (void)window;
  return 0;
}

void window_wait(struct window *window, double seconds) {
  (void)window, (void)seconds;
}
