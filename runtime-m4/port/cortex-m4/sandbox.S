/* An unprivileged function inside a privileged thread (sandbox.hpp).

   Entry: the MPU's regions 5 and 6, still those of the last unprivileged thread, are set to the sandbox's window. The
   callee-saved registers are pushed on the caller's own stack, and its stack pointer is stored where unprivileged code
   cannot write. Then PSP is set to the sandbox's stack, and CONTROL.nPRIV removes the privileges.

   Exit: only by SVC, and only to one place. The function is not trusted: the caller's stack pointer is the stored one,
   the return address is fixed here, and all registers but the result come from the caller's stack. While a privileged
   thread runs, the vector table has this handler (boards/common/vectors.hpp); unprivileged threads cannot reach it. */

    .syntax unified
    .cpu    cortex-m4
    .thumb

    .equ    MPU_RBAR, 0xE000ED9C    /* followed by RASR, and by both again for another region */
    .equ    UNPRIVILEGED, 3         /* CONTROL: nPRIV, and SPSEL as before */
    .equ    FRAME, 32               /* bytes that the core pops when an exception returns */
    .equ    FRAME_PC, 24            /* offset of pc and xPSR in it */
    .equ    XPSR_THUMB, 1 << 24

/* int32 robosync_call_in_sandbox(r0, r1, r2: the function's arguments; r3: Sandbox) */
    .section .text.robosync_call_in_sandbox, "ax"
    .global robosync_call_in_sandbox
    .type   robosync_call_in_sandbox, %function
    .thumb_func
robosync_call_in_sandbox:
    push    {r3-r11, lr}            /* ten words, so that a frame below them is aligned */
    ldmia   r3, {r4-r9}
    ldr     r3, =MPU_RBAR
    stmia   r3, {r4-r7}
    ldr     r3, =robosync_sandbox_caller
    str     sp, [r3]
    msr     psp, r8
    movs    r3, #UNPRIVILEGED
    msr     control, r3
    isb
    blx     r9
    svc     0
    .pool
    .size   robosync_call_in_sandbox, . - robosync_call_in_sandbox

    .section .text.SVC_Sandbox_Handler, "ax"
    .global SVC_Sandbox_Handler
    .type   SVC_Sandbox_Handler, %function
    .thumb_func
SVC_Sandbox_Handler:
    mrs     r0, control
    lsrs    r0, r0, #1
    bcc     Unexpected_Handler      /* privileged code makes no system calls */
    mrs     r0, psp
    ldr     r3, =robosync_sandbox_caller
    ldr     r0, [r0]                /* r0 of the frame: the result */
    ldr     r3, [r3]
    str     r0, [r3, #-FRAME]!
    ldr     r1, =.Lback
    mov     r2, #XPSR_THUMB
    strd    r1, r2, [r3, #FRAME_PC]
    msr     psp, r3
    movs    r0, #0
    msr     control, r0
    bx      lr
.Lback:
    pop     {r3-r11, pc}
    .pool
    .size   SVC_Sandbox_Handler, . - SVC_Sandbox_Handler

    .section .bss.robosync_sandbox_caller, "aw", %nobits
    .align  2
robosync_sandbox_caller:
    .space  4
