/* The C library's memory, string, number, heap and formatting functions, compiled for the host, against the host's own.
 */
#define _GNU_SOURCE /* memmem, memrchr, mempcpy */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <ctype.h>
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#include "host.h"
#include "operands.h"

/* clang-format off */
#define LIKE_THE_HOST(X) \
  X(memcpy) X(memmove) X(memset) X(memcmp) X(memchr) X(strlen) X(strnlen) X(strcmp) X(strncmp) X(strcpy) X(strncpy) \
  X(strcat) X(strncat) X(strchr) X(strrchr) X(strstr) X(strspn) X(strcspn) X(strpbrk) X(strtok_r) X(strtok) \
  X(memrchr) X(memccpy) X(memmem) X(mempcpy) X(stpcpy) X(stpncpy) X(strcasecmp) X(strncasecmp) X(strcoll) X(strxfrm) \
  X(strerror) X(strndup) X(rand) X(rand_r) X(srand) X(strtol) X(strtoul) X(strtoll) X(strtoull) X(atoi) X(strtod) \
  X(strtof) X(qsort) X(qsort_r) X(bsearch) X(free) X(strdup) X(at_quick_exit)
/* clang-format on */
LIKE_THE_HOST(RUNTIME_FUNCTION)
/* The host's have attributes that this test contradicts. */
void *rt_malloc(size_t);
void *rt_calloc(size_t, size_t);
void *rt_realloc(void *, size_t);
void *rt_aligned_alloc(size_t, size_t);
long long rt_clock(void);
void rt_quick_exit(int);
extern _Thread_local int rt_errno;
extern uintptr_t rt___trax_heap, rt___trax_heap_end;
int rt_printf(const char *, ...);
int rt_iprintf(const char *, ...);
int rt_snprintf(char *, size_t, const char *, ...);
int rt_sniprintf(char *, size_t, const char *, ...);
int rt_sprintf(char *, const char *, ...);
extern unsigned rt___trax_clock_mhz;
int rt_puts(const char *);
int rt_fputs(const char *, void *);
size_t rt_fwrite(const void *, size_t, size_t, void *);
#define CHARACTER_CLASSES(X)                                                                                           \
  X(isalnum)                                                                                                           \
  X(isalpha)                                                                                                           \
  X(isblank) X(iscntrl) X(isdigit) X(isgraph) X(islower) X(isprint) X(ispunct) X(isspace) X(isupper) X(isxdigit)
#define DECLARE(name) int rt_##name(int);
CHARACTER_CLASSES(DECLARE)
DECLARE(tolower)
DECLARE(toupper)

/* Every start within a word, every size up to a few words, each byte around the target untouched. */
static void memory_functions(void **state) {
  (void)state;
  unsigned char source[96], ours[96], theirs[96];
  for (size_t i = 0; i < sizeof source; i++)
    source[i] = (unsigned char)(i * 37 + 11);
  for (size_t to = 8; to < 16; to++)
    for (size_t from = 8; from < 16; from++)
      for (size_t size = 0; size < 70; size++) {
        memset(ours, 0xAA, sizeof ours);
        memset(theirs, 0xAA, sizeof theirs);
        assert_ptr_equal(rt_memcpy(ours + to, source + from, size), ours + to);
        memcpy(theirs + to, source + from, size);
        assert_memory_equal(ours, theirs, sizeof ours);

        memcpy(ours, source, sizeof ours); /* overlapping */
        memcpy(theirs, source, sizeof theirs);
        assert_ptr_equal(rt_memmove(ours + to, ours + from, size), ours + to);
        memmove(theirs + to, theirs + from, size);
        assert_memory_equal(ours, theirs, sizeof ours);

        memset(theirs + to, (int)from * 0x111, size);
        assert_ptr_equal(rt_memset(ours + to, (int)from * 0x111, size), ours + to);
        assert_memory_equal(ours, theirs, sizeof ours);

        memcpy(ours + to, source + from, size);
        assert_int_equal(rt_memcmp(ours + to, source + from, size), 0);
        for (size_t at = 0; at < size; at += 5) {
          ours[to + at] ^= 0x80;
          int want = memcmp(ours + to, source + from, size), got = rt_memcmp(ours + to, source + from, size);
          assert_int_equal((want > 0) - (want < 0), (got > 0) - (got < 0));
          ours[to + at] ^= 0x80;
          assert_ptr_equal(rt_memchr(source + from, source[from + at] | 0x300, size),
                           memchr(source + from, source[from + at], size));
        }
        assert_null(rt_memchr(source + from, source[from + size], size));
      }
}

static int sign_of(int x) {
  return (x > 0) - (x < 0);
}

