; A function's own features count, whatever the command line says: where its stack is decides about atomic operations on
; automatic objects, and about the size of a frame. The functions of one file agree about the place.
; RUN: sed "/^define.*_global()/,/^}/d" %s > %t.ll && %trax_llc -O2 %t.ll -o - 2>%t.local | FileCheck %s --check-prefixes=CHECK,LOCAL
; RUN: FileCheck %s --check-prefix=WARN --implicit-check-not=warning < %t.local
; RUN: not %trax_llc -O2 %s -o %t 2>&1 | FileCheck %s --check-prefix=BOTH
; BOTH: error: {{.*}}the functions of one file expect the stack in one place
; -mattr is added to what the functions say.
; RUN: %trax_llc -O2 -mattr=+global-stack %s -o - 2>&1 | FileCheck %s --check-prefixes=GLOBAL --implicit-check-not=warning
; Objects for either place take neither for granted.
; RUN: %trax_llc -O2 -mattr=+either-stack %t.ll -o - 2>/dev/null | FileCheck %s --check-prefix=EITHER --implicit-check-not=.stack

; LOCAL: .stack local
; GLOBAL: .stack global
; EITHER-LABEL: by_option:
; EITHER: call __atomic_store_4
; EITHER-LABEL: counted:
; EITHER: call __atomic_fetch_add_4
; GLOBAL-LABEL: own_global:
; GLOBAL: call __atomic_store_4
; GLOBAL: ret

declare void @look(ptr)

define void @own_global() #0 {
  %a = alloca i32
  call void @look(ptr %a)
  store atomic i32 1, ptr %a release, align 4
  ret void
}

; GLOBAL-LABEL: own_local:
; CHECK-LABEL: own_local:
; LOCAL-NOT: __atomic
; GLOBAL: call __atomic_store_4
; CHECK: ret
define void @own_local() #1 {
  %a = alloca i32
  call void @look(ptr %a)
  store atomic i32 1, ptr %a release, align 4
  ret void
}

; GLOBAL-LABEL: by_option:
; CHECK-LABEL: by_option:
; GLOBAL: call __atomic_store_4
; LOCAL-NOT: __atomic
; CHECK: ret
define void @by_option() {
  %a = alloca i32
  call void @look(ptr %a)
  store atomic i32 1, ptr %a release, align 4
  ret void
}

; GLOBAL-LABEL: counted:
; GLOBAL: ainc
; CHECK-LABEL: counted:
; LOCAL-NOT: ainc
; LOCAL-NOT: call
; CHECK: ret
define i32 @counted() {
  %a = alloca i32
  store i32 1, ptr %a
  %b = atomicrmw add ptr %a, i32 1 monotonic
  ret i32 %b
}

; WARN: warning: {{.*}}'large_local'
; WARN-NEXT: note: -mstack=global puts the stack into global memory
; WARN-NEXT: warning: {{.*}}'large_by_option'
define void @large_global() #0 {
  %a = alloca [600 x i8]
  call void @look(ptr %a)
  ret void
}
define void @large_local() #1 {
  %a = alloca [600 x i8]
  call void @look(ptr %a)
  ret void
}
define void @large_by_option() {
  %a = alloca [600 x i8]
  call void @look(ptr %a)
  ret void
}

attributes #0 = { "target-features"="+global-stack" }
attributes #1 = { "target-features"="-global-stack" }
