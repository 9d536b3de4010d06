/* Formatted output of the C library. There is one stream, the host's standard output; stderr goes there too. A call's
   text is not interleaved with other threads' calls. Each function named like its standard twin with an i in front is
   the same but for the floating-point conversions, and brings none of their code into the program. */
#ifndef TRAX_STDIO_H
#define TRAX_STDIO_H

#define __need_size_t
#define __need_NULL
#include <stddef.h>

#define EOF (-1)

#ifdef __cplusplus
extern "C" {
#endif

typedef struct trax_stream FILE;
#define stdout ((FILE *)1)
#define stderr ((FILE *)2)

#define __TRAX_PRINTF(text, first) __attribute__((__format__(__printf__, text, first)))

int printf(const char *__restrict format, ...) __TRAX_PRINTF(1, 2);
int vprintf(const char *__restrict format, __builtin_va_list arguments) __TRAX_PRINTF(1, 0);
int fprintf(FILE *__restrict stream, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int vfprintf(FILE *__restrict stream, const char *__restrict format, __builtin_va_list arguments) __TRAX_PRINTF(2, 0);
int sprintf(char *__restrict to, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int vsprintf(char *__restrict to, const char *__restrict format, __builtin_va_list arguments) __TRAX_PRINTF(2, 0);
int snprintf(char *__restrict to, size_t size, const char *__restrict format, ...) __TRAX_PRINTF(3, 4);
int vsnprintf(char *__restrict to, size_t size, const char *__restrict format, __builtin_va_list arguments)
    __TRAX_PRINTF(3, 0);

int iprintf(const char *__restrict format, ...) __TRAX_PRINTF(1, 2);
int fiprintf(FILE *__restrict stream, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int siprintf(char *__restrict to, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int sniprintf(char *__restrict to, size_t size, const char *__restrict format, ...) __TRAX_PRINTF(3, 4);

int putchar(int c);
int putc(int c, FILE *stream);
int fputc(int c, FILE *stream);
int puts(const char *string);
int fputs(const char *__restrict string, FILE *__restrict stream);
size_t fwrite(const void *__restrict memory, size_t size, size_t count, FILE *__restrict stream);
void perror(const char *text);
int fflush(FILE *stream);     /* nothing is ever held back */
int remove(const char *path); /* there are no files: fails */

#ifdef __cplusplus
}
#endif

#endif
