/* The input files: finds them, tells what they are, and loads objects until nothing more is needed. */
#include "ld.h"

#include <string.h>
#include <unistd.h>

const char *ld_foreign_format(const uint8_t *bytes, size_t size) {
  if (size >= SELFMAG && memcmp(bytes, ELFMAG, SELFMAG) == 0)
    return NULL;
  if (size == 0)
    return "empty";
  if (size >= 4 && memcmp(bytes, "BC\xC0\xDE", 4) == 0)
    return "LLVM bitcode (link-time optimisation is not supported: compile without -flto)";
  for (size_t i = 0; i < size && i < 512; i++)
    if (bytes[i] != '\t' && bytes[i] != '\n' && bytes[i] != '\r' && (bytes[i] < ' ' || bytes[i] > '~'))
      return "neither an ELF object nor an archive";
  return "a text file, neither an ELF object nor an archive (linker scripts are not supported)";
}

static const char *find_library(ld_context *ctx, const char *name) {
  const char *file = name[0] == ':' ? name + 1 : ld_format(ctx, "lib%s.a", name);
  for (size_t i = 0; i < ctx->options.library_paths.count; i++) {
    const char *path = ld_format(ctx, "%s/%s", ctx->options.library_paths.items[i], file);
    if (access(path, F_OK) == 0)
      return path;
  }
  ld_error(ctx, "library -l%s not found: no %s in %s", name, file,
           ctx->options.library_paths.count == 0   ? "the library path, which is empty (-L)"
           : ctx->options.library_paths.count == 1 ? ctx->options.library_paths.items[0]
                                                   : "any directory of the library path (-L)");
  return NULL;
}

/* Loading an object can make others needed, which are loaded after it. */
static void load_pending(ld_context *ctx) {
  for (size_t i = 0; i < ctx->pending.count; i++) {
    ld_object *object = ctx->pending.items[i];
    if (ctx->options.trace)
      printf("%s\n", object->name);
    ld_push(ctx, &ctx->objects, object);
    ld_object_load(ctx, object);
  }
  ctx->pending.count = 0;
}

static void add_input(ld_context *ctx, const ld_input *input) {
  const char *path = input->is_library ? find_library(ctx, input->name) : input->name;
  const uint8_t *bytes;
  size_t size;
  if (!path || !ld_read_file(ctx, path, &bytes, &size))
    return;
  trax_error error;
  if (trax_files_check_input(&ctx->files, path, &error) != TRAX_OK)
    ld_error(ctx, "%s", error.message);
  if (ld_is_archive(bytes, size)) {
    ld_archive_add(ctx, path, bytes, size, input->whole_archive);
    return;
  }
  const char *foreign = ld_foreign_format(bytes, size);
  if (foreign) {
    ld_error(ctx, "%s: is %s", path, foreign);
    return;
  }
  ld_object *object = ld_object_open(ctx, path, bytes, size);
  if (object) {
    object->taken = true;
    ld_push(ctx, &ctx->pending, object);
  }
}

/* The start file calls these functions of the runtime if they are there (weakly), and they are taken from its archive
   only for programs that have something for them to do (docs/abi.md, "Program start"). */
static void offer_start_work(ld_context *ctx) {
  bool start = false, end = false;
  for (size_t i = 0; i < ctx->sections.count; i++) {
    const ld_section *section = ctx->sections.items[i];
    if (section->discarded || section->size == 0)
      continue;
    start |= section->type == SHT_INIT_ARRAY || (section->flags & SHF_TLS && section->type != SHT_NOBITS);
    end |= section->type == SHT_FINI_ARRAY;
  }
  if (start)
    ld_symbols_offer(ctx, "__trax_start");
  if (end)
    ld_symbols_offer(ctx, "__trax_end_program");
}

/* The last object for the program's stack. There is one. */
static const char *last_with_stack(const ld_context *ctx) {
  size_t i = ctx->objects.count - 1;
  while (ctx->objects.items[i]->stack != ctx->stack)
    i--;
  return ctx->objects.items[i]->name;
}

/* Code for a stack in local memory takes automatic objects for the thread's own, and loses what other threads do to
   them if the stack is elsewhere. The first object that says where the stack is, commonly the start file, counts. */
static void check_stacks(ld_context *ctx) {
  static const char *const places[] = {NULL, "local memory", "global memory"};
  const unsigned errors = ctx->error_count;
  for (size_t i = 0; i < ctx->objects.count; i++) {
    const ld_object *object = ctx->objects.items[i];
    if (!ctx->stack)
      ctx->stack = object->stack;
    if (object->stack && object->stack != ctx->stack)
      ld_error(ctx, "%s: is for stacks in %s, %s for stacks in %s: compile and link both with the same -mstack",
               object->name, places[object->stack], last_with_stack(ctx), places[ctx->stack]);
  }
  const ld_symbol *size = ld_symbol_find(ctx, "__trax_stack_size");
  const bool is_global = size && size->kind != LD_UNDEFINED && size->kind != LD_LAZY;
  if (ctx->error_count == errors && ctx->stack && is_global != (ctx->stack == TRAX_EF_STACK_GLOBAL))
    ld_error(ctx, "%s: is for stacks in %s, but __trax_stack_size is %s: compile and link with the same -mstack",
             last_with_stack(ctx), places[ctx->stack], is_global ? "defined" : "not defined");
}

bool ld_load_inputs(ld_context *ctx) {
  const ld_options *options = &ctx->options;
  ld_start_symbols(ctx);
  for (size_t i = 0; i < options->inputs.count; i++) {
    add_input(ctx, &options->inputs.items[i]);
    load_pending(ctx);
  }
  offer_start_work(ctx);
  load_pending(ctx);
  check_stacks(ctx);
  return ctx->error_count == 0;
}
