/* Streams of the C library. Text for stdout goes to the host at once. A call's text is not interleaved with other
   threads' calls. Files are those below the folders that the user allowed (docs/porting.md). A function with an i
   before the standard name lacks the floating-point conversions, and brings none of their code into the program. */
#ifndef TRAX_STDIO_H
#define TRAX_STDIO_H

#define __need_size_t
#define __need_NULL
#include <stddef.h>
#include <trax/names.h>
#ifdef __TRAX_ALL_NAMES
#include <sys/types.h>
#endif

#define EOF (-1)
#define BUFSIZ 4096
#define FILENAME_MAX 4096
#define FOPEN_MAX 256
#define L_tmpnam 1
#define TMP_MAX 0
#define SEEK_SET 0
#define SEEK_CUR 1
#define SEEK_END 2
#define _IOFBF 0
#define _IOLBF 1
#define _IONBF 2

#ifdef __cplusplus
extern "C" {
#endif

typedef struct trax_stream FILE;
#ifndef TRAX_RUNTIME_STREAM_H
struct trax_stream { /* its members are private (stdio/stream.h) */
  int __words[13];
};
#endif
typedef long long fpos_t;
extern struct trax_stream __trax_stdin, __trax_stderr;
#define stdin (&__trax_stdin)
#define stdout ((FILE *)1)
#define stderr (&__trax_stderr)

#define __TRAX_PRINTF(text, first) __attribute__((__format__(__printf__, text, first)))
#define __TRAX_SCANF(text, first) __attribute__((__format__(__scanf__, text, first)))

int printf(const char *__restrict format, ...) __TRAX_PRINTF(1, 2);
int vprintf(const char *__restrict format, __builtin_va_list arguments) __TRAX_PRINTF(1, 0);
int fprintf(FILE *__restrict stream, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int vfprintf(FILE *__restrict stream, const char *__restrict format, __builtin_va_list arguments) __TRAX_PRINTF(2, 0);
int sprintf(char *__restrict to, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int vsprintf(char *__restrict to, const char *__restrict format, __builtin_va_list arguments) __TRAX_PRINTF(2, 0);
int snprintf(char *__restrict to, size_t size, const char *__restrict format, ...) __TRAX_PRINTF(3, 4);
int vsnprintf(char *__restrict to, size_t size, const char *__restrict format, __builtin_va_list arguments)
    __TRAX_PRINTF(3, 0);

#ifdef __TRAX_ALL_NAMES
int iprintf(const char *__restrict format, ...) __TRAX_PRINTF(1, 2);
int fiprintf(FILE *__restrict stream, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int siprintf(char *__restrict to, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int sniprintf(char *__restrict to, size_t size, const char *__restrict format, ...) __TRAX_PRINTF(3, 4);
#endif

int putchar(int c);
int putc(int c, FILE *stream);
int fputc(int c, FILE *stream);
int puts(const char *string);
int fputs(const char *__restrict string, FILE *__restrict stream);
size_t fwrite(const void *__restrict memory, size_t size, size_t count, FILE *__restrict stream);
void perror(const char *text);

/* Mode "r", "w" or "a", with "+", "b" and "x". setvbuf sets when text is written; the buffer is the library's. */
FILE *fopen(const char *__restrict path, const char *__restrict mode);
FILE *freopen(const char *__restrict path, const char *__restrict mode, FILE *__restrict stream);
#ifdef __TRAX_ALL_NAMES
FILE *fdopen(int descriptor, const char *mode);
int fileno(FILE *stream);
#endif
int fclose(FILE *stream);
int fflush(FILE *stream);
int setvbuf(FILE *__restrict stream, char *__restrict buffer, int mode, size_t size);
void setbuf(FILE *__restrict stream, char *__restrict buffer);
#ifdef __TRAX_ALL_NAMES
void setbuffer(FILE *stream, char *buffer, size_t size);
void setlinebuf(FILE *stream);
#endif

int fgetc(FILE *stream);
int getc(FILE *stream);
int getchar(void);
#ifdef __TRAX_ALL_NAMES
int getc_unlocked(FILE *stream);
int getchar_unlocked(void);
#endif
int ungetc(int c, FILE *stream);
char *fgets(char *__restrict to, int size, FILE *__restrict stream);
size_t fread(void *__restrict memory, size_t size, size_t count, FILE *__restrict stream);
#ifdef __TRAX_ALL_NAMES
ssize_t getline(char **__restrict line, size_t *__restrict capacity, FILE *__restrict stream);
ssize_t getdelim(char **__restrict line, size_t *__restrict capacity, int last, FILE *__restrict stream);
#define putc_unlocked putc
#define putchar_unlocked putchar
#endif

int scanf(const char *__restrict format, ...) __TRAX_SCANF(1, 2);
int vscanf(const char *__restrict format, __builtin_va_list arguments) __TRAX_SCANF(1, 0);
int fscanf(FILE *__restrict stream, const char *__restrict format, ...) __TRAX_SCANF(2, 3);
int vfscanf(FILE *__restrict stream, const char *__restrict format, __builtin_va_list arguments) __TRAX_SCANF(2, 0);
int sscanf(const char *__restrict text, const char *__restrict format, ...) __TRAX_SCANF(2, 3);
int vsscanf(const char *__restrict text, const char *__restrict format, __builtin_va_list arguments) __TRAX_SCANF(2, 0);

#ifdef __TRAX_ALL_NAMES
int asprintf(char **__restrict to, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int vasprintf(char **__restrict to, const char *__restrict format, __builtin_va_list arguments) __TRAX_PRINTF(2, 0);
int dprintf(int descriptor, const char *__restrict format, ...) __TRAX_PRINTF(2, 3);
int vdprintf(int descriptor, const char *__restrict format, __builtin_va_list arguments) __TRAX_PRINTF(2, 0);
#endif

int fseek(FILE *stream, long offset, int origin);
long ftell(FILE *stream);
#ifdef __TRAX_ALL_NAMES
int fseeko(FILE *stream, off_t offset, int origin);
off_t ftello(FILE *stream);
#endif
void rewind(FILE *stream);
int fgetpos(FILE *__restrict stream, fpos_t *__restrict position);
int fsetpos(FILE *stream, const fpos_t *position);
int feof(FILE *stream);
int ferror(FILE *stream);
void clearerr(FILE *stream);

int remove(const char *path);
int rename(const char *from, const char *to);
FILE *tmpfile(void);      /* fails: there is no folder for temporary files */
char *tmpnam(char *name); /* fails */
#ifdef __TRAX_ALL_NAMES
int renameat(int folder, const char *from, int to_folder, const char *to);
/* Not here: the use of the last two is an error. */
__TRAX_REFUSES(FILE *, popen, (const char *command, const char *mode), 0, "there are no processes")
__TRAX_FAILS(int, pclose, (FILE * stream), -1)
FILE *fmemopen(void *memory, size_t size, const char *mode)
    __attribute__((unavailable("a stream is a file; use sscanf and snprintf")));
FILE *open_memstream(char **to, size_t *size)
    __attribute__((unavailable("a stream is a file; use asprintf, or snprintf and realloc")));
#endif

#ifdef __cplusplus
}
#endif

#endif
