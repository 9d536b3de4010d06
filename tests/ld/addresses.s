// Sections at addresses of the user's choice, and in an order of the user's choice.
//
// RUN: rm -rf %t && mkdir %t && cd %t && %trax_mc -filetype=obj %s -o a.o
// DEFINE: %{options} =
// DEFINE: %{link} = %trax_ld a.o -o a -e f1 %{options} && llvm-readelf -SlsW a > out && FileCheck %s --input-file=out

// Each in a segment of its own; what follows, follows.
// REDEFINE: %{options} = -Tdata=0x20000 -Tbss=0x30000 --section-start=.boot=0x2000 --section-start .rodata=0x8000
// RUN: %{link} --check-prefix=ALL
// ALL:      .text   PROGBITS 00001000 {{[0-9a-f]+}} 00000c
// ALL-NEXT: .boot   PROGBITS 00002000 {{[0-9a-f]+}} 000004
// ALL-NEXT: .rodata PROGBITS 00008000 {{[0-9a-f]+}} 000004
// ALL-NEXT: after   PROGBITS 00008004 {{[0-9a-f]+}} 000004
// ALL-NEXT: .data   PROGBITS 00020000 {{[0-9a-f]+}} 000004
// ALL-NEXT: .bss    NOBITS   00030000 {{[0-9a-f]+}} 000010
// ALL:      LOAD {{0x[0-9a-f]+}} 0x00001000 0x00001000 0x0000c 0x0000c R E 0x40
// ALL-NEXT: LOAD {{0x[0-9a-f]+}} 0x00002000 0x00002000 0x00004 0x00004 R E 0x40
// ALL-NEXT: LOAD {{0x[0-9a-f]+}} 0x00008000 0x00008000 0x00008 0x00008 R 0x40
// ALL-NEXT: LOAD {{0x[0-9a-f]+}} 0x00020000 0x00020000 0x00004 0x00004 RW 0x40
// ALL-NEXT: LOAD {{0x[0-9a-f]+}} 0x00030000 0x00030000 0x00000 0x00010 RW 0x40
// ALL: 00030040 0 NOTYPE GLOBAL DEFAULT ABS _end
// RUN: llvm-readelf -x .boot -x .data -x .rodata -x after a | FileCheck %s --check-prefix=BYTES
// BYTES-DAG: 0x00002000 00000200
// BYTES-DAG: 0x00020000 00000300
// BYTES-DAG: 0x00008000 00800000
// BYTES-DAG: 0x00008004 04800000

// The whole image moves with its text; a section may lie below it; the last of several addresses counts.
// REDEFINE: %{options} = -Ttext=0x40000 -Tdata 0x50000 -Tdata=0x2000
// RUN: %{link} --check-prefix=MOVED
// MOVED:      .text   PROGBITS 00040000
// MOVED-NEXT: .boot   PROGBITS 0004000c
// MOVED-NEXT: .rodata PROGBITS 00040040
// MOVED-NEXT: after   PROGBITS 00040044
// MOVED-NEXT: .data   PROGBITS 00002000
// MOVED-NEXT: .bss    NOBITS   00002004
// MOVED-DAG: 00040080 0 NOTYPE GLOBAL DEFAULT ABS _end
// MOVED-DAG: 00002004 0 NOTYPE GLOBAL DEFAULT ABS __bss_start
// MOVED-DAG: 00002014 0 NOTYPE GLOBAL DEFAULT ABS __bss_end

// The entry may lie in any text.
// RUN: %trax_ld a.o -o a -e boot --section-start=.boot=0x2000 && llvm-readelf -h a | FileCheck %s --check-prefix=ENTRY
// ENTRY: Entry point address: 0x2000