/* Strings over an alphabet of two letters, so that everything occurs. */
static void string_functions(void **unused) {
  (void)unused;
  uint64_t state = 7;
  for (int round = 0, last = some_of(300000); round < last; round++) {
    _Alignas(4) char a[32], b[32], ours[80], theirs[80];
    size_t offset_a = random64(&state) & 3, offset_b = random64(&state) & 3;
    size_t length_a = random64(&state) % 20, length_b = random64(&state) % (round & 1 ? 20 : 4);
    memset(a, 0, sizeof a);
    memset(b, 0, sizeof b);
    for (size_t i = 0; i < length_a; i++)
      a[offset_a + i] = (char)("ab\x80"[random64(&state) % 3]);
    for (size_t i = 0; i < length_b; i++)
      b[offset_b + i] = round % 7 ? a[offset_a + i] : (char)("ab\x80"[random64(&state) % 3]);
    const char *s = a + offset_a, *t = b + offset_b;
    size_t n = random64(&state) % 24;
    assert_int_equal(rt_strlen(s), strlen(s));
    assert_int_equal(rt_strnlen(s, n), strnlen(s, n));
    assert_int_equal(sign_of(rt_strcmp(s, t)), sign_of(strcmp(s, t)));
    assert_int_equal(sign_of(rt_strncmp(s, t, n)), sign_of(strncmp(s, t, n)));
    assert_ptr_equal(rt_strchr(s, 'b'), strchr(s, 'b'));
    assert_ptr_equal(rt_strchr(s, 0), strchr(s, 0));
    assert_ptr_equal(rt_strrchr(s, 'a'), strrchr(s, 'a'));
    assert_ptr_equal(rt_strrchr(s, 0), strrchr(s, 0));
    assert_ptr_equal(rt_strstr(s, t), strstr(s, t));
    assert_int_equal(rt_strspn(s, "a\x80"), strspn(s, "a\x80"));
    assert_int_equal(rt_strcspn(s, "b\x80"), strcspn(s, "b\x80"));
    assert_ptr_equal(rt_strpbrk(s, "b\x80"), strpbrk(s, "b\x80"));
    memset(ours, 0x55, sizeof ours);
    memset(theirs, 0x55, sizeof theirs);
    assert_ptr_equal(rt_strcpy(ours, s), ours);
    strcpy(theirs, s);
    assert_ptr_equal(rt_strcat(ours, t), ours);
    strcat(theirs, t);
    assert_ptr_equal(rt_strncat(ours, s, n), ours);
    strncat(theirs, s, n);
    assert_memory_equal(ours, theirs, sizeof ours);
    assert_ptr_equal(rt_strncpy(ours, s, n), ours);
    strncpy(theirs, s, n);
    assert_memory_equal(ours, theirs, sizeof ours);
    char *rest, *host_rest;
    strcpy(ours, s);
    strcpy(theirs, s);
    char *token = rt_strtok_r(ours, "b", &rest), *host_token = strtok_r(theirs, "b", &host_rest);
    for (;; token = rt_strtok_r(NULL, "b", &rest), host_token = strtok_r(NULL, "b", &host_rest)) {
      assert_int_equal(token == NULL, host_token == NULL);
      if (!token)
        break;
      assert_string_equal(token, host_token);
    }
  }
}

/* Random strings over a small alphabet, so that parts are found, against the host's functions. */
static void more_string_functions(void **unused) {
  (void)unused;
  uint64_t state = 16;
  for (int i = 0, last = some_of(200000); i < last; i++) {
    char a[24], b[24], got[32], want[32];
    size_t size_a = random64(&state) % sizeof a, size_b = random64(&state) % (i & 1 ? 4 : sizeof b),
           n = random64(&state) % 26;
    for (size_t k = 0; k < sizeof a; k++) {
      a[k] = (char)(k == size_a ? 0 : "aAbB"[random64(&state) & 3]);
      b[k] = (char)(k == size_b ? 0 : "aAbB"[random64(&state) & 3]);
    }
    a[sizeof a - 1] = b[sizeof b - 1] = 0;
    size_t length_a = strlen(a), length_b = strlen(b), bytes = n < sizeof a ? n : sizeof a;
    assert_ptr_equal(rt_memrchr(a, 'b', bytes), memrchr(a, 'b', bytes));
    assert_ptr_equal(rt_memmem(a, length_a, b, length_b), memmem(a, length_a, b, length_b));
    memset(got, '#', sizeof got);
    memset(want, '#', sizeof want);
    char *end = rt_memccpy(got, a, 'B', bytes), *host_end = memccpy(want, a, 'B', bytes);
    assert_int_equal(end ? end - got : -1, host_end ? host_end - want : -1);
    assert_memory_equal(got, want, sizeof got);
    assert_int_equal((char *)rt_mempcpy(got, b, bytes) - got, (char *)mempcpy(want, b, bytes) - want);
    assert_memory_equal(got, want, sizeof got);
    assert_int_equal(rt_stpcpy(got, a) - got, stpcpy(want, a) - want);
    assert_memory_equal(got, want, sizeof got);
    assert_int_equal(rt_stpncpy(got, b, n) - got, stpncpy(want, b, n) - want);
    assert_memory_equal(got, want, sizeof got);
    assert_int_equal(sign_of(rt_strcasecmp(a, b)), sign_of(strcasecmp(a, b)));
    assert_int_equal(sign_of(rt_strncasecmp(a, b, n)), sign_of(strncasecmp(a, b, n)));
    assert_int_equal(sign_of(rt_strcoll(a, b)), sign_of(strcmp(a, b)));
    assert_int_equal(rt_strxfrm(got, a, sizeof got), length_a);
    assert_string_equal(got, a);
  }
  char text[] = " one, two,,three ", copy[] = " one, two,,three ", *rest;
  for (char *token = rt_strtok(text, " ,"), *want = strtok_r(copy, " ,", &rest); token || want;
       token = rt_strtok(NULL, " ,"), want = strtok_r(NULL, " ,", &rest))
    assert_string_equal(token, want);
  assert_string_equal(rt_strerror(ERANGE), strerror(ERANGE));
  assert_string_equal(rt_strerror(ENOENT), strerror(ENOENT));
  assert_string_equal(rt_strerror(12345), "Unknown error");
  unsigned seed = 0;
  rt_srand(0);
  for (int i = 0; i < 100; i++) /* one sequence, in the caller's word or the thread's own */
    assert_int_equal(rt_rand(), rt_rand_r(&seed));
}

