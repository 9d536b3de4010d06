/* Messages on standard error, after the program's name. */
#ifndef TRAX_ERR_H
#define TRAX_ERR_H

#include <stdarg.h>

#ifdef __cplusplus
extern "C" {
#endif

#define __TRAX_PRINTF_AT(text, first) __attribute__((__format__(__printf__, text, first)))
void warn(const char *format, ...) __TRAX_PRINTF_AT(1, 2); /* with the text of errno */
void warnx(const char *format, ...) __TRAX_PRINTF_AT(1, 2);
void vwarn(const char *format, va_list arguments) __TRAX_PRINTF_AT(1, 0);
void vwarnx(const char *format, va_list arguments) __TRAX_PRINTF_AT(1, 0);
__attribute__((noreturn)) void err(int status, const char *format, ...) __TRAX_PRINTF_AT(2, 3);
__attribute__((noreturn)) void errx(int status, const char *format, ...) __TRAX_PRINTF_AT(2, 3);
__attribute__((noreturn)) void verr(int status, const char *format, va_list arguments) __TRAX_PRINTF_AT(2, 0);
__attribute__((noreturn)) void verrx(int status, const char *format, va_list arguments) __TRAX_PRINTF_AT(2, 0);
#undef __TRAX_PRINTF_AT

#ifdef __cplusplus
}
#endif

#endif
