/* The call graph: the functions of the live code, their calls by relocations and decoded instructions, and the sizes of
   their frames, which the compiler writes (.stack_sizes). */
#include "ld.h"
#include "trax/isa.h"

#include <stdlib.h>
#include <string.h>

#define RA 1
#define SP 2
#define FP 3
#define RECENT_CALLS 32 /* searched for an equal one */

/* --- functions --- */

typedef struct start {
  const ld_symbol *symbol;
  uint32_t rank; /* of several symbols with one address, the lowest names the function */
  size_t index;
} start;
typedef LD_VECTOR(start) start_list;

static int compare_starts(const void *left, const void *right) {
  const start *a = left, *b = right;
  if (a->symbol->section->ordinal != b->symbol->section->ordinal)
    return a->symbol->section->ordinal < b->symbol->section->ordinal ? -1 : 1;
  if (a->symbol->value != b->symbol->value)
    return a->symbol->value < b->symbol->value ? -1 : 1;
  if (a->rank != b->rank)
    return a->rank < b->rank ? -1 : 1;
  return a->index < b->index ? -1 : 1;
}

static bool is_code(const ld_section *section) {
  return section->live && (section->flags & SHF_EXECINSTR) && section->data && section->size >= 4;
}

/* A label within a function starts no function: assembly need not hide such labels. */
static void add_start(ld_context *ctx, start_list *starts, const ld_symbol *symbol) {
  if (symbol->kind != LD_DEFINED || !is_code(symbol->section) || symbol->value >= symbol->section->size)
    return;
  bool is_function = symbol->type == STT_FUNC, is_global = symbol->binding != STB_LOCAL;
  if (!is_function && symbol->value != 0 && !(symbol->type == STT_NOTYPE && is_global))
    return;
  if (symbol->type == STT_SECTION || symbol->type == STT_FILE)
    return;
  start fresh = {symbol, is_function ? (is_global ? 0 : 1) : is_global ? 2 : 3, starts->count};
  ld_push(ctx, starts, fresh);
}

static void collect_starts(ld_context *ctx, start_list *starts) {
  for (size_t i = 0; i < ctx->sections.count; i++)
    ctx->sections.items[i]->ordinal = (uint32_t)i;
  for (size_t o = 0; o < ctx->objects.count; o++) {
    const ld_object *object = ctx->objects.items[o];
    for (size_t i = 1; i < object->symbol_count && i < object->first_global; i++)
      add_start(ctx, starts, object->symbols[i]);
  }
  for (size_t i = 0; i < ctx->symbols.count; i++)
    add_start(ctx, starts, ctx->symbols.items[i]);
  if (starts->count)
    qsort(starts->items, starts->count, sizeof *starts->items, compare_starts);
}

static ld_function *add_function(ld_context *ctx, ld_section *section, uint32_t offset, const ld_symbol *symbol) {
  ld_function fresh = {.section = section,
                       .name = symbol && *symbol->name ? symbol->name : section->name,
                       .start = offset,
                       .end = section->size};
  ld_push(ctx, &ctx->functions, fresh);
  return &ctx->functions.items[ctx->functions.count - 1];
}

/* Cuts a section into functions. starts are those of its symbols. */
static void cut_section(ld_context *ctx, ld_section *section, const start *starts, size_t count) {
  size_t first = ctx->functions.count;
  uint64_t covered = 0; /* the end of the last symbol with a size */
  ld_function *last = NULL;
  for (size_t i = 0; i < count; i++) {
    const ld_symbol *symbol = starts[i].symbol;
    if (i > 0 && symbol->value == starts[i - 1].symbol->value)
      continue;
    if (last && symbol->type != STT_FUNC && symbol->value < covered)
      continue;
    if (!last && symbol->value > 0)
      last = add_function(ctx, section, 0, NULL);
    if (last)
      last->end = symbol->value;
    last = add_function(ctx, section, symbol->value, symbol);
    last->is_complete = symbol->size != 0;
    if (symbol->size)
      covered = (uint64_t)symbol->value + symbol->size;
  }
  if (!last)
    add_function(ctx, section, 0, NULL);
  section->first_function = (uint32_t)first;
  section->function_count = (uint32_t)(ctx->functions.count - first);
}

