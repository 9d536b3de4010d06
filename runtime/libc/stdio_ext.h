/* glibc's and musl's functions about the state of streams, for gnulib. */
#ifndef TRAX_STDIO_EXT_H
#define TRAX_STDIO_EXT_H

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

int __freading(FILE *stream);
int __fwriting(FILE *stream);
int __freadable(FILE *stream);
int __fwritable(FILE *stream);
int __flbf(FILE *stream);
size_t __fbufsize(FILE *stream);
size_t __fpending(FILE *stream);
void __fpurge(FILE *stream);
void __fseterr(FILE *stream);
void _flushlbf(void);

#ifdef __cplusplus
}
#endif

#endif
