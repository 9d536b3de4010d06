#include <string.h>
#include <wctype.h>

#define CLASSES(X)                                                                                                     \
  X(alnum) X(alpha) X(blank) X(cntrl) X(digit) X(graph) X(lower) X(print) X(punct) X(space) X(upper) X(xdigit)

#define FUNCTION(NAME)                                                                                                 \
  int isw##NAME(wint_t c) {                                                                                            \
    return (unsigned)c < 128 && is##NAME((int)c);                                                                      \
  }
CLASSES(FUNCTION)

wint_t towlower(wint_t c) {
  return (unsigned)c < 128 ? (wint_t)tolower((int)c) : c;
}

wint_t towupper(wint_t c) {
  return (unsigned)c < 128 ? (wint_t)toupper((int)c) : c;
}

wctype_t wctype(const char *name) {
#define FIND(NAME)                                                                                                     \
  if (strcmp(name, #NAME) == 0)                                                                                        \
    return is##NAME;
  CLASSES(FIND)
  return 0;
}

int iswctype(wint_t c, wctype_t type) {
  return type && (unsigned)c < 128 && type((int)c);
}

wctrans_t wctrans(const char *name) {
  return strcmp(name, "tolower") == 0 ? tolower : strcmp(name, "toupper") == 0 ? toupper : 0;
}

wint_t towctrans(wint_t c, wctrans_t how) {
  return how && (unsigned)c < 128 ? (wint_t)how((int)c) : c;
}
