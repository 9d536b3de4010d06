/* Files beneath a folder. They are opened with openat2 and as on a host that has none or refuses it: the same answers
   but for links. They are written whole or not at all. */
#define _GNU_SOURCE /* O_PATH */
#include "temporary.h"
#include "trax/beneath.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmocka.h>

static int refused; /* errno of openat2; 0: the host decides */

long __real_syscall(long number, ...);
long __wrap_syscall(long number, int folder, const char *path, const void *how, size_t size);

long __wrap_syscall(long number, int folder, const char *path, const void *how, size_t size) {
  assert_int_equal(number, SYS_openat2);
  if (!refused)
    return __real_syscall(number, folder, path, how, size);
  errno = refused;
  return -1;
}

static const struct {
  const char *path;
  int code, without; /* errno with openat2, and without it; 0: opens */
} cases[] = {{"file", 0, 0},
             {"./file", 0, 0},
             {"deep/file", 0, 0},
             {"deep//file", 0, 0},
             {"deep/", 0, 0},
             {".", 0, 0},
             {"none", ENOENT, ENOENT},
             {"none/file", ENOENT, ENOENT},
             {"file/file", ENOTDIR, ENOTDIR},
             {"/etc/passwd", EXDEV, EXDEV},
             {"..", EXDEV, EXDEV},
             {"deep/../../file", EXDEV, EXDEV},
             {"deep/../file", 0, EXDEV},
             {"link", 0, ELOOP},
             {"folder/file", 0, ENOTDIR},
             {"out", EXDEV, ELOOP},
             {"out/passwd", EXDEV, ENOTDIR}};

static int next_descriptor(void) {
  const int descriptor = open("/dev/null", O_RDONLY);
  close(descriptor);
  return descriptor;
}

static void make_file(int folder, const char *name) {
  close(openat(folder, name, O_WRONLY | O_CREAT, 0666));
}

static void test_open(void **state) {
  (void)state;
  const char *inside = test_path("inside");
  assert_int_equal(mkdir(inside, 0777), 0);
  const int folder = open(inside, O_PATH | O_DIRECTORY);
  assert_int_equal(mkdirat(folder, "deep", 0777), 0);
  make_file(folder, "file");
  make_file(folder, "deep/file");
  assert_int_equal(symlinkat("file", folder, "link"), 0);
  assert_int_equal(symlinkat("deep", folder, "folder"), 0);
  assert_int_equal(symlinkat("/etc", folder, "out"), 0);
  static const int codes[] = {0, ENOSYS, EPERM};
  for (size_t k = 0; k < sizeof codes / sizeof *codes; k++)
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
      const int next = next_descriptor(), code = codes[k] ? cases[i].without : cases[i].code;
      refused = codes[k];
      errno = 0;
      const int descriptor = trax_beneath_open(folder, cases[i].path, O_RDONLY);
      if (code ? descriptor >= 0 || errno != code : descriptor < 0)
        fail_msg("%s, openat2 %d: descriptor %d, errno %d", cases[i].path, codes[k], descriptor, errno);
      if (descriptor >= 0)
        close(descriptor);
      assert_int_equal(next_descriptor(), next); /* no folder is left open */
    }
  refused = 0;
  static const char *const made[] = {"deep/file", "file", "link", "folder", "out"};
  for (size_t i = 0; i < sizeof made / sizeof *made; i++)
    unlinkat(folder, made[i], 0);
  unlinkat(folder, "deep", AT_REMOVEDIR);
  close(folder);
  rmdir(inside);
}

/* --- writing --- */

static const struct {
  const char *path, *refusal; /* refusal: NULL: it is written */
} outputs[] = {{"new", NULL},
               {"file", NULL},
               {"deep/new", NULL},
               {"deep", "it is a folder"},
               {"deep/", "Is a directory"},
               {".", "Is a directory"},
               {"deep/..", "Is a directory"},
               {"link", "it is a link"},
               {"pipe", "it is a device or a pipe"},
               {"none/new", "No such file or directory"},
               {"file/new", "Not a directory"},
               {"../new", "leaves its folder"},
               {"out/new", "leaves its folder"},
               {"/tmp/new", "leaves its folder"}};