static void character_classes(void **state) {
  (void)state;
#define CHECK(name) assert_int_equal(rt_##name(c) != 0, name(c) != 0);
  for (int c = -1; c < 128; c++) {
    CHARACTER_CLASSES(CHECK)
    assert_int_equal(rt_tolower(c), tolower(c));
    assert_int_equal(rt_toupper(c), toupper(c));
  }
}

static void check_text_to_integer(const char *text, int base) {
  char *end, *host_end;
#define CHECK_CONVERSION(name)                                                                                         \
  do {                                                                                                                 \
    errno = rt_errno = 0;                                                                                              \
    unsigned long long want = (unsigned long long)name(text, &host_end, base);                                         \
    unsigned long long got = (unsigned long long)rt_##name(text, &end, base);                                          \
    if (got != want || end != host_end || rt_errno != errno)                                                           \
      fail_msg("%s(\"%s\", %d): %llx, %td, errno %d; want %llx, %td, %d", #name, text, base, got, end - text,          \
               rt_errno, want, host_end - text, errno);                                                                \
  } while (0)
  CHECK_CONVERSION(strtol);
  CHECK_CONVERSION(strtoul);
  CHECK_CONVERSION(strtoll);
  CHECK_CONVERSION(strtoull);
}

static void text_to_integer(void **unused) {
  (void)unused;
  static const char *const texts[] = {"",
                                      " ",
                                      "-",
                                      "+",
                                      "0",
                                      "-0",
                                      "0x",
                                      "0xg",
                                      "0x1F",
                                      "-0X1f",
                                      "08",
                                      "017",
                                      " \t\n\v\f\r42",
                                      "+-1",
                                      "zz",
                                      "ZZ",
                                      "123abc",
                                      "9223372036854775807",
                                      "9223372036854775808",
                                      "-9223372036854775808",
                                      "-9223372036854775809",
                                      "18446744073709551615",
                                      "18446744073709551616",
                                      "-18446744073709551615",
                                      "-18446744073709551616",
                                      "99999999999999999999999999",
                                      "2147483647",
                                      "2147483648",
                                      "4294967296"};
  static const int bases[] = {0, 2, 8, 10, 16, 36};
  for (size_t i = 0; i < COUNT(texts); i++)
    for (size_t j = 0; j < COUNT(bases); j++)
      check_text_to_integer(texts[i], bases[j]);
  uint64_t state = 8;
  for (int i = 0, last = some_of(200000); i < last; i++) {
    char text[80];
    int64_t x = (int64_t)random_integer(&state);
    snprintf(text, sizeof text, (const char *[]){"%lld", "%llx", "0x%llx", "0%llo", "-%llu", "%lld7"}[i % 6],
             (long long)x);
    check_text_to_integer(text, bases[random64(&state) % COUNT(bases)]);
  }
  assert_int_equal(rt_atoi("  -2147483648x"), INT32_MIN);
}

static int compare_count;
static int compare_keys(const void *a, const void *b) {
  compare_count++;
  return *(const unsigned char *)a - *(const unsigned char *)b;
}

static int compare_in_context(const void *a, const void *b, void *count) {
  ++*(int *)count;
  return *(const unsigned char *)a - *(const unsigned char *)b;
}

/* The same bits, end and errno. For the host alone, to be rounded up to the least normal number is an underflow. */
static void check_text_to_double(const char *text) {
  char *end, *host_end;
  errno = rt_errno = 0;
  double want = strtod(text, &host_end), got = rt_strtod(text, &end);
  if (bits_of(got) != bits_of(want) || end != host_end || (fabs(want) != 0x1p-1022 && rt_errno != errno))
    fail_msg("strtod(\"%.60s\"): %a, %td, errno %d; want %a, %td, %d", text, got, end - text, rt_errno, want,
             host_end - text, errno);
  errno = rt_errno = 0;
  float want_float = strtof(text, &host_end), got_float = rt_strtof(text, &end);
  if (float_bits_of(got_float) != float_bits_of(want_float) || end != host_end ||
      (fabsf(want_float) != 0x1p-126f && rt_errno != errno))
    fail_msg("strtof(\"%.60s\"): %a, %td, errno %d; want %a, %td, %d", text, (double)got_float, end - text, rt_errno,
             (double)want_float, host_end - text, errno);
}

