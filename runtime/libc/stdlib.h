/* The C library's standard library functions. */
#ifndef TRAX_STDLIB_H
#define TRAX_STDLIB_H

#define __need_size_t
#define __need_NULL
#define __need_wchar_t
#include <stddef.h>

#include <trax/names.h>
#ifdef __TRAX_ALL_NAMES
#include <alloca.h>
#endif

#define EXIT_SUCCESS 0
#define EXIT_FAILURE 1
#define RAND_MAX 0x7FFFFFFF

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  int quot, rem;
} div_t;
typedef struct {
  long quot, rem;
} ldiv_t;
typedef struct {
  long long quot, rem;
} lldiv_t;

int abs(int x);
long labs(long x);
long long llabs(long long x);
div_t div(int n, int d);
ldiv_t ldiv(long n, long d);
lldiv_t lldiv(long long n, long long d);

/* exit ends the calling thread with a status; the others go on (docs/isa.md, "Traps"). abort stops the
 * machine. */
__attribute__((noreturn)) void exit(int status);
__attribute__((noreturn)) void _Exit(int status);
__attribute__((noreturn)) void abort(void);
/* The function runs once, on the last thread to return from main or to call exit, the latest given first. 0 if it will.
 */
int atexit(void (*function)(void));
/* Ends the thread as _Exit does, after the functions of at_quick_exit, at most 32. */
__attribute__((noreturn)) void quick_exit(int status);
int at_quick_exit(void (*function)(void));

/* Correctly rounded. ERANGE where the result is infinite, subnormal or, from another number, 0. */
double strtod(const char *__restrict text, char **__restrict end);
float strtof(const char *__restrict text, char **__restrict end);
long double strtold(const char *__restrict text, char **__restrict end);
double atof(const char *text);
int atoi(const char *text);
long atol(const char *text);
long long atoll(const char *text);
long strtol(const char *__restrict text, char **__restrict end, int base);
unsigned long strtoul(const char *__restrict text, char **__restrict end, int base);
long long strtoll(const char *__restrict text, char **__restrict end, int base);
unsigned long long strtoull(const char *__restrict text, char **__restrict end, int base);

/* Not stable; in place, without recursion, in about 2 n log2 n comparisons for any order (heapsort). */
void qsort(void *base, size_t count, size_t size, int (*compare)(const void *, const void *));
void *bsearch(const void *key, const void *base, size_t count, size_t size, int (*compare)(const void *, const void *));

/* Memory from the heap, which follows the program; shared by all threads, aligned to 16 bytes. NULL if none is left. */
void *malloc(size_t size);
void *calloc(size_t count, size_t size);
void *realloc(void *memory, size_t size);
void *aligned_alloc(size_t alignment, size_t size);
void free(void *memory);

/* Each thread has a sequence of its own. */
int rand(void);
void srand(unsigned seed);
#ifdef __TRAX_ALL_NAMES
int rand_r(unsigned *seed);
#endif

/* Multibyte characters are those of UTF-8. */
#define MB_CUR_MAX ((size_t)4)

int mblen(const char *bytes, size_t count);
int mbtowc(wchar_t *__restrict c, const char *__restrict bytes, size_t count);
int wctomb(char *bytes, wchar_t c);
size_t mbstowcs(wchar_t *__restrict to, const char *__restrict from, size_t count);
size_t wcstombs(char *__restrict to, const wchar_t *__restrict from, size_t count);

/* The environment is empty at the start. */
char *getenv(const char *name);
int system(const char *command); /* 0 for NULL: there is no command processor */

#ifdef __TRAX_ALL_NAMES
/* glibc's numbers; one sequence for all threads. */
long random(void);
void srandom(unsigned seed);
/* The sequences that POSIX specifies. */
double drand48(void);
double erand48(unsigned short state[3]);
long lrand48(void);
long nrand48(unsigned short state[3]);
long mrand48(void);
long jrand48(unsigned short state[3]);
void srand48(long seed);
unsigned short *seed48(unsigned short state[3]);

void qsort_r(void *base, size_t count, size_t size, int (*compare)(const void *, const void *, void *), void *context);
int posix_memalign(void **memory, size_t alignment, size_t size);
void *reallocarray(void *memory, size_t count, size_t size);

const char *getprogname(void); /* "program" if main has no parameters */

int setenv(const char *name, const char *value, int overwrite);
int unsetenv(const char *name);
int putenv(char *text);
int clearenv(void);
char *realpath(const char *__restrict path, char *__restrict resolved); /* the path as it is, if there is such a file */
int mkstemp(char *pattern);
char *mkdtemp(char *pattern);
#endif

#ifdef __cplusplus
}
#endif

#ifdef __TRAX_ALL_NAMES
#include <malloc.h> /* as on Android: QuickJS takes malloc_usable_size from here */
#endif

#endif
