/* Every allocation of the base library fails once: each call then ends with an error that says so, releases what it
   has, and leaves the files as they were. */
#define _GNU_SOURCE /* O_PATH, fopencookie */
#include "temporary.h"
#include "trax/beneath.h"
#include "trax/files.h"
#include "trax/input.h"
#include "trax/map.h"
#include "trax/output.h"
#include "trax/pool.h"
#include "trax/progress.h"

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* --- the allocations --- */

static int until_failure = -1; /* number of allocations that succeed before one fails; -1: none fails */
static int live;               /* number of blocks and streams that were not released */

static bool fails(void) {
  if (until_failure < 0 || until_failure-- > 0)
    return false;
  errno = ENOMEM;
  return true;
}

static void *made(void *block) {
  live += block != NULL;
  return block;
}

/* A replacement of a function that allocates: FAILURE is what it returns if it fails. */
#define ALLOCATOR(name, parameters, arguments)                                                                         \
  void *__real_##name parameters;                                                                                      \
  void *__wrap_##name parameters;                                                                                      \
  void *__wrap_##name parameters {                                                                                     \
    return fails() ? NULL : made(__real_##name arguments);                                                             \
  }

ALLOCATOR(malloc, (size_t size), (size))
ALLOCATOR(calloc, (size_t count, size_t size), (count, size))
ALLOCATOR(aligned_alloc, (size_t alignment, size_t size), (alignment, size))
ALLOCATOR(strdup, (const char *text), (text))
ALLOCATOR(strndup, (const char *text, size_t size), (text, size))
ALLOCATOR(fdopen, (int descriptor, const char *mode), (descriptor, mode))
ALLOCATOR(fmemopen, (void *bytes, size_t size, const char *mode), (bytes, size, mode))
ALLOCATOR(fopencookie, (void *cookie, const char *mode, cookie_io_functions_t functions), (cookie, mode, functions))

void *__real_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size);
void __real_free(void *block);
void __wrap_free(void *block);
int __real_fclose(FILE *file);
int __wrap_fclose(FILE *file);

void *__wrap_realloc(void *block, size_t size) {
  if (fails())
    return NULL;
  live += block == NULL;
  return __real_realloc(block, size);
}

void __wrap_free(void *block) {
  live -= block != NULL;
  __real_free(block);
}

int __wrap_fclose(FILE *file) {
  live--;
  return __real_fclose(file);
}

/* --- the calls --- */

static trax_error error;
static char file[300], link_to_file[300], dangling[300], absent[300];
static int folder;
static FILE *null;

static bool list_files(void) {
  trax_files files = {0};
  trax_files_input(&files, "--in", file);
  trax_files_output(&files, "-o", absent);
  trax_files_output(&files, "--stats", dangling);
  const bool good =
      trax_files_check(&files, &error) == TRAX_OK && trax_files_check_input(&files, file, &error) == TRAX_OK;
  trax_files_release(&files);
  return good;
}

static bool write_link(void) {
  return trax_output_check(link_to_file, &error) == TRAX_OK &&
         trax_write_file(link_to_file, "old", 3, &error) == TRAX_OK;
}

static bool write_device(void) {
  return trax_write_file("/dev/null", "old", 3, &error) == TRAX_OK;
}

static bool write_descriptor(void) {
  return trax_write_file("/dev/fd/2", "", 0, &error) == TRAX_OK;
}

static bool write_beneath(void) {
  return trax_beneath_check(folder, "file", "S", &error) == TRAX_OK &&
         trax_beneath_write(folder, "./file", "S", "old", 3, &error) == TRAX_OK;
}

static bool read_whole(void) {
  uint8_t *bytes;
  size_t size;
  if (trax_read_file(file, 100, &bytes, &size, &error) != TRAX_OK)
    return false;
  free(bytes);
  return size == 3;
}

static bool read_empty(void) {
  uint8_t *bytes;
  size_t size;
  if (trax_read_file("/dev/null", 0, &bytes, &size, &error) != TRAX_OK)
    return false;
  free(bytes);
  return size == 0;
}

static void do_nothing(void *context, uint32_t item) {
  (void)context, (void)item;
}

static bool use_pool(void) {
  unsigned job;
  struct trax_pool *pool = trax_pool_create(2, &error);
  const bool good = pool && trax_pool_add(pool, 3, do_nothing, NULL, &job, &error) == TRAX_OK;
  if (good)
    trax_pool_run(pool, job);
  trax_pool_destroy(pool);
  return good;
}

/* The calls below have no message. */

static bool fill_map(void) {
  struct trax_map map = {0};
  bool good = true;
  strcpy(error.message, "out of memory");
  for (unsigned key = 0; key < 100 && good; key++)
    good = trax_map_put(&map, sizeof(struct trax_map_entry), key, key) != NULL;
  for (unsigned key = 0; key < map.count; key++) /* a map that does not grow keeps what it has */
    assert_int_equal(trax_map_find(&map, sizeof(struct trax_map_entry), key)->value, key);
  trax_map_free(&map);
  return good;
}

static bool show_progress(void) {
  trax_progress_line line = {.terminal = null, .program = "test"};
  strcpy(error.message, "out of memory");
  FILE *output = trax_progress_line_output(&line);
  const bool good = output && trax_progress_line_show(&line, "drawing", 0, NULL);
  trax_progress_line_clear(&line);
  if (output)
    fclose(output);
  return good;
}

static bool (*const calls[])(void) = {list_files, write_link, write_device, write_descriptor, write_beneath,
                                      read_whole, read_empty, use_pool,     fill_map,         show_progress};

static int next_descriptor(void) {
  const int descriptor = open("/dev/null", O_RDONLY);
  close(descriptor);
  return descriptor;
}

static void test_calls(void **state) {
  (void)state;
  snprintf(file, sizeof file, "%s", test_path("file"));
  snprintf(link_to_file, sizeof link_to_file, "%s", test_path("link"));
  snprintf(dangling, sizeof dangling, "%s", test_path("dangling"));
  snprintf(absent, sizeof absent, "%s", test_path("none/./new"));
  assert_int_equal(trax_write_file(file, "old", 3, &error), TRAX_OK);
  assert_int_equal(symlink("file", link_to_file), 0);
  assert_int_equal(symlink("new", dangling), 0);
  folder = open(test_directory(), O_PATH | O_DIRECTORY);
  null = fopen("/dev/null", "w");
  for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
    const int next = next_descriptor(), before = live;
    int allocations = 0;
    for (bool good = false; !good; allocations++) {
      error.message[0] = '\0';
      until_failure = allocations;
      good = calls[i]();
      const bool failed = until_failure < 0;
      until_failure = -1;
      if (good == failed)
        fail_msg("call %zu, allocation %d: %s", i, allocations, good ? "succeeds" : error.message);
      if (failed && !strstr(error.message, "out of memory") && !strstr(error.message, "Cannot allocate memory"))
        fail_msg("call %zu, allocation %d: %s", i, allocations, error.message);
      if (live != before || next_descriptor() != next || count_files() != 3)
        fail_msg("call %zu, allocation %d: leaves %d blocks, descriptor %d, %u files", i, allocations, live - before,
                 next_descriptor() - next, count_files());
    }
    assert_true(allocations > 1);
    assert_true(read_whole());
  }
  fclose(null);
  close(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_calls)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
