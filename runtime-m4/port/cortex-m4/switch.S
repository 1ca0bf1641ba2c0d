/* The context switch: PendSV, at the lowest priority, so it runs when no other handler does.

   The registers of a thread that does not run are saved on its own stack:

       higher addresses
       | FPSCR, s0–s15           only if the thread used the FPU   } stacked by the core
       | xPSR pc lr r12 r3–r0                                      } at exception entry
       | s16–s31                 only if the thread used the FPU   } stacked here
       | EXC_RETURN r11–r4                                         }
       +-- Context::sp

   Saving may run into the guard below the stack: the instruction at robosync_saving_core or _fpu
   then faults, fault.cpp stops the thread, and the switch continues at robosync_saved.

   Bit 4 of EXC_RETURN is 0 if the thread used the FPU. If the core has deferred stacking s0–s15,
   storing s16 makes it stack them first.

   The next thread is chosen as in Kernel::select_next(), but in registers. One instruction loads everything that the
   choice depends on (kernel::Selection). If an interrupt makes a thread ready after that load, it compares the thread's
   rank with one that is not above the rank chosen here, and requests another switch if the thread's rank is above it.

   A thread's run time is the value of the free-running clock, which counts down, when the thread
   started, minus the value when it ends. This takes three instructions of each switch, because the running thread's
   origin is next to the pointer to the thread, and is loaded and stored with it. Some boards add a call to read the
   clock (clock.hpp).

   Unprivileged threads cost the others nothing. They enter the switch through their own vector table.
   The EXC_RETURN saved for them has bits 4 and 5 cleared, and bit 6 too if they used the FPU, so only
   the FPU path of the restore has to test for them. A secluded thread (ThreadSpec::data_bytes) starts as
   if it had used the FPU, so bit 6 is always cleared, and only the path for that tests for it. */

    .syntax unified
    .cpu    cortex-m4
    .fpu    fpv4-sp-d16
    .thumb

    .equ    VTOR, 0xE000ED08
    .equ    MPU_RASR, 0xE000EDA0    /* and MPU_RBAR before it */
    .equ    RUNNING_RANK, 28        /* kernel::Selection::running_rank_ */
    .equ    CEILING, 29             /* … ::ceiling_ */
    .equ    BY_RANK, 32             /* … ::by_rank_ */
    .equ    ALL_WRITE, 0x1302       /* upper half of core::kMpuAllWrite */
    .equ    SECLUDED, 1 << 22       /* Context::kSecluded */
    .equ    ALL_RAM, 0x20000015     /* RBAR: start of RAM, region 5; region 6, the stack, overrides it */
    .equ    CLOSED, 0x11020039      /* core::kMpuPrivileged, 512 MB */
    .equ    SWITCH_PRIORITY, 0xC0   /* core::kSwitchPriority */

    .section .text.PendSV_Handler, "ax"
    .global PendSV_Handler, robosync_saving_core, robosync_saving_fpu, robosync_saved
    .global robosync_save_unprivileged, robosync_saving_unprivileged_fpu, robosync_saved_unprivileged, robosync_no_room
    .type   PendSV_Handler, %function
    .type   robosync_save_unprivileged, %function
    .type   robosync_no_room, %function
    .thumb_func
PendSV_Handler:
    mrs     r0, psp
    tst     lr, #0x10
    beq     2f
robosync_saving_core:
    stmdb   r0!, {r4-r11, lr}

robosync_saved:
#if defined(ROBOSYNC_CLOCK_IS_SYSTICK) || defined(ROBOSYNC_CLOCK_IS_CALLED)
    mov     r4, r0
    bl      robosync_read_clock
    mov     r10, r0
    mov     r0, r4
#endif
    ldr     r9, =robosync_kernel
    ldmia   r9, {r2-r8}             /* running_ (its Context), its origin, the clock, held_, ready_ */
#if defined(ROBOSYNC_CLOCK_IS_SYSTICK) || defined(ROBOSYNC_CLOCK_IS_CALLED)
    mov     r4, r10
#else
    ldr     r4, [r4]
#endif
    subs    r3, r4
    strd    r0, r3, [r2]            /* Context::sp, ::run_time */

    cbz     r6, 10f
    clz     r6, r6                  /* the highest rank that is ready */
