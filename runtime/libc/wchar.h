/* Wide characters: Unicode, as UTF-8 in multibyte strings. Streams of wide characters read and write UTF-8; a
   stream takes both kinds. In formats of input %n and the width of %s count bytes. */
#ifndef TRAX_WCHAR_H
#define TRAX_WCHAR_H

#define __need_size_t
#define __need_NULL
#define __need_wchar_t
#include <stddef.h>
#include <trax/names.h>

typedef __WINT_TYPE__ wint_t;
#ifndef TRAX_MBSTATE_T
#define TRAX_MBSTATE_T
typedef struct {
  unsigned __state;
} mbstate_t;
#endif

#define WEOF ((wint_t) - 1)
#ifndef WCHAR_MAX
#define WCHAR_MAX __WCHAR_MAX__
#define WCHAR_MIN (-WCHAR_MAX - 1)
#endif

#ifdef __cplusplus
extern "C" {
#endif

size_t wcslen(const wchar_t *string);
size_t wcsnlen(const wchar_t *string, size_t size);
wchar_t *wcscpy(wchar_t *__restrict to, const wchar_t *__restrict from);
wchar_t *wcsncpy(wchar_t *__restrict to, const wchar_t *__restrict from, size_t size);
wchar_t *wcscat(wchar_t *__restrict to, const wchar_t *__restrict from);
wchar_t *wcsncat(wchar_t *__restrict to, const wchar_t *__restrict from, size_t size);
int wcscmp(const wchar_t *a, const wchar_t *b);
int wcsncmp(const wchar_t *a, const wchar_t *b, size_t size);
int wcscoll(const wchar_t *a, const wchar_t *b);
wchar_t *wcschr(const wchar_t *string, wchar_t c);
wchar_t *wcsrchr(const wchar_t *string, wchar_t c);
wchar_t *wcsstr(const wchar_t *string, const wchar_t *part);
wchar_t *wcspbrk(const wchar_t *string, const wchar_t *set);
size_t wcsspn(const wchar_t *string, const wchar_t *set);
size_t wcscspn(const wchar_t *string, const wchar_t *set);
wchar_t *wcsdup(const wchar_t *string);
wchar_t *wmemcpy(wchar_t *__restrict to, const wchar_t *__restrict from, size_t size);
wchar_t *wmemmove(wchar_t *to, const wchar_t *from, size_t size);
wchar_t *wmemset(wchar_t *to, wchar_t c, size_t size);
int wmemcmp(const wchar_t *a, const wchar_t *b, size_t size);
wchar_t *wmemchr(const wchar_t *memory, wchar_t c, size_t size);
size_t wcsxfrm(wchar_t *__restrict to, const wchar_t *__restrict from, size_t size);
wchar_t *wcstok(wchar_t *__restrict string, const wchar_t *__restrict set, wchar_t **__restrict state);
float wcstof(const wchar_t *__restrict text, wchar_t **__restrict end);
double wcstod(const wchar_t *__restrict text, wchar_t **__restrict end);
long double wcstold(const wchar_t *__restrict text, wchar_t **__restrict end);
long wcstol(const wchar_t *__restrict text, wchar_t **__restrict end, int base);
unsigned long wcstoul(const wchar_t *__restrict text, wchar_t **__restrict end, int base);
long long wcstoll(const wchar_t *__restrict text, wchar_t **__restrict end, int base);
unsigned long long wcstoull(const wchar_t *__restrict text, wchar_t **__restrict end, int base);
struct tm;
size_t wcsftime(wchar_t *__restrict to, size_t size, const wchar_t *__restrict format,
                const struct tm *__restrict time);
#ifdef __TRAX_ALL_NAMES
int wcwidth(wchar_t c); /* 1, 0 for the null character, -1 for control characters */
#endif

struct trax_stream;
int fwide(struct trax_stream *stream, int mode); /* the mode */
wint_t fgetwc(struct trax_stream *stream);
wint_t getwc(struct trax_stream *stream);
wint_t getwchar(void);
wint_t ungetwc(wint_t c, struct trax_stream *stream);
wchar_t *fgetws(wchar_t *__restrict to, int size, struct trax_stream *__restrict stream);
wint_t fputwc(wchar_t c, struct trax_stream *stream);
wint_t putwc(wchar_t c, struct trax_stream *stream);
wint_t putwchar(wchar_t c);
int fputws(const wchar_t *__restrict text, struct trax_stream *__restrict stream);
int wprintf(const wchar_t *__restrict format, ...);
int vwprintf(const wchar_t *__restrict format, __builtin_va_list arguments);
int fwprintf(struct trax_stream *__restrict stream, const wchar_t *__restrict format, ...);
int vfwprintf(struct trax_stream *__restrict stream, const wchar_t *__restrict format, __builtin_va_list arguments);
int swprintf(wchar_t *__restrict to, size_t size, const wchar_t *__restrict format, ...);
int vswprintf(wchar_t *__restrict to, size_t size, const wchar_t *__restrict format, __builtin_va_list arguments);
int wscanf(const wchar_t *__restrict format, ...);
int vwscanf(const wchar_t *__restrict format, __builtin_va_list arguments);
int fwscanf(struct trax_stream *__restrict stream, const wchar_t *__restrict format, ...);
int vfwscanf(struct trax_stream *__restrict stream, const wchar_t *__restrict format, __builtin_va_list arguments);
int swscanf(const wchar_t *__restrict text, const wchar_t *__restrict format, ...);
int vswscanf(const wchar_t *__restrict text, const wchar_t *__restrict format, __builtin_va_list arguments);

wint_t btowc(int c);
int wctob(wint_t c);
int mbsinit(const mbstate_t *state);
size_t mbrlen(const char *__restrict bytes, size_t count, mbstate_t *__restrict state);
size_t mbrtowc(wchar_t *__restrict c, const char *__restrict bytes, size_t count, mbstate_t *__restrict state);
size_t wcrtomb(char *__restrict bytes, wchar_t c, mbstate_t *__restrict state);
size_t mbsrtowcs(wchar_t *__restrict to, const char **__restrict from, size_t count, mbstate_t *__restrict state);
size_t wcsrtombs(char *__restrict to, const wchar_t **__restrict from, size_t count, mbstate_t *__restrict state);

#ifdef __cplusplus
}
#endif

#endif
