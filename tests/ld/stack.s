// The worst stack depth: calls, tail calls, and programs without a bound. Every function states its frame
// in .stack_sizes; the code moves no sp, since only the statements count.
//
// RUN: split-file %s %t && cd %t
// RUN: %trax_mc -filetype=obj macros.s -o macros.o
// DEFINE: %{case} =
// DEFINE: %{options} =
// DEFINE: %{link} = cat macros.s %{case}.s > %{case}.whole.s && %trax_mc -filetype=obj %{case}.whole.s -o %{case}.o && \
// DEFINE:   %trax_ld --gc-sections --print-stack %{case}.o -o %{case} %{options} | \
// DEFINE:   FileCheck %{case}.s --match-full-lines --strict-whitespace
// REDEFINE: %{case} = path
// RUN: %{link}
// REDEFINE: %{case} = tails
// RUN: %{link}
// REDEFINE: %{case} = loops
// RUN: %{link}
// REDEFINE: %{case} = recursion
// RUN: %{link}
// REDEFINE: %{case} = indirect
// RUN: %{link}
// REDEFINE: %{case} = frames
// RUN: %{link}
// REDEFINE: %{case} = labels
// RUN: %{link}
// REDEFINE: %{case} = tables
// RUN: %{link}
// REDEFINE: %{case} = pointers
// RUN: %{link}

//--- macros.s
.macro function name, frame
  .section .text.\name, "ax", @progbits
  .globl \name
  .type \name, @function
\name:
  .pushsection .stack_sizes, "o", @progbits, .text.\name
  .long \name
  .uleb128 \frame
  .popsection
.endm
.macro finish name
  .size \name, . - \name
.endm
.macro leaf name, frame
  function \name, \frame
  ret
  finish \name
.endm

//--- path.s
// Two ways to f: the deeper one counts; so does a leaf below them. A weak function that nobody defines is never called.
// Functions that the entry cannot reach do not count. A frame of more than 127 bytes takes two bytes in the record.
//      CHECK:stack: at most 216 bytes, of 504 (512 of local memory less 8 of thread-local data)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:         8        8  _start, path.o:(.text._start)
// CHECK-NEXT:        16       24  deep, path.o:(.text.deep)
// CHECK-NEXT:       180      204  f, path.o:(.text.f)
// CHECK-NEXT:        12      216  g, path.o:(.text.g)
//  CHECK-NOT:{{.}}
  function _start, 8
  jal r1, shallow
  jal r1, deep
  jal r1, nobody
  .weak nobody
  addi r4, r0, %abs(thread)
  halt
  finish _start
  function shallow, 12
  jal r1, f
  ret
  finish shallow
  function deep, 16
  jal r1, f
  ret
  finish deep
  function f, 180
  jal r1, g
  ret
  finish f
  leaf g, 12
  function unused, 5000
  jal r1, unused
  finish unused
  .section .tbss, "awT", @nobits
thread:
  .space 8

//--- tails.s
// A tail call puts the callee in the caller's place: f and g are no deeper than g, and f's own calls count with f's frame. A
// conditional branch to another function is a tail call too.
//      CHECK:stack: at most 104 bytes, of 512 (local memory)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:         4        4  _start, tails.o:(.text._start)
// CHECK-NEXT:        60       64  f, tails.o:(.text.f), leaves by a tail call
// CHECK-NEXT:        80       84  g, tails.o:(.text.g)
// CHECK-NEXT:        20      104  h, tails.o:(.text.h)
//  CHECK-NOT:{{.}}
  function _start, 4
  jal r1, f
  halt
  finish _start
  function f, 60
  jal r1, h
  beq r4, r0, g
  ret
  finish f
  function g, 80
  jal r1, h
  j last
  finish g
  leaf h, 20
  leaf last, 90

