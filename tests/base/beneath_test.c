/* Files beneath a folder, with openat2 and as on a host that has none or refuses it: the same answers but for links. */
#define _GNU_SOURCE /* O_PATH */
#include "temporary.h"
#include "trax/beneath.h"

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
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

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_open)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
