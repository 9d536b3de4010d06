# The shared multiplier.
# RUN: %trax_mc -M no-aliases -show-encoding %s | FileCheck %s --check-prefixes=CHECK,ENC
# RUN: %trax_mc -filetype=obj -o %t.o %s && %trax_objdump -no-aliases %t.o | FileCheck %s

# CHECK: mul r4, r5, r6
# ENC-SAME: encoding: [0x00,0x30,0x85,0x08]
mul r4, r5, r6
# CHECK: mul r31, r0, r1
# ENC-SAME: encoding: [0x00,0x08,0xe0,0x0b]
mul r31, r0, r1
# CHECK: mulh r4, r5, r6
# ENC-SAME: encoding: [0x01,0x30,0x85,0x08]
mulh r4, r5, r6
# CHECK: mulh r31, r0, r1
# ENC-SAME: encoding: [0x01,0x08,0xe0,0x0b]
mulh r31, r0, r1
# CHECK: mulhu r4, r5, r6
# ENC-SAME: encoding: [0x02,0x30,0x85,0x08]
mulhu r4, r5, r6
# CHECK: mulhu r31, r0, r1
# ENC-SAME: encoding: [0x02,0x08,0xe0,0x0b]
mulhu r31, r0, r1
