/* Outputs (trax/output.h) of unusual paths, and what happens to them between their opening and their end. What is
   refused leaves the earlier file, nothing beside it, and no open descriptor. */
#define _GNU_SOURCE /* O_PATH */
#include "temporary.h"
#include "trax/files.h"
#include "trax/output.h"
#include "trax/reads.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static trax_error error;

static int next_descriptor(void) {
  const int descriptor = open("/dev/null", O_RDONLY);
  close(descriptor);
  return descriptor;
}

static void make_file(const char *path, const char *text) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static void expect_text(const char *path, const char *text) {
  char found[32] = "";
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  found[fread(found, 1, sizeof found - 1, file)] = '\0';
  fclose(file);
  assert_string_equal(found, text);
}

static void expect_refusal(trax_status status, const char *path, const char *reason) {
  char expected[600];
  snprintf(expected, sizeof expected, "%s: %s", path, reason);
  assert_int_equal(status, TRAX_ERROR);
  assert_string_equal(error.message, expected);
}

/* Both the check before a run and the writing refuse the path. */
static void refused(const char *path, const char *reason) {
  const int next = next_descriptor();
  expect_refusal(trax_output_check(path, &error), path, reason);
  expect_refusal(trax_write_file(path, "new", 3, &error), path, reason);
  assert_int_equal(next_descriptor(), next);
}

/* --- descriptors --- */

static void test_descriptors(void **state) {
  (void)state;
  static const int modes[] = {O_RDONLY, O_PATH, O_WRONLY | O_APPEND, O_RDWR | O_APPEND};
  const char *file = test_path("file");
  make_file(file, "old ");
  for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
    const int descriptor = open(file, modes[i]);
    char path[32];
    snprintf(path, sizeof path, "/dev/fd/%d", descriptor);
    if (i < 2) {
      refused(path, "cannot be written: Bad file descriptor");
    } else {
      assert_int_equal(trax_output_check(path, &error), TRAX_OK);
      assert_int_equal(trax_write_file(path, "new ", 4, &error), TRAX_OK);
    }
    close(descriptor);
    refused(path, "cannot be written: Bad file descriptor");
  }
  expect_text(file, "old new new ");
  unlink(file);
}

/* Standard output that is full, after more than the buffer, which is written at once and dropped. The message has the
   reason, whatever happened since. */
static void test_full_stream(void **state) {
  (void)state;
  int status;
  const pid_t child = fork();
  if (child == 0) {
    static char bytes[1 << 17];
    stdout = fopen("/dev/full", "w");
    for (unsigned i = 0; i < 2; i++) {
      fwrite(bytes, 1, sizeof bytes, stdout);
      isatty(next_descriptor()); /* sets errno */
      if (trax_output_flush(&error) != TRAX_ERROR ||
          strcmp(error.message, "standard output cannot be written: No space left on device") != 0)
        _exit(1);
    }
    _exit(0);
  }
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_int_equal(status, 0);
}

/* --- links --- */

static void test_links(void **state) {
  (void)state;
  enum { LINKS = TRAX_MOST_LINKS + 1 };
  char name[16], target[16] = "end";
  for (unsigned i = 1; i <= LINKS; i++) {
    snprintf(name, sizeof name, "link%u", i);
    assert_int_equal(symlink(target, test_path(name)), 0);
    strcpy(target, name);
  }
  char last[300];
  snprintf(last, sizeof last, "%s", test_path(name));
  for (unsigned there = 0; there < 2; there++) {
    refused(last, "cannot be written: Too many levels of symbolic links");
    assert_int_equal(count_files(), LINKS + there);
    snprintf(name, sizeof name, "link%u", TRAX_MOST_LINKS);
    assert_int_equal(trax_write_file(test_path(name), "new", 3, &error), TRAX_OK);
    expect_text(test_path("end"), "new");
    assert_int_equal(count_files(), LINKS + 1);
  }
  for (unsigned i = 1; i <= LINKS; i++) {
    snprintf(name, sizeof name, "link%u", i);
    unlink(test_path(name));
  }
  unlink(test_path("end"));
}

