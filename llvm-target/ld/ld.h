/* The linker's data structures and passes. One ld_context holds a whole link; link.c runs the passes in order:

     options   command line                              -> context.options
     input     objects and archives, symbol resolution   -> context.objects, context.symbols
     symbols   wrapped, common, linker-defined symbols
     merge     string and constant sections cut into pieces
     gc        what the program can reach                -> section.live, piece.live
     layout    output sections, segments, addresses      -> context.outputs, context.segments
     callgraph functions and their calls                 -> context.functions
     stack     the worst stack depth, or an error        -> context.stack_report
     output    the image: headers, contents, symbol table; relocate applies the relocations in it
     map       the optional reports

   A pass reports faults by ld_error and continues as far as it can, so that one run shows all errors; it returns
   whether the link is still free of them. Memory belongs to the context and is freed with it. */
#ifndef TRAX_LD_H
#define TRAX_LD_H

#include "trax/abi.h"
#include "trax/files.h"

#include <elf.h>
#include <libelf.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifndef SHF_GNU_RETAIN
#define SHF_GNU_RETAIN (1u << 21)
#endif

#define LD_SEGMENT_ALIGNMENT 64u       /* docs/abi.md */
#define LD_INSTRUCTION_CACHE 4096u     /* bytes, docs/trax-sim.md, by default; for reports only */
#define LD_MAX_ALIGNMENT 65536u        /* of a section; a larger one is taken for a damaged file */
#define LD_MAX_FILE (256u << 20)       /* of the output; zeroed data among other data, written out, could be any size */
#define LD_BOUNDARY_SECTION UINT32_MAX /* __start_NAME, __stop_NAME */
#define LD_MERGE_NONE UINT32_MAX       /* a piece without a place in the output */

typedef struct ld_context ld_context;
typedef struct ld_object ld_object;
typedef struct ld_section ld_section;
typedef struct ld_symbol ld_symbol;
typedef struct ld_output ld_output;

/* --- util.c: memory, vectors, maps, files, diagnostics --- */

#define LD_VECTOR(type)                                                                                                \
  struct {                                                                                                             \
    type *items;                                                                                                       \
    size_t count, capacity;                                                                                            \
  }
#define ld_push(ctx, vector, item)                                                                                     \
  ((vector)->count == (vector)->capacity                                                                               \
       ? (void)((vector)->items =                                                                                      \
                    ld_grow((ctx), (vector)->items, (vector)->count, &(vector)->capacity, sizeof *(vector)->items))    \
       : (void)0,                                                                                                      \
   (void)((vector)->items[(vector)->count++] = (item)))

void *ld_alloc(ld_context *ctx, size_t size); /* zeroed, aligned to 16; the link ends if memory is exhausted */
void *ld_alloc_array(ld_context *ctx, size_t count, size_t size);
char *ld_format(ld_context *ctx, const char *format, ...) __attribute__((format(printf, 2, 3)));
const char *ld_demangle(ld_context *ctx, const char *text); /* text with the names of C++ in it as people write them */
void *ld_grow(ld_context *ctx, void *items, size_t count, size_t *capacity, size_t size);
void ld_free_all(ld_context *ctx);

/* A map from byte strings, which must outlive it, to values. */
typedef struct ld_map_entry {
  const void *key;
  uint32_t length, hash;
  uintptr_t value; /* 0: none yet */
} ld_map_entry;
typedef struct ld_map {
  ld_map_entry *entries;
  size_t count, capacity;
} ld_map;

/* The place of key's value, made if new; valid until the next call. */
uintptr_t *ld_map_at(ld_context *ctx, ld_map *map, const void *key, size_t length);
uintptr_t ld_map_find(const ld_map *map, const void *key, size_t length); /* 0 if absent */

