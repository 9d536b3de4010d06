# Branch and jump shorthands.
# RUN: %trax_mc -M no-aliases %s | FileCheck %s --check-prefix=PLAIN
# RUN: %trax_mc %s | FileCheck %s --check-prefix=ALIAS

here:
# PLAIN: beq r4, r0, here
# ALIAS: beqz r4, here
beqz r4, here
# PLAIN: bne r4, r0, here
# ALIAS: bnez r4, here
bnez r4, here
# PLAIN: blt r4, r0, here
# ALIAS: bltz r4, here
bltz r4, here
# PLAIN: bge r4, r0, here
# ALIAS: bgez r4, here
bgez r4, here
# PLAIN: blt r0, r4, here
# ALIAS: bgtz r4, here
bgtz r4, here
# PLAIN: bge r0, r4, here
# ALIAS: blez r4, here
blez r4, here
# PLAIN: blt r5, r4, here
# ALIAS: blt r5, r4, here
bgt r4, r5, here
# PLAIN: bge r5, r4, here
# ALIAS: bge r5, r4, here
ble r4, r5, here
# PLAIN: bltu r5, r4, here
# ALIAS: bltu r5, r4, here
bgtu r4, r5, here
# PLAIN: bgeu r5, r4, here
# ALIAS: bgeu r5, r4, here
bleu r4, r5, here
# PLAIN: jal r0, here
# ALIAS: j here
j here
# PLAIN: jal r1, here
# ALIAS: call here
call here
# PLAIN: jal r1, here
# ALIAS: call here
jal here
