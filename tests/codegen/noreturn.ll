; What never returns saves no register of its caller's; what calls does, so that a debugger finds the way back.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

declare void @use()

; CHECK-LABEL: ends:
; CHECK-NOT: sw
; CHECK: halt
define void @ends() noreturn nounwind {
  call void asm sideeffect "", "~{r20},~{r31}"()
  call void @__builtin_trax_halt()
  unreachable
}
; CHECK-LABEL: calls:
; CHECK: sw r1,
; CHECK: sw r20,
; CHECK: call use
define void @calls() noreturn nounwind {
  call void asm sideeffect "", "~{r20}"()
  call void @use()
  unreachable
}
; CHECK-LABEL: returns:
; CHECK: sw r20, -4(r2)
; CHECK: lw r20, -4(r2)
; CHECK: ret
define void @returns() nounwind {
  call void asm sideeffect "", "~{r20}"()
  ret void
}
declare void @__builtin_trax_halt()
