; Words that may lie anywhere are compared in the pieces in which they are loaded: nothing is put together first.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: halves:
; CHECK-COUNT-4: lbu
; CHECK-NOT: slli
; CHECK: seqz
; CHECK: ret
define i1 @halves(ptr %a, ptr %b) {
  %x = load i16, ptr %a, align 1
  %y = load i16, ptr %b, align 1
  %same = icmp eq i16 %x, %y
  ret i1 %same
}

; CHECK-LABEL: branch:
; CHECK-COUNT-4: lhu
; CHECK-NOT: slli
; CHECK: b{{eq|ne}}z
define void @branch(ptr %a, ptr %b) {
  %x = load i64, ptr %a, align 2
  %y = load i64, ptr %b, align 2
  %same = icmp eq i64 %x, %y
  br i1 %same, label %store, label %end
store:
  store i8 0, ptr %a
  br label %end
end:
  ret void
}

; The store changes a byte of the one, after it is loaded, and perhaps the other, before it is.
; CHECK-LABEL: order:
; CHECK: lbu {{r[0-9]+}}, 0(r4)
; CHECK-NOT: 0(r5)
; CHECK: sb r0, 0(r4)
; CHECK: lbu {{r[0-9]+}}, 0(r5)
; CHECK: snez
define i1 @order(ptr %a, ptr %b) {
  %x = load i32, ptr %a, align 1
  store i8 0, ptr %a
  %y = load i32, ptr %b, align 1
  %differ = icmp ne i32 %x, %y
  ret i1 %differ
}

; The difference is put together, not both words: three shifts.
; CHECK-LABEL: difference:
; CHECK-COUNT-4: xor
; CHECK-COUNT-3: slli
; CHECK-NOT: slli
; CHECK: ret
define i32 @difference(ptr %a, ptr %b) {
  %x = load i32, ptr %a, align 1
  %y = load i32, ptr %b, align 1
  %difference = xor i32 %x, %y
  ret i32 %difference
}

; A word that is needed elsewhere is put together.
; CHECK-LABEL: shared:
; CHECK: bne r
define i32 @shared(ptr %a, ptr %b) {
  %x = load i32, ptr %a, align 1
  %y = load i32, ptr %b, align 1
  %same = icmp eq i32 %x, %y
  br i1 %same, label %equal, label %other
equal:
  ret i32 %x
other:
  ret i32 0
}
