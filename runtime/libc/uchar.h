/* C's Unicode characters: UTF-16 and UTF-32, from UTF-8 and back. */
#ifndef TRAX_UCHAR_H
#define TRAX_UCHAR_H

#define __need_size_t
#include <stddef.h>

#ifndef TRAX_MBSTATE_T
#define TRAX_MBSTATE_T
typedef struct {
  unsigned __state;
} mbstate_t;
#endif

#ifndef __cplusplus
typedef __CHAR16_TYPE__ char16_t;
typedef __CHAR32_TYPE__ char32_t;
#endif

#ifdef __cplusplus
extern "C" {
#endif

size_t mbrtoc16(char16_t *__restrict c, const char *__restrict bytes, size_t count, mbstate_t *__restrict state);
size_t c16rtomb(char *__restrict bytes, char16_t c, mbstate_t *__restrict state);
size_t mbrtoc32(char32_t *__restrict c, const char *__restrict bytes, size_t count, mbstate_t *__restrict state);
size_t c32rtomb(char *__restrict bytes, char32_t c, mbstate_t *__restrict state);

#ifdef __cplusplus
}
#endif

#endif
