# Spellings that the disassembler does not print, and places that it prints as addresses. Encodings are proved elsewhere,
# for all words of all formats: tests/disassembly, isa-reassembly, isa-model.
# RUN: %trax_mc -M no-aliases -show-encoding %s | FileCheck %s
# RUN: %trax_mc -filetype=obj -o %t.o %s && %trax_objdump -no-aliases %t.o | FileCheck %s --check-prefix=OBJ

# A negative constant of 16 bits may be written as the word that it is extended to.
# CHECK: addi r1, r2, -512 # encoding: [0x00,0xfe,0x22,0x20]
addi r1, r2, 0xFFFFFE00
# An address without an offset has the offset 0.
# CHECK: lw r7, 0(r8) # encoding: [0x00,0x00,0xe8,0x60]
lw r7, (r8)
# CHECK: jalr r5, 0(r6) # encoding: [0x00,0x00,0xa6,0x9c]
jalr r5, (r6)
# Special registers, traps and fences by number.
# CHECK: rdsr r4, cycleh # encoding: [0x05,0x00,0x80,0xa0]
rdsr r4, 5
# CHECK: trap r4, host # encoding: [0x07,0x00,0x04,0xa4]
trap r4, 7
# CHECK: fence w # encoding: [0x02,0x00,0x00,0xac]
fence 2

# Targets are distances in the source. Addresses wrap.
# OBJ: 18: 83e08000 beq r31, r0, 0xfffe0018
beq r31, r0, -131072
# OBJ: 1c: 85007fff bne r8, r0, 0x20018
bne r8, r0, 131068
# OBJ: 20: 98300000 jal r1, 0xffc00020
jal r1, -4194304
# OBJ: 24: 9befffff jal r31, 0x400020
jal r31, 4194300