static void cut_functions(ld_context *ctx) {
  start_list starts = {0};
  collect_starts(ctx, &starts);
  size_t next = 0;
  for (size_t i = 0; i < ctx->sections.count; i++) {
    ld_section *section = ctx->sections.items[i];
    size_t from = next;
    while (next < starts.count && starts.items[next].symbol->section == section)
      next++;
    if (is_code(section))
      cut_section(ctx, section, starts.count ? starts.items + from : NULL, next - from);
  }
}

/* NULL if there is none. */
static ld_function *function_at(const ld_context *ctx, const ld_section *section, uint32_t offset) {
  if (!section->function_count || offset >= section->size)
    return NULL;
  size_t low = section->first_function, high = low + section->function_count;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (ctx->functions.items[middle].start <= offset)
      low = middle;
    else
      high = middle;
  }
  return &ctx->functions.items[low];
}

/* The function that contains symbol + addend, or NULL. */
static ld_function *function_of(const ld_context *ctx, const ld_symbol *symbol, int32_t addend) {
  while (symbol->kind == LD_DEFSYM) { /* no circle: those were refused */
    const ld_defsym *defsym = &ctx->options.defsyms.items[symbol->value];
    if (!defsym->base)
      return NULL;
    addend = (int32_t)((uint32_t)addend + defsym->offset);
    symbol = ld_symbol_find(ctx, defsym->base);
  }
  if (symbol->kind != LD_DEFINED || !symbol->section->live)
    return NULL;
  return function_at(ctx, symbol->section, symbol->value + (uint32_t)addend);
}

/* --- calls --- */

typedef struct word_relocs {
  uint32_t target; /* index + 1 of the relocation of the instruction's operand */
  bool stays;      /* R_TRAX_JUMP */
} word_relocs;

typedef struct scanner {
  ld_context *ctx;
  word_relocs *words; /* for each word of the section */
  size_t capacity;
} scanner;

static void index_relocs(scanner *scanner, const ld_section *section) {
  size_t count = section->size / 4;
  if (count > scanner->capacity) {
    scanner->capacity = 2 * count;
    scanner->words = ld_alloc_array(scanner->ctx, scanner->capacity, sizeof *scanner->words);
  }
  if (count)
    memset(scanner->words, 0, count * sizeof *scanner->words);
  for (uint32_t r = 0; r < section->reloc_count; r++) {
    const ld_reloc *reloc = &section->relocs[r];
    if (reloc->offset % 4 != 0 || reloc->offset / 4 >= count || reloc->type == R_TRAX_NONE)
      continue;
    if (reloc->type == R_TRAX_JUMP)
      scanner->words[reloc->offset / 4].stays = true;
    else
      scanner->words[reloc->offset / 4].target = r + 1;
  }
}

static void add_call(ld_context *ctx, ld_function *caller, const ld_function *callee, bool tail) {
  uint32_t index = (uint32_t)(callee - ctx->functions.items);
  size_t last = caller->calls.count, first = last > RECENT_CALLS ? last - RECENT_CALLS : 0;
  for (size_t i = last; i-- > first;)
    if (caller->calls.items[i].callee == index && caller->calls.items[i].is_tail == tail) {
      caller->calls.items[i].sites++;
      return;
    }
  ld_call call = {.callee = index, .is_tail = tail, .sites = 1};
  ld_push(ctx, &caller->calls, call);
}

/* Whether the instruction gives sp a value that it does not compute from sp or fp and a constant. */
static bool moves_sp(trax_inst inst) {
  if (!(trax_op_table[inst.op].flags & TRAX_WRITES_RD) || inst.rd != SP)
    return false;
  switch (inst.op) {
  case TRAX_OP_ADDI:
    return inst.ra != SP && inst.ra != FP;
  case TRAX_OP_ANDI:
  case TRAX_OP_SRLI:
  case TRAX_OP_SLLI:
    return inst.ra != SP; /* alignment */
  default:
    return true;
  }
}

