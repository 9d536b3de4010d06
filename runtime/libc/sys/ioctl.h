/* Devices have no operations here. */
#ifndef TRAX_SYS_IOCTL_H
#define TRAX_SYS_IOCTL_H

#include <trax/names.h>

#define TIOCGWINSZ 0x5413
struct winsize {
  unsigned short ws_row, ws_col, ws_xpixel, ws_ypixel;
};

__TRAX_FAILS(int, ioctl, (int descriptor, unsigned long request, ...), -1)

#endif
