/* Fuzzes configurations: the words of a case's first line are assignments as for --set, and its first file is a
   configuration file. An accepted configuration is printed and must read back as the same one. */
#include "fuzz_case.h"
#include "host/config.h"
#include "machine/config.h"
#include "trax/input.h"

#include <stdlib.h>
#include <string.h>

trax_status __wrap_trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error);

/* libconfig leaks the text of an unterminated string. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
  return "leak:libconfig";
}

static const uint8_t *current;
static size_t current_size;

trax_status __wrap_trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error) {
  (void)path, (void)limit, (void)error;
  *bytes = malloc(current_size + 1);
  if (!*bytes)
    abort();
  if (current_size)
    memcpy(*bytes, current, current_size);
  (*bytes)[current_size] = 0;
  *size = current_size;
  return TRAX_OK;
}

static trax_status read_text(struct trax_config *config, const uint8_t *bytes, size_t size, trax_error *error) {
  current = bytes;
  current_size = size;
  const trax_status status = trax_config_read_file(config, "machine.cfg", error);
  if (status != TRAX_OK && strncmp(error->message, "machine.cfg:", 12) != 0) {
    fprintf(stderr, "a message without file and line: %s\n", error->message);
    abort();
  }
  return status;
}

static void print(const struct trax_config *config, char **text, size_t *size) {
  FILE *out = open_memstream(text, size);
  if (!out)
    abort();
  trax_config_print(config, out);
  fclose(out);
}

static void read_back(const struct trax_config *config) {
  char *first, *second;
  size_t first_size, second_size;
  trax_error error = {.message = ""};
  trax_config *again = trax_config_create();
  print(config, &first, &first_size);
  if (!again || read_text(again, (const uint8_t *)first, first_size, &error) != TRAX_OK) {
    fprintf(stderr, "a printed configuration is refused: %s\n%s", error.message, first);
    abort();
  }
  print(again, &second, &second_size);
  if (first_size != second_size || memcmp(first, second, first_size) != 0) {
    fprintf(stderr, "a printed configuration reads back as another one:\n%s%s", first, second);
    abort();
  }
  trax_config_destroy(again);
  free(first);
  free(second);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  trax_error error = {.message = ""};
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  trax_config *config = trax_config_create();
  if (!config)
    abort();
  bool accepted = true;
  if (fuzz_case.file_count)
    accepted = read_text(config, fuzz_case.files[0].bytes, fuzz_case.files[0].size, &error) == TRAX_OK;
  char *words[FUZZ_MAX_OPTIONS / 2 + 1];
  const size_t count = fuzz_case_words(fuzz_case.options, words, FUZZ_MAX_OPTIONS / 2 + 1);
  for (size_t i = 0; i < count; i++) {
    char *equals = strchr(words[i], '=');
    if (equals)
      *equals = 0;
    accepted &= trax_config_set(config, words[i], equals ? equals + 1 : "", &error) == TRAX_OK;
  }
  if (!accepted && !error.message[0])
    abort(); /* refused without a reason */
  if (trax_config_check(config, &error) == TRAX_OK)
    read_back(config); /* refused values have left the configuration unchanged */
  trax_config_destroy(config);
  fuzz_case_free(&fuzz_case);
  return 0;
}