//--- loops.s
// Functions that only replace one another have a bound. All count as the deepest: even takes 8 + 100.
//      CHECK:stack: at most 112 bytes, of 512 (local memory)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:         4        4  _start, loops.o:(.text._start)
// CHECK-NEXT:        12       16  odd, loops.o:(.text.odd), leaves by a tail call
// CHECK-NEXT:         8       12  even, loops.o:(.text.even)
// CHECK-NEXT:       100      112  f, loops.o:(.text.f)
//  CHECK-NOT:{{.}}
  function _start, 4
  jal r1, odd
  halt
  finish _start
  function odd, 12
  beq r4, r0, odd
  j even
  finish odd
  function even, 8
  jal r1, f
  j odd
  finish even
  leaf f, 100

//--- recursion.s
// A path goes round a recursion once. self calls itself; a calls b calls c jumps to a.
//      CHECK:stack: at least 70 bytes, of 512 (local memory)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:         0        0  _start, recursion.o:(.text._start)
// CHECK-NEXT:        10       10  a, recursion.o:(.text.a)
// CHECK-NEXT:        20       30  b, recursion.o:(.text.b)
// CHECK-NEXT:        30       60  c, recursion.o:(.text.c)
// CHECK-NEXT:        10       70  leaf, recursion.o:(.text.leaf)
// CHECK-NEXT:  not counted:
// CHECK-NEXT:  recursion: self -> self, recursion.o:(.text.self)
// CHECK-NEXT:  recursion: a -> b -> c -> a, recursion.o:(.text.a)
//  CHECK-NOT:{{.}}
  function _start, 0
  jal r1, self
  jal r1, a
  halt
  finish _start
  function self, 40
  jal r1, self
  ret
  finish self
  function a, 10
  jal r1, b
  ret
  finish a
  function b, 20
  jal r1, c
  ret
  finish b
  function c, 30
  jal r1, leaf
  j a
  finish c
  leaf leaf, 10

//--- indirect.s
// Calls through registers, in tail position too, have no bound. A marked jump stays in its function, a return through the
// register with which the function is called is a return, an address that a relocation gives is known, one without code is not.
//      CHECK:stack: at least 20 bytes, of 512 (local memory)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:         0        0  _start, indirect.o:(.text._start)
// CHECK-NEXT:        20       20  known, indirect.o:(.text.known)
// CHECK-NEXT:  not counted:
// CHECK-NEXT:  2 indirect calls: calls, indirect.o:(.text.calls)
// CHECK-NEXT:  1 indirect call: jumps, indirect.o:(.text.jumps)
// CHECK-NEXT:  2 indirect calls: outside, indirect.o:(.text.outside)
//  CHECK-NOT:{{.}}
  function _start, 0
  jal r1, calls
  jal r1, jumps
  jal r1, switch
  jal r12, other_link
  jal r1, outside
  lui r4, %hi(known)
  jalr r1, %lo(known)(r4)
  halt
  finish _start
  function calls, 0
  jalr r1, 0(r4)
  jalr r12, 4(r4)
  ret
  finish calls
  function jumps, 0
  jr r4
  finish jumps
  function switch, 0
  .reloc ., R_TRAX_JUMP
  jr r4
  finish switch
  function other_link, 0
  jr r12
  finish other_link
  function outside, 0
  jal r1, 0x2000 - .
  jal r1, somewhere
  .set somewhere, 0x2000
  ret
  finish outside
  leaf known, 20

//--- frames.s
// Functions without a record: what is seen of the frame counts, and that it is not known is said.
//      CHECK:stack: at least 32 bytes, of 512 (local memory)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:         0        0  _start, frames.o:(.text._start)
// CHECK-NEXT:        32       32  variable, frames.o:(.text.variable)
// CHECK-NEXT:  not counted:
// CHECK-NEXT:  frame of unknown size: unknown, frames.o:(.text.unknown)
// CHECK-NEXT:  frame of variable size: variable, frames.o:(.text.variable)
//  CHECK-NOT:{{.}}
  function _start, 0
  jal r1, unknown
  jal r1, variable
  halt
  finish _start
  .section .text.unknown, "ax", @progbits
  .type unknown, @function
unknown:
  addi r2, r2, -16
  addi r2, r2, 16
  ret
  finish unknown
  .section .text.variable, "ax", @progbits
  .type variable, @function