void ld_error(ld_context *ctx, const char *format, ...) __attribute__((format(printf, 2, 3)));
void ld_warning(ld_context *ctx, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Reports how many errors the limit suppressed. */
void ld_report_suppressed(const ld_context *ctx);

/* The bytes of a regular file of less than 4 GB; false after an error message. */
bool ld_read_file(ld_context *ctx, const char *path, const uint8_t **bytes, size_t *size);
/* Whole (trax/output.h), and no signal leaves a part of it; false after an error message. */
bool ld_write_file(ld_context *ctx, const char *path, const void *bytes, size_t size, bool executable);

static inline uint64_t ld_align(uint64_t value, uint32_t alignment) {
  return (value + alignment - 1) & ~(uint64_t)(alignment - 1);
}
static inline uint32_t ld_load32(const uint8_t *bytes) {
  return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}
bool ld_starts_with(const char *text, const char *prefix);
bool ld_parse_number(const char *text, uint32_t *value); /* decimal, 0x or octal, all of text */

/* --- options.c --- */

typedef struct ld_input {
  const char *name;
  bool is_library;    /* -l */
  bool whole_archive; /* every member, needed or not */
} ld_input;

typedef struct ld_defsym {
  const char *name;
  const char *base; /* a symbol's name, or NULL for a plain number */
  uint32_t offset;
} ld_defsym;

typedef struct ld_section_start {
  const char *name; /* of an output section */
  uint32_t address;
} ld_section_start;

typedef LD_VECTOR(const char *) ld_words;

typedef enum ld_stack_check { LD_STACK_ERROR, LD_STACK_WARN, LD_STACK_NONE } ld_stack_check;

typedef struct ld_options {
  const char *output;
  const char *entry;
  const char *map_path; /* NULL: none; "-": standard output */
  LD_VECTOR(ld_input) inputs;
  ld_words library_paths;
  ld_words undefined; /* -u */
  ld_words wrapped;
  LD_VECTOR(ld_defsym) defsyms;
  LD_VECTOR(ld_section_start) section_starts;
  const char *ordering_path; /* --symbol-ordering-file, or NULL */
  uint32_t text_start;
  unsigned error_limit;    /* 0: none */
  unsigned response_files; /* read so far */
  ld_words response_paths;
  bool whole_archive; /* of the inputs that follow */
  bool allow_multiple_definition;
  uint32_t stack_size; /* bytes that the stack may take; 0: what local memory has */
  ld_stack_check stack_check;
  bool gc_sections, print_gc_sections, print_memory_usage, print_stack;
  bool strip_all, strip_debug;
  bool no_demangle;
  bool fatal_warnings, no_warnings, trace;
  bool help, version, version_only; /* asked for; version_only: and nothing else */
} ld_options;

/* argv without the program's name. */
bool ld_parse_options(ld_context *ctx, int argc, char **argv);
void ld_print_help(FILE *out);

/* --- object.c, archive.c, input.c: what is linked --- */

enum {
#define LD_NUMBER(name, number) name = number,
  TRAX_RELOCATIONS(LD_NUMBER)
#undef LD_NUMBER
};

typedef struct ld_reloc {
  uint32_t offset; /* in the section */
  uint32_t type;   /* R_TRAX_* */
  ld_symbol *symbol;
  int32_t addend;
} ld_reloc;

/* A string or constant of a merged section. It reaches to the next piece's offset, or the section's end. */
typedef struct ld_piece {
  uint32_t offset;
  uint32_t output_offset; /* in section.merged_into; LD_MERGE_NONE while it has no place */
  bool live;
} ld_piece;

struct ld_section {
  ld_object *object; /* NULL for a section made by the linker */
  const char *name;
  uint32_t type, flags, alignment, size, entry_size;
  const uint8_t *data; /* size bytes; NULL for SHT_NOBITS */
  ld_reloc *relocs;
  uint32_t reloc_count;
  bool discarded;         /* never part of the output: a losing COMDAT group, notes to the linker, ... */
  bool live;              /* part of the output */
  ld_section *group_next; /* ring of a group's members, or NULL */
  ld_section *first_dependent, *next_dependent; /* SHF_LINK_ORDER sections that live as long as this one */
  ld_piece *pieces;                             /* not NULL if the section's contents are merged */
  uint32_t piece_count;
  ld_section *merged_into;
  ld_output *output;
  uint32_t output_offset;
  uint32_t wanted_place;   /* by --symbol-ordering-file; 0: none */
  uint32_t ordinal;        /* in the order of the passes that need one */
  uint32_t first_function; /* in context.functions */
  uint32_t function_count;
};

typedef enum ld_symbol_kind {
  LD_UNDEFINED,
  LD_LAZY,     /* defined by an archive member that has not been taken */
  LD_COMMON,   /* value is the alignment; becomes LD_DEFINED when resolution ends */
  LD_DEFINED,  /* value is the offset in section */
  LD_ABSOLUTE, /* value is the address */
  LD_DEFSYM,   /* value is the index in options.defsyms */
  LD_BOUNDARY  /* of the layout: value is an offset in ld_bounds or LD_BOUNDARY_SECTION; becomes LD_ABSOLUTE */
} ld_symbol_kind;

struct ld_symbol {
  const char *name;
  ld_symbol_kind kind;
  uint8_t binding;    /* STB_*; of an undefined symbol, STB_WEAK if all references are weak */
  uint8_t type;       /* STT_* */
  uint8_t visibility; /* STV_* */
  bool referenced;    /* by an object that was taken, or by the command line */
  bool reported;      /* as undefined */
  bool in_archive;    /* of an undefined symbol: a member that was not taken defines it */
  ld_object *object;  /* the definer (LD_LAZY: the member that would define it), NULL for the linker; the first referrer
                         if undefined */
  ld_section *section;
  uint32_t value, size;
};

struct ld_object {
  const char *name; /* "a.o" or "lib.a(a.o)" */
  Elf *elf;
  ld_section **sections; /* by section index; [0] is NULL */
  size_t section_count;
  ld_symbol **symbols; /* by symbol index; [0] is the absolute 0 */
  size_t symbol_count, first_global;
  const Elf32_Sym *raw_symbols;
  const Elf32_Word *raw_shndx; /* SHT_SYMTAB_SHNDX or NULL */
  const char *strings;
  size_t strings_size;
  uint32_t stack;             /* TRAX_EF_STACK_LOCAL, TRAX_EF_STACK_GLOBAL, or 0 for either */
  bool taken;                 /* its definitions count: named on the command line, or extracted */
  const ld_symbol *taken_for; /* of an archive member: the symbol it was extracted for, or NULL */
  const ld_object *taken_by;  /* and the first object that needs it, NULL for the command line */
};

/* Checks headers and symbol table; NULL after an error message. bytes must be aligned to 8 and outlive the link. */
ld_object *ld_object_open(ld_context *ctx, const char *name, const uint8_t *bytes, size_t size);
/* Sections, groups, symbols and relocations of an opened object. */
void ld_object_load(ld_context *ctx, ld_object *object);
/* The name of symbol index; NULL after an error message. */
const char *ld_object_symbol_name(ld_context *ctx, const ld_object *object, size_t index);
/* The section index of a symbol with SHN_XINDEX seen through. reserved: whether it is one of SHN_ABS, SHN_COMMON, ...
 */
uint32_t ld_object_symbol_section(const ld_object *object, size_t index, bool *reserved);

/* The name of bytes' format if it is not an ELF object, such as "LLVM bitcode", else NULL. */
const char *ld_foreign_format(const uint8_t *bytes, size_t size);
bool ld_is_archive(const uint8_t *bytes, size_t size);
/* Adds the members of an archive as lazy objects, or as taken ones. */
void ld_archive_add(ld_context *ctx, const char *name, const uint8_t *bytes, size_t size, bool whole);

bool ld_load_inputs(ld_context *ctx);

/* --- symbols.c --- */

ld_symbol *ld_symbol_find(const ld_context *ctx, const char *name); /* NULL if no object mentions it */
void ld_symbols_add_lazy(ld_context *ctx, ld_object *object);       /* what object's extraction would define */
bool ld_symbols_add(ld_context *ctx, ld_object *object);            /* fills object->symbols */
void ld_start_symbols(ld_context *ctx); /* what the command line wraps, defines and refers to */
/* Takes the archive member that defines name, if one does. */
void ld_symbols_offer(ld_context *ctx, const char *name);
/* After the last input: common symbols get sections, those of the linker are defined where referenced. */
bool ld_finish_symbols(ld_context *ctx);
/* The address of a symbol with a place in the output; undefined weak ones and those of dropped sections have 0. */
uint32_t ld_symbol_address(const ld_context *ctx, const ld_symbol *symbol);
/* NAME of __start_NAME and __stop_NAME, else NULL. */
const char *ld_boundary_section(const char *symbol);
/* Gives LD_BOUNDARY symbols their addresses. */
void ld_place_boundaries(ld_context *ctx);
/* The offset in its section that a relocation with this addend refers to: of a section symbol, the addend is a part. */
uint32_t ld_symbol_offset(const ld_symbol *symbol, int32_t addend);
/* Whether that offset is not part of the output. */
bool ld_symbol_is_dropped(const ld_symbol *symbol, int32_t addend);

/* --- merge.c --- */

void ld_split_merge_sections(ld_context *ctx);
ld_piece *ld_find_piece(const ld_section *section, uint32_t offset); /* NULL outside the section */
/* Puts the live pieces of all sections together; called by the layout with the sections of one output section. */
void ld_merge_output(ld_context *ctx, ld_output *output);

/* --- gc.c --- */

void ld_mark_live(ld_context *ctx);

/* --- layout.c --- */

/* The order of output sections in the image: by class, then by their order within it. The first three classes are
   segments; thread-local data is in local memory, the rest is not loaded. */
typedef enum ld_class { LD_CODE, LD_CONSTANTS, LD_DATA, LD_THREAD_LOCAL, LD_NOT_LOADED } ld_class;
typedef enum ld_order { LD_CONSTRUCTORS, LD_DESTRUCTORS, LD_CONTENTS, LD_ZEROS } ld_order;

struct ld_output {
  const char *name;
  uint32_t type, flags, alignment, entry_size;
  LD_VECTOR(ld_section *) sections;
  ld_class class;
  ld_order order;
  uint32_t address, size;
  uint32_t load_address; /* of .tdata: where its initial values are in the image; otherwise 0 */
  uint32_t file_offset;
  uint32_t header_index; /* in the section header table; 0: none */
};

typedef struct ld_segment {
  uint32_t flags; /* PF_* */
  uint32_t address, file_offset, file_size, memory_size;
} ld_segment;

typedef struct ld_bounds {
  uint32_t executable_start, end, text_start, text_end, init_array_start, init_array_end, fini_array_start,
      fini_array_end, bss_start, bss_end, tdata_start, tdata_end, tdata_load, tbss_start, tbss_end;
} ld_bounds;

bool ld_layout(ld_context *ctx);
/* The address of an offset in a live section. */
uint32_t ld_section_address(const ld_section *section, uint32_t offset);
ld_output *ld_output_find(const ld_context *ctx, const char *name);

/* --- gather.c --- */

void ld_gather(ld_context *ctx);
/* Compares class, order and header_index, for qsort. */
int ld_compare_outputs(const void *left, const void *right);

/* --- callgraph.c --- */

typedef struct ld_call {
  uint32_t callee; /* in context.functions */
  uint32_t sites;
  bool is_tail; /* a jump: the callee returns to the caller's caller */
} ld_call;

typedef struct ld_function {
  ld_section *section; /* NULL: represents the callees of indirect calls */
  const char *name;
  uint32_t start, end; /* offsets in the section */
  uint32_t frame;      /* bytes; without a record, what is seen of it */
  bool has_record;     /* in .stack_sizes */
  bool moves_sp;       /* by more than a constant */
  bool is_complete;    /* its symbol has a size */
  bool runs_constructors, runs_destructors;
  bool address_taken;
  uint32_t indirect_calls;
  uint32_t link_registers;     /* with which it is called, a bit for each */
  uint16_t indirect_jumps[32]; /* by register */
  LD_VECTOR(ld_call) calls;
} ld_function;

bool ld_build_call_graph(ld_context *ctx);

/* --- stack.c --- */

/* Computes the worst stack depth; an error, or a warning, if the stack has less room. */
bool ld_check_stack(ld_context *ctx);

/* --- undefined.c --- */

/* Reports undefined symbols that live code needs. */
bool ld_check_undefined(ld_context *ctx);

/* --- relocate.c --- */

/* Applies the relocations of every live section to its bytes in the image. */
bool ld_relocate(ld_context *ctx);
/* "a.o:(.text+0x4)" */
const char *ld_place(ld_context *ctx, const ld_section *section, uint32_t offset);
/* " (in function 'f')" or nothing. */
const char *ld_in_function(ld_context *ctx, const ld_section *section, uint32_t offset);

/* --- output.c --- */

bool ld_build_image(ld_context *ctx);
bool ld_write_image(ld_context *ctx);

/* --- map.c --- */

bool ld_write_map(ld_context *ctx);
void ld_print_memory_usage(const ld_context *ctx, FILE *out);

/* --- the whole --- */

/* Runs a link as the program does; argv[0] is ignored. The exit status. Keeps no state and can be called again. */
int ld_main(int argc, char **argv);

struct ld_context {
  ld_options options;
  trax_files files;        /* what is read beside the inputs, and what is written */
  jmp_buf out_of_memory;   /* where the link ends then */
  struct ld_chunk *chunks; /* memory */
  unsigned error_count, warning_count;

  LD_VECTOR(ld_object *) objects; /* taken, in link order */
  LD_VECTOR(ld_object *) pending; /* taken, to be loaded */
  LD_VECTOR(Elf *) elves;         /* to be closed */
  LD_VECTOR(ld_section *) sections;
  LD_VECTOR(ld_symbol *) symbols; /* global, in the order of first mention */
  ld_map symbol_map;              /* name -> ld_symbol * */
  ld_map groups;                  /* COMDAT signature -> the ld_object * that has it */
  ld_map wrapped;                 /* --wrap: name of a reference -> name to use, const char * */

  LD_VECTOR(ld_output *) outputs; /* in the order of the image */
  LD_VECTOR(ld_segment) segments; /* R-X, R--, RW-, and more where sections have addresses of their own */
  ld_bounds bounds;
  uint32_t stack;      /* of all objects, as of one */
  uint32_t local_size; /* bytes of local memory that thread-local data takes */
  uint32_t entry;

  LD_VECTOR(ld_function) functions;              /* of the live code, in the order of sections and offsets */
  LD_VECTOR(uint32_t) constructors, destructors; /* functions */
  uint64_t stack_depth;                          /* bytes: the deepest known path from the entry */
  bool stack_is_bounded;                         /* whether it is the deepest of all */
  const char *stack_report;

  uint8_t *image;
  size_t image_size;
};

#endif
