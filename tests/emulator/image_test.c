/* The ELF loader: what a good file gives, and that no bad one gives anything but a message. */
#define _GNU_SOURCE /* memfd_create */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include <cmocka.h>

#include "machine/address_space.h"
#include "program/image.h"
#include "programs.h"

/* A file in memory: thousands of versions of it are written. */
static char file_name[64];

static trax_image *open_file(const struct elf_file *file, trax_error *error) {
  elf_save(file_name, file);
  return trax_image_open(file_name, error);
}

static trax_image *open_program(const char *name) {
  struct elf_file file = program_file(name);
  trax_error error;
  trax_image *image = open_file(&file, &error);
  if (!image)
    fail_msg("%s", error.message);
  free(file.bytes);
  return image;
}

static volatile uint32_t used;

/* Goes through everything an image offers. */
static void use(trax_image *image) {
  size_t count;
  uint32_t sum = trax_image_entry(image);
  const struct trax_load_segment *segments = trax_image_segments(image, &count);
  for (size_t i = 0; i < count; ++i)
    for (uint32_t j = 0; j < segments[i].file_bytes; ++j)
      sum += segments[i].bytes[j];
  const struct trax_symbol *symbols = trax_image_symbols(image, &count);
  for (size_t i = 0; i < count; ++i)
    sum += (uint32_t)strlen(symbols[i].name);
  for (uint32_t pc = TEXT - 4; pc < TEXT + 24; pc += 4) {
    struct trax_source_line lines[4];
    size_t found = trax_image_lines(image, pc, lines, 4);
    assert_true(found <= 4);
    for (size_t i = 0; i < found; ++i)
      sum += (uint32_t)strlen(lines[i].file) + (lines[i].function ? (uint32_t)strlen(lines[i].function) : 0);
    const struct trax_symbol *symbol = trax_image_symbol_at(image, pc);
    sum += symbol ? symbol->bytes : 0;
  }
  (void)trax_image_symbol(image, "outer");
  used += sum;
}

static void test_a_good_image(void **state) {
  (void)state;
  trax_image *image = open_program("copy");
  assert_int_equal(trax_image_entry(image), TEXT);
  size_t count;
  const struct trax_load_segment *segments = trax_image_segments(image, &count);
  assert_int_equal(count, 2);
  assert_int_equal(segments[0].address, TEXT);
  assert_int_equal(segments[0].permissions, TRAX_PERMIT_READ | TRAX_PERMIT_EXECUTE);
  assert_int_equal(segments[0].memory_bytes, 48);
  assert_int_equal(segments[1].address, DATA);
  assert_int_equal(segments[1].permissions, TRAX_PERMIT_READ | TRAX_PERMIT_WRITE);
  assert_int_equal(segments[1].file_bytes, 24);
  assert_int_equal(segments[1].memory_bytes, 124);

  assert_int_equal(trax_image_symbol(image, "input")->bytes, 8); /* the global one */
  assert_null(trax_image_symbol(image, "inpu"));
  assert_string_equal(trax_image_symbol_at(image, TEXT)->name, "_start");
  assert_string_equal(trax_image_symbol_at(image, TEXT + 4)->name, "_start");
  assert_string_equal(trax_image_symbol_at(image, TEXT + 12)->name, "label"); /* nearer */
  assert_string_equal(trax_image_symbol_at(image, DATA + 12)->name, "output");
  assert_string_equal(trax_image_symbol_at(image, DATA + 20)->name, "__trax_heap_end");
  assert_null(trax_image_symbol_at(image, DATA + 28)); /* past every symbol's size */
  assert_null(trax_image_symbol_at(image, 0));
  assert_null(trax_image_symbol_at(image, 0xFFFFFFFC));
  struct trax_source_line line;
  assert_int_equal(trax_image_lines(image, TEXT, &line, 1), 0); /* no debug information */
  trax_image_close(image);
}

