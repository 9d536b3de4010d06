/* Formatted output of wide characters, for the functions of streams. */
#ifndef TRAX_RUNTIME_WIDE_FORMAT_H
#define TRAX_RUNTIME_WIDE_FORMAT_H

#include <stdarg.h>
#include <stddef.h>

/* Formats to UTF-8 in memory from malloc. *count receives the bytes, or -1 with the result NULL. */
char *__trax_format_wide(const char *format, va_list arguments, int *count);
/* The characters of a text in UTF-8, which may have null characters. */
size_t __trax_characters(const char *bytes, size_t count);

#endif
