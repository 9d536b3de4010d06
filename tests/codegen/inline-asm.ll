; Operands of inline assembly.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: registers:
; CHECK: add r4, r4, r5
; CHECK: ret
define i32 @registers(i32 %a, float %b) {
  %r = call i32 asm "add $0, $1, $2", "=r,r,r"(i32 %a, float %b)
  ret i32 %r
}
; CHECK-LABEL: immediates:
; CHECK: addi r12, r4, -5
; CHECK: add r4, r12, r0
; CHECK: ret
define i32 @immediates(i32 %a) {
  %r = call i32 asm "addi $0, $1, $2", "=r,r,I"(i32 %a, i32 -5)
  %s = call i32 asm "add $0, $1, ${2:z}", "=r,r,rJ"(i32 %r, i32 0)
  ret i32 %s
}
; CHECK-LABEL: memory:
; CHECK: lw r4, 16(r4)
; CHECK: ret
define i32 @memory(ptr %p) {
  %q = getelementptr i8, ptr %p, i32 16
  %r = call i32 asm "lw $0, $1", "=r,*m"(ptr elementtype(i32) %q)
  ret i32 %r
}
; CHECK-LABEL: clobbered:
; CHECK: sw r20, -4(r2)
; CHECK: addi r20, r4, 1
; CHECK: lw r20, -4(r2)
; CHECK: ret
define void @clobbered(i32 %a) {
  call void asm sideeffect "addi r20, $0, 1", "r,~{r20}"(i32 %a)
  ret void
}
; CHECK-LABEL: named:
; CHECK: mv r15, r4
; CHECK: mv r4, r15
; CHECK: ret
define i32 @named(i32 %a) {
  %r = call i32 asm "mv $0, $1", "={a0},{t3}"(i32 %a)
  ret i32 %r
}
