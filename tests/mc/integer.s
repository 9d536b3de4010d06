# Integer operations on registers.
# RUN: %trax_mc -M no-aliases -show-encoding %s | FileCheck %s --check-prefixes=CHECK,ENC
# RUN: %trax_mc -filetype=obj -o %t.o %s && %trax_objdump -no-aliases %t.o | FileCheck %s

# CHECK: add r4, r5, r6
# ENC-SAME: encoding: [0x00,0x30,0x85,0x04]
add r4, r5, r6
# CHECK: add r31, r0, r1
# ENC-SAME: encoding: [0x00,0x08,0xe0,0x07]
add r31, r0, r1
# CHECK: sub r4, r5, r6
# ENC-SAME: encoding: [0x01,0x30,0x85,0x04]
sub r4, r5, r6
# CHECK: sub r31, r0, r1
# ENC-SAME: encoding: [0x01,0x08,0xe0,0x07]
sub r31, r0, r1
# CHECK: and r4, r5, r6
# ENC-SAME: encoding: [0x02,0x30,0x85,0x04]
and r4, r5, r6
# CHECK: and r31, r0, r1
# ENC-SAME: encoding: [0x02,0x08,0xe0,0x07]
and r31, r0, r1
# CHECK: or r4, r5, r6
# ENC-SAME: encoding: [0x03,0x30,0x85,0x04]
or r4, r5, r6
# CHECK: or r31, r0, r1
# ENC-SAME: encoding: [0x03,0x08,0xe0,0x07]
or r31, r0, r1
# CHECK: xor r4, r5, r6
# ENC-SAME: encoding: [0x04,0x30,0x85,0x04]
xor r4, r5, r6
# CHECK: xor r31, r0, r1
# ENC-SAME: encoding: [0x04,0x08,0xe0,0x07]
xor r31, r0, r1
# CHECK: sll r4, r5, r6
# ENC-SAME: encoding: [0x05,0x30,0x85,0x04]
sll r4, r5, r6
# CHECK: sll r31, r0, r1
# ENC-SAME: encoding: [0x05,0x08,0xe0,0x07]
sll r31, r0, r1
# CHECK: srl r4, r5, r6
# ENC-SAME: encoding: [0x06,0x30,0x85,0x04]
srl r4, r5, r6
# CHECK: srl r31, r0, r1
# ENC-SAME: encoding: [0x06,0x08,0xe0,0x07]
srl r31, r0, r1
# CHECK: sra r4, r5, r6
# ENC-SAME: encoding: [0x07,0x30,0x85,0x04]
sra r4, r5, r6
# CHECK: sra r31, r0, r1
# ENC-SAME: encoding: [0x07,0x08,0xe0,0x07]
sra r31, r0, r1
# CHECK: slt r4, r5, r6
# ENC-SAME: encoding: [0x08,0x30,0x85,0x04]
slt r4, r5, r6
# CHECK: slt r31, r0, r1
# ENC-SAME: encoding: [0x08,0x08,0xe0,0x07]
slt r31, r0, r1
# CHECK: sltu r4, r5, r6
# ENC-SAME: encoding: [0x09,0x30,0x85,0x04]
sltu r4, r5, r6
# CHECK: sltu r31, r0, r1
# ENC-SAME: encoding: [0x09,0x08,0xe0,0x07]
sltu r31, r0, r1
# CHECK: cmovnz r4, r5, r6
# ENC-SAME: encoding: [0x0a,0x30,0x85,0x04]
cmovnz r4, r5, r6
# CHECK: cmovnz r31, r0, r1
# ENC-SAME: encoding: [0x0a,0x08,0xe0,0x07]
cmovnz r31, r0, r1
# CHECK: cmovz r4, r5, r6
# ENC-SAME: encoding: [0x0b,0x30,0x85,0x04]
cmovz r4, r5, r6
# CHECK: cmovz r31, r0, r1
# ENC-SAME: encoding: [0x0b,0x08,0xe0,0x07]
cmovz r31, r0, r1
# CHECK: min r4, r5, r6
# ENC-SAME: encoding: [0x0c,0x30,0x85,0x04]
min r4, r5, r6
# CHECK: min r31, r0, r1
# ENC-SAME: encoding: [0x0c,0x08,0xe0,0x07]
min r31, r0, r1
# CHECK: max r4, r5, r6
# ENC-SAME: encoding: [0x0d,0x30,0x85,0x04]
max r4, r5, r6
# CHECK: max r31, r0, r1
# ENC-SAME: encoding: [0x0d,0x08,0xe0,0x07]
max r31, r0, r1
# CHECK: minu r4, r5, r6
# ENC-SAME: encoding: [0x0e,0x30,0x85,0x04]
minu r4, r5, r6
# CHECK: minu r31, r0, r1
# ENC-SAME: encoding: [0x0e,0x08,0xe0,0x07]
minu r31, r0, r1
# CHECK: maxu r4, r5, r6
# ENC-SAME: encoding: [0x0f,0x30,0x85,0x04]
maxu r4, r5, r6
# CHECK: maxu r31, r0, r1
# ENC-SAME: encoding: [0x0f,0x08,0xe0,0x07]
maxu r31, r0, r1
