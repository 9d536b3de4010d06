# Loads, stores and the atomic increment. An address without an offset has the offset 0.
# RUN: %trax_mc -M no-aliases -show-encoding %s | FileCheck %s --check-prefixes=CHECK,ENC
# RUN: %trax_mc -filetype=obj -o %t.o %s && %trax_objdump -no-aliases %t.o | FileCheck %s

# CHECK: lb r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x50]
lb r4, 0(r5)
# CHECK: lb r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x53]
lb r31, -32768(r0)
# CHECK: lb r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x50]
lb r1, 32767(r2)
# CHECK: lb r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x50]
lb r7, (r8)
# CHECK: lbu r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x54]
lbu r4, 0(r5)
# CHECK: lbu r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x57]
lbu r31, -32768(r0)
# CHECK: lbu r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x54]
lbu r1, 32767(r2)
# CHECK: lbu r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x54]
lbu r7, (r8)
# CHECK: lh r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x58]
lh r4, 0(r5)
# CHECK: lh r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x5b]
lh r31, -32768(r0)
# CHECK: lh r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x58]
lh r1, 32767(r2)
# CHECK: lh r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x58]
lh r7, (r8)
# CHECK: lhu r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x5c]
lhu r4, 0(r5)
# CHECK: lhu r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x5f]
lhu r31, -32768(r0)
# CHECK: lhu r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x5c]
lhu r1, 32767(r2)
# CHECK: lhu r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x5c]
lhu r7, (r8)
# CHECK: lw r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x60]
lw r4, 0(r5)
# CHECK: lw r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x63]
lw r31, -32768(r0)
# CHECK: lw r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x60]
lw r1, 32767(r2)
# CHECK: lw r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x60]
lw r7, (r8)
# CHECK: lwnt r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x64]
lwnt r4, 0(r5)
# CHECK: lwnt r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x67]
lwnt r31, -32768(r0)
# CHECK: lwnt r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x64]
lwnt r1, 32767(r2)
# CHECK: lwnt r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x64]
lwnt r7, (r8)
# CHECK: sb r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x68]
sb r4, 0(r5)
# CHECK: sb r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x6b]
sb r31, -32768(r0)
# CHECK: sb r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x68]
sb r1, 32767(r2)
# CHECK: sb r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x68]
sb r7, (r8)
# CHECK: sh r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x6c]
sh r4, 0(r5)
# CHECK: sh r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x6f]
sh r31, -32768(r0)
# CHECK: sh r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x6c]
sh r1, 32767(r2)
# CHECK: sh r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x6c]
sh r7, (r8)
# CHECK: sw r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x70]
sw r4, 0(r5)
# CHECK: sw r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x73]
sw r31, -32768(r0)
# CHECK: sw r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x70]
sw r1, 32767(r2)
# CHECK: sw r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x70]
sw r7, (r8)
# CHECK: swnt r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x74]
swnt r4, 0(r5)
# CHECK: swnt r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x77]
swnt r31, -32768(r0)
# CHECK: swnt r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x74]
swnt r1, 32767(r2)
# CHECK: swnt r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x74]
swnt r7, (r8)
# CHECK: ainc r4, 0(r5)
# ENC-SAME: encoding: [0x00,0x00,0x85,0x78]
ainc r4, 0(r5)
# CHECK: ainc r31, -32768(r0)
# ENC-SAME: encoding: [0x00,0x80,0xe0,0x7b]
ainc r31, -32768(r0)
# CHECK: ainc r1, 32767(r2)
# ENC-SAME: encoding: [0xff,0x7f,0x22,0x78]
ainc r1, 32767(r2)
# CHECK: ainc r7, 0(r8)
# ENC-SAME: encoding: [0x00,0x00,0xe8,0x78]
ainc r7, (r8)
