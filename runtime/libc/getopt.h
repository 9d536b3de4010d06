/* The options of a command line, as in GNU's library: they may follow other arguments, which getopt moves to the end,
   unless the text of options begins with "+". All threads share the state. */
#ifndef TRAX_GETOPT_H
#define TRAX_GETOPT_H

#define no_argument 0
#define required_argument 1
#define optional_argument 2

struct option {
  const char *name;
  int has_arg;
  int *flag;
  int val;
};

#ifdef __cplusplus
extern "C" {
#endif

extern char *optarg;
extern int optind, opterr, optopt;

int getopt(int count, char *const arguments[], const char *options);
int getopt_long(int count, char *const arguments[], const char *options, const struct option *longs, int *index);
int getopt_long_only(int count, char *const arguments[], const char *options, const struct option *longs, int *index);

#ifdef __cplusplus
}
#endif

#endif
