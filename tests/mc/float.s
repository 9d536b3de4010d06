# Floating point.
# RUN: %trax_mc -M no-aliases -show-encoding %s | FileCheck %s --check-prefixes=CHECK,ENC
# RUN: %trax_mc -filetype=obj -o %t.o %s && %trax_objdump -no-aliases %t.o | FileCheck %s

# CHECK: fadd r4, r5, r6
# ENC-SAME: encoding: [0x00,0x30,0x85,0x0c]
fadd r4, r5, r6
# CHECK: fadd r31, r0, r1
# ENC-SAME: encoding: [0x00,0x08,0xe0,0x0f]
fadd r31, r0, r1
# CHECK: fsub r4, r5, r6
# ENC-SAME: encoding: [0x01,0x30,0x85,0x0c]
fsub r4, r5, r6
# CHECK: fsub r31, r0, r1
# ENC-SAME: encoding: [0x01,0x08,0xe0,0x0f]
fsub r31, r0, r1
# CHECK: fmul r4, r5, r6
# ENC-SAME: encoding: [0x00,0x30,0x85,0x10]
fmul r4, r5, r6
# CHECK: fmul r31, r0, r1
# ENC-SAME: encoding: [0x00,0x08,0xe0,0x13]
fmul r31, r0, r1
# CHECK: fdiv r4, r5, r6
# ENC-SAME: encoding: [0x00,0x30,0x85,0x18]
fdiv r4, r5, r6
# CHECK: fdiv r31, r0, r1
# ENC-SAME: encoding: [0x00,0x08,0xe0,0x1b]
fdiv r31, r0, r1
# CHECK: fmin r4, r5, r6
# ENC-SAME: encoding: [0x02,0x30,0x85,0x0c]
fmin r4, r5, r6
# CHECK: fmin r31, r0, r1
# ENC-SAME: encoding: [0x02,0x08,0xe0,0x0f]
fmin r31, r0, r1
# CHECK: fmax r4, r5, r6
# ENC-SAME: encoding: [0x03,0x30,0x85,0x0c]
fmax r4, r5, r6
# CHECK: fmax r31, r0, r1
# ENC-SAME: encoding: [0x03,0x08,0xe0,0x0f]
fmax r31, r0, r1
# CHECK: feq r4, r5, r6
# ENC-SAME: encoding: [0x04,0x30,0x85,0x0c]
feq r4, r5, r6
# CHECK: feq r31, r0, r1
# ENC-SAME: encoding: [0x04,0x08,0xe0,0x0f]
feq r31, r0, r1
# CHECK: flt r4, r5, r6
# ENC-SAME: encoding: [0x05,0x30,0x85,0x0c]
flt r4, r5, r6
# CHECK: flt r31, r0, r1
# ENC-SAME: encoding: [0x05,0x08,0xe0,0x0f]
flt r31, r0, r1
# CHECK: fle r4, r5, r6
# ENC-SAME: encoding: [0x06,0x30,0x85,0x0c]
fle r4, r5, r6
# CHECK: fle r31, r0, r1
# ENC-SAME: encoding: [0x06,0x08,0xe0,0x0f]
fle r31, r0, r1
# CHECK: fcvt.w.s r4, r5
# ENC-SAME: encoding: [0x00,0x00,0x85,0x14]
fcvt.w.s r4, r5
# CHECK: fcvt.w.s r31, r0
# ENC-SAME: encoding: [0x00,0x00,0xe0,0x17]
fcvt.w.s r31, r0
# CHECK: fcvt.wu.s r4, r5
# ENC-SAME: encoding: [0x01,0x00,0x85,0x14]
fcvt.wu.s r4, r5
# CHECK: fcvt.wu.s r31, r0
# ENC-SAME: encoding: [0x01,0x00,0xe0,0x17]
fcvt.wu.s r31, r0
# CHECK: fcvt.s.w r4, r5
# ENC-SAME: encoding: [0x02,0x00,0x85,0x14]
fcvt.s.w r4, r5
# CHECK: fcvt.s.w r31, r0
# ENC-SAME: encoding: [0x02,0x00,0xe0,0x17]
fcvt.s.w r31, r0
# CHECK: fcvt.s.wu r4, r5
# ENC-SAME: encoding: [0x03,0x00,0x85,0x14]
fcvt.s.wu r4, r5
# CHECK: fcvt.s.wu r31, r0
# ENC-SAME: encoding: [0x03,0x00,0xe0,0x17]
fcvt.s.wu r31, r0
# CHECK: frsqrt r4, r5
# ENC-SAME: encoding: [0x01,0x00,0x85,0x18]
frsqrt r4, r5
# CHECK: frsqrt r31, r0
# ENC-SAME: encoding: [0x01,0x00,0xe0,0x1b]
frsqrt r31, r0
