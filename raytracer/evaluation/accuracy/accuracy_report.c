/* The rows as a table, CSV, JSON and work-precision diagrams. */
#include "accuracy.h"

#include "trax/output.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const struct {
  const char *key, *unit, *meaning;
} figures[TRAX_ACCURACY_FIGURE_COUNT] = {
#define FIGURE(NAME, key, unit, meaning) {key, unit, meaning},
    TRAX_ACCURACY_FIGURES(FIGURE)
#undef FIGURE
};

static double value(const struct trax_accuracy_row *row, enum trax_accuracy_figure figure) {
  return row->figures[figure];
}

/* --- rows kept in files --- */

static json_t *figures_json(const struct trax_accuracy_row *row) {
  json_t *object = json_object();
  for (int i = 0; i < TRAX_ACCURACY_FIGURE_COUNT; i++)
    json_object_set_new(object, figures[i].key,
                        row->figures[i] == floor(row->figures[i]) && fabs(row->figures[i]) < 0x1p53
                            ? json_integer((json_int_t)row->figures[i])
                            : json_real(row->figures[i]));
  return object;
}

static trax_status write_json(json_t *json, const char *path, trax_error *error) {
  trax_output output;
  trax_status status = json ? trax_output_open(&output, path, error) : trax_fail(error, "out of memory");
  if (status == TRAX_OK && (json_dumpf(json, output.file, JSON_INDENT(2)) != 0 || fputc('\n', output.file) == EOF)) {
    trax_output_discard(&output);
    status = trax_fail(error, "%s: %s", path, strerror(errno));
  } else if (status == TRAX_OK) {
    status = trax_output_commit(&output, error);
  }
  json_decref(json);
  return status;
}

trax_status trax_accuracy_write_row(const struct trax_accuracy_row *row, const char *path, trax_error *error) {
  return write_json(figures_json(row), path, error);
}

bool trax_accuracy_read_row(struct trax_accuracy_row *row, const char *path) {
  json_t *object = json_load_file(path, 0, NULL);
  bool good = object != NULL;
  for (int i = 0; i < TRAX_ACCURACY_FIGURE_COUNT && good; i++) {
    const json_t *number = json_object_get(object, figures[i].key);
    good = json_is_number(number);
    row->figures[i] = json_number_value(number);
  }
  json_decref(object);
  return good;
}

/* --- tables --- */

static const char *mark(const struct trax_accuracy_row *row) {
  return row->numerical_front && row->total_front ? "N T" : row->numerical_front ? "N" : row->total_front ? "T" : "";
}

static void print_grouped(double number, FILE *out) {
  char digits[32];
  const int length = snprintf(digits, sizeof digits, "%.0f", number);
  for (int i = 0; i < length; i++) {
    if (i && (length - i) % 3 == 0)
      fputc(',', out);
    fputc(digits[i], out);
  }
}

void trax_accuracy_print(const struct trax_accuracy_report *report, FILE *out) {
  fprintf(
      out,
      "%s, view %s, %u x %u, chip %s. C has %u samples a pixel; RMSE to one of %u: %.2g. Front: N of cycles against "
      "numerical\nerror, of one sample; T of cycles against total error.\n\n",
      report->scene, report->view, report->width, report->height, report->chip, report->converged_samples,
      report->rough_samples, report->rough_rmse);
  fprintf(out,
          "| method | cycles | to default | instructions | code | scene, MB | memory, MB | energy, mJ | MRPS | "
          "numerical RMSE | "
          "largest | wrong pixels: missed, grown, other | tied | shadows | FLIP | sampling RMSE | total RMSE | "
          "total FLIP | front |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | "
          "--- | --- |\n");
  const struct trax_accuracy_row *first = report->rows;
  for (const struct trax_accuracy_row *row = first; row < first + report->count; row++) {
    fprintf(out, "| %s", row->variant.name);
    if (trax_variant_latency(&row->variant))
      fprintf(out, " (%u cycles)", trax_variant_latency(&row->variant));
    fputs(" | ", out);
    print_grouped(value(row, TRAX_ACCURACY_CYCLES), out);
    if (row == first)
      fputs(" |  | ", out);
    else
      fprintf(out, " | %+.2f %% | ", 100 * (value(row, TRAX_ACCURACY_CYCLES) / value(first, TRAX_ACCURACY_CYCLES) - 1));
    print_grouped(value(row, TRAX_ACCURACY_INSTRUCTIONS), out);
    fprintf(out, " | %.0f | %.2f | %.2f | %.3f | %.2f | %.2g | %.2g | ", value(row, TRAX_ACCURACY_CODE),
            1e-6 * value(row, TRAX_ACCURACY_SCENE), 1e-6 * value(row, TRAX_ACCURACY_MEMORY),
            1e3 * value(row, TRAX_ACCURACY_ENERGY), value(row, TRAX_ACCURACY_MRPS), value(row, TRAX_ACCURACY_RMSE),
            value(row, TRAX_ACCURACY_LARGEST));
    fprintf(out, "%.0f", value(row, TRAX_ACCURACY_WRONG));
    if (value(row, TRAX_ACCURACY_WRONG) > 0)
      fprintf(out, ": %.0f, %.0f, %.0f", value(row, TRAX_ACCURACY_MISSED), value(row, TRAX_ACCURACY_GROWN),
              value(row, TRAX_ACCURACY_OTHER));
    fprintf(out, " | %.0f | %.0f | %.2g | %.3g | %.3g | %.3g | %s |\n", value(row, TRAX_ACCURACY_TIED),
            value(row, TRAX_ACCURACY_SHADOW), value(row, TRAX_ACCURACY_FLIP), value(row, TRAX_ACCURACY_SAMPLING_RMSE),
            value(row, TRAX_ACCURACY_TOTAL_RMSE), value(row, TRAX_ACCURACY_TOTAL_FLIP), mark(row));
  }
}

