; Division of words: an estimate by the special unit, and a test of its remainder. TraxDivision.cpp describes it;
; tests/c/division.c has its results.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: quotient:
; CHECK: bltu r4, r5, {{.*}}
; CHECK: fcvt.s.wu r13, r5
; CHECK: fcvt.s.wu r14, r4
; CHECK: mv r12, r4
; CHECK: fdiv r14, r14, r13
; CHECK: fcvt.wu.s r4, r14
; CHECK: mul r14, r4, r5
; CHECK: sub r12, r12, r14
; CHECK: bgeu r12, r5, {{.*}}
; CHECK: ret
; CHECK: li r4, 0
; CHECK: ret
; CHECK: beqz r5, {{.*}}
; CHECK: fcvt.s.w r14, r12
; CHECK: fdiv r14, r14, r13
; CHECK: fcvt.w.s r14, r14
; CHECK: add r15, r4, r14
; CHECK: mul r14, r14, r5
; CHECK: sub r12, r12, r14
; CHECK: srai r14, r12, 31
; CHECK: and r16, r5, r14
; CHECK: add r4, r15, r14
; CHECK: add r12, r12, r16
; CHECK: bltu r12, r5, {{.*}}
; CHECK: j {{.*}}
define i32 @quotient(i32 %n, i32 %d) {
  %q = udiv i32 %n, %d
  ret i32 %q
}
; CHECK-LABEL: remainder:
; CHECK: bltu r4, r5, {{.*}}
; CHECK: fcvt.s.wu r12, r5
; CHECK: fcvt.s.wu r13, r4
; CHECK: fdiv r13, r13, r12
; CHECK: fcvt.wu.s r13, r13
; CHECK: mul r14, r13, r5
; CHECK: sub r4, r4, r14
; CHECK: bgeu r4, r5, {{.*}}
; CHECK: ret
define i32 @remainder(i32 %n, i32 %d) {
  %r = urem i32 %n, %d
  ret i32 %r
}
; CHECK-LABEL: small_divisor:
; CHECK: fcvt.s.wu r13, r5
; CHECK: fcvt.s.wu r14, r4
; CHECK: mv r12, r4
; CHECK: fdiv r14, r14, r13
; CHECK: fcvt.wu.s r4, r14
; CHECK: mul r14, r4, r5
; CHECK: sub r12, r12, r14
; CHECK: bgeu r12, r5, {{.*}}
; CHECK: ret
define i32 @small_divisor(i32 %n, i16 zeroext %d) {
  %w = zext i16 %d to i32
  %q = udiv i32 %n, %w
  ret i32 %q
}
; CHECK-LABEL: bytes:
; CHECK: andi r14, r4, 255
; CHECK: andi r12, r5, 255
; CHECK: fcvt.s.wu r13, r12
; CHECK: fcvt.s.wu r15, r14
; CHECK: fdiv r15, r15, r13
; CHECK: fcvt.wu.s r4, r15
; CHECK: mul r15, r4, r12
; CHECK: sub r14, r14, r15
; CHECK: bgeu r14, r12, {{.*}}
; CHECK: ret
define i8 @bytes(i8 %n, i8 %d) {
  %q = udiv i8 %n, %d
  ret i8 %q
}
; CHECK-LABEL: signed:
; CHECK: fcvt.s.w r13, r5
; CHECK: fcvt.s.w r14, r4
; CHECK: mv r12, r4
; CHECK: neg r15, r5
; CHECK: fdiv r14, r14, r13
; CHECK: max r15, r5, r15
; CHECK: fcvt.w.s r4, r14
; CHECK: srai r14, r12, 31
; CHECK: mul r16, r4, r5
; CHECK: sub r16, r12, r16
; CHECK: xor r17, r16, r14
; CHECK: sub r17, r17, r14
; CHECK: bgeu r17, r15, {{.*}}
; CHECK: ret
; CHECK: beqz r5, {{.*}}
; CHECK: xor r12, r12, r5
; CHECK: xor r17, r15, r14
; CHECK: srai r12, r12, 31
; CHECK: sub r17, r17, r14
; CHECK: ori r12, r12, 1
; CHECK: fcvt.s.w r18, r16
; CHECK: fdiv r18, r18, r13
; CHECK: fcvt.w.s r18, r18
; CHECK: add r19, r4, r18
; CHECK: mul r18, r18, r5
; CHECK: sub r16, r16, r18
; CHECK: xor r18, r16, r14
; CHECK: sub r18, r18, r14
; CHECK: srai r18, r18, 31
; CHECK: and r11, r12, r18
; CHECK: and r18, r17, r18
; CHECK: add r16, r16, r18
; CHECK: sub r4, r19, r11
; CHECK: xor r18, r16, r14
; CHECK: sub r18, r18, r14
; CHECK: bltu r18, r15, {{.*}}
; CHECK: j {{.*}}
define i32 @signed(i32 %n, i32 %d) {
  %q = sdiv i32 %n, %d
  ret i32 %q
}
; CHECK-LABEL: both:
; CHECK: fcvt.s.w r12, r5
; CHECK: fcvt.s.w r13, r4
; CHECK: neg r14, r5
; CHECK: fdiv r13, r13, r12
; CHECK: max r14, r5, r14
; CHECK: fcvt.w.s r15, r13
; CHECK: srai r13, r4, 31
; CHECK: mul r16, r15, r5
; CHECK: sub r16, r4, r16
; CHECK: xor r17, r16, r13
; CHECK: sub r17, r17, r13
; CHECK: bgeu r17, r14, {{.*}}
; CHECK: xor r4, r15, r16
; CHECK: ret
define i32 @both(i32 %n, i32 %d) {
  %q = sdiv i32 %n, %d
  %r = srem i32 %n, %d
  %s = xor i32 %q, %r
  ret i32 %s
}
; CHECK-LABEL: remainder_by_product:
; CHECK: bltu r4, r5, {{.*}}
; CHECK: fcvt.s.wu r13, r5
; CHECK: fcvt.s.wu r12, r4
; CHECK: fdiv r12, r12, r13
; CHECK: fcvt.wu.s r12, r12
; CHECK: mul r14, r12, r5
; CHECK: sub r4, r4, r14
; CHECK: bgeu r4, r5, {{.*}}
; CHECK: xor r4, r12, r4
; CHECK: ret
define i32 @remainder_by_product(i32 %n, i32 %d) {
  %q = udiv i32 %n, %d
  %p = mul i32 %d, %q
  %r = sub i32 %n, %p
  %s = xor i32 %q, %r
  ret i32 %s
}
; CHECK-LABEL: invariant:
; CHECK: li r12, 1
; CHECK: lui r15, 20352
; CHECK: maxu r13, r5, r12
; CHECK: addi r15, r15, -4
; CHECK: fcvt.s.wu r14, r13
; CHECK: fdiv r15, r15, r14
; CHECK: addi r14, r4, 400
; CHECK: fcvt.wu.s r15, r15
; CHECK: mulhu r16, r15, r13
; CHECK: srli r17, r15, 1
; CHECK: cmovz r17, r15, r16
; CHECK: mul r15, r13, r17
; CHECK: neg r15, r15
; CHECK: mulhu r15, r17, r15
; CHECK: add r15, r17, r15
; CHECK: lw r16, 0(r4)
; CHECK: mulhu r17, r16, r15
; CHECK: mul r18, r17, r13
; CHECK: sub r16, r16, r18
; CHECK: bgeu r16, r13, {{.*}}
; CHECK: sw r16, 0(r4)
; CHECK: addi r4, r4, 4
; CHECK: bne r4, r14, {{.*}}
; CHECK: j {{.*}}
; CHECK: mulhu r18, r16, r15
; CHECK: maxu r18, r18, r12
; CHECK: mul r19, r18, r13
; CHECK: add r17, r17, r18
; CHECK: sub r16, r16, r19
; CHECK: bltu r16, r13, {{.*}}
; CHECK: j {{.*}}
; CHECK: ret
define void @invariant(ptr %a, i32 %d) {
entry:
  br label %loop
loop:
  %i = phi i32 [ 0, %entry ], [ %next, %loop ]
  %p = getelementptr i32, ptr %a, i32 %i
  %n = load i32, ptr %p
  %r = urem i32 %n, %d
  store i32 %r, ptr %p
  %next = add i32 %i, 1
  %end = icmp eq i32 %next, 100
  br i1 %end, label %done, label %loop
done:
  ret void
}
; CHECK-LABEL: not_in_each_iteration:
; CHECK: bltu r15, r5, {{.*}}
; CHECK: fcvt.s.wu r14, r5
; CHECK: fcvt.s.wu r12, r15
; CHECK: fdiv r12, r12, r14
define i32 @not_in_each_iteration(ptr %a, i32 %d) {
entry:
  br label %loop
loop:
  %i = phi i32 [ 0, %entry ], [ %next, %latch ]
  %s = phi i32 [ 0, %entry ], [ %t, %latch ]
  %p = getelementptr i32, ptr %a, i32 %i
  %n = load i32, ptr %p
  %odd = trunc i32 %n to i1
  br i1 %odd, label %divides, label %latch
divides:
  %q = udiv i32 %n, %d
  br label %latch
latch:
  %t = phi i32 [ %s, %loop ], [ %q, %divides ]
  %next = add i32 %i, 1
  %end = icmp eq i32 %next, 100
  br i1 %end, label %done, label %loop
done:
  ret i32 %t
}
; CHECK-LABEL: constant:
; CHECK: lui r12, 52429
; CHECK: addi r12, r12, -13107
; CHECK: mulhu r12, r4, r12
; CHECK: srli r4, r12, 3
; CHECK: ret
define i32 @constant(i32 %n) {
  %q = udiv i32 %n, 10
  ret i32 %q
}
; CHECK-LABEL: small_code:
; CHECK: call __divsi3
; CHECK: ret
define i32 @small_code(i32 %n, i32 %d) optsize {
  %q = sdiv i32 %n, %d
  ret i32 %q
}
; CHECK-LABEL: double_word:
; CHECK: call __udivdi3
; CHECK: ret
define i64 @double_word(i64 %n, i64 %d) {
  %q = udiv i64 %n, %d
  ret i64 %q
}
