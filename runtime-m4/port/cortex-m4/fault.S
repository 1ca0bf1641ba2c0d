/* All fault handlers: collect the registers that the core did not stack, and call C++.
   robosync_fault returns the EXC_RETURN to leave with. */

    .syntax unified
    .cpu    cortex-m4
    .thumb

    .section .text.fault_handlers, "ax"
    .global HardFault_Handler, MemManage_Handler, BusFault_Handler, UsageFault_Handler
    .type   HardFault_Handler, %function
    .type   MemManage_Handler, %function
    .type   BusFault_Handler, %function
    .type   UsageFault_Handler, %function
    .thumb_func
HardFault_Handler:
    .thumb_func
MemManage_Handler:
    .thumb_func
BusFault_Handler:
    .thumb_func
UsageFault_Handler:
    ldr     r2, =0xE000EF34         /* FPCCR: drop FPU registers whose stacking is deferred; */
    ldr     r3, [r2]                /* the space for them may lie outside the stack */
    bic     r3, r3, #1
    str     r3, [r2]
    mov     r0, sp                  /* where the core stacked if a handler faulted */
    mrs     r1, psp                 /* where it stacked, or tried to, if a thread faulted */
    push    {r0, r1, r4-r11, lr}    /* struct FaultEntry */
    sub     sp, #4                  /* 8-aligned for C++ */
    add     r0, sp, #4
    bl      robosync_fault
    add     sp, #12                 /* that word, msp and psp */
    pop     {r4-r11, lr}
    bx      r0
    .pool
    .size   UsageFault_Handler, . - UsageFault_Handler
