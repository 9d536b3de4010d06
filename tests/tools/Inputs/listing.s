# Input of trax-objdump: two functions with lines, data in the text, data.
        .file 1 "." "first.c"
        .file 2 "sub/second.c"
        .text
        .globl main
        .type main,@function
main:
        .loc 1 2
        addi r2, r2, -4
        sw r1, 0(r2)
        .loc 1 3
        call helper
        lui r4, %hi(value+4)
        .loc 2 1
        lw r4, %lo(value+4)(r4)
        fmul r4, r4, r4
        .loc 1 4
again:
        fdiv r4, r4, r4
        bnez r4, again
        ret
        .size main, .-main
        .type table,@object
table:
        .word 0x20800001
        .byte 0x41, 0x42
        .size table, .-table
odd:
        .byte 0x43, 0
        .word 0xFFFFFFFF
        .globl helper
        .type helper,@function
helper:
        .loc 2 9
        lui r5, %hi(table)
        addi r5, r5, %lo(table)
        halt
        .size helper, .-helper

        .data
        .globl value
        .hidden value
        .type value,@object
        .size value, 8
value:  .ascii "some"
        .word table
        .section .tbss,"awT",@nobits
        .globl counter
        .type counter,@object
counter: .zero 4
        .section .rodata,"a"
        .byte 0xFF
        .weak maybe
        .comm shared,8,4
        .equ constant, 77
