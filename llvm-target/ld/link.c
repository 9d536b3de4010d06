/* The linker as a function: reads objects and archives, writes an executable for the TP. */
#include "ld.h"
#include "trax/output.h"
#include "trax/version.h"

#include <stdlib.h>

/* Objects and archives are compared with the outputs later, when their paths are known. */
static bool check_files(ld_context *ctx) {
  const ld_options *options = &ctx->options;
  trax_error error;
  trax_files_output(&ctx->files, "-o", options->output);
  trax_files_output(&ctx->files, "-Map", options->map_path);
  trax_files_input(&ctx->files, NULL, options->ordering_path);
  for (size_t i = 0; i < options->response_paths.count; i++)
    trax_files_input(&ctx->files, NULL, options->response_paths.items[i]);
  if (trax_files_check(&ctx->files, &error) == TRAX_OK)
    return true;
  ld_error(ctx, "%s", error.message);
  return false;
}

static bool link_program(ld_context *ctx) {
  if (!check_files(ctx) || !ld_load_inputs(ctx) || !ld_finish_symbols(ctx))
    return false;
  ld_split_merge_sections(ctx);
  ld_mark_live(ctx);
  if (!ld_check_undefined(ctx) || !ld_layout(ctx) || !ld_build_call_graph(ctx) || !ld_check_stack(ctx) ||
      !ld_build_image(ctx) || !ld_relocate(ctx))
    return false;
  if (ctx->options.fatal_warnings && ctx->warning_count) {
    ld_error(ctx, "%u warning%s, treated as errors", ctx->warning_count, ctx->warning_count == 1 ? "" : "s");
    return false;
  }
  return (!ctx->options.map_path || ld_write_map(ctx)) && ld_write_image(ctx);
}

static bool run(ld_context *ctx, int argc, char **argv) {
  bool ok = ld_parse_options(ctx, argc - 1, argv + 1);
  if (ok && ctx->options.help)
    ld_print_help(stdout);
  if (ok && ctx->options.version)
    puts("trax-ld " TRAX_VERSION " (compatible with GNU linkers)"); /* Meson and libtool look for "GNU" */
  if (ok && !ctx->options.help && !ctx->options.version_only && ctx->options.inputs.count) {
    ok = link_program(ctx);
    if (ok && ctx->options.print_memory_usage)
      ld_print_memory_usage(ctx, stdout);
  }
  trax_error error;
  if (trax_output_flush(&error) != TRAX_OK) {
    ld_error(ctx, "%s", error.message);
    ok = false;
  }
  ld_report_suppressed(ctx);
  return ok;
}

int ld_main(int argc, char **argv) {
  ld_context *ctx = calloc(1, sizeof *ctx);
  if (!ctx)
    return 1;
  elf_version(EV_CURRENT);
  volatile bool ok = false;
  if (setjmp(ctx->out_of_memory) == 0)
    ok = run(ctx, argc, argv);
  ld_free_all(ctx);
  free(ctx);
  return ok ? 0 : 1;
}