/* A branch, jump or call to a place known now. */
static void scan_transfer(scanner *scanner, ld_function *function, uint32_t offset, trax_inst inst) {
  ld_context *ctx = scanner->ctx;
  uint32_t reloc_index = scanner->words[offset / 4].target;
  ld_function *callee;
  if (reloc_index) {
    const ld_reloc *reloc = &function->section->relocs[reloc_index - 1];
    callee = function_of(ctx, reloc->symbol, reloc->addend);
    if (!callee && reloc->symbol->kind != LD_UNDEFINED)
      function->indirect_calls++; /* an address without a function */
  } else {
    callee = function_at(ctx, function->section, offset + (uint32_t)inst.imm);
  }
  bool links = inst.op == TRAX_OP_JAL && inst.rd != 0;
  if (!callee || (callee == function && !links))
    return;
  if (links)
    callee->link_registers |= 1u << inst.rd;
  add_call(ctx, function, callee, !links);
}

static void scan_indirect(scanner *scanner, ld_function *function, uint32_t offset, trax_inst inst) {
  const word_relocs *word = &scanner->words[offset / 4];
  if (word->stays && inst.rd == 0)
    return;
  if (word->target) { /* jalr rd, %lo(f)(ra) */
    scan_transfer(scanner, function, offset, (trax_inst){.op = TRAX_OP_JAL, .rd = inst.rd});
  } else if (inst.rd != 0) {
    function->indirect_calls++;
  } else if (inst.imm != 0) {
    function->indirect_jumps[0]++;
  } else {
    function->indirect_jumps[inst.ra]++; /* perhaps a return */
  }
}

static void scan_function(scanner *scanner, ld_function *function) {
  const ld_section *section = function->section;
  trax_inst inst = {0};
  for (uint32_t offset = (function->start + 3) & ~3u; offset < function->end && section->size - offset >= 4;
       offset += 4) {
    inst = trax_decode(ld_load32(section->data + offset));
    if (inst.op == TRAX_OP_JALR)
      scan_indirect(scanner, function, offset, inst);
    else if (trax_op_table[inst.op].flags & TRAX_IS_BRANCH)
      scan_transfer(scanner, function, offset, inst);
    else if (moves_sp(inst))
      function->moves_sp = true;
    else if (inst.op == TRAX_OP_ADDI && inst.rd == SP && inst.ra == SP && inst.imm < 0 &&
             (uint32_t)-inst.imm > function->frame)
      function->frame = (uint32_t)-inst.imm;
  }
  /* Assembly may run on into what follows; a compiler's functions have sizes and do not. */
  bool ends = (inst.op == TRAX_OP_JAL || inst.op == TRAX_OP_JALR) && inst.rd == 0;
  if (!function->is_complete && !ends && inst.op != TRAX_OP_HALT && inst.op != TRAX_OP_ILLEGAL &&
      function->end < section->size)
    add_call(scanner->ctx, function, function_at(scanner->ctx, section, function->end), true);
}

/* A function whose address is taken can be called through a pointer. Calls and branches take none. */
static void note_address(ld_context *ctx, const ld_reloc *reloc) {
  if (reloc->type == R_TRAX_JAL21 || reloc->type == R_TRAX_BR16 || reloc->type == R_TRAX_JUMP)
    return;
  ld_function *function = function_of(ctx, reloc->symbol, reloc->addend);
  const ld_symbol *symbol = reloc->symbol;
  bool is_start =
      function && (symbol->kind != LD_DEFINED || symbol->value + (uint32_t)reloc->addend == function->start);
  if (is_start)
    function->address_taken = true;
}

/* The constructors' and destructors' tables are called through pointers, but the linker knows what is in them. */
static void note_table_entry(ld_context *ctx, const ld_section *table, const ld_reloc *reloc) {
  const ld_function *function = function_of(ctx, reloc->symbol, reloc->addend);
  if (!function)
    return;
  uint32_t index = (uint32_t)(function - ctx->functions.items);
  if (table->type == SHT_FINI_ARRAY)
    ld_push(ctx, &ctx->destructors, index);
  else
    ld_push(ctx, &ctx->constructors, index);
}

static void note_table_reader(ld_context *ctx, const ld_section *section, const ld_reloc *reloc) {
  ld_function *reader = function_at(ctx, section, reloc->offset);
  if (reader && strcmp(reloc->symbol->name, "__init_array_start") == 0)
    reader->runs_constructors = true;
  else if (reader && strcmp(reloc->symbol->name, "__fini_array_start") == 0)
    reader->runs_destructors = true;
}

