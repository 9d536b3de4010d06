/* trax-scene as its user meets it: arguments, messages, exit status, and what is left on the disk. */
#define _GNU_SOURCE
#include "support.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

struct outcome {
  int status; /* as from waitpid */
  char out[8192], err[8192];
};

static void read_back(int descriptor, char *text, size_t size) {
  ssize_t got = pread(descriptor, text, size - 1, 0);
  assert_true(got >= 0);
  text[got] = 0;
  close(descriptor);
}

static pid_t start(int out, int err, const char *const *arguments) {
  const char *argv[32] = {TRAX_SCENE_PROGRAM};
  for (int i = 0; arguments[i]; i++) {
    assert_in_range(i, 0, 29);
    argv[i + 1] = arguments[i];
  }
  pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execv(argv[0], (char *const *)argv);
    _exit(127);
  }
  return child;
}

static void run(struct outcome *outcome, const char *const *arguments) {
  int out = memfd_create("out", MFD_CLOEXEC), err = memfd_create("err", MFD_CLOEXEC);
  assert_true(out >= 0 && err >= 0);
  pid_t child = start(out, err, arguments);
  assert_int_equal(waitpid(child, &outcome->status, 0), child);
  read_back(out, outcome->out, sizeof outcome->out);
  read_back(err, outcome->err, sizeof outcome->err);
}

#define RUN(outcome, ...) run(outcome, (const char *const[]){__VA_ARGS__, NULL})

static int exit_status(const struct outcome *outcome) {
  return WIFEXITED(outcome->status) ? WEXITSTATUS(outcome->status) : -1;
}

