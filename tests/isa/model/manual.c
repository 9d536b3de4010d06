/* The sections of the manual that describe an instruction. */
#include "semantics.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* One line of the manual, and where it is. */
struct line {
  const char *name;
  unsigned number;
  const char *text, *end;
};

enum { MOST_BOXES = 32, MOST_MANUAL_BYTES = 1 << 24 };

struct box {
  unsigned low, width;
};

/* The section that is being read. */
struct section {
  struct model_instruction instruction; /* mnemonic NULL: not in a section */
  struct box boxes[MOST_BOXES];
  unsigned box_count;
  bool has_ranges, has_diagram, has_immediate; /* has_ranges: the boxes' line comes next */
  unsigned immediate_high, immediate_low;
  struct line semantics;
};

static bool fail_at(struct model_error *error, const struct line *line, const char *reason) {
  return model_fail(error, "%s:%u: %s", line->name, line->number, reason);
}

static bool next_line(struct line *line) {
  const char *begin = line->number ? line->end : line->text;
  if (*begin == '\n' && line->number)
    begin++;
  if (!*begin)
    return false;
  line->text = begin;
  line->end = begin + strcspn(begin, "\n");
  line->number++;
  return true;
}

/* A number in decimal. */
static bool read_number(const char **at, const char *end, unsigned *value) {
  const char *begin = *at;
  for (*value = 0; *at < end && isdigit((unsigned char)**at) && *at - begin < 9; ++*at)
    *value = *value * 10 + (unsigned)(**at - '0');
  return *at > begin;
}

static bool skip(const char **at, const char *end, const char *text) {
  const size_t length = strlen(text);
  if ((size_t)(end - *at) < length || memcmp(*at, text, length) != 0)
    return false;
  *at += length;
  return true;
}

static void skip_blanks(const char **at, const char *end) {
  while (*at < end && isblank((unsigned char)**at))
    ++*at;
}

/* "31..26   25..21 ... 5..0": the bits of the boxes in the next line. Any other line is none of these. */
static bool read_ranges(struct section *section, const struct line *line) {
  const char *at = line->text;
  unsigned high, above = 32;
  section->box_count = 0;
  for (skip_blanks(&at, line->end); at < line->end; skip_blanks(&at, line->end)) {
    unsigned low;
    if (section->box_count == MOST_BOXES || !read_number(&at, line->end, &high))
      return false;
    low = high;
    if (skip(&at, line->end, "..") && !read_number(&at, line->end, &low))
      return false;
    if (high + 1 != above || low > high)
      return false;
    section->boxes[section->box_count++] = (struct box){low, high - low + 1};
    above = low;
  }
  return section->box_count && above == 0;
}

static bool read_box(struct section *section, const struct line *line, const struct box *box, const char *text,
                     size_t length, struct model_error *error) {
  static const struct {
    const char *name;
    enum model_field field;
  } fields[] = {{"rd", MODEL_FIELD_RD},
                {"ra", MODEL_FIELD_RA},
                {"rb", MODEL_FIELD_RB},
                {"imm", MODEL_FIELD_IMM},
                {"offset", MODEL_FIELD_IMM}};
  struct model_instruction *instruction = &section->instruction;
  for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
    if (strlen(fields[i].name) == length && memcmp(fields[i].name, text, length) == 0) {
      if (instruction->field[fields[i].field].width)
        return fail_at(error, line, "a field stands twice in the diagram");
      if (fields[i].field != MODEL_FIELD_IMM && box->width != 5)
        return fail_at(error, line, "a register's field must have 5 bits");
      instruction->field[fields[i].field].low = box->low;
      instruction->field[fields[i].field].width = box->width;
      return true;
    }
  const char *at = text;
  unsigned value;
  if (!read_number(&at, text + length, &value) || at != text + length ||
      (box->width < 32 && value >= UINT64_C(1) << box->width))
    return model_fail(error, "%s:%u: '%.*s' is neither a field nor a number of %u bits", line->name, line->number,
                      (int)length, text, box->width);
  instruction->mask |= (uint32_t)((UINT64_C(1) << box->width) - 1) << box->low;
  instruction->match |= value << box->low;
  return true;
}

