/* The options of a command line. */
#include <getopt.h>
#include <stdio.h>
#include <string.h>

char *optarg;
int optind = 1, opterr = 1, optopt = '?';
static const char *joined; /* what is left of joined letters, "bc" of "-abc" */

static void complain(char *const arguments[], const char *options, const char *what, const char *name, int length) {
  if (opterr && *options != ':')
    fiprintf(stderr, "%s: %s '%.*s'\n", arguments[0], what, length, name);
}

/* Moves the arguments [from, to), which are options, before those of [first, from). */
static void move(char **arguments, int first, int from, int to) {
  for (; from < to; first++, from++) {
    char *option = arguments[from];
    memmove(arguments + first + 1, arguments + first, (size_t)(from - first) * sizeof *arguments);
    arguments[first] = option;
  }
}

static int find_long(char *const arguments[], const char *options, const struct option *longs, const char *name,
                     size_t length) {
  int found = -1;
  for (int i = 0; longs[i].name; i++) {
    if (strncmp(longs[i].name, name, length) != 0)
      continue;
    if (strlen(longs[i].name) == length)
      return i;
    if (found >= 0) {
      complain(arguments, options, "option is ambiguous:", name, (int)length);
      return -2;
    }
    found = i;
  }
  return found;
}

static int take_long(int count, char *const arguments[], const char *options, const struct option *longs, int *index,
                     const char *name) {
  size_t length = strcspn(name, "=");
  int found = find_long(arguments, options, longs, name, length);
  optind++;
  optopt = 0;
  if (found < 0) {
    if (found == -1)
      complain(arguments, options, "unrecognized option", name - 2, (int)length + 2);
    return '?';
  }
  const struct option *option = &longs[found];
  if (name[length] == '=' && option->has_arg == no_argument) {
    complain(arguments, options, "option does not allow an argument:", name, (int)length);
    optopt = option->val;
    return '?';
  }
  optarg = name[length] == '=' ? (char *)name + length + 1 : NULL;
  if (!optarg && option->has_arg == required_argument) {
    if (optind >= count) {
      complain(arguments, options, "option requires an argument:", name, (int)length);
      optopt = option->val;
      return *options == ':' ? ':' : '?';
    }
    optarg = arguments[optind++];
  }
  if (index)
    *index = found;
  if (!option->flag)
    return option->val;
  *option->flag = option->val;
  return 0;
}

static int take_letter(int count, char *const arguments[], const char *options) {
  int letter = (unsigned char)*joined++;
  const char *row = letter == ':' ? NULL : strchr(options, letter);
  const char *rest = *joined ? joined : NULL;
  if (!rest || (row && row[1] == ':')) {
    optind++;
    joined = NULL;
  }
  optarg = NULL;
  if (!row) {
    optopt = letter;
    complain(arguments, options, "invalid option --", (char[]){(char)letter, 0}, 1);
    return '?';
  }
  if (row[1] != ':')
    return letter;
  optarg = (char *)rest;
  if (!rest && row[2] != ':') {
    if (optind >= count) {
      optopt = letter;
      complain(arguments, options, "option requires an argument --", (char[]){(char)letter, 0}, 1);
      return *options == ':' ? ':' : '?';
    }
    optarg = arguments[optind++];
  }
  return letter;
}

static int take(int count, char *const arguments[], const char *options, const struct option *longs, int *index,
                int long_only) {
  int in_order = *options == '+';
  if (*options == '+' || *options == '-')
    options++;
  if (optind == 0) {
    optind = 1;
    joined = NULL;
  }
  if (joined)
    return take_letter(count, arguments, options);
  int first = optind;
  while (optind < count && (arguments[optind][0] != '-' || !arguments[optind][1]) && !in_order)
    optind++;
  if (optind >= count || arguments[optind][0] != '-' || !arguments[optind][1]) {
    optind = first;
    return -1;
  }
  int from = optind, result;
  const char *text = arguments[optind];
  if (strcmp(text, "--") == 0) {
    optind++;
    result = -1;
  } else if (longs && text[1] == '-') {
    result = take_long(count, arguments, options, longs, index, text + 2);
  } else if (longs && long_only && find_long(arguments, ":", longs, text + 1, strcspn(text + 1, "=")) >= 0) {
    result = take_long(count, arguments, options, longs, index, text + 1);
  } else {
    joined = text + 1;
    result = take_letter(count, arguments, options);
  }
  if (from != first) {
    int last = joined ? optind + 1 : optind; /* joined letters are left: their argument moves as well */
    move((char **)arguments, first, from, last);
    optind -= from - first;
  }
  return result;
}

int getopt(int count, char *const arguments[], const char *options) {
  return take(count, arguments, options, NULL, NULL, 0);
}

int getopt_long(int count, char *const arguments[], const char *options, const struct option *longs, int *index) {
  return take(count, arguments, options, longs, index, 0);
}

int getopt_long_only(int count, char *const arguments[], const char *options, const struct option *longs, int *index) {
  return take(count, arguments, options, longs, index, 1);
}
