; The linker must tell the jumps of switches and computed gotos, which stay in their function, from calls in tail position.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s
; RUN: %trax_llc -O2 -filetype=obj %s -o %t.o && llvm-readelf -r %t.o | grep -c " 0000000a Unknown" | FileCheck %s --check-prefix=COUNT
; COUNT: {{^}}2{{$}}

; CHECK-LABEL: switch:
; CHECK: [[PLACE:.Ltmp[0-9]+]]:
; CHECK-NEXT: .reloc [[PLACE]], R_TRAX_JUMP
; CHECK-NEXT: jr r
define i32 @switch(i32 %x) {
  switch i32 %x, label %other [
    i32 0, label %a
    i32 1, label %b
    i32 2, label %c
    i32 3, label %d
    i32 4, label %e
    i32 5, label %a
    i32 6, label %d
    i32 7, label %c
    i32 8, label %e
  ]
a:
  ret i32 31
b:
  ret i32 -7
c:
  %r = call i32 @external(i32 3)
  ret i32 %r
d:
  ret i32 99
e:
  %s = call i32 @external(i32 77)
  %t = add i32 %s, 1
  ret i32 %t
other:
  ret i32 0
}

; CHECK-LABEL: goto:
; CHECK: .reloc {{.*}}, R_TRAX_JUMP
; CHECK-NEXT: jr r
define i32 @goto(ptr %place) {
  indirectbr ptr %place, [label %a, label %b]
a:
  ret i32 1
b:
  ret i32 2
}

; CHECK-LABEL: tail:
; CHECK-NOT: .reloc
; CHECK: jr r
; CHECK-LABEL: .Lfunc_end2
define i32 @tail(ptr %f) {
  %r = tail call i32 %f(i32 1)
  ret i32 %r
}

declare i32 @external(i32)
