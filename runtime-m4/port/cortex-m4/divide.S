/* 64-bit division, for a board with little flash: the compiler's own is 900 bytes and three times as
   slow where it matters, times divided by 1000.

   The dividend is in r1:r0, the divisor in r3:r2; quotient and remainder come back in r1:r0 and r3:r2
   (the run-time ABI for the Arm architecture). A division by 0 terminates, with an undefined result. */

    .syntax unified
    .cpu    cortex-m4
    .thumb

    .section .text.divide, "ax"
    .global __aeabi_uldivmod, __aeabi_ldivmod
    .type   __aeabi_uldivmod, %function
    .type   __aeabi_ldivmod, %function

/* Operands that both fit a word, the usual case, need one division. A longer dividend with a divisor of 16 bits is
   divided in digits of 16 bits, so that a remainder and the next digit fit a word. */
    .thumb_func
__aeabi_uldivmod:
    cbnz    r3, by_bits
    cbnz    r1, 1f
    udiv    ip, r0, r2
    mls     r2, ip, r2, r0
    mov     r0, ip
    bx      lr
1:
    lsrs    ip, r2, #16
    bne     by_bits
    udiv    ip, r1, r2
    mls     r1, ip, r2, r1
    lsrs    r3, r0, #16
    orr     r3, r3, r1, lsl #16
    udiv    r1, r3, r2
    mls     r3, r1, r2, r3
    uxth    r0, r0
    orr     r0, r0, r3, lsl #16
    udiv    r3, r0, r2
    mls     r2, r3, r2, r0
    orr     r0, r3, r1, lsl #16
    mov     r1, ip
    movs    r3, #0
    bx      lr

/* Bit by bit: first the divisor is shifted so that its highest bit lines up with the dividend's. */
by_bits:
    push    {r4-r8, lr}
    movs    r4, #0                  /* quotient */
    movs    r5, #0
    clz     r7, r1
    cbnz    r1, 1f
    clz     r7, r0
    adds    r7, #32
1:  clz     r6, r3
    cbnz    r3, 2f
    clz     r6, r2
    adds    r6, #32
2:  subs    r6, r6, r7              /* bits to shift; with none to shift, the quotient is 0 or 1 */
    it      mi
    movmi   r6, #0
    rsb     r7, r6, #32             /* a shift by 32 to 255 gives 0 */
    lsr     r7, r2, r7
    lsls    r3, r3, r6
    orrs    r3, r7
    sub     r7, r6, #32
    lsl     r7, r2, r7
    orrs    r3, r7
    lsls    r2, r2, r6
3:  adds    r4, r4, r4
    adcs    r5, r5
    subs    r7, r0, r2
    sbcs    r8, r1, r3
    ittt    hs
    movhs   r0, r7
    movhs   r1, r8
    addhs   r4, #1
    lsrs    r3, r3, #1
    rrx     r2, r2
    subs    r6, #1
    bpl     3b
    mov     r2, r0
    mov     r3, r1
    mov     r0, r4
    mov     r1, r5
    pop     {r4-r8, pc}
    .size   __aeabi_uldivmod, . - __aeabi_uldivmod

/* The quotient is rounded towards 0; the remainder has the sign of the dividend. */
    .thumb_func
__aeabi_ldivmod:
    push    {r4, r5, r6, lr}
    mov     r5, r1
    eor     r4, r1, r3
    cmp     r1, #0
    bge     1f
    rsbs    r0, #0
    sbc     r1, r1, r1, lsl #1
1:  cmp     r3, #0
    bge     2f
    rsbs    r2, #0
    sbc     r3, r3, r3, lsl #1
2:  bl      __aeabi_uldivmod
    cmp     r4, #0
    bge     3f
    rsbs    r0, #0
    sbc     r1, r1, r1, lsl #1
3:  cmp     r5, #0
    bge     4f
    rsbs    r2, #0
    sbc     r3, r3, r3, lsl #1
4:  pop     {r4, r5, r6, pc}
    .size   __aeabi_ldivmod, . - __aeabi_ldivmod
