// The function of long double called NAMEl, which is that of double: both types are binary64. Assembled once for each NAME.

#define PASTE(a, b) a##b
#define LONG(name) PASTE(name, l)
#define QUOTE(x) #x
#define SECTION(name) QUOTE(.text.name)

  .section SECTION(LONG(NAME)), "ax", @progbits
  .globl LONG(NAME)
  .type LONG(NAME), @function
LONG(NAME):
  jal r0, NAME
  .size LONG(NAME), . - LONG(NAME)