static void test_source_lines(void **state) {
  (void)state;
  trax_image *image = open_program("null");
  struct trax_source_line lines[4];
  for (int i = 0; i < 4; ++i) {
    size_t count = trax_image_lines(image, TEXT + 4 * (uint32_t)i, lines, 4);
    assert_int_equal(count, i == 2 ? 2 : 1);
    assert_string_equal(lines[0].file, "dir/source.c");
    assert_int_equal(lines[0].line, i == 2 ? 5 : 10 + i);
    assert_int_equal(lines[0].column, 3);
    assert_string_equal(lines[0].function, i == 2 ? "inner" : "outer");
  }
  assert_int_equal(trax_image_lines(image, TEXT + 8, lines, 4), 2);
  assert_string_equal(lines[1].file, "dir/source.c");
  assert_int_equal(lines[1].line, 12);
  assert_string_equal(lines[1].function, "outer");
  assert_int_equal(trax_image_lines(image, TEXT + 8, lines, 1), 1); /* as many as there is room for */
  assert_int_equal(trax_image_lines(image, TEXT + 16, lines, 4), 0);
  assert_int_equal(trax_image_lines(image, 0, lines, 4), 0);
  trax_image_close(image);
}

/* Opens a copy of `program` after `damage`. It must be refused with a message that names the file and says `message`.
 */
static void refuse(const char *program, void (*damage)(struct elf_file *file), const char *message) {
  struct elf_file file = program_file(program);
  damage(&file);
  trax_error error = {.message = ""};
  trax_image *image = open_file(&file, &error);
  if (image)
    fail_msg("a file is accepted that should be refused with \"%s\"", message);
  if (strncmp(error.message, file_name, strlen(file_name)) != 0 || !strstr(error.message, message))
    fail_msg("the message \"%s\" lacks \"%s\"", error.message, message);
  free(file.bytes);
}

#define DAMAGE(NAME, ...)                                                                                              \
  static void NAME(struct elf_file *file) {                                                                            \
    __VA_ARGS__;                                                                                                       \
  }
DAMAGE(empty, file->size = 0)
DAMAGE(text_file, memcpy(file->bytes, "#!/bin/sh", 9))
DAMAGE(archive, memcpy(file->bytes, "!<arch>\n", 8))
DAMAGE(only_magic, file->size = 20)
DAMAGE(wide, file->bytes[EI_CLASS] = ELFCLASS64)
DAMAGE(big_endian, file->bytes[EI_DATA] = ELFDATA2MSB)
DAMAGE(ident_version, file->bytes[EI_VERSION] = 2)
DAMAGE(machine, elf_header(file)->e_machine = EM_RISCV)
DAMAGE(object, elf_header(file)->e_type = ET_REL)
DAMAGE(shared, elf_header(file)->e_type = ET_DYN)
DAMAGE(version, elf_header(file)->e_version = 0)
DAMAGE(flags, elf_header(file)->e_flags = 3)
DAMAGE(stack, elf_header(file)->e_flags = TRAX_EF_STACK_GLOBAL)
DAMAGE(header_size, elf_header(file)->e_ehsize = 64)
DAMAGE(no_programs, elf_header(file)->e_phnum = 0)
DAMAGE(program_size, elf_header(file)->e_phentsize = 56)
DAMAGE(programs_outside, elf_header(file)->e_phoff = 0xFFFFFFF0)
DAMAGE(programs_unaligned, elf_header(file)->e_phoff += 1)
DAMAGE(sections_unaligned, elf_header(file)->e_shoff -= 2)
DAMAGE(section_size, elf_header(file)->e_shentsize = 64)
DAMAGE(sections_outside, elf_header(file)->e_shoff = (Elf32_Off)file->size)
DAMAGE(no_sections, elf_header(file)->e_shnum = 0)
DAMAGE(names_outside, elf_header(file)->e_shstrndx = 99)
DAMAGE(entry_low, elf_header(file)->e_entry = 0)
DAMAGE(entry_odd, elf_header(file)->e_entry = TEXT + 2)
DAMAGE(entry_in_data, elf_header(file)->e_entry = DATA)
DAMAGE(entry_behind, elf_header(file)->e_entry = TEXT + 48)
DAMAGE(no_load, elf_program_header(file, 0)->p_type = elf_program_header(file, 1)->p_type = PT_NOTE)
DAMAGE(dynamic, elf_program_header(file, 1)->p_type = PT_DYNAMIC)
DAMAGE(interpreter, elf_program_header(file, 1)->p_type = PT_INTERP)
DAMAGE(file_above_memory, elf_program_header(file, 1)->p_filesz = 125)
DAMAGE(segment_outside, elf_program_header(file, 0)->p_offset = (Elf32_Off)file->size - 40)
DAMAGE(segment_wraps, elf_program_header(file, 0)->p_offset = 0xFFFFFFE0)
DAMAGE(null_page, elf_program_header(file, 1)->p_vaddr = 0xFC0)
DAMAGE(unaligned, elf_program_header(file, 1)->p_vaddr = DATA + 4)
DAMAGE(into_local, elf_program_header(file, 1)->p_vaddr = 0xFFFFFDC0)
DAMAGE(address_wraps, elf_program_header(file, 1)->p_memsz = 0xFFFFFFFF)
DAMAGE(alignment, elf_program_header(file, 1)->p_align = 48)
DAMAGE(segment_flags, elf_program_header(file, 1)->p_flags |= 8)
DAMAGE(writable_text, elf_program_header(file, 0)->p_flags |= PF_W)
DAMAGE(overlap, elf_program_header(file, 1)->p_vaddr = TEXT)
DAMAGE(tls_data, elf_program_header(file, 1)->p_type = PT_TLS)
DAMAGE(tls_elsewhere, elf_program_header(file, 1)->p_type = PT_TLS; elf_program_header(file, 1)->p_filesz = 0)
DAMAGE(tls_large, tls_elsewhere(file); elf_program_header(file, 1)->p_vaddr = TRAX_LOCAL_BASE;
       elf_program_header(file, 1)->p_memsz = 513)