/* The number exactly between two doubles (or floats), in all its digits, and its neighbours in the last of them: an x87
   number has the bits for it. */
static void check_halfway(long double halfway) {
  static char text[1300];
  int size = snprintf(text, sizeof text - 2, "%.*Le", 780, halfway);
  char *exponent = strchr(text, 'e'), tail[16];
  strcpy(tail, exponent);
  check_text_to_double(text);
  char *last = exponent - 1;
  while (*last == '0')
    last--;
  if (*last == '.')
    return;
  (*last)--;
  check_text_to_double(text);
  (*last)++;
  strcpy(exponent, "1");
  strcat(text, tail); /* a digit far behind */
  check_text_to_double(text);
  size = snprintf(text, sizeof text, "%.1100Lf", halfway);
  if (size < (int)sizeof text)
    check_text_to_double(text);
}

static void text_to_double(void **unused) {
  (void)unused;
  static const char *const texts[] = {
      "",
      " ",
      "-",
      ".",
      "-.",
      "e5",
      ".e1",
      "0",
      "-0",
      "+0.0",
      "0e5",
      "0e",
      "0e+",
      "1e",
      "1e+",
      "1e-x",
      "1.",
      ".5",
      "-.5e1",
      "1..2",
      " \t\n\v\f\r42.5x",
      "+-1",
      "1e400",
      "-1e400",
      "1e-400",
      "-1e-400",
      "1e99999999999",
      "1e-99999999999",
      "0e99999999999",
      "1.7976931348623157e308",
      "1.7976931348623158e308",
      "1.7976931348623159e308",
      "179769313486231580793e289",
      "4.9e-324",
      "2.4703282292062327e-324",
      "2.4703282292062328e-324",
      "2.2250738585072011e-308",
      "2.2250738585072012e-308",
      "2.2250738585072014e-308",
      "9007199254740993",
      "9007199254740993.0000000000000000000000000000001",
      "9007199254740992.99999999999999999999",
      "3.4028235e38",
      "3.40282356779733661637539395458142568447e38",
      "3.4028235677973366163753939545814256845e38",
      "3.5e38",
      "1.17549431e-38",
      "7.0064923e-46",
      "7.00649232162408535461864791645e-46",
      "1e-45",
      "inf",
      "INFINITY",
      "-infinit",
      "+Inf",
      "in",
      "i",
      "nan",
      "-NaN",
      "nan(",
      "nan()",
      "nan(12_ab)x",
      "nan(1-2)",
      "na",
      "0x",
      "0x.",
      "0x.p1",
      "0x1",
      "0x1p",
      "0x1p+",
      "0x1p4",
      "-0X1.8P-1",
      "0x.8p1",
      "0x1.fffffffffffff8p0",
      "0x1.fffffffffffff7p0",
      "0x1.00000000000008p0",
      "0x1.000000000000080000000000000000000001p0",
      "0x1.000000000000180000000000p0",
      "0x123456789abcdef0123456789p-30",
      "0x1p1023",
      "0x1p1024",
      "0x1.fffffffffffff8p1023",
      "0x1.fffffffffffff7p1023",
      "0x1p-1074",
      "0x1p-1075",
      "0x1.8p-1074",
      "0x1p-149",
      "0x1.8p-149",
      "0x1.000001p-1075",
      "0x0.0000001p-1050",
      "0x1p-99999999999",
      "0x0p99999999999",
      "0x1.000001p0",
      "0x1.0000018p0",
      "0x1.000003p0",
      "0x.00000000000000000000000000000001p128",
  };
  for (size_t i = 0; i < COUNT(texts); i++)
    check_text_to_double(texts[i]);
  char text[400];
  for (size_t i = 0; i < COUNT(special_doubles); i++) {
    snprintf(text, sizeof text, "%.17g", double_of(special_doubles[i]));
    check_text_to_double(text);
  }
  uint64_t state = 15;
  for (int i = 0, last = some_of(200000); i < last; i++) {
    double x = random_double(&state);
    snprintf(text, sizeof text, i & 1 ? "%.*e" : "%.*g", (int)(random64(&state) % 40), x);
    check_text_to_double(text);
    snprintf(text, sizeof text, "%llu%s%llu%se%d", (unsigned long long)random_integer(&state), i & 2 ? "." : "",
             (unsigned long long)random_integer(&state), i & 4 ? "000000000" : "", (int)(random64(&state) % 700) - 360);
    check_text_to_double(text);
    snprintf(text, sizeof text, "%a", x);
    check_text_to_double(text);
    snprintf(text, sizeof text, "0x%llx.%llxp%d", (unsigned long long)random64(&state),
             (unsigned long long)random64(&state), (int)(random64(&state) % 2300) - 1150);
    check_text_to_double(text);
    if (i % 16)
      continue;
    x = fabs(x);
    if (x < 0x1p1023)
      check_halfway(((long double)x + (long double)nextafter(x, INFINITY)) / 2);
    float f = fabsf(random_float(&state));
    if (f < 0x1p127f)
      check_halfway(((long double)f + (long double)nextafterf(f, INFINITY)) / 2);
  }
}

