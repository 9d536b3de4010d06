/* What a user does with the window of trax-render --show: window_client grab FILE.ppm | key LETTER | title.

   All wait for a window whose title begins with "trax-render: ". Status 1: there is none within a minute. */
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Window find_window(Display *display, char **title) {
  Window root, parent, *children, found = 0;
  unsigned count;
  if (!XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count))
    return 0;
  for (unsigned i = 0; i < count && !found; i++)
    if (XFetchName(display, children[i], title) && strncmp(*title, "trax-render: ", 13) == 0)
      found = children[i];
  XFree(children);
  return found;
}

/* A channel in 8 bits, 255 the brightest, however many the screen has. */
static unsigned char channel(unsigned long pixel, unsigned long mask) {
  const unsigned long lowest = mask & -mask, most = mask / lowest;
  return (unsigned char)(((pixel & mask) / lowest * 255 + most / 2) / most);
}

static int grab(Display *display, Window window, const char *path) {
  XWindowAttributes size;
  XGetWindowAttributes(display, window, &size);
  XImage *image = XGetImage(display, window, 0, 0, (unsigned)size.width, (unsigned)size.height, AllPlanes, ZPixmap);
  FILE *file = fopen(path, "wb");
  if (!image || !file)
    return 1;
  fprintf(file, "P6\n%d %d\n255\n", size.width, size.height);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const unsigned long pixel = XGetPixel(image, x, y);
      const unsigned char rgb[3] = {channel(pixel, image->red_mask), channel(pixel, image->green_mask),
                                    channel(pixel, image->blue_mask)};
      fwrite(rgb, 3, 1, file);
    }
  XDestroyImage(image);
  return fclose(file) != 0;
}

static int press(Display *display, Window window, KeySym key) {
  XKeyEvent event = {.type = KeyPress,
                     .display = display,
                     .window = window,
                     .root = DefaultRootWindow(display),
                     .same_screen = True,
                     .keycode = XKeysymToKeycode(display, key)};
  return !XSendEvent(display, window, True, KeyPressMask, (XEvent *)&event) || !XSync(display, False);
}

static int ignore(Display *display, XErrorEvent *event) {
  (void)display, (void)event; /* a window that was closed meanwhile */
  return 0;
}

int main(int count, char **arguments) {
  Display *display = XOpenDisplay(NULL);
  char *title = NULL;
  Window window = 0;
  if (!display || count < 2)
    return 1;
  XSetErrorHandler(ignore);
  for (int i = 0; i < 600 && !(window = find_window(display, &title)); i++)
    usleep(100000);
  if (!window)
    return 1;
  if (strcmp(arguments[1], "grab") == 0 && count > 2)
    return grab(display, window, arguments[2]);
  if (strcmp(arguments[1], "key") == 0 && count > 2)
    return press(display, window, (KeySym)arguments[2][0]);
  puts(title);
  return 0;
}