DAMAGE(symbols_outside, elf_section(file, ".symtab")->sh_offset = 0x7FFFFFF0)
DAMAGE(symbol_size, elf_section(file, ".symtab")->sh_entsize = 24)
DAMAGE(symbols_unaligned, elf_section(file, ".symtab")->sh_offset += 2)
DAMAGE(symbol_part, elf_section(file, ".symtab")->sh_size -= 1)
DAMAGE(symbol_strings, elf_section(file, ".symtab")->sh_link = 77)
DAMAGE(symbol_no_strings, elf_section(file, ".symtab")->sh_link = 1)
DAMAGE(strings_open, elf_section(file, ".strtab")->sh_size -= 1)
DAMAGE(strings_outside, elf_section(file, ".strtab")->sh_size = 0x7FFFFFFF)
DAMAGE(symbol_name, ((Elf32_Sym *)(file->bytes + elf_section(file, ".symtab")->sh_offset))[1].st_name = 0x10000)

static void test_refusals(void **state) {
  (void)state;
  static const struct {
    void (*damage)(struct elf_file *file);
    const char *message;
  } cases[] = {
      {empty, "the file is empty"},
      {text_file, "not an ELF file"},
      {archive, "not an ELF file but an archive"},
      {only_magic, "truncated: 20 bytes do not hold the ELF header"},
      {wide, "ELF class 2; a TRaX executable is ELF32 (class 1): is it a program for the host?"},
      {big_endian, "little endian"},
      {ident_version, "ELF version 2"},
      {machine, "built for ELF machine 0xf3; TRaX is 0x7472"},
      {object, "an object file, not an executable; link it first"},
      {shared, "ELF type 3"},
      {version, "ELF header version 0"},
      {flags, "e_flags is 0x3"},
      {stack, "is for stacks in global memory, but has no symbol __trax_stack_size"},
      {header_size, "ELF header of 64 bytes"},
      {no_programs, "no program headers"},
      {program_size, "program headers of 56 bytes"},
      {programs_outside, "2 program headers at offset 0xfffffff0, but the file ends at"},
      {programs_unaligned, "which are not multiples of 4"},
      {sections_unaligned, "which are not multiples of 4"},
      {section_size, "section headers of 64 bytes"},
      {sections_outside, "section headers at offset"},
      {no_sections, "none where the header announces a table"},
      {names_outside, "section names in section 99"},
      {entry_low, "entry 0x00000000 is not an instruction in an executable segment"},
      {entry_odd, "entry 0x00001002"},
      {entry_in_data, "entry 0x00010000"},
      {entry_behind, "entry 0x00001030"},
      {no_load, "no loadable segment"},
      {dynamic, "program header 1: dynamic linking is not supported"},
      {interpreter, "dynamic linking"},
      {file_above_memory, "program header 1: 125 bytes in the file for 124 in memory"},
      {segment_outside, "program header 0: 48 bytes at offset"},
      {segment_wraps, "program header 0: 48 bytes at offset 0xffffffe0"},
      {null_page, "address 0x00000fc0 lies in the null page"},
      {unaligned, "address 0x00010004 is not a multiple of 64"},
      {into_local, "reach into local memory"},
      {address_wraps, "reach into local memory"},
      {alignment, "alignment 48 is not a power of two"},
      {segment_flags, "unknown flags 0xe"},
      {writable_text, "both writable and executable"},
      {overlap, "overlap or share"},
      {tls_data, "initialised thread-local data"},
      {tls_elsewhere, "do not lie in local memory"},
      {tls_large, "513 bytes of thread-local data"},
      {symbols_outside, "(section 3): "},
      {symbol_size, "corrupt symbol table"},
      {symbols_unaligned, "corrupt symbol table"},
      {symbol_part, "corrupt symbol table"},
      {symbol_strings, "names in section 77"},
      {symbol_no_strings, "not a table of strings"},
      {strings_open, "not a table of strings"},
      {strings_outside, "but the file ends at"},
      {symbol_name, "name of symbol 1 at 0x10000"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
    refuse("copy", cases[i].damage, cases[i].message);
  trax_error error;
  assert_null(trax_image_open("/nonexistent", &error));
  assert_string_equal(error.message, "/nonexistent: cannot be read: No such file or directory");
  assert_null(trax_image_open("/", &error));
  assert_string_equal(error.message, "/: cannot be read: Is a directory");
}

static void test_stripped(void **state) {
  (void)state;
  struct elf_file file = program_file("copy");
  file.size = elf_header(&file)->e_shoff;
  Elf32_Ehdr *header = elf_header(&file);
  header->e_shoff = 0;
  header->e_shnum = header->e_shentsize = header->e_shstrndx = 0;
  trax_image *image = open_file(&file, NULL);
  assert_non_null(image);
  assert_null(trax_image_symbol_at(image, TEXT));
  use(image);
  trax_image_close(image);
  free(file.bytes);
}

/* Every beginning of a file lacks at least a part of the section headers, which are at its end. */
static void test_truncated_at_every_length(void **state) {
  (void)state;
  struct elf_file file = program_file("null");
  const size_t size = file.size;
  for (file.size = 0; file.size < size; ++file.size) {
    trax_error error = {.message = ""};
    trax_image *image = open_file(&file, &error);
    if (image)
      fail_msg("%zu of %zu bytes are accepted", file.size, size);
    assert_int_equal(strncmp(error.message, file_name, strlen(file_name)), 0);
    assert_true(strlen(error.message) > strlen(file_name) + 10);
  }
  free(file.bytes);
}

/* Each byte in turn takes other values; the image is refused, or what it offers can be used. */
static void test_every_byte_damaged(void **state) {
  (void)state;
  static const uint8_t changes[] = {0x01, 0x80, 0xFF};
  unsigned accepted = 0, refused = 0;
  struct elf_file file = program_file("null");
  for (size_t i = 0; i < file.size; ++i)
    for (size_t j = 0; j < sizeof changes; ++j) {
      file.bytes[i] ^= changes[j];
      trax_error error = {.message = ""};
      trax_image *image = open_file(&file, &error);
      if (image) {
        use(image);
        trax_image_close(image);
        ++accepted;
      } else {
        assert_true(strlen(error.message) > strlen(file_name) + 10);
        ++refused;
      }
      file.bytes[i] ^= changes[j];
    }
  /* Padding, code and names may be anything; headers may not. */
  assert_true(accepted > 500 && refused > 200);
  free(file.bytes);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_a_good_image),
      cmocka_unit_test(test_source_lines),
      cmocka_unit_test(test_refusals),
      cmocka_unit_test(test_stripped),
      cmocka_unit_test(test_truncated_at_every_length),
      cmocka_unit_test(test_every_byte_damaged),
  };
  int descriptor = memfd_create("test", 0);
  if (descriptor < 0)
    return 1;
  snprintf(file_name, sizeof file_name, "/proc/self/fd/%d", descriptor);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
