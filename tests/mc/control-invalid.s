# Targets that no branch or jump reaches.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s
# RUN: not test -e %t.out

# CHECK: [[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
beq r4, r5, 2
# CHECK: [[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bne r4, r5, 131072
# CHECK: [[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
blt r4, r5, -131076
# CHECK: [[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bge r4, r5, r6
# CHECK: [[#@LINE+1]]:14: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bltu r4, r5, %lo(x)
# CHECK: [[#@LINE+1]]:10: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
beqz r4, 7
# CHECK: [[#@LINE+1]]:9: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
jal r1, 4194304
# CHECK: [[#@LINE+1]]:9: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
jal r1, -4194308
# CHECK: [[#@LINE+1]]:3: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
j 6
# CHECK: [[#@LINE+1]]:6: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
call r4
# CHECK: [[#@LINE+1]]:10: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
jalr r1, 32768(r4)
# CHECK: [[#@LINE+1]]:10: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
jalr r1, symbol(r4)