/* Elements of every size from 1 to 12, so that words and bytes are swapped; the key is the first byte. */
static void sorting(void **unused) {
  (void)unused;
  uint64_t state = 9;
  for (int round = 0; round < 20000; round++) {
    size_t size = 1 + random64(&state) % 12, count = random64(&state) % (round % 50 ? 20 : 200);
    _Alignas(4) unsigned char data[200 * 12 + 1];
    unsigned sum = 0, sorted_sum = 0;
    for (size_t i = 0; i < count; i++) {
      unsigned char key = round % 3 == 0 ? (unsigned char)i : (unsigned char)(random64(&state) % (round % 2 ? 256 : 4));
      for (size_t j = 0; j < size; j++)
        data[i * size + j] = (unsigned char)(key * (j + 1)); /* tells whether an element stays whole */
      sum += key;
    }
    data[count * size] = 0xEE;
    compare_count = 0;
    if (round % 4)
      rt_qsort(data, count, size, compare_keys);
    else
      rt_qsort_r(data, count, size, compare_in_context, &compare_count);
    assert_true(compare_count <= 2 * (double)count * (log2((double)count + 2) + 1));
    assert_int_equal(data[count * size], 0xEE);
    for (size_t i = 0; i < count; i++) {
      sorted_sum += data[i * size];
      assert_true(i == 0 || data[(i - 1) * size] <= data[i * size]);
      for (size_t j = 0; j < size; j++)
        assert_int_equal(data[i * size + j], (unsigned char)(data[i * size] * (j + 1)));
    }
    assert_int_equal(sum, sorted_sum);
    for (int key = 0; key < 256; key += 5) {
      unsigned char byte = (unsigned char)key;
      unsigned char *found = rt_bsearch(&byte, data, count, size, compare_keys);
      int is_there = 0;
      for (size_t i = 0; i < count; i++)
        is_there |= data[i * size] == byte;
      assert_int_equal(found != NULL, is_there);
      if (found) {
        assert_int_equal(*found, byte);
        assert_int_equal((size_t)(found - data) % size, 0);
      }
    }
  }
}

/* Random allocations, each filled with a pattern that must still be there when it is freed. */
static void heap(void **unused) {
  (void)unused;
  enum { SIZE = 1 << 17, SLOTS = 64 };
  char *arena = calloc(SIZE, 1);
  rt___trax_heap = (uintptr_t)arena + 4; /* the runtime aligns */
  rt___trax_heap_end = (uintptr_t)arena + SIZE;
  char *part = rt_strndup("shortened", 5), *whole = rt_strndup("whole", 9);
  assert_string_equal(part, "short");
  assert_string_equal(whole, "whole");
  rt_free(part);
  rt_free(whole);
  unsigned char *slot[SLOTS] = {0};
  size_t size[SLOTS] = {0};
  uint64_t state = 10;
  int failures = 0;
  for (int round = 0, last = some_of(200000); round < last; round++) {
    int i = (int)(random64(&state) % SLOTS);
    size_t wanted = random64(&state) % (random64(&state) % 8 ? 200 : 8000);
    for (size_t j = 0; slot[i] && j < size[i]; j++)
      if (slot[i][j] != (unsigned char)(i + j))
        fail_msg("block %d is damaged at %zu", i, j);
    unsigned char *block;
    size_t alignment = (size_t)1 << random64(&state) % 8;
    switch (slot[i] ? random64(&state) % 2 : 2 + random64(&state) % 3) {
    case 0:
      rt_free(slot[i]);
      slot[i] = NULL;
      continue;
    case 1:
      block = rt_realloc(slot[i], wanted);
      if (!block) {
        failures++;
        continue;
      }
      for (size_t j = 0; j < size[i] && j < wanted; j++)
        assert_int_equal(block[j], (unsigned char)(i + j));
      break;
    case 2:
      block = rt_calloc(wanted / 4, 4);
      wanted = wanted / 4 * 4;
      for (size_t j = 0; block && j < wanted; j++)
        assert_int_equal(block[j], 0);
      break;
    case 3:
      block = rt_aligned_alloc(alignment, wanted);
      assert_int_equal((uintptr_t)block % alignment, 0);
      break;
    default:
      block = rt_malloc(wanted);
    }
    if (!block) {
      failures++;
      continue;
    }
    assert_int_equal((uintptr_t)block % 8, 0);
    assert_true((char *)block >= arena && (char *)block + wanted <= arena + SIZE);
    slot[i] = block;
    size[i] = wanted;
    for (size_t j = 0; j < wanted; j++)
      block[j] = (unsigned char)(i + j);
  }
  assert_true(failures > 0); /* the heap did run full, and went on */
  for (int i = 0; i < SLOTS; i++)
    rt_free(slot[i]);
  unsigned char *all = rt_malloc(SIZE / 2); /* what other sizes had is joined again */
  assert_non_null(all);
  rt_free(all);
  assert_null(rt_malloc((size_t)-1));
  assert_null(rt_malloc((size_t)-9));
  assert_null(rt_calloc((size_t)-1 / 2, 4));
  char *copy = rt_strdup("copied");
  assert_string_equal(copy, "copied");

  if (setjmp(host_abort_target) == 0) { /* freed twice */
    rt_free(copy);
    rt_free(copy);
    fail_msg("no complaint");
  }
  assert_non_null(strstr(host_abort_message, "free"));
  /* The lock is still held: nothing allocates after an abort. */
}

