# Every relocation of data.
# RUN: %trax_mc -filetype=obj -o %t.o %s
# RUN: llvm-readelf -r %t.o | FileCheck %s

.data
# CHECK: 00000000 {{[0-9a-f]+}}01 {{.*}} g + 4
.word g + 4
# CHECK: 00000004 {{[0-9a-f]+}}04 {{.*}} g + 0
.word g - .
# CHECK: 00000008 {{[0-9a-f]+}}02 {{.*}} g + 0
.half g
# CHECK: 0000000a {{[0-9a-f]+}}03 {{.*}} g + 0
.byte g
# A local symbol is its section and an offset.
# CHECK: 0000000c {{[0-9a-f]+}}01 {{.*}} .data + 10
.byte 0
.word local
local:
