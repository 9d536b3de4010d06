/* Types of C's Unicode characters; the functions that convert between them do not exist. */
#ifndef TRAX_UCHAR_H
#define TRAX_UCHAR_H

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

#endif