static unsigned entries_of(int folder, const char *name) {
  DIR *stream = fdopendir(openat(folder, name, O_RDONLY | O_DIRECTORY));
  assert_non_null(stream);
  unsigned entries = 0;
  while (readdir(stream))
    entries++;
  closedir(stream);
  return entries;
}

/* The file's bytes, of which there are few. */
static const char *text_of(int folder, const char *path) {
  static char text[16];
  const int file = openat(folder, path, O_RDONLY);
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  text[size > 0 ? size : 0] = '\0';
  return text;
}

static void make_outputs_folder(int folder) {
  assert_int_equal(mkdirat(folder, "deep", 0777), 0);
  make_file(folder, "file");
  assert_int_equal(fchmodat(folder, "file", 0750, 0), 0);
  assert_int_equal(symlinkat("file", folder, "link"), 0);
  assert_int_equal(symlinkat("/tmp", folder, "out"), 0);
  assert_int_equal(mkfifoat(folder, "pipe", 0666), 0);
}

/* What is refused leaves nothing, and a check only asks. */
static void test_write(void **state) {
  (void)state;
  const char *inside = test_path("outputs");
  assert_int_equal(mkdir(inside, 0777), 0);
  const int folder = open(inside, O_PATH | O_DIRECTORY);
  make_outputs_folder(folder);
  for (size_t i = 0; i < sizeof outputs / sizeof *outputs; i++) {
    const int next = next_descriptor();
    const unsigned entries = entries_of(folder, ".") + entries_of(folder, "deep");
    const char *path = outputs[i].path, *refusal = outputs[i].refusal;
    char expected[80];
    snprintf(expected, sizeof expected, "S: cannot be written: %s", refusal ? refusal : "");
    trax_error error;
    assert_int_equal(trax_beneath_check(folder, path, "S", &error), refusal ? TRAX_ERROR : TRAX_OK);
    if (refusal)
      assert_string_equal(error.message, expected);
    assert_int_equal(entries_of(folder, ".") + entries_of(folder, "deep"), entries);
    assert_int_equal(trax_beneath_write(folder, path, "S", path, strlen(path), &error), refusal ? TRAX_ERROR : TRAX_OK);
    if (refusal)
      assert_string_equal(error.message, expected);
    else
      assert_string_equal(text_of(folder, path), path);
    assert_int_equal(entries_of(folder, ".") + entries_of(folder, "deep"), entries + (strstr(path, "new") && !refusal));
    assert_int_equal(next_descriptor(), next);
  }
  struct stat status;
  assert_int_equal(fstatat(folder, "file", &status, 0), 0);
  assert_int_equal(status.st_mode & 07777, 0750);
  static const char *const made[] = {"deep/new", "new", "file", "link", "out", "pipe"};
  for (size_t i = 0; i < sizeof made / sizeof *made; i++)
    assert_int_equal(unlinkat(folder, made[i], 0), 0);
  unlinkat(folder, "deep", AT_REMOVEDIR);
  close(folder);
  rmdir(inside);
}

/* A file that does not become whole leaves the earlier one. */
static void test_limit(void **state) {
  (void)state;
  struct rlimit before;
  trax_error error;
  const int folder = open(test_directory(), O_PATH | O_DIRECTORY);
  assert_int_equal(trax_beneath_write(folder, "kept", "S", "earlier", 7, &error), TRAX_OK);
  signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &before);
  setrlimit(RLIMIT_FSIZE, &(struct rlimit){8, before.rlim_max});
  const trax_status result = trax_beneath_write(folder, "kept", "S", "more than eight", 15, &error);
  setrlimit(RLIMIT_FSIZE, &before);
  assert_int_equal(result, TRAX_ERROR);
  assert_string_equal(error.message, "S: cannot be written: File too large");
  assert_string_equal(text_of(folder, "kept"), "earlier");
  assert_int_equal(count_files(), 1);
  close(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_open), cmocka_unit_test(test_write),
                                     cmocka_unit_test(test_limit)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
