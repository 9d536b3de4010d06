; A function's own features count, whatever the command line says: where its stack is decides about atomic operations on
; automatic objects, and about the size of a frame.
; RUN: %trax_llc -O2 %s -o - 2>%t.local | FileCheck %s --check-prefixes=CHECK,LOCAL
; RUN: FileCheck %s --check-prefix=WARN --implicit-check-not=warning < %t.local
; -mattr is added to what the functions say.
; RUN: %trax_llc -O2 -mattr=+global-stack %s -o - 2>&1 | FileCheck %s --check-prefixes=CHECK,GLOBAL --implicit-check-not=warning

declare void @look(ptr)

; CHECK-LABEL: own_global:
; CHECK: call __atomic_store_4
; CHECK: ret
define void @own_global() #0 {
  %a = alloca i32
  call void @look(ptr %a)
  store atomic i32 1, ptr %a release, align 4
  ret void
}

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