// Overlaps, wrong addresses, and values of a second thread-local section.
// RUN: not %trax_ld a.o -o no -e f1 -Tdata=0x1000 2>&1 | FileCheck %s --check-prefix=OVERLAP
// OVERLAP: trax-ld: error: section .data, at 0x1000, overlaps section .text, at 0x1000 to 0x100c
// RUN: printf '.section .tdata, "awT"\n.space 128\n' > values.s && %trax_mc -filetype=obj values.s -o values.o
// RUN: not %trax_ld a.o values.o -o no -e f1 --section-start=.rodata=0x2000 -Tdata=0x2040 2>&1 | FileCheck %s --check-prefix=VALUES
// VALUES: trax-ld: error: the segments at 0x2000 and 0x2040 overlap
// RUN: not %trax_ld a.o -o no -e f1 -Tbss=0x1001 --section-start=.boot=100 --section-start=.boot --section-start==4 --section-start=x=y 2>&1 | \
// RUN:   FileCheck %s --check-prefix=WRONG --implicit-check-not=error:
// WRONG: trax-ld: error: -Tbss=0x1001: must be a multiple of 64 in global memory, 0x1000 or above
// WRONG: trax-ld: error: --section-start=.boot=100: must be a multiple of 64 in global memory, 0x1000 or above
// WRONG: trax-ld: error: --section-start=.boot: expected NAME=ADDRESS
// WRONG: trax-ld: error: --section-start==4: expected NAME=ADDRESS
// WRONG: trax-ld: error: --section-start=x=y: not a 32-bit number
// RUN: printf '.section .tdata, "awT"\n.word 1\n.section .local, "awT"\n.word 2\n.section pages, "a"\n.p2align 12\n.word 3\n' > more.s
// RUN: %trax_mc -filetype=obj more.s -o more.o
// RUN: not %trax_ld a.o more.o -o no -e f1 --section-start=pages=0x2040 2>&1 | FileCheck %s --check-prefix=MORE
// MORE: trax-ld: error: --section-start=pages=0x2040: the section is aligned to 4096
// MORE: trax-ld: error: section .local: initialised thread-local data is in .tdata already
// RUN: not ls no

// Symbols that --symbol-ordering-file lists come first, in its order, local ones and code that is hot or cold by its name
// included. Unknown names, comments and empty lines do nothing. Constructors keep the order of their priorities.
// RUN: printf '# order\n\n  cold \nnobody\nf3\r\nf1\nf3\nlater\n' > order
// RUN: printf '.section .init_array.2, "aw", @init_array\nlater: .long f1\n.section .init_array.1, "aw", @init_array\n.long f1\n' > arrays.s
// RUN: %trax_mc -filetype=obj arrays.s -o arrays.o
// REDEFINE: %{options} = arrays.o --symbol-ordering-file=order -Map=map
// RUN: %{link} --check-prefix=ORDER && FileCheck %s --check-prefix=MAP --input-file=map
// ORDER: .text PROGBITS 00001000 {{[0-9a-f]+}} 00000c
// MAP:      a.o:(.text.unlikely.cold)
// MAP:      a.o:(.text.f3)
// MAP:      a.o:(.text.f1)
// MAP:      arrays.o:(.init_array.1)
// MAP:      arrays.o:(.init_array.2)
// RUN: not %trax_ld a.o -o no -e f1 --symbol-ordering-file=absent 2>&1 | FileCheck %s --check-prefix=ABSENT
// ABSENT: trax-ld: error: absent: cannot be read

// Code is not moved. The options of other linkers' users are accepted.
// RUN: %trax_ld a.o -o one -e f1 && %trax_ld a.o -o two -e f1 --relax && cmp one two && %trax_ld a.o -o two -e f1 --no-relax && cmp one two

  .macro function name, section
  .section \section, "ax", @progbits
  .globl \name
\name:
  .endm
  function f1, .text.f1
  .word 0x11000000
  .section .text.f3, "ax", @progbits
f3:
  .word 0x33000000
  function cold, .text.unlikely.cold
  .word 0
  function boot, .boot
  .long data
  .section .rodata, "a", @progbits
rodata:
  .long rodata
  .section after, "a", @progbits
  .long . - after + rodata + 4
  .data
data:
  .long bss
  .bss
bss:
  .space 16
  .section .unloaded
  .long _end, __bss_start, __bss_end
