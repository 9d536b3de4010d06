/* Fuzzes the loader: the first file of a case is the executable. It is opened, its symbols and source lines are looked
   up, it is loaded and run for some cycles, and at the end every thread is unwound. The word
   `functional` in the line of options selects that engine. */
#include "fuzz_case.h"
#include "machine/machine.h"
#include "program/program.h"
#include "report/backtrace.h"
#include "trax/input.h"

#include <stdlib.h>
#include <string.h>

trax_status __wrap_trax_input_open(trax_input *input, const char *path, trax_error *error);
trax_status __wrap_trax_input_read(trax_input *input, size_t size, trax_error *error);

static const fuzz_file *current;
static bool was_read; /* the loader may get another door */

trax_status __wrap_trax_input_open(trax_input *input, const char *path, trax_error *error) {
  (void)error;
  was_read = true;
  *input = (trax_input){.path = path, .descriptor = -1, .is_regular = true, .expected = current->size};
  return TRAX_OK;
}

/* Allocates exactly the bytes that were asked for, and the NUL, so that a sanitizer sees reads beyond them. */
trax_status __wrap_trax_input_read(trax_input *input, size_t size, trax_error *error) {
  (void)error;
  const size_t read = size < current->size ? size : current->size;
  if (read <= input->size && input->bytes)
    return TRAX_OK;
  input->bytes = realloc(input->bytes, read + 1);
  if (!input->bytes)
    abort();
  memcpy(input->bytes, current->bytes, read);
  input->bytes[read] = 0;
  input->size = input->capacity = read;
  return TRAX_OK;
}

/* Reads a string to its end, so that the sanitizer checks it. */
static size_t touch(const char *text) {
  return text ? strlen(text) : 0;
}

static void add_frame(void *context, uint32_t function, uint32_t bytes) {
  *(size_t *)context += function + bytes;
}

static size_t look_up_variables(trax_image *image, uint32_t pc) {
  struct trax_frame_variable *items;
  unsigned base;
  size_t sum = 0;
  const size_t count = trax_image_variables(image, pc, &items, &base);
  for (size_t i = 0; i < count; i++)
    sum += touch(items[i].name);
  free(items);
  return sum;
}

static size_t look_up_symbols(trax_image *image) {
  struct trax_source_line lines[8];
  size_t count, sum = 0;
  trax_image_frames(image, add_frame, &sum);
  const struct trax_symbol *symbols = trax_image_symbols(image, &count);
  for (size_t i = 0; i < count && i < 64; i++) {
    sum += touch(symbols[i].name);
    const size_t frames = trax_image_lines(image, symbols[i].address, lines, 8);
    for (size_t frame = 0; frame < frames; frame++)
      sum += touch(lines[frame].function) + touch(lines[frame].file);
    sum += look_up_variables(image, symbols[i].address);
    const struct trax_symbol *symbol = trax_image_symbol_at(image, symbols[i].address + 1);
    sum += symbol ? touch(symbol->name) : 0;
  }
  return sum;
}

static void run(trax_machine *machine, const char *words, FILE *nowhere) {
  trax_error error = {.message = ""};
  const trax_run_options options = {
      .output = nowhere, .max_cycles = 2000, .engine = strstr(words, "functional") ? "functional" : "fast"};
  struct trax_post_mortem *post_mortem = trax_post_mortem_create(machine, NULL, true, &error);
  const trax_status status = trax_machine_run(machine, &options, &error);
  if (!post_mortem || touch(trax_post_mortem_text(post_mortem)) == 0)
    abort();
  trax_post_mortem_destroy(post_mortem);
  if (status == TRAX_FAULT)
    trax_machine_print_fault(machine, nowhere);
  if (status == TRAX_ERROR) {
    fprintf(stderr, "%s\n", error.message);
    abort();
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  static FILE *nowhere;
  static volatile size_t sum;
  if (!nowhere && !(nowhere = fopen("/dev/null", "w")))
    abort();
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  current = fuzz_case.file_count ? &fuzz_case.files[0] : NULL;
  trax_error error = {.message = ""};
  trax_config *config = trax_config_create();
  if (!config || trax_config_set(config, "memory.size_mib", "4", &error))
    abort();
  trax_machine *machine = trax_machine_create(config, &error);
  was_read = !machine || !current;
  const bool loaded = machine && current && trax_machine_load_elf(machine, "program.elf", &error) == TRAX_OK;
  if (!was_read)
    abort();
  if (loaded) {
    sum += look_up_symbols(trax_loaded_of(machine)->image);
    if (strstr(fuzz_case.options, "main-on-0") && trax_machine_main_on_thread_0(machine, &error) == TRAX_ERROR &&
        !error.message[0])
      abort();
    run(machine, fuzz_case.options, nowhere);
  } else if (machine && current && !error.message[0]) {
    abort(); /* refused without a reason */
  }
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  fuzz_case_free(&fuzz_case);
  return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t capacity, unsigned seed) {
  static const char words[] = "functional main-on-0";
  return fuzz_case_mutate(bytes, size, capacity, seed, words);
}