/* "|   1    |   rd   | ... |" */
static bool read_boxes(struct section *section, const struct line *line, struct model_error *error) {
  const char *at = line->text;
  unsigned box = 0;
  skip_blanks(&at, line->end);
  if (section->has_diagram)
    return fail_at(error, line, "a second diagram");
  if (!skip(&at, line->end, "|"))
    return fail_at(error, line, "expected the boxes of the bits in the line above");
  for (skip_blanks(&at, line->end); at < line->end; skip_blanks(&at, line->end), box++) {
    const char *text = at, *bar = memchr(at, '|', (size_t)(line->end - at)), *text_end = bar;
    if (!bar || box == section->box_count)
      return fail_at(error, line, "there are more boxes than bits in the line above");
    while (text_end > text && isblank((unsigned char)text_end[-1]))
      text_end--;
    if (!read_box(section, line, &section->boxes[box], text, (size_t)(text_end - text), error))
      return false;
    at = bar + 1;
  }
  section->has_diagram = true;
  return box == section->box_count ? true : fail_at(error, line, "there are fewer boxes than bits in the line above");
}

/* "IMM is bits 15..0, sign extended, times 4. Values of 6 and above are illegal." */
static bool read_immediate(struct section *section, const struct line *line, struct model_error *error) {
  struct model_instruction *instruction = &section->instruction;
  const char *at = line->text;
  unsigned scale = 1, limit = 0, first = 0;
  skip(&at, line->end, "IMM is bits ");
  const bool bits = read_number(&at, line->end, &section->immediate_high) && skip(&at, line->end, "..") &&
                    read_number(&at, line->end, &section->immediate_low) && skip(&at, line->end, ", ");
  instruction->imm_signed = bits && skip(&at, line->end, "sign");
  if (!bits || (!instruction->imm_signed && !skip(&at, line->end, "zero")) || !skip(&at, line->end, " extended") ||
      (skip(&at, line->end, ", times ") && !read_number(&at, line->end, &scale)) || !skip(&at, line->end, ".") ||
      (skip(&at, line->end, " Values of ") &&
       !(read_number(&at, line->end, &limit) && limit && skip(&at, line->end, " and above are illegal."))) ||
      (limit && skip(&at, line->end, " Values below ") &&
       !(read_number(&at, line->end, &first) && skip(&at, line->end, " are illegal."))) ||
      at != line->end)
    return fail_at(error, line,
                   "expected 'IMM is bits H..L, sign|zero extended[, times N].[ Values of N and above are illegal."
                   "[ Values below N are illegal.]]'");
  instruction->imm_scale = scale;
  instruction->imm_first = first;
  instruction->imm_limit = limit;
  section->has_immediate = true;
  return true;
}

static bool read_semantics(struct section *section, const struct line *line, struct model_error *error) {
  const char *at = line->text + strlen("Semantics:"), *last = line->end;
  skip_blanks(&at, line->end);
  while (last > at && isspace((unsigned char)last[-1]))
    last--;
  if (section->semantics.text)
    return fail_at(error, line, "second semantics");
  if (last - at < 2 || *at != '`' || last[-1] != '`')
    return fail_at(error, line, "expected a statement between backquotes");
  section->semantics = *line;
  section->semantics.text = at + 1;
  section->semantics.end = last - 1;
  return true;
}

/* Adds the section that ends to the instructions, if it is one. heading: its line, or any. */
static bool finish(struct model_isa *isa, struct section *section, const struct line *line, struct model_error *error) {
  struct model_instruction *instruction = &section->instruction;
  const struct line heading = {.name = line->name, .number = instruction->line};
  const unsigned width = instruction->field[MODEL_FIELD_IMM].width, low = instruction->field[MODEL_FIELD_IMM].low;
  if (!instruction->mnemonic || (!section->has_diagram && !section->semantics.text))
    return true;
  if (!section->has_diagram || !section->semantics.text)
    return fail_at(error, &heading,
                   section->has_diagram ? "the instruction has no line 'Semantics: `...`'"
                                        : "the instruction has no diagram of its bits");
  if (section->has_immediate != (width != 0) ||
      (width && (section->immediate_low != low || section->immediate_high != low + width - 1)))
    return fail_at(error, &heading, "the line 'IMM is bits ...' and the diagram do not go together");
  for (size_t i = 0; i < isa->count; i++)
    if (!((isa->instructions[i].match ^ instruction->match) & isa->instructions[i].mask & instruction->mask))
      return model_fail(error, "%s:%u: the encodings of %s and %s overlap", line->name, instruction->line,
                        isa->instructions[i].mnemonic, instruction->mnemonic);
  const char *begin = section->semantics.text;
  const char *line_begin = begin;
  while (line_begin[-1] != '\n')
    line_begin--;
  instruction->semantics = model_parse(instruction, line->name, section->semantics.number,
                                       (unsigned)(begin - line_begin) + 1, begin, section->semantics.end, error);
  struct model_instruction *more = realloc(isa->instructions, (isa->count + 1) * sizeof *more);
  if (!more)
    return fail_at(error, &heading, "out of memory");
  isa->instructions = more;
  more[isa->count++] = *instruction;
  instruction->mnemonic = NULL; /* isa's now */
  return more[isa->count - 1].semantics != NULL;
}

