/* trax-isa-model: runs an executable as docs/isa.md says, and writes its signature. */
#include "model.h"
#include "trax/files.h"
#include "trax/version.h"

#include <argp.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct options {
  uint32_t tms, tps, memory_mib, precision;
  uint64_t limit;
  const char *manual, *signature, *image;
};

static uint64_t number(struct argp_state *state, const char *option, const char *text, uint64_t least, uint64_t most) {
  char *rest;
  errno = 0;
  const unsigned long long value = strtoull(text, &rest, 10);
  if (*text < '0' || *text > '9' || *rest || errno || value < least || value > most)
    argp_error(state, "--%s %s: expected a number from %" PRIu64 " to %" PRIu64, option, text, least, most);
  return value;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  struct options *options = state->input;
  switch (key) {
  case 'm':
    options->tms = (uint32_t)number(state, "tms", text, 1, 64);
    return 0;
  case 'p':
    options->tps = (uint32_t)number(state, "tps", text, 1, 64);
    return 0;
  case 'M':
    options->memory_mib = (uint32_t)number(state, "memory-mib", text, 1, 4095);
    return 0;
  case 'b':
    options->precision = (uint32_t)number(state, "precision", text, 1, 24);
    return 0;
  case 'l':
    options->limit = number(state, "limit", text, 1, UINT64_MAX);
    return 0;
  case 'd':
    options->manual = text;
    return 0;
  case 's':
    options->signature = text;
    return 0;
  case ARGP_KEY_ARG:
    if (options->image)
      argp_error(state, "one image, not '%s' too", text);
    if (!*text)
      argp_error(state, "the image's name is empty");
    options->image = text;
    return 0;
  case ARGP_KEY_END:
    if (!options->image)
      argp_error(state, "an image is needed");
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

static void print_signature(const struct model_machine *machine, const struct model_image *image, FILE *file) {
  for (uint32_t address = image->begin_signature; address < image->end_signature; address += 4) {
    const uint8_t *bytes = machine->memory + address;
    fprintf(file, "%02x%02x%02x%02x\n", bytes[3], bytes[2], bytes[1], bytes[0]);
  }
  const struct model_fault *fault = &machine->fault;
  if (fault->kind)
    fprintf(file, "fault %s pc %08" PRIx32 " address %08" PRIx32 "\n", model_fault_word(fault->kind), fault->pc,
            fault->address);
}

/* Under its name only when it is complete. */
static bool write_signature(const struct model_machine *machine, const struct model_image *image, const char *path,
                            struct model_error *error) {
  char *temporary = NULL;
  if (strcmp(path, "-") == 0) {
    print_signature(machine, image, stdout);
    return true;
  }
  if (asprintf(&temporary, "%s.%ld", path, (long)getpid()) < 0)
    return model_fail(error, "out of memory");
  FILE *file = fopen(temporary, "w");
  if (file)
    print_signature(machine, image, file);
  const bool written = file && !ferror(file);
  const bool good = file && fclose(file) == 0 && written && rename(temporary, path) == 0;
  if (!good) {
    model_fail(error, "%s: cannot be written: %s", path, strerror(errno));
    if (file)
      remove(temporary);
  }
  free(temporary);
  return good;
}

/* The exit status, or -1 with *error. */
static int run(struct model_machine *machine, const struct options *options, struct model_error *error) {
  struct model_image image = {0};
  if (!model_load_image(machine, options->image, &image, error))
    return -1;
  if (options->signature && !image.end_signature) {
    model_fail(error, "%s: the program has no symbols begin_signature and end_signature", options->image);
    return -1;
  }
  machine->precision = options->precision;
  machine->output = stdout;
  const enum model_end end = model_run(machine, options->limit, error);
  if (end == MODEL_ERROR)
    return -1;
  if (end == MODEL_LIMIT) {
    fprintf(stderr, "trax-isa-model: %s: %" PRIu64 " instructions were executed and the program has not ended\n",
            options->image, options->limit);
    return 124;
  }
  if (options->signature && !write_signature(machine, &image, options->signature, error))
    return -1;
  if (end == MODEL_ENDED)
    return model_status(machine) & 0xFF;
  const struct model_fault *fault = &machine->fault;
  fprintf(stderr, "trax-isa-model: fault: %s, pc 0x%08" PRIx32 ", address 0x%08" PRIx32 ", thread %" PRIu32 "\n",
          model_fault_word(fault->kind), fault->pc, fault->address, fault->thread);
  return fault->kind == MODEL_FAULT_ABORT ? 134 : 1;
}

int main(int argc, char **argv) {
  static const struct argp_option table[] = {
      {"tms", 'm', "N", 0, "thread multiprocessors of the chip; default 1", 0},
      {"tps", 'p', "N", 0, "threads of each; default 1", 0},
      {"memory-mib", 'M', "N", 0, "end of global memory, in MiB; default 1024", 0},
      {"precision", 'b', "BITS", 0, "of FPDIV and iSQRT; default 24, correctly rounded", 0},
      {"limit", 'l', "N", 0, "stop after so many instructions, with status 124; default 1000000000", 0},
      {"manual", 'd', "FILE", 0, "instead of the project's docs/isa.md", 0},
      {"signature", 's', "FILE", 0, "write the words from begin_signature to end_signature", 0},
      {0}};
  static const struct argp argp = {
      table,
      parse,
      "IMAGE",
      "Runs an executable as the manual's semantics say, threads in turn, one instruction each.\v"
      "Exit status: the program's; 1 for an error of use or a fault, 134 for an abort, 124 for the limit.",
      NULL,
      NULL,
      NULL};
  struct options options = {
      .tms = 1, .tps = 1, .memory_mib = 1024, .precision = 24, .limit = 1000000000, .manual = MODEL_MANUAL};
  struct model_error error;
  argp_err_exit_status = 1;
  argp_program_version = "trax-isa-model " TRAX_VERSION;
  argp_parse(&argp, argc, argv, 0, NULL, &options);
  trax_files files = {0};
  trax_error wrong;
  trax_files_input(&files, NULL, options.image);
  trax_files_input(&files, NULL, options.manual);
  trax_files_output(&files, "--signature", options.signature);
  if (trax_files_check(&files, &wrong) != TRAX_OK) {
    fprintf(stderr, "trax-isa-model: error: %s\n", wrong.message);
    return 1;
  }
  trax_files_release(&files);
  struct model_isa *isa = model_isa_read(options.manual, &error);
  struct model_machine *machine =
      isa ? model_create(isa, options.tms, options.tps, (uint64_t)options.memory_mib << 20, &error) : NULL;
  int status = machine ? run(machine, &options, &error) : -1;
  if (status >= 0 && (fflush(stdout) != 0 || ferror(stdout))) {
    model_fail(&error, "standard output: %s", strerror(errno));
    status = -1;
  }
  if (status < 0)
    fprintf(stderr, "trax-isa-model: error: %s\n", error.message);
  model_destroy(machine);
  model_isa_free(isa);
  return status < 0 ? 1 : status;
}