11: cbnz    r5, 13f
12: add     r5, r9, r6, lsl #2
    strb    r6, [r9, #RUNNING_RANK]
    ldr     r0, [r5, #BY_RANK]
14: ldmia   r0, {r1-r3, r12}        /* the next thread's Context: ::sp, ::run_time, ::region, ::windows */
    adds    r2, r4
    strd    r0, r2, [r9]            /* running_, its origin */
    ldr     r6, =MPU_RASR
    str     r3, [r6, #-4]
    ldmia   r1!, {r4-r11, lr}
    tst     lr, #0x10
    beq     3f
1:  msr     psp, r1
    bx      lr

10: cbz     r7, 15f                 /* none in the first word */
    clz     r6, r7
    adds    r6, #32
    b       11b
15: clz     r6, r8
    adds    r6, #64                 /* for an empty set: 96, the index of the idle thread */
    b       11b

13: ldrb    r7, [r9, #CEILING]      /* held_: a mutex */
    cmp     r6, r7
    blo     12b
    strb    r7, [r9, #RUNNING_RANK]
    ldr     r0, [r5]                /* Mutex::owner_ */
    b       14b

2:
robosync_saving_fpu:
    vstmdb  r0!, {s16-s31}
    b       robosync_saving_core
3:  tst     lr, #0x20
    beq     4f
    vldmia  r1!, {s16-s31}
    b       1b

/* Into an unprivileged thread: set its window, its vector table and CONTROL. The base of the lower region (r3) is
   set already; r12 is Context::windows. */
4:  tst     lr, #0x40
    beq     6f
    orr     lr, lr, #0x30
    msr     psp, r1
5:  ldr     r0, =MPU_RASR
    movt    r2, #ALL_WRITE
    pkhbt   r1, r12, r2
    addw    r3, r3, #0x201          /* 512 bytes on, and the next region number */
    pkhtb   r12, r2, r12, asr #16
9:  stmia   r0, {r1, r3, r12}
    ldr     r1, =robosync_unprivileged_vectors
    str     r1, [r0, #VTOR - MPU_RASR]
    movs    r1, #1
    msr     control, r1
    bx      lr
6:  vldmia  r1!, {s16-s31}
    orr     lr, lr, #0x60
    msr     psp, r1
    tst     r12, #SECLUDED
    beq     5b
    ldr     r0, =MPU_RASR
    movt    r2, #ALL_WRITE
    pkhbt   r1, r12, r2
    ldr     r3, =ALL_RAM
    ldr     r12, =CLOSED
    b       9b

/* Out of an unprivileged thread: (psp), if there is room on its stack (PendSV_Unprivileged_Handler). */
    .thumb_func
robosync_save_unprivileged:
    tst     lr, #0x10
    bic     lr, lr, #0x30
    beq     7f
8:  stmdb   r0!, {r4-r11, lr}
robosync_saved_unprivileged:
    ldr     r1, =VTOR
    ldr     r2, =robosync_vectors
    str     r2, [r1]
    movs    r2, #0
    msr     control, r2
    b       robosync_saved
7:
robosync_saving_unprivileged_fpu:
    vstmdb  r0!, {s16-s31}
    bic     lr, lr, #0x40
    b       8b

/* If there is no room: a fault, attributed to the thread (fault.cpp). */
    .thumb_func
robosync_no_room:
    udf     #0
    .pool
    .size   PendSV_Handler, . - PendSV_Handler

/* void robosync_become_idle(stack top): the caller becomes the idle thread, on that stack, and
   sleeps as tick.cpp describes. */
    .section .text.robosync_become_idle, "ax"
    .global robosync_become_idle, robosync_idle_masks, robosync_idle_unmasks
    .type   robosync_become_idle, %function
    .thumb_func
robosync_become_idle:
    msr     psp, r0
    movs    r0, #2                  /* thread mode uses PSP, and has no FPU state */
    msr     control, r0
    isb
    movs    r4, #SWITCH_PRIORITY
    movs    r5, #0
#if defined(ROBOSYNC_IDLE_WORKS)
    ldr     r6, =robosync_has_work
#endif
    msr     basepri, r5             /* the pending switch happens here */
1:  msr     basepri_max, r4         /* a SwitchLock */
#if defined(ROBOSYNC_IDLE_WORKS)
    ldr     r0, [r6]
    cbnz    r0, 2f
#endif
    bl      robosync_set_alarm
robosync_idle_masks:
    cpsid   i
    msr     basepri, r5
    wfi                             /* any interrupt ends it, and is then held off until cpsie */
    bl      robosync_count_sleep
    msr     basepri_max, r4         /* a SwitchLock again */
robosync_idle_unmasks:
    cpsie   i
    bl      robosync_end_sleep
    msr     basepri, r5             /* the tick and the switch happen here */
    b       1b
#if defined(ROBOSYNC_IDLE_WORKS)
2:  msr     basepri, r5
    bl      robosync_work_instead
    b       1b
    .pool
#endif
    .size   robosync_become_idle, . - robosync_become_idle