static bool begin(struct section *section, const struct line *line, struct model_error *error) {
  const char *text = line->text;
  free(section->instruction.mnemonic);
  *section = (struct section){.instruction = {.line = line->number, .imm_scale = 1}};
  if (!skip(&text, line->end, "### "))
    return true;
  section->instruction.mnemonic = strndup(text, (size_t)(line->end - text));
  return section->instruction.mnemonic ? true : fail_at(error, line, "out of memory");
}

static bool read_line(struct model_isa *isa, struct section *section, const struct line *line,
                      struct model_error *error) {
  const char *text = line->text;
  if (*text == '#')
    return finish(isa, section, line, error) && begin(section, line, error);
  if (!section->instruction.mnemonic)
    return true;
  if (section->has_ranges) {
    section->has_ranges = false;
    return read_boxes(section, line, error);
  }
  if (skip(&text, line->end, "Semantics:"))
    return read_semantics(section, line, error);
  if (skip(&text, line->end, "IMM is bits "))
    return read_immediate(section, line, error);
  section->has_ranges = read_ranges(section, line);
  return true;
}

struct model_isa *model_isa_parse(const char *name, const char *text, struct model_error *error) {
  struct model_isa *isa = calloc(1, sizeof *isa);
  struct section section = {0};
  struct line line = {.name = name, .text = text};
  bool good = isa != NULL || model_fail(error, "%s: out of memory", name);
  while (good && next_line(&line))
    good = read_line(isa, &section, &line, error);
  good = good && finish(isa, &section, &line, error) &&
         (isa->count || model_fail(error, "%s: the page describes no instruction", name));
  free(section.instruction.mnemonic);
  if (good)
    return isa;
  model_isa_free(isa);
  return NULL;
}

struct model_isa *model_isa_read(const char *path, struct model_error *error) {
  struct model_isa *isa = NULL;
  FILE *file = fopen(path, "rb");
  char *text = malloc(MOST_MANUAL_BYTES);
  errno = 0;
  const size_t bytes = file && text ? fread(text, 1, MOST_MANUAL_BYTES, file) : 0;
  if (!file || !text || ferror(file) || bytes == MOST_MANUAL_BYTES)
    model_fail(error, "%s: cannot be read: %s", path, bytes == MOST_MANUAL_BYTES ? "too large" : strerror(errno));
  else {
    text[bytes] = 0;
    isa = model_isa_parse(path, text, error);
  }
  if (file)
    fclose(file);
  free(text);
  return isa;
}

void model_isa_free(struct model_isa *isa) {
  if (!isa)
    return;
  for (size_t i = 0; i < isa->count; i++) {
    free(isa->instructions[i].mnemonic);
    model_node_free(isa->instructions[i].semantics);
  }
  free(isa->instructions);
  free(isa);
}

const struct model_instruction *model_decode(const struct model_isa *isa, uint32_t word) {
  for (size_t i = 0; i < isa->count; i++) {
    const struct model_instruction *instruction = &isa->instructions[i];
    if ((word & instruction->mask) != instruction->match)
      continue;
    const unsigned low = instruction->field[MODEL_FIELD_IMM].low, width = instruction->field[MODEL_FIELD_IMM].width;
    const uint32_t value = width ? word >> low & (uint32_t)((UINT64_C(1) << width) - 1) : 0;
    return instruction->imm_limit && (value < instruction->imm_first || value >= instruction->imm_limit) ? NULL
                                                                                                         : instruction;
  }
  return NULL;
}

void model_operands(const struct model_instruction *instruction, uint32_t word, uint32_t operand[MODEL_FIELDS]) {
  const unsigned width = instruction->field[MODEL_FIELD_IMM].width;
  for (unsigned i = 0; i < MODEL_FIELDS; i++)
    operand[i] = word >> instruction->field[i].low & (uint32_t)((UINT64_C(1) << instruction->field[i].width) - 1);
  uint32_t *imm = &operand[MODEL_FIELD_IMM];
  if (instruction->imm_signed && width && *imm >> (width - 1))
    *imm -= (uint32_t)(UINT64_C(1) << width);
  *imm *= instruction->imm_scale;
}