static const char *triangle(void) {
  return test_text("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

static void test_success(void **state) {
  (void)state;
  struct outcome outcome;
  const char *scene = test_path("out.trax"), *json = test_path("out.json");
  RUN(&outcome, triangle(), triangle(), "-o", scene, "--stats", "--stats-json", json);
  assert_string_equal(outcome.err, "");
  assert_int_equal(exit_status(&outcome), 0);
  assert_contains(outcome.out, "scene.triangles                   2");
  assert_contains(outcome.out, "import.seconds");
  assert_contains(outcome.out, "build.seconds");
  assert_contains(outcome.out, "memory.import");
  assert_contains(outcome.out, "memory.build");
  char text[8192];
  int descriptor = open(json, O_RDONLY);
  assert_true(descriptor >= 0);
  read_back(descriptor, text, sizeof text);
  assert_contains(text, "\"scene.triangles\": 2,");
  RUN(&outcome, "--check", scene);
  assert_int_equal(exit_status(&outcome), 0);
  assert_string_equal(outcome.out, "");
  RUN(&outcome, "--check", scene, "--stats");
  assert_contains(outcome.out, "bvh.leaves                        1");
  RUN(&outcome, triangle(), "-o", scene, "--smooth", "--crease", "45");
  assert_int_equal(exit_status(&outcome), 0);
  RUN(&outcome, "--check", scene);
  assert_int_equal(exit_status(&outcome), 0);
  RUN(&outcome, "--help");
  assert_int_equal(exit_status(&outcome), 0);
  assert_contains(outcome.out, "usage: trax-scene");
}

static void test_notes(void **state) {
  (void)state;
  struct outcome outcome;
  const char *mesh = test_text("notes.obj", "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 2\n"
                                            "f 1 2 4\nl 1 2\n");
  const char *scene = test_path("notes.trax");
  RUN(&outcome, mesh, "-o", scene, "--drop-nonfinite");
  assert_int_equal(exit_status(&outcome), 0);
  assert_contains(outcome.err, "lost.mtl cannot be read: materials go without");
  assert_contains(outcome.err, "1 of 3 triangles have no area");
  assert_contains(outcome.err, "1 of 3 triangles are not finite");
  assert_contains(outcome.err, "1 points and lines are left out");
  RUN(&outcome, mesh, "-o", scene, "--drop-nonfinite", "-q");
  assert_string_equal(outcome.err, "");
}

static void test_refusals(void **state) {
  (void)state;
  const char *good = triangle(), *flat = test_text("flat.obj", "v 0 0 0\nf 1 1 1\n");
  const char *nan = test_text("nan.obj", "v nan 0 0\nf 1 1 1\n"), *scene = test_path("never.trax");
  const char *lost = test_path("lost.ply"), *nowhere = test_path("no/where.trax");
  const struct {
    const char *arguments[8], *message;
  } bad[] = {
      {{NULL}, "no mesh; try --help"},
      {{good}, "no output; give one with -o"},
      {{"-o", scene}, "no mesh"},
      {{"--check", scene, good}, "--check takes neither"},
      {{good, "-o", scene, "--leaf", "8"}, "--leaf: '8' is not a whole number from 1 to 7"},
      {{good, "-o", scene, "--leaf", "2x"}, "--leaf: '2x'"},
      {{good, "-o", scene, "--passes", "17"}, "--passes: '17' is not a whole number from 0 to 16"},
      {{good, "-o", scene, "--depth", "0"}, "--depth: '0'"},
      {{good, "-o", scene, "--traversal-cost", "nan"}, "--traversal-cost: 'nan' is not a positive number"},
      {{good, "-o", scene, "--intersection-cost", "2"}, "--intersection-cost has been removed; --traversal-cost is"},
      {{good, "-o", scene, "--cache-lines", "0"}, "--cache-lines: '0' is not a whole number from 1 to 4096"},
      {{good, "-o", scene, "--cache-lines", "4097"}, "--cache-lines: '4097'"},
      {{good, "-o", scene, "--splits=9"}, "--splits: '9' is neither auto nor a number from 1 to 8"},
      {{good, "-o", scene, "--nodes", "octal"},
       "--nodes: 'octal' is none of auto, binary, quantised, wide4, wide4-quantised and wide8"},
      {{good, "-o", scene, "--crease", "30"}, "--crease without --smooth or --normals"},
      {{good, "-o", scene, "--smooth", "--crease", "0"}, "--crease: '0' is not an angle"},
      {{good, "-o", scene, "--smooth", "--crease", "181"}, "--crease: '181' is not an angle"},
      {{good, "-o", scene, "--diffuse", "1,2"}, "--diffuse: '1,2' is not [NAME=]R,G,B"},
      {{good, "-o", scene, "--diffuse", "a=0,0,1.5"}, "--diffuse: 'a=0,0,1.5'"},
      {{good, "-o", scene, "--diffuse", "a=0,0,1"}, "no material is named 'a'"},
      {{good, "-o", scene, "--material", "a=tin"}, "--material: 'a=tin' is not [NAME=]lambert"},
      {{good, "-o", scene, "--material", "mirorr"}, "did you mean mirror?"},
      {{good, "-o", scene, "--material", "a=mirror"}, "no material is named 'a'"},
      {{good, "-o", scene, "--texture-size", "100"}, "--texture-size: '100' is not a power of two up to 4096"},
      {{good, "-o", scene, "--texture-size", "8192"}, "--texture-size: '8192' is not"},
      {{good, "-o", scene, "--normals", "round"}, "--normals: 'round' is none of file, smooth and flat"},
      {{good, "-o", scene, "--normals", "flat", "--crease", "30"}, "--crease without --smooth or --normals"},
      {{good, "-o", scene, "--stats-json", scene}, "is written twice, by --output and by --stats-json"},
      {{good, "-o", scene, "--unknown"}, "unknown option --unknown"},
      {{lost, "-o", scene}, "trax-scene: error: "},
      {{good, lost, "-o", scene}, "lost.ply: cannot be read: No such file"},
      {{flat, "-o", scene}, "flat.obj: no triangles are left: all are of zero area"},
      {{nan, "-o", scene}, "nan.obj: 1 of 1 triangles have a vertex that is NaN"},
      {{good, "-o", nowhere}, "where.trax: cannot be written"},
      {{"--check", good}, "triangle.obj: not a scene file"},
      {{"--check", good, "--write-triangles", nowhere}, "--check takes neither --tree nor --write-triangles"},
      {{good, "-o", scene, "--refit-from", "0"}, "--refit-from needs --at, and excludes --refit"},
      {{good, "-o", scene, "--at=1", "--refit-from=0", "--refit", good}, "--refit-from needs --at, and excludes"},
      {{good, "-o", scene, "--at=1", "--refit-from=0", "--splits"}, "--refit-from builds a tree without splits"},
      {{good, "-o", scene, "--animation", "run"}, "--animation without --at"},
  };
  unsigned files = count_files();
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    struct outcome outcome;
    run(&outcome, bad[i].arguments);
    assert_contains(outcome.err, bad[i].message);
    assert_int_equal(exit_status(&outcome), 1);
    assert_string_equal(outcome.out, "");
    assert_int_equal(count_files(), files);
  }
}

/* 300 triangles here and there, and one without area; their material's image is not there. */
static const char *crowd(void) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  test_text("crowd.mtl", "newmtl m\nmap_Kd lost.png\n");
  fprintf(out, "mtllib crowd.mtl\nusemtl m\n");
  uint32_t state = 7;
  for (unsigned i = 1; i <= 300; i++) {
    const float x = 9 * random_unit(&state), y = 9 * random_unit(&state), z = 9 * random_unit(&state);
    fprintf(out, "v %g %g %g\nv %g %g %g\nv %g %g %g\nvt 0 0\nf -3/1 -2/1 -1/1\n", (double)x, (double)y, (double)z,
            (double)(x + random_unit(&state)), (double)y, (double)z, (double)x, (double)(y + random_unit(&state)),
            (double)z);
  }
  fprintf(out, "f 1/1 2/1 2/1\n");
  fclose(out);
  const char *path = test_text("crowd.obj", text);
  free(text);
  return path;
}

