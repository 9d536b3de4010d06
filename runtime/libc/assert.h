/* assert: a false one stops the machine with a fault report that shows the text and the place. Includable several
 * times. */
#undef assert
#ifdef NDEBUG
#define assert(condition) ((void)0)
#else
#define __TRAX_ASSERT_TEXT(x) #x
#define __TRAX_ASSERT_LINE(x) __TRAX_ASSERT_TEXT(x)
/* The message is put together at compile time: nothing is formatted when it fails. */
#define assert(condition)                                                                                              \
  ((condition) ? (void)0                                                                                               \
               : __trax_assert_fail(__FILE__ ":" __TRAX_ASSERT_LINE(__LINE__) ": assertion failed: " #condition))
#endif

#ifndef TRAX_ASSERT_H
#define TRAX_ASSERT_H

#ifdef __cplusplus
extern "C" {
#endif
__attribute__((noreturn)) void __trax_assert_fail(const char *message);

#ifdef __cplusplus
}
#endif

#if !defined(__cplusplus) && __STDC_VERSION__ < 202311L
#define static_assert _Static_assert
#endif

#endif
