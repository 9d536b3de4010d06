/* trax-compare: do two pictures agree? */
#include "core/machine.h"
#include "render.h"
#include "trax/options.h"
#include "trax/version.h"

#include <getopt.h>
#include <stdlib.h>

static const char usage[] = "Usage: trax-compare [options] A B\n"
                            "\n"
                            "Compares two pictures of one size, PNG, PFM or EXR: all four channels as they are seen, "
                            "of linear floats with gamma\n"
                            "2. Prints also the root of the mean square of the differences of R, G and B, of 255 and, "
                            "of two pictures of floats,\n"
                            "of their values. Exit status 0: they agree; 1: they do not, or an error.\n"
                            "\n"
                            "      --within N      differences up to N of 255 count as agreement (default 0)\n"
                            "      --at-least P    per cent of the pixels that must agree (default 100)\n"
                            "  -q, --quiet         prints errors only\n"
                            "  -h, --help\n"
                            "      --version\n";

enum { OPT_WITHIN = 256, OPT_AT_LEAST, OPT_VERSION };

static int fail(const char *message) {
  fprintf(stderr, "trax-compare: error: %s\n", message);
  return 1;
}

static bool parse(const char *text, double limit, double *value) {
  char *end;
  *value = strtod(text, &end);
  return end != text && *end == '\0' && *value >= 0 && *value <= limit;
}

static int compare(const char *path_a, const char *path_b, unsigned within, double at_least, bool quiet) {
  struct trax_picture a, b = {0};
  trax_error error;
  if (trax_picture_read(&a, path_a, &error))
    return fail(error.message);
  int exit_status = 1;
  struct trax_difference difference;
  if (trax_picture_read(&b, path_b, &error)) {
    fail(error.message);
  } else if (a.width != b.width || a.height != b.height) {
    trax_fail(&error, "%s is %u x %u, %s is %u x %u", path_a, a.width, a.height, path_b, b.width, b.height);
    fail(error.message);
  } else {
    trax_picture_compare(&difference, &a, &b, within);
    double percent = trax_difference_percent(&difference);
    if (!quiet) {
      printf("%.4f %% of %llu pixels within %u/255, %llu differ", percent, (unsigned long long)difference.pixels,
             within, (unsigned long long)difference.unequal);
      if (difference.unequal)
        printf(", by up to %u at (%u, %u), RMSE %.4g", difference.largest, difference.x, difference.y, difference.rmse);
      putchar('\n');
      if (difference.floats)
        printf("RMSE %.6g of linear floats, %llu channels not finite\n", difference.radiance_rmse,
               (unsigned long long)difference.not_finite);
    }
    exit_status = percent >= at_least ? 0 : 1;
  }
  trax_picture_release(&a);
  trax_picture_release(&b);
  return exit_status;
}

int main(int argc, char **argv) {
  static const struct option options[] = {{"within", required_argument, NULL, OPT_WITHIN},
                                          {"at-least", required_argument, NULL, OPT_AT_LEAST},
                                          {"quiet", no_argument, NULL, 'q'},
                                          {"help", no_argument, NULL, 'h'},
                                          {"version", no_argument, NULL, OPT_VERSION},
                                          {NULL, 0, NULL, 0}};
  double within = 0, at_least = 100;
  bool quiet = false;
  trax_error error;
  opterr = 0;
  for (int which; (which = getopt_long(argc, argv, ":qh", options, NULL)) != -1;)
    switch (which) {
    case OPT_WITHIN:
      if (!parse(optarg, 255, &within) || within != (unsigned)within)
        return fail("--within: expected a whole number from 0 to 255");
      break;
    case OPT_AT_LEAST:
      if (!parse(optarg, 100, &at_least))
        return fail("--at-least: expected per cent, 0 to 100");
      break;
    case 'q':
      quiet = true;
      break;
    case 'h':
      fputs(usage, stdout);
      return 0;
    case OPT_VERSION:
      puts("trax-compare " TRAX_VERSION);
      return 0;
    default:
      trax_wrong_option(options, argv, which, &error);
      return fail(error.message);
    }
  if (argc - optind != 2)
    return fail("expected two pictures; trax-compare --help shows how");
  return compare(argv[optind], argv[optind + 1], (unsigned)within, at_least, quiet);
}
