# Shorthands: what they assemble to, and which the disassembler prefers.
# RUN: %trax_mc -M no-aliases %s | FileCheck %s --check-prefix=PLAIN
# RUN: %trax_mc %s | FileCheck %s --check-prefix=ALIAS
# RUN: %trax_mc -filetype=obj -o %t.o %s && %trax_objdump -no-aliases %t.o | FileCheck %s --check-prefix=PLAIN

# PLAIN: addi r0, r0, 0
# ALIAS: nop
nop
# PLAIN: addi r4, r5, 0
# ALIAS: mv r4, r5
mv r4, r5
# PLAIN: xori r4, r5, -1
# ALIAS: not r4, r5
not r4, r5
# PLAIN: sub r4, r0, r5
# ALIAS: neg r4, r5
neg r4, r5
# PLAIN: sltiu r4, r5, 1
# ALIAS: seqz r4, r5
seqz r4, r5
# PLAIN: sltu r4, r0, r5
# ALIAS: snez r4, r5
snez r4, r5
# PLAIN: slt r4, r5, r0
# ALIAS: sltz r4, r5
sltz r4, r5
# PLAIN: slt r4, r0, r5
# ALIAS: sgtz r4, r5
sgtz r4, r5
# PLAIN: slt r4, r6, r5
# ALIAS: slt r4, r6, r5
sgt r4, r5, r6
# PLAIN: sltu r4, r6, r5
# ALIAS: sltu r4, r6, r5
sgtu r4, r5, r6
# PLAIN: flt r4, r6, r5
# ALIAS: flt r4, r6, r5
fgt r4, r5, r6
# PLAIN: fle r4, r6, r5
# ALIAS: fle r4, r6, r5
fge r4, r5, r6
# PLAIN: jalr r0, 0(r1)
# ALIAS: ret
ret
# PLAIN: jalr r0, 0(r5)
# ALIAS: jr r5
jr r5
# PLAIN: jalr r1, 0(r5)
# ALIAS: jalr r5
jalr r5

# li takes one instruction where one is enough.
# PLAIN: addi r4, r0, 0
# ALIAS: li r4, 0
li r4, 0
# PLAIN: addi r4, r0, -32768
# ALIAS: li r4, -32768
li r4, -32768
# PLAIN: addi r4, r0, -512
# ALIAS: li r4, -512
li r4, 0xFFFFFE00
# PLAIN: lui r4, 1
# PLAIN-NOT: addi
# PLAIN: lui r4, 1
# PLAIN: addi r4, r4, -32768
# ALIAS: lui r4, 1
# ALIAS-NEXT: lui r4, 1
# ALIAS-NEXT: addi r4, r4, -32768
li r4, 0x10000
li r4, 0x8000
# PLAIN: lui r5, 4660
# PLAIN: addi r5, r5, 22136
li r5, 0x12345678
# PLAIN: lui r5, 32768
# PLAIN: addi r5, r5, -1
li r5, 0x7FFFFFFF
# PLAIN: lui r5, 32768
# PLAIN: addi r5, r5, -32768
li r5, 0x7FFF8000
# PLAIN: lui r5, 65535
# PLAIN: addi r5, r5, 32767
li r5, 0xFFFF7FFF
# PLAIN: lui r5, 32768
# PLAIN-NOT: addi
li r5, 0x80000000