trax_status trax_accuracy_write_csv(const struct trax_accuracy_report *report, const char *path, trax_error *error) {
  trax_output output;
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  fputs("method,group,samples,bits,latency", output.file);
  for (int i = 0; i < TRAX_ACCURACY_FIGURE_COUNT; i++)
    fprintf(output.file, ",%s", figures[i].key);
  fputs(",numerical_front,total_front\n", output.file);
  for (size_t i = 0; i < report->count; i++) {
    const struct trax_accuracy_row *row = &report->rows[i];
    fprintf(output.file, "\"%s\",%s,%u,%u,%u", row->variant.name, row->variant.group, row->variant.samples,
            row->variant.bits, trax_variant_latency(&row->variant));
    for (int figure = 0; figure < TRAX_ACCURACY_FIGURE_COUNT; figure++)
      fprintf(output.file, ",%.15g", row->figures[figure]);
    fprintf(output.file, ",%d,%d\n", row->numerical_front, row->total_front);
  }
  return trax_output_commit(&output, error);
}

trax_status trax_accuracy_write_json(const struct trax_accuracy_report *report, const char *path, trax_error *error) {
  json_t *described = json_object(), *rows = json_array();
  for (int i = 0; i < TRAX_ACCURACY_FIGURE_COUNT; i++)
    json_object_set_new(described, figures[i].key,
                        json_pack("{s:s, s:s}", "unit", figures[i].unit, "meaning", figures[i].meaning));
  for (size_t i = 0; i < report->count; i++) {
    const struct trax_accuracy_row *row = &report->rows[i];
    json_array_append_new(
        rows, json_pack("{s:s, s:s, s:s, s:b, s:s, s:b, s:i, s:i, s:i, s:i, s:b, s:b, s:o}", "method",
                        row->variant.name, "group", row->variant.group, "triangle",
                        trax_triangle_names[row->variant.method.triangle], "fast_math", row->variant.method.fast_math,
                        "nodes", trax_node_formats[row->variant.tree.nodes].name, "split", row->variant.tree.split,
                        "vertex_bits", (int)row->variant.tree.vertex_bits, "samples", (int)row->variant.samples, "bits",
                        (int)row->variant.bits, "latency", (int)trax_variant_latency(&row->variant), "numerical_front",
                        row->numerical_front, "total_front", row->total_front, "figures", figures_json(row)));
  }
  return write_json(json_pack("{s:s, s:i, s:s, s:s, s:s, s:[ii], s:i, s:i, s:f, s:o, s:o}", "format", "trax-accuracy",
                              "version", 1, "scene", report->scene, "view", report->view, "chip", report->chip, "size",
                              (int)report->width, (int)report->height, "converged_samples",
                              (int)report->converged_samples, "rough_samples", (int)report->rough_samples, "rough_rmse",
                              report->rough_rmse, "figures", described, "rows", rows),
                    path, error);
}

/* --- diagrams: the numerical error above, of one sample a pixel; the total error below --- */

/* What is plotted along x, and by which factor. */
static const struct {
  enum trax_accuracy_figure figure;
  double factor;
  const char *label;
} works[] = {{TRAX_ACCURACY_CYCLES, 1e-6, "cycles, million"},
             {TRAX_ACCURACY_MEMORY, 1e-6, "bytes from and to memory, million"},
             {TRAX_ACCURACY_ENERGY, 1e3, "energy, mJ"}};
