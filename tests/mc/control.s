# Branches and jumps by a number of bytes, and the system instructions.
# RUN: %trax_mc -M no-aliases -show-encoding %s | FileCheck %s --check-prefixes=CHECK,ENC
# RUN: %trax_mc -filetype=obj -o %t.o %s && %trax_objdump -no-aliases %t.o | FileCheck %s --check-prefix=OBJ

# CHECK: beq r4, r5, 8
# ENC-SAME: encoding: [0x02,0x00,0x85,0x80]
beq r4, r5, 8
# CHECK: beq r31, r0, -131072
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x83]
beq r31, r0, -131072
# CHECK: beq r0, r1, 131068
# ENC-SAME: encoding: [0xff,0x7f,0x01,0x80]
beq r0, r1, 131068
# CHECK: bne r4, r5, 8
# ENC-SAME: encoding: [0x02,0x00,0x85,0x84]
bne r4, r5, 8
# CHECK: bne r31, r0, -131072
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x87]
bne r31, r0, -131072
# CHECK: bne r0, r1, 131068
# ENC-SAME: encoding: [0xff,0x7f,0x01,0x84]
bne r0, r1, 131068
# CHECK: blt r4, r5, 8
# ENC-SAME: encoding: [0x02,0x00,0x85,0x88]
blt r4, r5, 8
# CHECK: blt r31, r0, -131072
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x8b]
blt r31, r0, -131072
# CHECK: blt r0, r1, 131068
# ENC-SAME: encoding: [0xff,0x7f,0x01,0x88]
blt r0, r1, 131068
# CHECK: bge r4, r5, 8
# ENC-SAME: encoding: [0x02,0x00,0x85,0x8c]
bge r4, r5, 8
# CHECK: bge r31, r0, -131072
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x8f]
bge r31, r0, -131072
# CHECK: bge r0, r1, 131068
# ENC-SAME: encoding: [0xff,0x7f,0x01,0x8c]
bge r0, r1, 131068
# CHECK: bltu r4, r5, 8
# ENC-SAME: encoding: [0x02,0x00,0x85,0x90]
bltu r4, r5, 8
# CHECK: bltu r31, r0, -131072
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x93]
bltu r31, r0, -131072
# CHECK: bltu r0, r1, 131068
# ENC-SAME: encoding: [0xff,0x7f,0x01,0x90]
bltu r0, r1, 131068
# CHECK: bgeu r4, r5, 8
# ENC-SAME: encoding: [0x02,0x00,0x85,0x94]
bgeu r4, r5, 8
# CHECK: bgeu r31, r0, -131072
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x97]
bgeu r31, r0, -131072
# CHECK: bgeu r0, r1, 131068
# ENC-SAME: encoding: [0xff,0x7f,0x01,0x94]
bgeu r0, r1, 131068
# CHECK: jal r0, 0
# ENC-SAME: encoding: [0x00,0x00,0x00,0x98]
jal r0, 0
# CHECK: jal r1, -4194304
# ENC-SAME: encoding: [0x00,0x00,0x30,0x98]
jal r1, -4194304
# CHECK: jal r31, 4194300
# ENC-SAME: encoding: [0xff,0xff,0xef,0x9b]
jal r31, 4194300
# CHECK: jalr r0, 0(r1)
# ENC-SAME: encoding: [0x00,0x00,0x01,0x9c]
jalr r0, 0(r1)
# CHECK: jalr r1, -4(r31)
# ENC-SAME: encoding: [0xfc,0xff,0x3f,0x9c]
jalr r1, -4(r31)
# CHECK: jalr r5, 0(r6)
# ENC-SAME: encoding: [0x00,0x00,0xa6,0x9c]
jalr r5, (r6)
# CHECK: rdsr r4, thread
# ENC-SAME: encoding: [0x00,0x00,0x80,0xa0]
rdsr r4, thread
# CHECK: rdsr r4, tm
# ENC-SAME: encoding: [0x01,0x00,0x80,0xa0]
rdsr r4, tm
# CHECK: rdsr r4, tp
# ENC-SAME: encoding: [0x02,0x00,0x80,0xa0]
rdsr r4, tp
# CHECK: rdsr r4, threads
# ENC-SAME: encoding: [0x03,0x00,0x80,0xa0]
rdsr r4, threads
# CHECK: rdsr r4, cycle
# ENC-SAME: encoding: [0x04,0x00,0x80,0xa0]
rdsr r4, cycle
# CHECK: rdsr r4, cycleh
# ENC-SAME: encoding: [0x05,0x00,0x80,0xa0]
rdsr r4, cycleh
# CHECK: rdsr r4, thread
# ENC-SAME: encoding: [0x00,0x00,0x80,0xa0]
rdsr r4, 0
# CHECK: rdsr r4, cycleh
# ENC-SAME: encoding: [0x05,0x00,0x80,0xa0]
rdsr r4, 5
# CHECK: trap r4, exit
# ENC-SAME: encoding: [0x00,0x00,0x04,0xa4]
trap r4, exit
# CHECK: trap r4, putc
# ENC-SAME: encoding: [0x01,0x00,0x04,0xa4]
trap r4, putc
# CHECK: trap r4, abort
# ENC-SAME: encoding: [0x02,0x00,0x04,0xa4]
trap r4, abort
# CHECK: trap r4, rays
# ENC-SAME: encoding: [0x03,0x00,0x04,0xa4]
trap r4, rays
# CHECK: trap r4, items
# ENC-SAME: encoding: [0x04,0x00,0x04,0xa4]
trap r4, items
# CHECK: trap r4, puts
# ENC-SAME: encoding: [0x05,0x00,0x04,0xa4]
trap r4, puts
# CHECK: trap r4, kinds
# ENC-SAME: encoding: [0x06,0x00,0x04,0xa4]
trap r4, kinds
# CHECK: trap r4, host
# ENC-SAME: encoding: [0x07,0x00,0x04,0xa4]
trap r4, host
# CHECK: trap r4, exit
# ENC-SAME: encoding: [0x00,0x00,0x04,0xa4]
trap r4, 0
# CHECK: trap r4, puts
# ENC-SAME: encoding: [0x05,0x00,0x04,0xa4]
trap r4, 5
# CHECK: fence r
# ENC-SAME: encoding: [0x01,0x00,0x00,0xac]
fence r
# CHECK: fence w
# ENC-SAME: encoding: [0x02,0x00,0x00,0xac]
fence w
# CHECK: fence rw
# ENC-SAME: encoding: [0x03,0x00,0x00,0xac]
fence rw
# CHECK: fence w
# ENC-SAME: encoding: [0x02,0x00,0x00,0xac]
fence 2
# CHECK: halt
# ENC-SAME: encoding: [0x00,0x00,0x00,0xa8]
halt

# The disassembler prints addresses.
# OBJ: 0: 80850002 beq r4, r5, 0x8
# OBJ: 4: 83e08000 beq r31, r0, 0xfffe0004
# OBJ: 48: 98000000 jal r0, 0x48
# OBJ: 4c: 98300000 jal r1, 0xffc0004c
# OBJ: 50: 9befffff jal r31, 0x40004c
# OBJ: 58: 9c3ffffc jalr r1, -4(r31)
# OBJ: 74: a0800005 rdsr r4, cycleh
# OBJ: 94: a4040005 trap r4, puts
# OBJ: 98: a4040006 trap r4, kinds
# OBJ: 9c: a4040007 trap r4, host
# OBJ: a8: ac000001 fence r
# OBJ: b0: ac000003 fence rw
# OBJ: b8: a8000000 halt
