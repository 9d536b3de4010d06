/* The engine of scanf. A number may have 127 characters; the rest is left to be read. */
#include "scan.h"

#include <ctype.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CHARACTERS = 127 };

static void skip_blanks(struct source *from) {
  int c;
  do
    c = trax_scan_next(from);
  while (isspace(c));
  trax_scan_back(from, c);
}

/* --- numbers --- */

/* A number as text, and the character behind it. */
struct token {
  struct source *from;
  char *text;
  int used, most, c;
};

static void accept(struct token *token) {
  token->text[token->used++] = (char)token->c;
  token->c = token->used < token->most ? trax_scan_next(token->from) : EOF;
}

/* Accepts the character if it is the one, in lower case. */
static int accept_if(struct token *token, int lower) {
  if (token->c == EOF || tolower(token->c) != lower)
    return 0;
  accept(token);
  return 1;
}

static int accept_word(struct token *token, const char *word) {
  while (*word)
    if (!accept_if(token, *word++))
      return 0;
  return 1;
}

static int digit_of(int c) {
  return isdigit(c) ? c - '0' : isalpha(c) ? tolower(c) - 'a' + 10 : 99;
}

static int accept_digits(struct token *token, int base) {
  int count = 0;
  for (; token->c != EOF && digit_of(token->c) < base; count++)
    accept(token);
  return count;
}

static void accept_sign(struct token *token) {
  if (token->c == '+' || token->c == '-')
    accept(token);
}

/* If *base is 0, the prefix decides, and *base receives the base. */
static int take_integer(struct token *token, int *base) {
  int count = 0;
  accept_sign(token);
  if ((*base == 0 || *base == 16) && token->c == '0') {
    accept(token);
    count = 1;
    if (accept_if(token, 'x')) {
      *base = 16;
      count = 0;
    } else if (*base == 0) {
      *base = 8;
    }
  }
  if (*base == 0)
    *base = 10;
  return count + accept_digits(token, *base) > 0;
}

static int take_double(struct token *token) {
  accept_sign(token);
  if (accept_if(token, 'n'))
    return accept_word(token, "an");
  if (accept_if(token, 'i'))
    return accept_word(token, "nf") && (token->c == EOF || tolower(token->c) != 'i' || accept_word(token, "inity"));
  int base = 10, count = 0;
  if (token->c == '0') {
    accept(token);
    count = 1;
    if (accept_if(token, 'x')) {
      base = 16;
      count = 0;
    }
  }
  count += accept_digits(token, base);
  if (accept_if(token, '.'))
    count += accept_digits(token, base);
  if (!count)
    return 0;
  if (accept_if(token, base == 16 ? 'p' : 'e')) {
    accept_sign(token);
    return accept_digits(token, 10) > 0;
  }
  return 1;
}

static void store_integer(const struct directive *how, void *to, unsigned long long value) {
  switch (how->length) {
  case 'H':
    *(char *)to = (char)value;
    break;
  case 'h':
    *(short *)to = (short)value;
    break;
  case 'q':
  case 'j':
    *(long long *)to = (long long)value;
    break;
  default:
    *(int *)to = (int)value;
  }
}

__attribute__((noinline)) static int scan_number(struct source *from, const struct directive *how, void *to) {
  char text[MOST_CHARACTERS + 1];
  int most = how->has_width && how->width < MOST_CHARACTERS ? how->width : MOST_CHARACTERS;
  struct token token = {from, text, 0, most, trax_scan_next(from)};
  int base = how->letter == 'd' || how->letter == 'u'   ? 10
             : how->letter == 'o'                       ? 8
             : how->letter == 'x' || how->letter == 'p' ? 16
                                                        : 0;
  if (token.c == EOF)
    return EOF;
  int is_double = how->letter == 'e';
  int good = is_double ? take_double(&token) : take_integer(&token, &base);
  trax_scan_back(from, token.c);
  text[token.used] = 0;
  if (!good)
    return 0;
  if (how->discards)
    return 1;
  if (!is_double)
    store_integer(how, to,
                  how->letter == 'd' || how->letter == 'i' ? (unsigned long long)strtoll(text, NULL, base)
                                                           : strtoull(text, NULL, base));
  else if (how->length == 'l' || how->length == 'q')
    *(double *)to = strtod(text, NULL);
  else
    *(float *)to = strtof(text, NULL);
  return 1;
}

/* --- formats --- */

static const char *read_directive(const char *format, struct directive *how) {
  *how = (struct directive){0};
  if (*format == '*') {
    how->discards = 1;
    format++;
  }
  for (; isdigit((unsigned char)*format); format++) {
    how->width = 10 * how->width + (*format - '0');
    how->has_width = 1;
  }
  while (*format && strchr("hlLqjzt", *format)) {
    how->length = *format == 'h' && how->length == 'h'                                         ? 'H'
                  : (*format == 'l' && how->length == 'l') || *format == 'L' || *format == 'q' ? 'q'
                                                                                               : *format;
    format++;
  }
  how->letter = *format;
  if (*format && strchr("aefgAEFG", *format))
    how->letter = 'e';
  if (*format == 'X')
    how->letter = 'x';
  if (*format == 'S' || *format == 'C') { /* POSIX's names for %ls and %lc */
    how->letter = *format == 'S' ? 's' : 'c';
    how->length = 'l';
  }
  return *format ? format + 1 : format;
}

/* One conversion: 1, 0 if the input does not match, EOF at its end. */
static int convert(struct source *from, const struct directive *how, const char *set, void *to) {
  switch (how->letter) {
  case 'd':
  case 'i':
  case 'u':
  case 'o':
  case 'x':
  case 'p':
  case 'e':
    return scan_number(from, how, to);
  case 's':
  case 'c':
  case '[':
    return trax_scan_text(from, how, set, to);
  default:
    return 0;
  }
}

int trax_scan(struct source *from, const char *format, va_list arguments) {
  int done = 0;
  while (*format) {
    if (isspace((unsigned char)*format)) {
      skip_blanks(from);
      format++;
      continue;
    }
    if (*format != '%' || format[1] == '%') {
      if (*format == '%') {
        skip_blanks(from);
        format++;
      }
      int c = trax_scan_next(from);
      if (c != (unsigned char)*format++) {
        trax_scan_back(from, c);
        return c == EOF && !done ? EOF : done;
      }
      continue;
    }
    struct directive how;
    format = read_directive(format + 1, &how);
    const char *set = format;
    if (how.letter == '[')
      trax_scan_set_has(set, 0, 0, &format);
    void *to = how.discards ? NULL : va_arg(arguments, void *);
    if (how.letter == 'n') {
      if (to)
        store_integer(&how, to, (unsigned)from->count);
      continue;
    }
    if (how.letter != 'c' && how.letter != '[')
      skip_blanks(from);
    int result = convert(from, &how, set, to);
    if (result <= 0)
      return result == EOF && !done ? EOF : done;
    done += !how.discards;
  }
  return done;
}
