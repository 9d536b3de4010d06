/* Terminals have no modes here. */
#ifndef TRAX_TERMIOS_H
#define TRAX_TERMIOS_H

#include <trax/names.h>

typedef unsigned tcflag_t, speed_t;
typedef unsigned char cc_t;
struct termios {
  tcflag_t c_iflag, c_oflag, c_cflag, c_lflag;
  cc_t c_cc[32];
};
enum { IGNBRK = 1, BRKINT = 2, PARMRK = 8, ISTRIP = 32, INLCR = 64, IGNCR = 128, ICRNL = 256, IXON = 1024 };
enum { OPOST = 1, CSIZE = 48, CS8 = 48, PARENB = 256 };
enum { ISIG = 1, ICANON = 2, ECHO = 8, ECHONL = 64, IEXTEN = 32768 };
enum { VTIME = 5, VMIN = 6, TCSANOW = 0, TCSADRAIN = 1, TCSAFLUSH = 2 };

__TRAX_FAILS(int, tcgetattr, (int descriptor, struct termios *modes), -1)
__TRAX_FAILS(int, tcsetattr, (int descriptor, int when, const struct termios *modes), -1)

#endif
