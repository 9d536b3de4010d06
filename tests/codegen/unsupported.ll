; What cannot be compiled is said; nothing is written, and nothing crashes.
; RUN: not %trax_llc -O2 %s -o %t.s 2>&1 | FileCheck %s
; RUN: not test -e %t.s

%huge = type { [200 x i32] }
declare void @take_huge(ptr byval(%huge) align 4)
declare i32 @nine(i32, i32, i32, i32, i32, i32, i32, i32, i32)
declare i32 @__builtin_trax_rdsr(i32)
declare void @__builtin_trax_trap(i32, i32)

; CHECK: error: {{.*}} in function huge_argument {{.*}}: an argument of 800 bytes does not fit the local memory
define void @huge_argument(ptr %p) {
  call void @take_huge(ptr byval(%huge) align 4 %p)
  ret void
}
; CHECK: error: {{.*}} in function must_tail {{.*}}: this call cannot be a tail call: arguments or result need the stack
define i32 @must_tail(i32 %a, i32 %b, i32 %c, i32 %d, i32 %e, i32 %f, i32 %g, i32 %h, i32 %i) {
  %r = musttail call i32 @nine(i32 %a, i32 %b, i32 %c, i32 %d, i32 %e, i32 %f, i32 %g, i32 %h, i32 0)
  ret i32 %r
}
; CHECK: error: {{.*}} in function register_number {{.*}}: special register must be a constant below 6
define i32 @register_number(i32 %n) {
  %r = call i32 @__builtin_trax_rdsr(i32 %n)
  ret i32 %r
}
; CHECK: error: {{.*}} in function trap_code {{.*}}: trap code must be a constant below 8
define void @trap_code() {
  call void @__builtin_trax_trap(i32 0, i32 8)
  ret void
}
; CHECK: error: {{.*}} in function convention {{.*}}: unsupported calling convention
define swiftcc void @convention() {
  ret void
}
; CHECK: error: couldn't allocate input reg for constraint 'r'
define void @wide_operand(i128 %x) {
  call void asm sideeffect "nop", "r"(i128 %x)
  ret void
}
; CHECK: error: value out of range for constraint 'I'
define void @immediate_too_large() {
  call void asm sideeffect "addi r4, r4, $0", "I"(i32 40000)
  ret void
}