static void check_format(const char *want, const char *got, int want_count, int got_count, const char *format) {
  if (want_count != got_count || strcmp(want, got))
    fail_msg("\"%s\": got \"%s\" (%d), want \"%s\" (%d)", format, got, got_count, want, want_count);
}

#define SIZE 2048
#define CHECK_FORMAT(format, ...)                                                                                      \
  do {                                                                                                                 \
    static char want[SIZE], got[SIZE];                                                                                 \
    int want_count = snprintf(want, SIZE, format, __VA_ARGS__),                                                        \
        got_count = rt_snprintf(got, SIZE, format, __VA_ARGS__);                                                       \
    check_format(want, got, want_count, got_count, format);                                                            \
  } while (0)

#pragma GCC diagnostic ignored "-Wformat"
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
#pragma GCC diagnostic ignored "-Wformat-security"

/* %, some flags, width and precision, a length, a letter. */
static void random_format(uint64_t *state, char *format, const char *length, const char *letters) {
  char *p = format;
  *p++ = '[';
  *p++ = '%';
  for (int i = 0; i < 5; i++)
    if (random64(state) % 4 == 0)
      *p++ = "-+ #0"[i];
  if (random64(state) % 2)
    p += sprintf(p, "%d", 1 + (int)(random64(state) % 30));
  if (random64(state) % 2)
    p += sprintf(p, ".%d", (int)(random64(state) % 26));
  char letter = letters[random64(state) % strlen(letters)];
  char *alternate = strchr(format, '#');
  if (alternate && (letter | 32) == 'g') /* glibc loses zeros here where rounding makes a power of ten */
    *alternate = '+';
  p += sprintf(p, "%s%c]", length, letter);
}

static void formatted_integers(void **unused) {
  (void)unused;
  uint64_t state = 11;
  static const char *const lengths[] = {"", "h", "hh", "l", "ll", "j", "z", "t"};
  for (int i = 0, last = some_of(400000); i < last; i++) {
    char format[40];
    random_format(&state, format, lengths[i % 8], "diuoxXbB");
    uint64_t x = random_integer(&state);
    if (i % 8 < 3)
      CHECK_FORMAT(format, (int)x);
    else
      CHECK_FORMAT(format, (long long)x);
  }
  CHECK_FORMAT("%d %5d|%-5d|%05d|%+d|% d", 0, 42, 42, -42, 7, 7);
  CHECK_FORMAT("%.0d|%5.0d|%#.0o|%#x|%#X|%.0x|", 0, 0, 0, 0, 255, 0);
  CHECK_FORMAT("%*d|%-*d|%.*d|%*.*d", 6, 1, 6, 2, 4, 3, -7, -1, 4);
  CHECK_FORMAT("%c|%5c|%-5c|%%|%s|%.2s|%8s|%-8s|%08.3d", 'a', 'b', 'c', "string", "cut", "right", "left", 5);
  CHECK_FORMAT("%p|%20p|%-20p|", (void *)4096, (void *)0x1234, (void *)255);
  CHECK_FORMAT("no conversion %d", 0);
  CHECK_FORMAT("%.3s|%.0s|%s", "abcdef", "x", "");
}

/* Compares with glibc in a UTF-8 locale. It may read one character more than the precision allows. */
static void formatted_wide(void **unused) {
  (void)unused;
  assert_non_null(setlocale(LC_CTYPE, "C.UTF-8"));
  uint64_t state = 13;
  static const wchar_t ends[] = {1, 0x7F, 0x80, 0x7FF, 0x800, 0xD7FF, 0xE000, 0xFFFF, 0x10000, 0x10FFFF};
  for (int i = 0, last = some_of(100000); i < last; i++) {
    char format[40];
    wchar_t text[12] = {0};
    for (uint64_t j = random64(&state) % 12; j > 0; j--)
      text[j - 1] =
          random64(&state) % 2 ? ends[random64(&state) % COUNT(ends)] : (wchar_t)(1 + random64(&state) % 0xD000);
    random_format(&state, format, "l", "s");
    CHECK_FORMAT(format, text);
    random_format(&state, format, "", "S");
    CHECK_FORMAT(format, text);
    *strchrnul(format, '.') = 0; /* %c has no precision */
    strcat(format, "lc|%-5C|%d");
    if (strchr(format, 'S') == NULL)
      CHECK_FORMAT(format, (wint_t)text[0], (wint_t)0x20AC, 7);
  }
  CHECK_FORMAT("%'d|%qd|%Ld|%lc|%d", 12345, 1LL << 40, -1LL, (wint_t)'x', 3);
  static const wint_t wrong[] = {0xD800, 0xDFFF, 0x110000, 0xFFFFFFFF, 0x80000000};
  for (size_t i = 0; i < COUNT(wrong); i++) {
    char got[32];
    const wchar_t text[] = {'a', (wchar_t)wrong[i], 0};
    rt_errno = 0;
    assert_int_equal(rt_snprintf(got, sizeof got, "before %lc after", wrong[i]), -1);
    assert_string_equal(got, "before ");
    assert_int_equal(rt_errno, EILSEQ);
    assert_int_equal(rt_snprintf(got, sizeof got, "before %ls", text), -1);
    assert_string_equal(got, "before ");
    assert_int_equal(rt_snprintf(got, sizeof got, "%.1ls", text), 1); /* does not look at it */
    assert_int_equal(rt_snprintf(got, sizeof got, "%ls", (wchar_t *)NULL), 6);
    assert_string_equal(got, "(null)");
  }
  setlocale(LC_CTYPE, "C");
}

