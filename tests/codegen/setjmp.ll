; RUN: %trax_llc -O2 %s -o - | FileCheck %s
; RUN: %trax_llc -O0 %s -o - | FileCheck %s
; __builtin_setjmp keeps the place to continue at and r31; longjmp loads ra, r31, sp and fp, in that order, and jumps.

declare i32 @llvm.eh.sjlj.setjmp(ptr)
declare void @llvm.eh.sjlj.longjmp(ptr)
declare ptr @llvm.frameaddress.p0(i32)
declare ptr @llvm.stacksave.p0()
declare i32 @work(i32)

@buffer = global [5 x ptr] zeroinitializer

; Every saved register is saved: the jump brings none of them back.
; CHECK-LABEL: save:
; CHECK-DAG: sw r20, {{[0-9]+}}({{r[0-9]+}})
; CHECK-DAG: sw r31, {{[0-9]+}}({{r[0-9]+}})
; CHECK-DAG: lui [[HI:[a-z0-9]+]], %hi([[AGAIN:.LBB[0-9_]+]])
; CHECK-DAG: addi [[PLACE:[a-z0-9]+]], [[HI]], %lo([[AGAIN]])
; CHECK: sw [[PLACE]], 4(
; CHECK: sw r31, 12(
; CHECK: {{^}}[[AGAIN]]:
; CHECK: li {{[a-z0-9]+}}, 1
define i32 @save(i32 %a) {
  %fp = call ptr @llvm.frameaddress.p0(i32 0)
  store ptr %fp, ptr @buffer
  %sp = call ptr @llvm.stacksave.p0()
  store ptr %sp, ptr getelementptr (i8, ptr @buffer, i32 8)
  %again = call i32 @llvm.eh.sjlj.setjmp(ptr @buffer)
  %sum = add i32 %again, %a
  %result = call i32 @work(i32 %sum)
  %all = add i32 %result, %a
  ret i32 %all
}

; CHECK-LABEL: jump:
; CHECK: lw r1, 4([[BUFFER:[a-z0-9]+]])
; CHECK-NEXT: lw r31, 12([[BUFFER]])
; CHECK-NEXT: lw r2, 8([[BUFFER]])
; CHECK-NEXT: lw r3, 0([[BUFFER]])
; CHECK: ret
define void @jump(ptr %to) {
  call void @llvm.eh.sjlj.longjmp(ptr %to)
  unreachable
}
