#include "window.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

struct window {
  Display *display;
  Window window;
  GC gc;
  Visual *visual;
  int depth;
  Atom closing, protocols;
  uint32_t width, height;  /* of the window */
  uint32_t times, divisor; /* one of them is 1 */
  uint32_t *pixels;
  bool gone; /* the display is no longer there */
};

/* Without it a display that goes away would end the program, and its run. */
static void display_gone(Display *display, void *window) {
  (void)display;
  ((struct window *)window)->gone = true;
}

static int say_nothing(Display *display) {
  (void)display;
  return 0;
}

/* The largest factor, or the smallest divisor, with which the picture takes nine tenths of the screen at most. */
static void choose_size(struct window *window, uint32_t width, uint32_t height, uint32_t room_x, uint32_t room_y) {
  enum { MOST_TIMES = 8 };
  window->times = window->divisor = 1;
  while (window->times < MOST_TIMES && width * (window->times + 1) <= room_x && height * (window->times + 1) <= room_y)
    window->times++;
  while (window->times == 1 && (width / window->divisor > room_x || height / window->divisor > room_y))
    window->divisor++;
  window->width = width * window->times / window->divisor;
  window->height = height * window->times / window->divisor;
  window->width += window->width == 0;
  window->height += window->height == 0;
}

trax_status window_open(struct window **made, uint32_t width, uint32_t height, trax_error *error) {
  struct window *window = calloc(1, sizeof *window);
  if (!window)
    return trax_fail(error, "out of memory");
  window->display = XOpenDisplay(NULL);
  if (!window->display) {
    free(window);
    const char *name = getenv("DISPLAY");
    return trax_fail(error, "--show: %s%s; --progress-png FILE writes the same frames",
                     name ? "cannot open the display " : "there is no display (DISPLAY is not set)", name ? name : "");
  }
  const int screen = DefaultScreen(window->display);
  window->visual = DefaultVisual(window->display, screen);
  window->depth = DefaultDepth(window->display, screen);
  choose_size(window, width, height, (uint32_t)DisplayWidth(window->display, screen) * 9 / 10,
              (uint32_t)DisplayHeight(window->display, screen) * 9 / 10);
  window->pixels = calloc((size_t)window->width * window->height, sizeof *window->pixels);
  if (!window->pixels || window->depth < 24) {
    const bool shallow = window->pixels != NULL;
    window_close(window);
    return shallow ? trax_fail(error, "--show: the display has less than 24 bits a pixel")
                   : trax_fail(error, "out of memory");
  }
  XSetIOErrorHandler(say_nothing);
  XSetIOErrorExitHandler(window->display, display_gone, window);
  window->window = XCreateSimpleWindow(window->display, RootWindow(window->display, screen), 0, 0, window->width,
                                       window->height, 0, 0, BlackPixel(window->display, screen));
  window->gc = XCreateGC(window->display, window->window, 0, NULL);
  window->closing = XInternAtom(window->display, "WM_DELETE_WINDOW", False);
  window->protocols = XInternAtom(window->display, "WM_PROTOCOLS", False);
  XSetWMProtocols(window->display, window->window, &window->closing, 1);
  XSizeHints hints = {.flags = PMinSize | PMaxSize,
                      .min_width = (int)window->width,
                      .max_width = (int)window->width,
                      .min_height = (int)window->height,
                      .max_height = (int)window->height};
  XSetWMNormalHints(window->display, window->window, &hints);
  XStoreName(window->display, window->window, "trax-render");
  XSelectInput(window->display, window->window, ExposureMask | KeyPressMask);
  XMapWindow(window->display, window->window);
  XFlush(window->display);
  *made = window;
  return TRAX_OK;
}

void window_close(struct window *window) {
  if (!window)
    return;
  if (!window->gone && window->window)
    XDestroyWindow(window->display, window->window);
  if (!window->gone)
    XCloseDisplay(window->display);
  free(window->pixels);
  free(window);
}

/* A channel of 8 bits, where the screen has it and with as many bits: 255 is the brightest. */
static uint32_t put_channel(uint32_t value, unsigned long mask) {
  if (!mask)
    return 0;
  const unsigned long lowest = mask & -mask, most = mask / lowest;
  return (uint32_t)((value * most + 127) / 255 * lowest);
}

void window_draw(struct window *window, const struct trax_picture *picture, const char *title) {
  if (window->gone)
    return;
  for (uint32_t y = 0; y < window->height; y++)
    for (uint32_t x = 0; x < window->width; x++) {
      const uint32_t from_x = x / window->times * window->divisor, from_y = y / window->times * window->divisor;
      const uint32_t pixel = picture->pixels[(size_t)from_y * picture->width + from_x];
      window->pixels[(size_t)y * window->width + x] = put_channel(pixel & 255, window->visual->red_mask) |
                                                      put_channel(pixel >> 8 & 255, window->visual->green_mask) |
                                                      put_channel(pixel >> 16 & 255, window->visual->blue_mask);
    }
  XImage *image = XCreateImage(window->display, window->visual, (unsigned)window->depth, ZPixmap, 0,
                               (char *)window->pixels, window->width, window->height, 32, 0);
  if (image) {
    const uint16_t one = 1;
    image->byte_order = *(const uint8_t *)&one ? LSBFirst : MSBFirst; /* as it lies in memory here */
    XPutImage(window->display, window->window, window->gc, image, 0, 0, 0, 0, window->width, window->height);
    image->data = NULL; /* it is the window's */
    XDestroyImage(image);
  }
  XStoreName(window->display, window->window, title);
  XFlush(window->display);
}

int window_key(struct window *window) {
  while (!window->gone && XPending(window->display) > 0) {
    XEvent event;
    XNextEvent(window->display, &event);
    if (event.type == Expose && event.xexpose.count == 0)
      return WINDOW_EXPOSED;
    if (event.type == ClientMessage && event.xclient.message_type == window->protocols &&
        (Atom)event.xclient.data.l[0] == window->closing)
      return 'q';
    if (event.type == KeyPress) {
      const KeySym symbol = XLookupKeysym(&event.xkey, 0);
      if (symbol == XK_Escape)
        return 'q';
      if (symbol >= XK_a && symbol <= XK_z)
        return (int)(symbol - XK_a) + 'a';
    }
  }
  return window->gone ? 'q' : 0;
}

void window_wait(struct window *window, double seconds) {
  struct pollfd display = {.fd = window->gone ? -1 : ConnectionNumber(window->display), .events = POLLIN};
  if (window->gone || XPending(window->display) == 0)
    poll(&display, 1, (int)(1000 * seconds));
}