enum { WORKS = sizeof works / sizeof *works };

static const struct {
  const char *name, *title, *colour;
  int shape; /* gnuplot's pointtype: to be told apart without colours, too */
} groups[] = {{"triangle", "other triangle test", "#0072b2", 9},
              {"math", "-ffast-math", "#d55e00", 11},
              {"tree", "other nodes, split triangles", "#e69f00", 5},
              {"vertices", "vertices of 16 bits", "#56b4e9", 13},
              {"unit", "special unit of so many bits", "#009e73", 6},
              {"samples", "more samples", "#cc79a7", 4},
              {"default", "default", "black", 7}}; /* above the others */
enum { GROUPS = sizeof groups / sizeof *groups };

/* A logarithmic axis has no 0. */
#define LEAST_ERROR 1e-6

static double work_of(const struct trax_accuracy_row *row, int work) {
  return works[work].factor * value(row, works[work].figure);
}

static double error_of(const struct trax_accuracy_row *row, bool total) {
  return fmax(value(row, total ? TRAX_ACCURACY_TOTAL_RMSE : TRAX_ACCURACY_RMSE), LEAST_ERROR);
}

static bool is_plotted(const struct trax_accuracy_row *row, bool total) {
  return total || row->variant.samples == 1;
}

/* A line for each row: works, error, and the bits of a unit unless others are named on nearly the same spot. */
static void write_block(const struct trax_accuracy_report *report, const char *group, bool total, FILE *out) {
  uint64_t labelled = 0; /* a bit for each factor of 2^(1/2) of the error */
  fprintf(out, "$%s_%s << EOD\n", total ? "total" : "numerical", group);
  for (size_t i = 0; i < report->count; i++) {
    const struct trax_accuracy_row *row = &report->rows[i];
    if (strcmp(row->variant.group, group) != 0 || !is_plotted(row, total))
      continue;
    for (int work = 0; work < WORKS; work++)
      fprintf(out, "%.9g ", work_of(row, work));
    const double error = error_of(row, total);
    fprintf(out, "%.9g", error);
    const uint64_t spot = UINT64_C(1) << ((int)floor(2 * log2(error / LEAST_ERROR)) & 63); /* 9 decades of errors */
    if (row->variant.bits && !(labelled & spot)) {
      labelled |= spot;
      fprintf(out, " %u\n", row->variant.bits);
    } else {
      fputs(" \"\"\n", out);
    }
  }
  fputs("EOD\n", out);
}

struct point {
  double work, error;
};

static int by_work(const void *a, const void *b) {
  const struct point *x = a, *y = b;
  if (x->work != y->work)
    return x->work < y->work ? -1 : 1;
  return (x->error > y->error) - (x->error < y->error);
}

/* The front: points that no cheaper one is as good as, in the order of work. */
static void write_front(struct point *points, size_t count, FILE *out) {
  fputs("$front << EOD\n", out);
  double least = INFINITY;
  for (size_t i = 0; i < count; i++)
    if (points[i].error < least) {
      least = points[i].error;
      fprintf(out, "%.9g %.9g\n", points[i].work, points[i].error);
    }
  fputs("EOD\n", out);
}

/* The numbers along x: of a narrow range four at even distances, of a wide one 1, 2 and 5 times the powers of ten. */
static void write_axis(double least, double most, FILE *out) {
  const double low = least * pow(most / least, -0.1) * 0.995, high = most * pow(most / least, 0.1) * 1.005;
  fprintf(out, "set xrange [%.9g:%.9g]\nset xtics (", low, high);
  if (high / low < 4) {
    const int decimals = (int)fmax(0, 1 - floor(log10((high - low) / 4))); /* two digits of the distance */
    for (int i = 0; i < 4; i++) {
      const double place = low + (high - low) * (i + 0.5) / 4;
      fprintf(out, "%s'%.*f' %.9g", i ? ", " : "", decimals, place, place);
    }
  } else {
    bool first = true;
    for (double decade = pow(10, floor(log10(low))); decade < high; decade *= 10)
      for (int digit = 1; digit <= 5; digit += digit == 1 ? 1 : 3) {
        if (digit * decade < low || digit * decade > high)
          continue;
        fprintf(out, "%s'%g' %.9g", first ? "" : ", ", digit * decade, digit * decade);
        first = false;
      }
  }
  fputs(")\n", out);
}

