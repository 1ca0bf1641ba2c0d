/* A function without privileges in the midst of a thread that has them (sandbox.hpp).

   In: the MPU's regions 5 and 6, which are those of whoever ran last without privileges, become the sandbox's; all
   registers that the caller wants back are on its own stack, whose pointer nobody without privileges can write; then
   the stack is the sandbox's, and CONTROL.nPRIV takes the rights.

   Out: by SVC alone, to one place. Nothing is believed: the caller's stack pointer is the one that was noted, the
   place to return to stands here, and all registers but the result come from the caller's stack. While a thread with
   privileges runs, the vector table has this handler (boards/common/vectors.hpp); other threads cannot come here. */

    .syntax unified
    .cpu    cortex-m4
    .thumb

    .equ    MPU_RBAR, 0xE000ED9C    /* its size, and both again for another region, stand behind it */
    .equ    UNPRIVILEGED, 3         /* CONTROL: nPRIV, and SPSEL as ever */
    .equ    FRAME, 32               /* what the core takes from the stack when an exception returns … */
    .equ    FRAME_PC, 24            /* … in it: pc, xPSR */
    .equ    XPSR_THUMB, 1 << 24

/* int32 robosync_call_in_sandbox(r0, r1, r2: the function's; r3: Sandbox) */
    .section .text.robosync_call_in_sandbox, "ax"
    .global robosync_call_in_sandbox
    .type   robosync_call_in_sandbox, %function
    .thumb_func
robosync_call_in_sandbox:
    push    {r3-r11, lr}            /* ten, so that a frame below them is aligned */
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
    bcc     Unexpected_Handler      /* who has privileges has nothing to ask for */
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
