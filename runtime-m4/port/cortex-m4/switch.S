/* The context switch: PendSV, at the lowest priority, so it runs when no other handler does.

   A thread that does not run leaves its registers on its own stack:

       higher addresses
       | FPSCR, s0–s15           only if the thread used the FPU   } stacked by the core
       | xPSR pc lr r12 r3–r0                                      } at exception entry
       | s16–s31                 only if the thread used the FPU   } stacked here
       | EXC_RETURN r11–r4                                         }
       +-- Context::sp

   Saving may run into the guard below the stack: the instruction at robosync_saving_core or _fpu
   then faults, fault.cpp stops the thread, and the switch goes on at robosync_saved.

   Bit 4 of EXC_RETURN is 0 if the thread used the FPU; storing s16 makes the core store s0–s15
   first where it put that off. Which thread comes next is decided in C++: robosync_switch. */

    .syntax unified
    .cpu    cortex-m4
    .fpu    fpv4-sp-d16
    .thumb

    .section .text.PendSV_Handler, "ax"
    .global PendSV_Handler, robosync_saving_core, robosync_saving_fpu, robosync_saved
    .type   PendSV_Handler, %function
    .thumb_func
PendSV_Handler:
    mrs     r1, psp
    tst     lr, #0x10
    beq     2f
robosync_saving_core:
    stmdb   r1!, {r4-r11, lr}

robosync_saved:
    ldr     r0, =robosync_kernel
    bl      robosync_switch         /* (kernel, sp of the thread that ran) -> sp of the next one */

    ldmia   r0!, {r4-r11, lr}
    tst     lr, #0x10
    beq     3f
1:  msr     psp, r0
    bx      lr

2:
robosync_saving_fpu:
    vstmdb  r1!, {s16-s31}
    b       robosync_saving_core
3:  vldmia  r0!, {s16-s31}
    b       1b
    .pool
    .size   PendSV_Handler, . - PendSV_Handler

/* void robosync_become_idle(stack top): what called becomes the idle thread, on that stack. */
    .section .text.robosync_become_idle, "ax"
    .global robosync_become_idle
    .type   robosync_become_idle, %function
    .thumb_func
robosync_become_idle:
    msr     psp, r0
    movs    r0, #2                  /* thread mode uses PSP, and has no FPU state */
    msr     control, r0
    isb
    movs    r0, #0
    msr     basepri, r0             /* the switch that waits happens here */
1:  wfi
    b       1b
    .size   robosync_become_idle, . - robosync_become_idle