static trax_status write_plot(const struct trax_accuracy_report *report, int work, bool total, FILE *out,
                              trax_error *error) {
  struct point *points = malloc(report->count * sizeof *points);
  if (!points)
    return trax_fail(error, "out of memory");
  size_t count = 0;
  for (size_t i = 0; i < report->count; i++)
    if (is_plotted(&report->rows[i], total))
      points[count++] = (struct point){work_of(&report->rows[i], work), error_of(&report->rows[i], total)};
  qsort(points, count, sizeof *points, by_work);
  write_front(points, count, out);
  write_axis(points[0].work, points[count - 1].work, out);
  free(points);
  const char *kind = total ? "total" : "numerical";
  fprintf(out,
          "set xlabel '%s'\nset ylabel '%s RMSE, of 255'\nset key %s\nplot $front using 1:2 with steps linecolor "
          "rgb 'gray60' title 'Pareto front'",
          works[work].label, kind,
          total && work == WORKS - 1 ? "at screen 0.5,0.01 center bottom maxrows 2 samplen 2 width 1" : "off");
  for (int group = 0; group < GROUPS; group++) {
    if (!total && strcmp(groups[group].name, "samples") == 0)
      continue;
    fprintf(out, ", \\\n  $%s_%s using %d:%d with points pointtype %d pointsize 0.7 linecolor rgb '%s' title '%s'",
            kind, groups[group].name, work + 1, WORKS + 1, groups[group].shape, groups[group].colour,
            groups[group].title);
  }
  if (!total)
    fprintf(out, ", \\\n  $numerical_unit using %d:%d:%d with labels font ',8' offset char 1.2,0 notitle", work + 1,
            WORKS + 1, WORKS + 2);
  fputc('\n', out);
  return TRAX_OK;
}

/* Within single quotes of gnuplot's. */
static void write_quoted(const char *text, FILE *out) {
  for (; *text; text++) {
    if (*text == '\'')
      fputc('\'', out);
    fputc((unsigned char)*text < ' ' ? ' ' : *text, out);
  }
}

static trax_status write_script(const struct trax_accuracy_report *report, const char *path, trax_error *error) {
  trax_output output;
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  FILE *out = output.file;
  trax_status status = TRAX_OK;
  fputs("# Draws accuracy.svg on standard output.\nset terminal svg size 1350,850 name 'accuracy'\nset logscale xy\n"
        "set format y '10^{%L}'\nset grid\n",
        out);
  for (int total = 0; total < 2; total++)
    for (int group = 0; group < GROUPS; group++)
      write_block(report, groups[group].name, total, out);
  fputs("set multiplot layout 2,3 title '", out);
  write_quoted(report->scene, out);
  fputs(", view ", out);
  write_quoted(report->view, out);
  fprintf(out, ", %u x %u pixels, chip ", report->width, report->height);
  write_quoted(report->chip, out);
  fprintf(out,
          ": above against exact arithmetic, below against %u samples a pixel' noenhanced "
          "margins 0.05,0.98,0.13,0.94 spacing 0.065,0.1\n",
          report->converged_samples);
  for (int total = 0; total < 2; total++)
    for (int work = 0; work < WORKS && status == TRAX_OK; work++)
      status = write_plot(report, work, total, out, error);
  fputs("unset multiplot\n", out);
  if (status == TRAX_OK)
    return trax_output_commit(&output, error);
  trax_output_discard(&output);
  return status;
}

/* Its standard output to a file. False: it does not start, or ends badly. */
static bool run_gnuplot(const char *script, FILE *to) {
  const pid_t child = fork();
  if (child == 0) {
    dup2(fileno(to), STDOUT_FILENO);
    execlp("gnuplot", "gnuplot", script, (char *)NULL);
    _exit(127);
  }
  int status = -1;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR)
    ;
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

trax_status trax_accuracy_draw(const struct trax_accuracy_report *report, const char *directory, bool *drawn,
                               trax_error *error) {
  char script[TRAX_PATH_SIZE], picture[TRAX_PATH_SIZE];
  if (snprintf(script, sizeof script, "%s/accuracy.gnuplot", directory) >= (int)sizeof script ||
      snprintf(picture, sizeof picture, "%s/accuracy.svg", directory) >= (int)sizeof picture)
    return trax_fail(error, "%s: the path is too long", directory);
  trax_output output;
  trax_status status = write_script(report, script, error);
  if (status == TRAX_OK)
    status = trax_output_open(&output, picture, error);
  if (status != TRAX_OK)
    return status;
  *drawn = run_gnuplot(script, output.file);
  if (*drawn)
    return trax_output_commit(&output, error);
  trax_output_discard(&output);
  return TRAX_OK;
}