static void stored_counts(void **unused) {
  (void)unused;
  struct {
    signed char a, b;
    short c, d;
    int e, f;
    long g, h;
    long long i, j;
    intmax_t k;
    size_t l;
    ptrdiff_t m;
  } n;
  memset(&n, 0xA5, sizeof n);
  char got[512];
  int count = rt_snprintf(got, 4, "1%hhn2%hn%d3%n%s%ln%.1f%lln%c%jn%%%zn%tn|%d", &n.a, &n.c, 4, &n.e, "56", &n.g, 7.5,
                          &n.i, '8', &n.k, &n.l, &n.m, 9);
  assert_int_equal(count, 13);
  assert_string_equal(got, "124");
  assert_int_equal(n.a, 1);
  assert_int_equal(n.b, (signed char)0xA5);
  assert_int_equal(n.c, 2);
  assert_int_equal(n.d, (short)0xA5A5);
  assert_int_equal(n.e, 4);
  assert_int_equal(n.f, (int)0xA5A5A5A5);
  assert_int_equal(n.g, 6);
  assert_int_equal(n.i, 9);
  assert_int_equal(n.k, 10);
  assert_int_equal(n.l, 11);
  assert_int_equal(n.m, 11);
  rt_snprintf(got, sizeof got, "%300d%hhn", 1, &n.a); /* modulo its size */
  assert_int_equal(n.a, 300 - 256);
}

static char letters[40];
static unsigned letter_count;

static void add_letter(void) {
  letters[letter_count] = (char)('a' + letter_count % 26);
  letter_count++;
}

static void add_dot(void) {
  letters[letter_count++] = '.';
}

/* As many functions as C promises, the latest first; one more is refused. */
static void quick_exits(void **unused) {
  (void)unused;
  assert_int_equal(rt_at_quick_exit(add_dot), 0);
  for (int i = 1; i < 32; i++)
    assert_int_equal(rt_at_quick_exit(add_letter), 0);
  assert_int_not_equal(rt_at_quick_exit(add_dot), 0);
  const int ended = setjmp(host_abort_target);
  if (!ended) {
    rt_quick_exit(7);
    fail_msg("the program goes on");
  }
  assert_int_equal(ended, 7 + 2);
  assert_string_equal(letters, "abcdefghijklmnopqrstuvwxyzabcde.");
}

/* A conversion that is unknown stops the program: its argument, and those behind it, cannot be found. */
static void refused(const char *format, const char *message) {
  char got[64];
  host_abort_message = "nothing";
  if (setjmp(host_abort_target) == 0) {
    rt_snprintf(got, sizeof got, format, 1, 2, 3);
    fail_msg("\"%s\" printed \"%s\"", format, got);
  }
  assert_string_equal(host_abort_message, message);
}

static void unknown_conversions(void **unused) {
  (void)unused;
  static const char known[] = "diouxXbBcCsSaAeEfFgGpn%", others[] = "hljztLq*-+ #'.0123456789";
  for (int c = 1; c < 256; c++) {
    if (strchr(known, c) || strchr(others, c))
      continue;
    char format[32], message[64];
    snprintf(format, sizeof format, "%%%c %%d", c);
    snprintf(message, sizeof message, "printf: unknown conversion: %%%c", c);
    refused(format, message);
  }
  refused("%d %", "printf: unknown conversion: %");
  refused("%d %-08.3ll", "printf: unknown conversion: %-08.3ll");
  refused("%2$d", "printf: unknown conversion: %2$");
  refused("%d %5.2ly|%d", "printf: unknown conversion: %5.2ly");
  refused("%0000000000000000000000000000000000000000000000000000000000000001y",
          "printf: unknown conversion: %0000000000000000000000000000000000");
  char got[64];
  for (const char *letter = "aefgAEFG"; *letter; letter++) {
    char format[] = "%d %.2x %d", message[] = "iprintf formats no doubles: %.2x";
    *strchr(format, 'x') = *strchr(message, 'x') = *letter;
    if (setjmp(host_abort_target) == 0) {
      rt_sniprintf(got, sizeof got, format, 1, 2.0, 3);
      fail_msg("\"%s\" printed \"%s\"", format, got);
    }
    assert_string_equal(host_abort_message, message);
  }
}

