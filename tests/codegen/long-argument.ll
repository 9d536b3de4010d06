; RUN: %trax_llc -O2 %s -o - | FileCheck %s
; RUN: %trax_llc -O0 %s -o - | FileCheck %s --check-prefix=CALLS
; CALLS: call take_words
; CALLS: call take_bytes
; Long aggregates by value are copied in a loop, four units a turn, and the rest behind it.

%words = type { [18 x i32] }
%bytes = type { [67 x i8] }
%long = type { [100 x i32] }
declare void @take_words(ptr byval(%words) align 4)
declare void @take_bytes(ptr byval(%bytes) align 1)
declare void @take_long(i32, ptr byval(%long) align 4)
declare void @use(ptr)

; CHECK-LABEL: pass_words:
; CHECK: addi [[END:r[0-9]+]], r4, 64
; CHECK: [[LOOP:.LBB[0-9_]+]]:
; CHECK-COUNT-4: lw
; CHECK-COUNT-4: sw
; CHECK: bne {{r[0-9]+}}, {{r[0-9]+}}, [[LOOP]]
; CHECK-NOT: .LBB
; CHECK-DAG: sw {{r[0-9]+}}, 64(r2)
; CHECK-DAG: sw {{r[0-9]+}}, 68(r2)
; CHECK: call take_words
define void @pass_words(ptr %p) {
  call void @take_words(ptr byval(%words) align 4 %p)
  ret void
}

; CHECK-LABEL: pass_bytes:
; CHECK: [[LOOP:.LBB[0-9_]+]]:
; CHECK-COUNT-4: lbu
; CHECK-COUNT-4: sb
; CHECK: bne {{r[0-9]+}}, {{r[0-9]+}}, [[LOOP]]
; CHECK: sb {{r[0-9]+}}, 66(r2)
; CHECK: call take_bytes
define void @pass_bytes(ptr %p) {
  call void @take_bytes(ptr byval(%bytes) align 1 %p)
  ret void
}

; sp moves: what is copied goes to the place made for this call.
; CHECK-LABEL: pass_long:
; CHECK: addi r2, r2, -400
; CHECK: [[LOOP:.LBB[0-9_]+]]:
; CHECK: bne {{r[0-9]+}}, {{r[0-9]+}}, [[LOOP]]
; CHECK: call take_long
; CHECK: addi r2, r2, 400
define void @pass_long(i32 %n, ptr %p) {
  %local = alloca i32, i32 %n
  call void @use(ptr %local)
  call void @take_long(i32 %n, ptr byval(%long) align 4 %p)
  ret void
}
