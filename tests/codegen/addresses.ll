; The addresses of strings that a loop passes to functions are computed there once registers are short, not kept in memory: the
; frame has the fourteen saved registers, nothing else.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

@s0 = constant i8 0
@s1 = constant i8 1
@s2 = constant i8 2
@s3 = constant i8 3
@s4 = constant i8 4
@s5 = constant i8 5
@s6 = constant i8 6
@s7 = constant i8 7
@s8 = constant i8 8
@s9 = constant i8 9
@s10 = constant i8 10
@s11 = constant i8 11
@s12 = constant i8 12
@s13 = constant i8 13
@s14 = constant i8 14
@s15 = constant i8 15
@s16 = constant i8 16
@s17 = constant i8 17
@s18 = constant i8 18
@s19 = constant i8 19
declare i32 @f(ptr)

; CHECK-LABEL: many:
; CHECK: addi r2, r2, -56
; CHECK: sw r31, 0(r2)
; CHECK-NOT: {{[ls]}}w {{.*}}(r2)
; CHECK: lui r4, %hi(s
define void @many() {
  br label %loop
loop:
  %r0 = call i32 @f(ptr @s0)
  %r1 = call i32 @f(ptr @s1)
  %r2 = call i32 @f(ptr @s2)
  %r3 = call i32 @f(ptr @s3)
  %r4 = call i32 @f(ptr @s4)
  %r5 = call i32 @f(ptr @s5)
  %r6 = call i32 @f(ptr @s6)
  %r7 = call i32 @f(ptr @s7)
  %r8 = call i32 @f(ptr @s8)
  %r9 = call i32 @f(ptr @s9)
  %r10 = call i32 @f(ptr @s10)
  %r11 = call i32 @f(ptr @s11)
  %r12 = call i32 @f(ptr @s12)
  %r13 = call i32 @f(ptr @s13)
  %r14 = call i32 @f(ptr @s14)
  %r15 = call i32 @f(ptr @s15)
  %r16 = call i32 @f(ptr @s16)
  %r17 = call i32 @f(ptr @s17)
  %r18 = call i32 @f(ptr @s18)
  %r19 = call i32 @f(ptr @s19)
  %again = icmp ne i32 %r19, 0
  br i1 %again, label %loop, label %end
end:
  ret void
}