static void processor_time(void **unused) {
  (void)unused;
  assert_int_equal(rt_clock(), -1); /* nobody said what the clock is */
  static const unsigned megahertz[] = {1, 3, 250, 333, 500, 1000, 1500, 100000};
  uint64_t state = 14;
  for (int i = 0, last = some_of(100000); i < last; i++) {
    const unsigned mhz = rt___trax_clock_mhz = megahertz[random64(&state) % COUNT(megahertz)];
    host_cycles = random64(&state) >> (12 + random64(&state) % 52);
    assert_true((unsigned __int128)host_cycles * 1000 / mhz == (unsigned __int128)rt_clock());
  }
  rt___trax_clock_mhz = 0;
}

static void formatted_doubles(void **unused) {
  (void)unused;
  uint64_t state = 12;
  for (int i = 0, last = some_of(400000); i < last; i++) {
    char format[40];
    random_format(&state, format, "", "eEfFgGaA");
    double x = random_double(&state);
    CHECK_FORMAT(format, x);
  }
  /* Decimal ties and runs of nines. */
  for (int i = 0, last = some_of(200000); i < last; i++) {
    char format[40];
    random_format(&state, format, "", "efg");
    double x = (double)(int64_t)(random64(&state) % 4000001 - 2000000) / (1 << random64(&state) % 12);
    CHECK_FORMAT(format, i % 2 ? x : nextafter(rint(x), (double)(i % 4) - 1));
  }
  for (size_t i = 0; i < 2 * COUNT(special_doubles); i++) {
    double x = double_of(special_doubles[i / 2] | (uint64_t)(i & 1) << 63);
    CHECK_FORMAT("%f|%e|%g|%a|%.0f|%.0e|%#.0f|%G|%10.3f|%-12.4e|%+08.2f|%.17g|%.1100f|%.800e", x, x, x, x, x, x, x, x,
                 x, x, x, x, x, x);
  }
  for (int power = -330; power <= 310; power++) {
    double x = pow(10, power);
    CHECK_FORMAT("%g|%.17g|%.3f|%e|%.16e", x, x, x, x, x);
    x = nextafter(x, 0);
    CHECK_FORMAT("%g|%.17g|%.3f|%e|%.16e", x, x, x, x, x);
  }
  CHECK_FORMAT("%.0f %.0f %.0f %.0f %.1f %.1f %g %g %g", 0.5, 1.5, 2.5, 3.5, 0.25, 0.35, 9.9999995, 999999.5,
               0.00009999995);
  static char got[SIZE];
  rt_snprintf(got, SIZE, "%#.2g %#.3g %#.2g %#g %#.1g %#.3g", 99.6, 999.6, 100.0, 0.5, 2.0, 1e-5);
  assert_string_equal(got, "1.0e+02 1.00e+03 1.0e+02 0.500000 2. 1.00e-05");
  /* The TP's long double is double; the host passes its own in other places. */
  rt_snprintf(got, SIZE, "%Lf|%lf", 1.5, 2.5);
  assert_string_equal(got, "1.500000|2.500000");
}

static void truncated_output(void **state) {
  (void)state;
  char got[16];
  for (size_t size = 0; size <= 12; size++) {
    memset(got, '#', sizeof got);
    assert_int_equal(rt_snprintf(got, size, "%d-%s", 12345, "abc"), 9);
    if (size)
      assert_int_equal(strlen(got), size - 1 < 9 ? size - 1 : 9);
    assert_int_equal(got[size > 10 ? 10 : size], '#');
    assert_int_equal(strncmp(got, "12345-abc", size ? size - 1 : 0), 0);
  }
  assert_int_equal(rt_snprintf(NULL, 0, "%s", "measure"), 7);
  assert_int_equal(rt_sprintf(got, "%s", "all of it"), 9);
  assert_string_equal(got, "all of it");
}

static void standard_output(void **state) {
  (void)state;
  host_output_size = 0;
  assert_int_equal(rt_printf("%s %d %.2f\n", "a", 1, 2.5), 9);
  assert_int_equal(rt_iprintf("%s %d\n", "b", 2), 4);
  rt_puts("line");
  rt_fputs("text", NULL);
  assert_int_equal(rt_fwrite("xyz", 1, 3, NULL), 3);
  assert_string_equal(host_output, "a 1 2.50\nb 2\nline\ntextxyz");
  char text[32];
  assert_int_equal(rt_snprintf(text, sizeof text, "%s|", (char *)NULL), 7);
  assert_string_equal(text, "(null)|");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_functions),
      cmocka_unit_test(string_functions),
      cmocka_unit_test(more_string_functions),
      cmocka_unit_test(character_classes),
      cmocka_unit_test(text_to_integer),
      cmocka_unit_test(text_to_double),
      cmocka_unit_test(sorting),
      cmocka_unit_test(quick_exits),
      cmocka_unit_test(heap),
      cmocka_unit_test(formatted_integers),
      cmocka_unit_test(formatted_wide),
      cmocka_unit_test(stored_counts),
      cmocka_unit_test(unknown_conversions),
      cmocka_unit_test(processor_time),
      cmocka_unit_test(formatted_doubles),
      cmocka_unit_test(truncated_output),
      cmocka_unit_test(standard_output),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
