; Repeated sequences become functions where size is all that counts.
; RUN: %trax_llc -O2 -verify-machineinstrs %s -o - | FileCheck %s

declare i32 @callee(i32, i32, i32)

; A leaf keeps ra, so the return address goes into another register.
; CHECK-LABEL: leaf_a:
; CHECK: jal [[LINK:r1[2-9]]], [[INNER:OUTLINED_FUNCTION_[0-9]]]
; CHECK-NEXT: addi r4, r12, 3
; CHECK-NEXT: sw r12, 0(r7)
; CHECK-NEXT: ret
define i32 @leaf_a(i32 %a, i32 %b, i32 %c, ptr %p) minsize optsize nounwind {
  %v1 = mul i32 %a, %b
  %v2 = xor i32 %v1, %b
  %v3 = mul i32 %v2, %c
  %v4 = add i32 %v3, %c
  %v5 = and i32 %v4, 4095
  store i32 %v5, ptr %p
  %v6 = add i32 %v5, 3
  ret i32 %v6
}
; CHECK-LABEL: leaf_b:
; CHECK: jal [[LINK]], [[INNER]]
; CHECK-NEXT: addi r4, r12, 4
; CHECK-NEXT: sw r12, 0(r7)
; CHECK-NEXT: ret
define i32 @leaf_b(i32 %a, i32 %b, i32 %c, ptr %p) minsize optsize nounwind {
  %v1 = mul i32 %a, %b
  %v2 = xor i32 %v1, %b
  %v3 = mul i32 %v2, %c
  %v4 = add i32 %v3, %c
  %v5 = and i32 %v4, 4095
  store i32 %v5, ptr %p
  %v6 = add i32 %v5, 4
  ret i32 %v6
}

; What ends with a call is called, and jumps to what it would have called.
; CHECK-LABEL: calls:
; CHECK: call [[CALLS:OUTLINED_FUNCTION_[0-9]]]
; CHECK: call [[CALLS]]
define i32 @calls(i32 %a, ptr %p) minsize optsize nounwind {
  %v1 = call i32 @callee(i32 %a, i32 1000, i32 2000)
  store volatile i32 1, ptr %p
  %v2 = call i32 @callee(i32 %a, i32 1000, i32 2000)
  store volatile i32 2, ptr %p
  %v3 = call i32 @callee(i32 %a, i32 1000, i32 2000)
  store volatile i32 3, ptr %p
  ret i32 %v3
}

; What ends with a return is jumped to.
; CHECK-LABEL: returns_a:
; CHECK: j [[RETURNS:OUTLINED_FUNCTION_[0-9]]]
define i32 @returns_a(i32 %a, i32 %b) minsize optsize nounwind {
  %v0 = add i32 %a, 8
  %v1 = udiv i32 %v0, 100
  %v2 = xor i32 %v1, %b
  %v3 = or i32 %v2, 77
  ret i32 %v3
}
; CHECK-LABEL: returns_b:
; CHECK: j [[RETURNS]]
define i32 @returns_b(i32 %a, i32 %b) minsize optsize nounwind {
  %v0 = add i32 %a, 9
  %v1 = udiv i32 %v0, 100
  %v2 = xor i32 %v1, %b
  %v3 = or i32 %v2, 77
  ret i32 %v3
}

; A function with a section of its own stays there.
; CHECK-LABEL: pinned:
; CHECK-NOT: OUTLINED
; CHECK: ret
define i32 @pinned(i32 %a, i32 %b) minsize optsize nounwind section ".text.pinned" {
  %v0 = add i32 %a, 9
  %v1 = udiv i32 %v0, 100
  %v2 = xor i32 %v1, %b
  %v3 = or i32 %v2, 77
  ret i32 %v3
}

; CHECK: [[RETURNS]]:
; CHECK: xor
; CHECK: ret
; CHECK: [[CALLS]]:
; CHECK: li r6, 2000
; CHECK: j callee
; CHECK: [[INNER]]:
; CHECK-COUNT-4: {{^[[:space:]]+(mul|xor|add)[[:space:]]}}
; CHECK-NEXT: andi r12, r12, 4095
; CHECK-NEXT: jr [[LINK]]
