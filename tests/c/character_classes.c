// RUN: %run_c %s %t --turns -O0,-O2
// <ctype.h> for every character of ASCII and EOF.
#include <ctype.h>
#include <stdio.h>

static int (*const classes[])(int) = {isalnum, isalpha, isblank, iscntrl, isdigit, isgraph,
                                      islower, isprint, ispunct, isspace, isupper, isxdigit};

int main(void) {
  for (int c = EOF; c < 128; c++) {
    unsigned member = 0;
    for (unsigned i = 0; i < sizeof classes / sizeof classes[0]; i++)
      member |= (unsigned)!!classes[i](c) << i;
    printf("%03x %02x%02x%s", member, (unsigned char)tolower(c), (unsigned char)toupper(c), c % 8 == 7 ? "\n" : " ");
  }
  return 0;
}