/* A link to itself names no file, neither the input nor one that can be written. */
static void test_loop(void **state) {
  (void)state;
  const char *loop = test_path("loop"), *input = test_path("input");
  trax_files files = {0};
  make_file(input, "old");
  assert_int_equal(symlink("loop", loop), 0);
  refused(loop, "cannot be written: Too many levels of symbolic links");
  trax_files_input(&files, NULL, input);
  trax_files_output(&files, NULL, loop);
  assert_int_equal(trax_files_check(&files, &error), TRAX_OK);
  trax_files_release(&files);
  unlink(loop);
  unlink(input);
}

/* --- what the target becomes while the output is written --- */

static void become_folder(const char *path) {
  unlink(path);
  mkdir(path, 0777);
}

static void become_link(const char *path) {
  unlink(path);
  assert_int_equal(symlink("elsewhere", path), 0);
}

static void become_input(const char *path) {
  struct stat status;
  assert_int_equal(stat(path, &status), 0);
  trax_reads_note(&status);
}

static const struct {
  void (*become)(const char *path);
  const char *reason;
} changes[] = {{become_folder, "cannot be written: Is a directory"},
               {become_link, "cannot be written: File exists"},
               {become_input, "is an input and the output"}};

static void test_changes(void **state) {
  (void)state;
  trax_reads_begin();
  for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
    const char *path = test_path("target");
    make_file(path, "old");
    const int next = next_descriptor();
    trax_output output;
    assert_int_equal(trax_output_open(&output, path, &error), TRAX_OK);
    fputs("new", output.file);
    changes[i].become(path);
    expect_refusal(trax_output_commit(&output, &error), path, changes[i].reason);
    assert_int_equal(count_files(), 1);
    assert_int_equal(next_descriptor(), next);
    if (changes[i].become == become_input)
      expect_text(path, "old");
    assert_int_equal(remove(path), 0);
  }
}

static void test_removed_folder(void **state) {
  (void)state;
  char folder[300], path[310];
  snprintf(folder, sizeof folder, "%s", test_path("folder"));
  snprintf(path, sizeof path, "%s/file", folder);
  assert_int_equal(mkdir(folder, 0777), 0);
  trax_output output;
  assert_int_equal(trax_output_open(&output, path, &error), TRAX_OK);
  assert_int_equal(unlink(output.temporary), 0);
  assert_int_equal(rmdir(folder), 0);
  expect_refusal(trax_output_commit(&output, &error), path, "cannot be written: No such file or directory");
}

/* --- limits --- */

static void test_no_descriptors(void **state) {
  (void)state;
  const char *path = test_path("kept");
  struct rlimit before;
  make_file(path, "old");
  getrlimit(RLIMIT_NOFILE, &before);
  setrlimit(RLIMIT_NOFILE, &(struct rlimit){(rlim_t)next_descriptor(), before.rlim_max});
  const trax_status checked = trax_output_check(path, &error), written = trax_write_file(path, "new", 3, &error);
  setrlimit(RLIMIT_NOFILE, &before);
  assert_int_equal(checked, TRAX_ERROR);
  expect_refusal(written, path, "cannot be written: Too many open files");
  expect_text(path, "old");
  assert_int_equal(count_files(), 1);
  unlink(path);
}

/* A new file has the permissions of the umask, and an earlier one keeps its own. */
static void test_modes(void **state) {
  (void)state;
  const char *path = test_path("mode");
  struct stat status;
  const mode_t before = umask(027);
  static const mode_t modes[] = {0640, 0750, 0750};
  for (unsigned i = 0; i < 3; i++) {
    assert_int_equal(trax_write_whole(path, "new", 3, i == 1, &error), TRAX_OK);
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 07777, modes[i]);
  }
  umask(before);
  unlink(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_descriptors),    cmocka_unit_test(test_full_stream),
                                     cmocka_unit_test(test_links),          cmocka_unit_test(test_loop),
                                     cmocka_unit_test(test_changes),        cmocka_unit_test(test_removed_folder),
                                     cmocka_unit_test(test_no_descriptors), cmocka_unit_test(test_modes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