static void scan_references(ld_context *ctx) {
  for (size_t i = 0; i < ctx->sections.count; i++) {
    const ld_section *section = ctx->sections.items[i];
    if (!section->live || !(section->flags & SHF_ALLOC))
      continue;
    bool is_table =
        section->type == SHT_INIT_ARRAY || section->type == SHT_PREINIT_ARRAY || section->type == SHT_FINI_ARRAY;
    for (uint32_t r = 0; r < section->reloc_count; r++) {
      const ld_reloc *reloc = &section->relocs[r];
      if (is_table)
        note_table_entry(ctx, section, reloc);
      else
        note_address(ctx, reloc);
      if (reloc->symbol->kind == LD_ABSOLUTE)
        note_table_reader(ctx, section, reloc);
    }
  }
}

static void finish_function(ld_context *ctx, ld_function *function) {
  for (unsigned i = 0; i < TRAX_NUM_REGISTERS; i++)
    if (!((function->link_registers | 1u << RA) >> i & 1))
      function->indirect_calls += function->indirect_jumps[i];
  if (!function->indirect_calls || !(function->runs_constructors || function->runs_destructors))
    return;
  function->indirect_calls = 0;
  for (size_t i = 0; function->runs_constructors && i < ctx->constructors.count; i++)
    add_call(ctx, function, &ctx->functions.items[ctx->constructors.items[i]], false);
  for (size_t i = 0; function->runs_destructors && i < ctx->destructors.count; i++)
    add_call(ctx, function, &ctx->functions.items[ctx->destructors.items[i]], false);
}

/* --- .stack_sizes: for each function its address, 4 bytes, and the size of its frame, ULEB128 --- */

static bool read_uleb(const ld_section *section, uint32_t *at, uint32_t *value) {
  uint64_t result = 0;
  for (unsigned shift = 0; *at < section->size; shift += 7) {
    uint8_t byte = section->data[(*at)++];
    if (shift < 63)
      result |= (uint64_t)(byte & 0x7F) << shift;
    else if (byte & 0x7F)
      result = UINT64_MAX;
    if (!(byte & 0x80)) {
      *value = result > INT32_MAX ? INT32_MAX : (uint32_t)result;
      return true;
    }
  }
  return false;
}

static void read_stack_sizes(ld_context *ctx, const ld_section *section) {
  uint32_t at = 0;
  for (uint32_t r = 0; at < section->size; r++) {
    while (r < section->reloc_count && section->relocs[r].type == R_TRAX_NONE)
      r++;
    const ld_reloc *reloc = r < section->reloc_count ? &section->relocs[r] : NULL;
    uint32_t place = at, size;
    at += 4;
    if (!reloc || reloc->offset != place || reloc->type != R_TRAX_32 || !read_uleb(section, &at, &size)) {
      ld_error(ctx, "%s: not a record of a function's stack size", ld_place(ctx, section, place));
      return;
    }
    ld_function *function = function_of(ctx, reloc->symbol, reloc->addend);
    if (!function)
      continue; /* dropped */
    function->frame = function->has_record && function->frame > size ? function->frame : size;
    function->has_record = true;
  }
}

bool ld_build_call_graph(ld_context *ctx) {
  scanner scanner = {.ctx = ctx};
  const ld_section *indexed = NULL;
  cut_functions(ctx);
  scan_references(ctx);
  for (size_t i = 0; i < ctx->functions.count; i++) {
    ld_function *function = &ctx->functions.items[i];
    if (function->section != indexed)
      index_relocs(&scanner, function->section);
    indexed = function->section;
    scan_function(&scanner, function);
  }
  for (size_t i = 0; i < ctx->functions.count; i++)
    finish_function(ctx, &ctx->functions.items[i]);
  for (size_t i = 0; i < ctx->sections.count; i++) {
    const ld_section *section = ctx->sections.items[i];
    if (!section->discarded && section->data && strcmp(section->name, ".stack_sizes") == 0)
      read_stack_sizes(ctx, section);
  }
  return ctx->error_count == 0;
}
