/* The progress line: what it says, how often it is drawn, how it goes. */
#include "trax/progress.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char *text;
static size_t size;

static trax_progress_line begin(void) {
  return (trax_progress_line){.terminal = open_memstream(&text, &size), .program = "tool"};
}

/* As if the step had begun so long ago, and the line had not been drawn since. */
static void pass(trax_progress_line *line, double seconds) {
  line->begun -= seconds;
  line->drawn_at = 0;
}

static void shown(trax_progress_line *line, const char *expected) {
  fflush(line->terminal);
  text[size] = '\0'; /* what was there before is longer */
  assert_string_equal(text, expected);
  rewind(line->terminal);
}

static void test_line(void **state) {
  (void)state;
  trax_progress_line line = begin();
  assert_true(trax_progress_line_show(&line, "reading", -1, NULL));
  shown(&line, "\rtool: reading\033[K");
  assert_false(trax_progress_line_show(&line, "reading", -1, NULL));    /* not so soon again */
  assert_true(trax_progress_line_show(&line, "building", 0, "a mesh")); /* but another step */
  shown(&line, "\rtool: building, a mesh, 0.0 %\033[K");
  pass(&line, 100);
  assert_true(trax_progress_line_show(&line, "building", 0.5, NULL));
  shown(&line, "\rtool: building, 50.0 %, 1:40 left\033[K");
  pass(&line, 7200 - 100);
  assert_true(trax_progress_line_show(&line, "building", 0.5, NULL));
  shown(&line, "\rtool: building, 50.0 %, 2:00:00 left\033[K");
  trax_progress_line_clear(&line);
  shown(&line, "\r\033[K");
  fclose(line.terminal);
  free(text);
}

/* A step that does not begin at its beginning, as a run that goes on, is as fast as it was since. */
static void test_resumed(void **state) {
  (void)state;
  trax_progress_line line = begin();
  trax_progress_line_show(&line, "running", 0.5, NULL);
  pass(&line, 60);
  trax_progress_line_show(&line, "running", 0.75, NULL);
  fflush(line.terminal);
  assert_non_null(strstr(text, "75.0 %, 1:00 left"));
  fclose(line.terminal);
  free(text);
}

/* A step that hangs near its end is not about to end, and its last second says nothing. */
static void test_near_the_end(void **state) {
  (void)state;
  trax_progress_line line = begin();
  trax_progress_line_show(&line, "building", 0, NULL);
  shown(&line, "\rtool: building, 0.0 %\033[K");
  pass(&line, 100);
  trax_progress_line_show(&line, "building", 0.999, NULL);
  shown(&line, "\rtool: building, 99.9 %\033[K");
  pass(&line, 7);
  line.moved_at -= 7;
  trax_progress_line_show(&line, "building", 0.999, NULL);
  shown(&line, "\rtool: building, 99.9 %, 0:07 left\033[K");
  pass(&line, 1);
  trax_progress_line_show(&line, "building", 1, NULL);
  shown(&line, "\rtool: building, 100.0 %\033[K");
  pass(&line, 60);
  line.moved_at -= 60;
  trax_progress_line_show(&line, "building", 1, NULL); /* how long it takes yet is not known */
  shown(&line, "\rtool: building, 100.0 %\033[K");
  fclose(line.terminal);
  free(text);
}

/* What is printed beside the line erases it first. */
static void test_output(void **state) {
  (void)state;
  trax_progress_line line = begin();
  FILE *const before = stdout, *output = trax_progress_line_output(&line);
  char *printed;
  size_t length;
  assert_non_null(output);
  trax_progress_line_show(&line, "running", -1, NULL);
  shown(&line, "\rtool: running\033[K");
  FILE *const other = stdout = open_memstream(&printed, &length);
  fputs("a line\n", output);
  fclose(output);
  stdout = before;
  fclose(other); /* which is still open */
  assert_string_equal(printed, "a line\n");
  shown(&line, "\r\033[K");
  assert_false(line.drawn);
  fclose(line.terminal);
  free(printed);
  free(text);
}

static void test_nobody(void **state) {
  (void)state;
  trax_progress_line line = {.program = "tool"};
  assert_false(trax_progress_line_show(&line, "reading", 0.5, NULL));
  trax_progress_line_clear(&line);
  line = begin();
  trax_progress_line_clear(&line); /* nothing is there */
  fclose(line.terminal);
  assert_int_equal(size, 0);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_line), cmocka_unit_test(test_resumed),
                                     cmocka_unit_test(test_near_the_end), cmocka_unit_test(test_output),
                                     cmocka_unit_test(test_nobody)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
