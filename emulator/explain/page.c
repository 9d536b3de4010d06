#define _POSIX_C_SOURCE 200809L /* open_memstream */
#define ZLIB_CONST
#include "explain/page.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* --- JSON --- */

void trax_page_quote(FILE *out, const char *text, size_t size) {
  fputc('"', out);
  for (size_t i = 0; i < size; i++) {
    const unsigned char c = (unsigned char)text[i];
    if (c == '"' || c == '\\')
      fprintf(out, "\\%c", c);
    else if (c == '\n')
      fputs("\\n", out);
    else if (c < 0x20)
      fprintf(out, "\\u%04x", c);
    else
      putc_unlocked(c, out);
  }
  fputc('"', out);
}

void trax_page_number(FILE *out, uint64_t value) {
  for (; value >= 128; value >>= 7)
    putc_unlocked((int)(value & 127) | 128, out);
  putc_unlocked((int)value, out);
}

void trax_page_decimal(FILE *out, uint64_t value) {
  char digits[20];
  size_t at = sizeof digits;
  do
    digits[--at] = (char)('0' + value % 10);
  while (value /= 10);
  while (at < sizeof digits)
    putc_unlocked(digits[at++], out);
}

trax_status trax_page_text(FILE *out, const char *name, trax_status (*put)(void *self, FILE *out, trax_error *error),
                           void *self, trax_error *error) {
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  if (!memory)
    return trax_fail(error, "out of memory for the page");
  trax_status status = put(self, memory, error);
  if (fclose(memory) != 0 && status == TRAX_OK)
    status = trax_fail(error, "out of memory for the page");
  if (status == TRAX_OK) {
    fprintf(out, "\"%s\": ", name);
    trax_page_quote(out, text, size);
    fputs(",\n", out);
  }
  free(text);
  return status;
}

/* --- figures: name, unit, meaning, group, of which the statistics have the values --- */

static void put_figure(void *context, const struct trax_figure *figure) {
  FILE *out = context;
  const char *const texts[] = {figure->name, figure->unit, figure->meaning};
  fputs("[", out);
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    trax_page_quote(out, texts[i], strlen(texts[i]));
    fputs(", ", out);
  }
  fprintf(out, "%d],\n", (int)figure->group);
}

static void put_figures(const struct trax_machine *machine, FILE *out) {
  fputs("\"figures\": [\n", out);
  trax_figures_visit(&machine->stats, NULL, &machine->config, put_figure, out);
  fputs("null],\n", out);
}

/* --- the script elements --- */

static void put_base64(FILE *out, const uint8_t *bytes, size_t size) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < size; i += 3) {
    const size_t left = size - i;
    const uint32_t word =
        (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    putc_unlocked(digits[word >> 18], out);
    putc_unlocked(digits[word >> 12 & 63], out);
    putc_unlocked(left > 1 ? digits[word >> 6 & 63] : '=', out);
    putc_unlocked(left > 2 ? digits[word & 63] : '=', out);
  }
}

/* Packs the bytes as zlib does. strategy: of zlib. */
static trax_status put_script(FILE *out, const char *name, const char *bytes, size_t size, int strategy,
                              trax_error *error) {
  enum { PART = 1 << 30, BUFFER = 3 << 14 }; /* BUFFER: a multiple of 3, for base64 */
  uint8_t *packed = malloc(BUFFER);
  z_stream stream = {.next_in = (const Bytef *)bytes};
  if (!packed || deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL, strategy) != Z_OK) {
    free(packed);
    return trax_fail(error, "out of memory for the page");
  }
  fprintf(out, "<script type=\"application/octet-stream\" id=\"%s\">", name);
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = packed;
    stream.avail_out = BUFFER;
    while (state == Z_OK && stream.avail_out) {
      if (!stream.avail_in) {
        stream.avail_in = size < PART ? (uInt)size : PART;
        size -= stream.avail_in;
      }
      state = deflate(&stream, size ? Z_NO_FLUSH : Z_FINISH);
    }
    put_base64(out, packed, BUFFER - stream.avail_out);
  }
  fputs("</script>\n", out);
  deflateEnd(&stream);
  free(packed);
  return TRAX_OK;
}

static trax_status put_members(struct trax_explain *explain, FILE *out, trax_error *error) {
  fputs("{", out);
  if (explain->options.title) {
    fputs("\"title\": ", out);
    trax_page_quote(out, explain->options.title, strlen(explain->options.title));
    fputs(",\n", out);
  }
  fputs("\"stats\": ", out);
  trax_status status = trax_stats_put_json(explain->machine, false, out, error);
  fputs(",\n", out);
  put_figures(explain->machine, out);
  for (unsigned i = 0; i < explain->reader_count && status == TRAX_OK; i++) {
    struct trax_reader *reader = explain->readers[i];
    if (reader->kind->put_members)
      status = reader->kind->put_members(reader, out, error);
    for (unsigned k = 0; k < TRAX_READER_FILES && status == TRAX_OK; k++)
      if (reader->kind->files[k].member)
        status = trax_page_text(out, reader->kind->files[k].member, reader->kind->files[k].put, reader, error);
  }
  return status;
}

/* The page's reader is the last of TRAX_READERS, so the others have finished. */
static trax_status put_page(void *self, FILE *out, trax_error *error) {
  struct trax_explain *explain = ((struct trax_reader *)self)->explain;
  char *texts[2] = {NULL, NULL};
  size_t sizes[2] = {0, 0};
  FILE *members = open_memstream(&texts[0], &sizes[0]), *columns = open_memstream(&texts[1], &sizes[1]);
  trax_status status = members && columns ? put_members(explain, members, error) : TRAX_ERROR;
  if (status == TRAX_OK)
    status = trax_pixels_put(explain, members, columns, error);
  bool complete = members && fputs("\"end\": null}\n", members) != EOF;
  complete = members && fclose(members) == 0 && complete;
  complete = columns && fclose(columns) == 0 && complete;
  if (!complete)
    status = trax_fail(error, "out of memory for the page");
  fputs(trax_page_begin, out);
  if (status == TRAX_OK)
    status = put_script(out, "data", texts[0], sizes[0], Z_DEFAULT_STRATEGY, error);
  if (status == TRAX_OK) /* twice as fast as the default, and 5 % larger */
    status = put_script(out, "pixels", texts[1], sizes[1], Z_RLE, error);
  fputs(trax_page_end, out);
  free(texts[0]);
  free(texts[1]);
  return status;
}

const struct trax_reader_kind trax_page_reader = {.bytes = sizeof(struct trax_reader),
                                                  .files = {{.path = TRAX_EXPLAIN_PATH(explore), .put = put_page}}};
