/* The formatting engine of all functions like printf. */
#ifndef TRAX_RUNTIME_FORMAT_H
#define TRAX_RUNTIME_FORMAT_H

#include <stdarg.h>
#include <stddef.h>

/* The destination of characters: the standard output, or memory up to its end. */
struct sink {
  char *at, *end; /* at is NULL for the standard output */
  int count;      /* characters so far, stored or not */
};

enum {
  FLAG_LEFT = 1,   /* - */
  FLAG_PLUS = 2,   /* + */
  FLAG_SPACE = 4,  /* space */
  FLAG_ALT = 8,    /* # */
  FLAG_ZERO = 16,  /* 0 */
  FLAG_GROUP = 32, /* ': does nothing in this locale */
  FLAG_BARE = 64,  /* no 0x before a hexadecimal double; for std::to_chars alone */
};

enum length { LENGTH_CHAR, LENGTH_SHORT, LENGTH_INT, LENGTH_LONG, LENGTH_LONG_LONG };

struct conversion {
  unsigned char flags;
  char letter;          /* in lower case, if it is that of an integer or a double */
  char is_upper;        /* the letter was in upper case: so are the digits, and the x, the b or the e */
  unsigned char length; /* enum length */
  int width;            /* 0 if none */
  int precision;        /* -1 if none */
};

/* Formats one double; the conversion is one of a, e, f and g. */
typedef void double_formatter(struct sink *out, const struct conversion *how, double x);

void trax_put(struct sink *out, int c);
void trax_put_repeated(struct sink *out, int c, int count);
/* Sign, padding to the width with zeros after a prefix ("-", "0x"), or with blanks before it; body is what follows. */
void trax_put_prefix(struct sink *out, const struct conversion *how, const char *prefix, int body);
/* For FLAG_LEFT: writes blanks after the text that began when out->count was start. */
void trax_put_suffix(struct sink *out, const struct conversion *how, int start);

/* Formats the arguments and returns out->count, or -1 for a wide character that cannot be encoded. An unknown
   conversion stops the program, as does one of a double if format_double is NULL: the linker then drops the code for
   doubles. */
int trax_format(struct sink *out, const char *format, va_list arguments, double_formatter *format_double);

double_formatter trax_format_double;

/* The same to the standard output, uninterrupted by other threads. */
int trax_print(const char *format, va_list arguments, double_formatter *format_double);
/* And to memory of size bytes, the terminating 0 included; size may be 0. */
int trax_print_to(char *to, size_t size, const char *format, va_list arguments, double_formatter *format_double);

void trax_lock_output(void);
void trax_unlock_output(void);

#endif