/* Imports it with an option; the file's bytes, for as long as the next but one call. */
static size_t import_crowd(struct outcome *outcome, const char *option, const char *value, char **bytes) {
  static char kept[2][1 << 17];
  static unsigned next;
  const char *scene = test_path("crowd.trax");
  RUN(outcome, crowd(), "-o", scene, "--stats", option, value);
  assert_int_equal(exit_status(outcome), 0);
  struct outcome check;
  RUN(&check, "--check", scene);
  assert_int_equal(exit_status(&check), 0);
  *bytes = kept[next++ % 2];
  const int descriptor = open(scene, O_RDONLY);
  const ssize_t size = read(descriptor, *bytes, sizeof kept[0]);
  close(descriptor);
  assert_in_range(size, 1, sizeof kept[0] - 1);
  return (size_t)size;
}

static unsigned figure(const struct outcome *outcome, const char *name) {
  const char *at = strstr(outcome->out, name);
  assert_non_null(at);
  return (unsigned)strtoul(at + strlen(name), NULL, 10);
}

static void test_what_options_do(void **state) {
  (void)state;
  struct outcome plain, changed;
  char *bytes, *others;
  const size_t size = import_crowd(&plain, "--depth", "32", &bytes); /* the default */
  assert_contains(plain.err, "1 of 301 triangles have no area");
  assert_contains(plain.err, "lost.png");
  assert_int_equal(figure(&plain, "scene.triangles "), 300);

  import_crowd(&changed, "--no-textures", NULL, &others);
  assert_null(strstr(changed.err, "lost.png"));

  assert_int_equal(import_crowd(&changed, "--cache-lines", "256", &others), size); /* the default */
  import_crowd(&plain, "--cache-lines", "256", &bytes);
  assert_memory_equal(bytes, others, size);
  assert_int_equal(import_crowd(&changed, "--cache-lines", "1", &others), size);
  assert_memory_not_equal(bytes, others, size);

  const unsigned leaves = figure(&plain, "bvh.leaves ");
  import_crowd(&changed, "--traversal-cost", "10", &others);
  assert_true(figure(&changed, "bvh.leaves ") < leaves);
  import_crowd(&changed, "--traversal-cost", "0.1", &others);
  assert_true(figure(&changed, "bvh.leaves ") > leaves);
}

/* The file at the output stays when the input is bad. */
static void test_output_survives(void **state) {
  (void)state;
  struct outcome outcome;
  const char *scene = test_text("old.trax", "old");
  RUN(&outcome, test_text("bad.obj", "v 0 0 0\nf 1 2 3\n"), "-o", scene);
  assert_int_equal(exit_status(&outcome), 1);
  assert_contains(outcome.err, "bad.obj:2: vertex index 2 is out of range");
  char text[16];
  read_back(open(scene, O_RDONLY), text, sizeof text);
  assert_string_equal(text, "old");
}

/* Failure to print is an error. */
static void test_full_output(void **state) {
  (void)state;
  const char *scene = test_path("full.trax");
  const char *const commands[][6] = {{"--help"}, {triangle(), "-o", scene, "--stats"}, {"--check", scene, "--stats"}};
  for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
    const int full = open("/dev/full", O_WRONLY | O_CLOEXEC), err = memfd_create("err", MFD_CLOEXEC);
    assert_true(full >= 0 && err >= 0);
    const pid_t child = start(full, err, commands[i]);
    struct outcome outcome;
    assert_int_equal(waitpid(child, &outcome.status, 0), child);
    read_back(err, outcome.err, sizeof outcome.err);
    close(full);
    assert_contains(outcome.err, "trax-scene: error: standard output cannot be written: No space left");
    assert_int_equal(exit_status(&outcome), 1);
  }
}

/* Interrupted while the importer waits for its input (a pipe that nobody writes): ends by the signal, at once, with
   nothing left behind. */
static void test_interrupt(void **state) {
  (void)state;
  const char *pipe = test_path("pipe.obj"), *scene = test_path("interrupted.trax");
  assert_int_equal(mkfifo(pipe, 0600), 0);
  unsigned files = count_files();
  int null = open("/dev/null", O_RDWR | O_CLOEXEC), err = memfd_create("err", MFD_CLOEXEC), writer;
  pid_t child = start(null, err, (const char *const[]){pipe, "-o", scene, NULL});
  while ((writer = open(pipe, O_WRONLY | O_NONBLOCK | O_CLOEXEC)) < 0) { /* until the importer reads */
    assert_int_equal(errno, ENXIO);
    assert_int_equal(waitpid(child, NULL, WNOHANG), 0);
    usleep(10000);
  }
  assert_int_equal(kill(child, SIGINT), 0);
  int status;
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFSIGNALED(status));
  assert_int_equal(WTERMSIG(status), SIGINT);
  char text[1024];
  read_back(err, text, sizeof text);
  assert_contains(text, "interrupted; nothing was written");
  assert_int_equal(count_files(), files);
  close(writer);
  close(null);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_success),         cmocka_unit_test(test_notes),           cmocka_unit_test(test_refusals),
      cmocka_unit_test(test_what_options_do), cmocka_unit_test(test_output_survives), cmocka_unit_test(test_interrupt),
      cmocka_unit_test(test_full_output),
  };
  return cmocka_run_group_tests_name("trax-scene", tests, NULL, NULL);
}
