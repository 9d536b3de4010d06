# Integer operations with a constant.
# RUN: %trax_mc -M no-aliases -show-encoding %s | FileCheck %s --check-prefixes=CHECK,ENC
# RUN: %trax_mc -filetype=obj -o %t.o %s && %trax_objdump -no-aliases %t.o | FileCheck %s

# CHECK: addi r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x20]
addi r4, r5, 0
# CHECK: addi r31, r0, -32768
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x23]
addi r31, r0, -32768
# CHECK: addi r1, r2, 32767
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x20]
addi r1, r2, 32767
# CHECK: addi r1, r2, -512
# ENC-SAME: encoding: [0x00,0xfe,0x22,0x20]
addi r1, r2, 0xFFFFFE00
# CHECK: andi r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x24]
andi r4, r5, 0
# CHECK: andi r31, r0, -32768
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x27]
andi r31, r0, -32768
# CHECK: andi r1, r2, 32767
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x24]
andi r1, r2, 32767
# CHECK: andi r1, r2, -512
# ENC-SAME: encoding: [0x00,0xfe,0x22,0x24]
andi r1, r2, 0xFFFFFE00
# CHECK: ori r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x28]
ori r4, r5, 0
# CHECK: ori r31, r0, -32768
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x2b]
ori r31, r0, -32768
# CHECK: ori r1, r2, 32767
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x28]
ori r1, r2, 32767
# CHECK: ori r1, r2, -512
# ENC-SAME: encoding: [0x00,0xfe,0x22,0x28]
ori r1, r2, 0xFFFFFE00
# CHECK: xori r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x2c]
xori r4, r5, 0
# CHECK: xori r31, r0, -32768
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x2f]
xori r31, r0, -32768
# CHECK: xori r1, r2, 32767
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x2c]
xori r1, r2, 32767
# CHECK: xori r1, r2, -512
# ENC-SAME: encoding: [0x00,0xfe,0x22,0x2c]
xori r1, r2, 0xFFFFFE00
# CHECK: slti r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x30]
slti r4, r5, 0
# CHECK: slti r31, r0, -32768
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x33]
slti r31, r0, -32768
# CHECK: slti r1, r2, 32767
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x30]
slti r1, r2, 32767
# CHECK: slti r1, r2, -512
# ENC-SAME: encoding: [0x00,0xfe,0x22,0x30]
slti r1, r2, 0xFFFFFE00
# CHECK: sltiu r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x34]
sltiu r4, r5, 0
# CHECK: sltiu r31, r0, -32768
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x37]
sltiu r31, r0, -32768
# CHECK: sltiu r1, r2, 32767
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x34]
sltiu r1, r2, 32767
# CHECK: sltiu r1, r2, -512
# ENC-SAME: encoding: [0x00,0xfe,0x22,0x34]
sltiu r1, r2, 0xFFFFFE00
# CHECK: slli r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x38]
slli r4, r5, 0
# CHECK: slli r31, r1, 31
# ENC-SAME: encoding: [0x1f,0x00,0xe1,0x3b]
slli r31, r1, 31
# CHECK: srli r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x3c]
srli r4, r5, 0
# CHECK: srli r31, r1, 31
# ENC-SAME: encoding: [0x1f,0x00,0xe1,0x3f]
srli r31, r1, 31
# CHECK: srai r4, r5, 0
# ENC-SAME: encoding: [0x00,0x00,0x85,0x40]
srai r4, r5, 0
# CHECK: srai r31, r1, 31
# ENC-SAME: encoding: [0x1f,0x00,0xe1,0x43]
srai r31, r1, 31
# CHECK: lui r4, 0
# ENC-SAME: encoding: [0x00,0x00,0x80,0x44]
lui r4, 0
# CHECK: lui r31, 65535
# ENC-SAME: encoding: [0xff,0xff,0xe0,0x47]
lui r31, 65535
# CHECK: lui r5, 32768
# ENC-SAME: encoding: [0x00,0x80,0xa0,0x44]
lui r5, 0x8000