variable:
  addi r2, r2, -32
  addi r3, r2, 32
  andi r2, r2, -16
  sub r2, r2, r4
  addi r2, r3, -32
  addi r2, r2, 32
  ret
  finish variable

//--- labels.s
// Assembly of one section: labels within a function with a size are none of their own, a function without a size runs on into
// the next, calls are resolved by the assembler, two names of one place are one function.
//      CHECK:stack: at least 24 bytes, of 512 (local memory)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:         0        0  _start, labels.o:(.text)
// CHECK-NEXT:         0        0  first, labels.o:(.text+0x14), leaves by a tail call
// CHECK-NEXT:        24       24  second, labels.o:(.text+0x18)
// CHECK-NEXT:  not counted:
// CHECK-NEXT:  recursion: second -> second, labels.o:(.text+0x18)
// CHECK-NEXT:  frame of unknown size: _start, labels.o:(.text)
// CHECK-NEXT:  frame of unknown size: first, labels.o:(.text+0x14)
//  CHECK-NOT:{{.}}
  .text
  .globl _start, first, second, within
  .type _start, @function
_start:
  jal r1, first
within:
  addi r4, r4, -1
  bne r4, r0, within
inner:
  j inner
  halt
  finish _start
first:
  nop
  .type second, @function
  .type alias, @function
alias:
second:
  jal r1, alias
  ret
  finish second
  .section .stack_sizes, "o", @progbits, .text
  .long second
  .uleb128 16
  .long alias
  .uleb128 24

//--- tables.s
// The code that runs the constructors calls the functions that .init_array lists, and no others.
//      CHECK:stack: at most 40 bytes, of 512 (local memory)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:         4        4  _start, tables.o:(.text._start)
// CHECK-NEXT:        36       40  constructor, tables.o:(.text.constructor)
//  CHECK-NOT:{{.}}
  function _start, 4
  lui r20, %hi(__init_array_start)
  addi r20, r20, %lo(__init_array_start)
  lw r4, 0(r20)
  jalr r1, 0(r4)
  halt
  finish _start
  leaf constructor, 36
  leaf destructor, 50
  .section .init_array, "aw", @init_array
  .long constructor
  .section .fini_array, "aw", @fini_array
  .long destructor

//--- pointers.s
// With indirect calls of every function whose address is taken, in data or by instructions: pointed is one, inner another, though
// it calls back; called and dropped are none, nor is what a jump table holds.
//      CHECK:stack: at least 30 bytes, of 512 (local memory)
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:        10       10  _start, pointers.o:(.text._start)
// CHECK-NEXT:        20       30  called, pointers.o:(.text.called)
// CHECK-NEXT:  not counted:
// CHECK-NEXT:  1 indirect call: _start, pointers.o:(.text._start)
// CHECK-NEXT:  with indirect calls of any function whose address is taken, 150 bytes:
// CHECK-NEXT:     frame    depth  function
// CHECK-NEXT:        10       10  _start, pointers.o:(.text._start)
// CHECK-NEXT:         0       10  (2 functions by address), leaves by a tail call
// CHECK-NEXT:        40       50  pointed, pointers.o:(.text.pointed)
// CHECK-NEXT:       100      150  below, pointers.o:(.text.below)
//  CHECK-NOT:{{.}}
  function _start, 10
  jal r1, called
  lui r4, %hi(table)
  lw r4, %lo(table)(r4)
  jalr r1, 0(r4)
  lui r5, %hi(inner)
  addi r5, r5, %lo(inner)
  halt
  finish _start
  function called, 20
  lui r4, %hi(switch)
  lw r4, %lo(switch)(r4)
  .reloc ., R_TRAX_JUMP
  jr r4
.Lcase:
  ret
  finish called
  function pointed, 40
  jal r1, below
  ret
  finish pointed
  leaf below, 100
  function inner, 12
  jalr r1, 0(r4)
  ret
  finish inner
  leaf dropped, 400
  .section .data.table, "aw", @progbits
table:
  .long pointed
  .section .data.dropped, "aw", @progbits
  .long dropped
  .section .rodata.switch, "a", @progbits
switch:
  .long .Lcase
