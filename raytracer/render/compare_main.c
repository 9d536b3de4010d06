/* trax-compare: compares two pictures. */
#include "figures.h"
#include "layers.h"
#include "trax/message.h"
#include "trax/options.h"
#include "trax/output.h"
#include "trax/reads.h"

#include <stdlib.h>

struct arguments {
  unsigned within;
  double at_least;
  bool json, quiet;
};

/* Parses a number from 0 to the row's `most`. */
static trax_status take_number(void *target, const trax_option *option, const char *value, trax_error *error) {
  char *end;
  double *number = (double *)((char *)target + option->offset);
  *number = strtod(value, &end);
  return end != value && *end == '\0' && *number >= 0 && *number <= (double)option->most
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is not a number from 0 to %u", (unsigned)option->most);
}

#define FIELD(member) TRAX_OPTION_FIELD(struct arguments, member)

static const trax_option rows[] = {
    TRAX_OPTION_GROUP("What agrees"),
    {"within", .argument = "N", FIELD(within), .most = 255,
     .meaning = "differences up to N of 255 count as agreement (default 0)"},
    {"at-least", .argument = "P", .parse = take_number, .offset = offsetof(struct arguments, at_least), .most = 100,
     .meaning = "per cent of the pixels that must agree (default 100)"},
    TRAX_OPTION_GROUP("Other"),
    {"json", FIELD(json),
     .meaning = "prints all figures as JSON, also those of layers (trax-render --layers) of A\n"
                "against the right ones, B's"},
    {"quiet", 'q', FIELD(quiet), .meaning = "prints errors only"},
    TRAX_OPTION_HELP('h'),
    TRAX_OPTION_VERSION,
    {0}};

static const trax_command command = {.name = "trax-compare",
                                     .synopsis = "[options] A B",
                                     .description =
                                         "Compares two pictures of one size (PNG, PFM or EXR) by all four channels "
                                         "as they are seen; linear floats get gamma 2.\n"
                                         "Two pictures of floats are judged by their floats: N of 255 is a part of "
                                         "the root of a value, and at least of white's.\n"
                                         "The RMSE of R, G and B is printed, too, in parts of 255, and for two "
                                         "pictures of floats also that of their values.\n"
                                         "Exit status 0: they agree; 1: they do not, or an error.",
                                     .rows = rows,
                                     .examples = "trax-compare before.png after.png   # the same in every bit?\n"
                                                 "trax-compare ours.png embree.png --within 2 --at-least 99.9",
                                     .column = 22};

static int fail(const char *message) {
  trax_message("trax-compare", TRAX_MESSAGE_ERROR, "%s", message);
  return 1;
}

static void print_json(const struct trax_difference *difference, const struct trax_layers_difference *layers) {
  struct figure figures[16] = {{"pixels", (double)difference->pixels},
                               {"differ", (double)difference->unequal},
                               {"beyond", (double)difference->beyond},
                               {"largest", difference->largest},
                               {"rmse", difference->rmse}};
  size_t count = 5;
  if (difference->floats) {
    figures[count++] = (struct figure){"floats_largest", difference->most};
    figures[count++] = (struct figure){"floats_rmse", difference->root_rmse};
    figures[count++] = (struct figure){"floats_not_finite", (double)difference->not_finite};
  }
  if (layers) {
    figures[count++] = (struct figure){"wrong_pixels", (double)layers->wrong};
    figures[count++] = (struct figure){"missed", (double)layers->missed};
    figures[count++] = (struct figure){"grown", (double)layers->grown};
    figures[count++] = (struct figure){"other", (double)layers->other};
    figures[count++] = (struct figure){"tied", (double)layers->tied};
    figures[count++] = (struct figure){"wrong_shadows", (double)layers->shadow};
  }
  figures_print(stdout, figures, count);
}

static int compare(const char *path_a, const char *path_b, const struct arguments *arguments) {
  struct trax_picture a, b = {0};
  trax_error error;
  if (trax_picture_read(&a, path_a, &error))
    return fail(error.message);
  int exit_status = 1;
  struct trax_difference difference;
  struct trax_layers_difference layers;
  if (trax_picture_read(&b, path_b, &error)) {
    fail(error.message);
  } else if (a.width != b.width || a.height != b.height) {
    trax_fail(&error, "%s is %u x %u, %s is %u x %u", path_a, a.width, a.height, path_b, b.width, b.height);
    fail(error.message);
  } else {
    trax_picture_compare(&difference, &a, &b, arguments->within);
    const double percent = trax_difference_percent(&difference);
    const double floats_percent = trax_difference_floats_percent(&difference);
    if (a.layers && b.layers)
      trax_layers_compare(&layers, &a, &b);
    if (arguments->json)
      print_json(&difference, a.layers && b.layers ? &layers : NULL);
    else if (!arguments->quiet) {
      printf("%.4f %% of %llu pixels within %u/255, %llu differ", percent, (unsigned long long)difference.pixels,
             arguments->within, (unsigned long long)difference.unequal);
      if (difference.unequal)
        printf(", by up to %u at (%u, %u), RMSE %.4g", difference.largest, difference.x, difference.y, difference.rmse);
      putchar('\n');
      if (difference.floats)
        printf("RMSE %.6g of linear floats, %llu channels not finite, %.4f %% of the pixels within %u/255 of their "
               "brightness\n",
               difference.radiance_rmse, (unsigned long long)difference.not_finite, floats_percent, arguments->within);
    }
    exit_status = floats_percent >= arguments->at_least ? 0 : 1;
  }
  trax_picture_release(&a);
  trax_picture_release(&b);
  return exit_status;
}

int main(int argc, char **argv) {
  struct arguments arguments = {.at_least = 100};
  trax_error error;
  trax_reads_begin();
  const trax_parsed parsed = trax_command_parse(&command, &arguments, &argc, argv, &error);
  if (parsed == TRAX_PARSED_WRONG)
    return fail(error.message);
  if (parsed == TRAX_PARSED_RUN && argc != 2)
    return fail("expected two pictures; trax-compare --help shows how");
  const int status = parsed == TRAX_PARSED_RUN ? compare(argv[0], argv[1], &arguments) : 0;
  return trax_output_flush(&error) == TRAX_OK ? status : fail(error.message);
}
