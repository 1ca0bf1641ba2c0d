/* The protocol of switching and waking (docs/kernel.md, "Waiting and waking"; kernel.hpp, kernel.cpp,
   mutex.cpp), for spin to try in every order: three threads, the idle thread, interrupts that come
   between any two steps and signal any of them, and the tick, which comes between those of threads.
   Rank 0 waits; 1 waits, with and without a deadline, and then takes a mutex whose ceiling it is; 2
   signals the others, with and without that mutex, and waits.

   A step is what one instruction does that others can see. The ready set stands in two words, which
   select_next() reads one after the other: rank 0 in the first, 1 and 2 in the second. (The M4 reads them by one
   instruction, which an interrupt may break off, so that it is one after the other for it, too.)

   What is found: an event that was signalled and is gone, or is there while its thread is blocked on
   it (a lost wake-up); a thread that is blocked until a deadline for which no timer stands, or for good, for which an
   old timer still stands; a timer put in that is in, or taken out that is out; a thread that runs while one that
   outranks it is ready; a mutex that is taken while it is held; a holder overtaken at or below the ceiling (priority
   inversion).

   With a MUTANT_… defined the model has a mistake, which must be found: check_model.py tries all. */

#define THREADS 3
#define IDLE    3   /* what an empty ready set selects */
#define NONE    9   /* kNoneRuns */
#define CEILING 1
#define FREE    9

#define A 1   /* events: A from threads, B from interrupts */
#define B 2

byte events[THREADS], wanted[THREADS];
byte ghost[THREADS];          /* signalled and not yet taken, by a book that no race can spoil */
bool ready[THREADS];
byte running = IDLE, running_rank = IDLE;
byte owner = FREE;            /* of the mutex; held_ */
bool masked = false;          /* BASEPRI: a Lock */
bool still = false;           /* … or a SwitchLock */
bool ticking = false;         /* SysTick is active */
bool armed = false;           /* the timer of thread 1 */
bool struck = false;          /* … has been due */
bool timed = false;           /* it is blocked until then */
bool pending = true;          /* PendSV */
bool switching = false;       /* PendSV is active */
bool slack = false;           /* the core has finished one instruction more than it should */

hidden byte best;             /* of check_running */

inline first_of_all(rank) {
  if
  :: ready[0] -> rank = 0
  :: !ready[0] && ready[1] -> rank = 1
  :: !ready[0] && !ready[1] && ready[2] -> rank = 2
  :: else -> rank = IDLE
  fi
}

/* What must hold whenever a thread takes a step, the lock is free and no switch is on its way. */
inline check_running() {

  first_of_all(best);
  if
  :: owner != FREE && best >= CEILING -> best = owner
  :: else
  fi;
  assert(running == best);
  best = 0
}

/* … and whenever the lock is free. */
#define NONE_LOST(thread) \
  ((ghost[thread] & ~events[thread]) == 0 && (ready[thread] || (events[thread] & wanted[thread]) == 0))
inline check_events() {
  assert(NONE_LOST(0) && NONE_LOST(1) && NONE_LOST(2));
  assert(ready[1] || !timed || armed);
  assert(ready[1] || timed || !armed)
}

#define NO_SWITCH (masked || still)
#define MAY_RUN(me) (running == me && !switching && !ticking && (!pending || NO_SWITCH || !slack))

/* One step of thread `me`. */
#define STEP(me, what)                                                        \
  atomic {                                                                    \
    MAY_RUN(me) ->                                                            \
    if :: pending && !NO_SWITCH -> slack = true :: else fi;                   \
    if :: !pending && !masked -> check_running() :: else fi;                  \
    if :: !masked -> check_events() :: else fi;                               \
    what                                                                      \
  }

inline make_ready(thread) {
  if :: thread < running_rank -> pending = true :: else fi;
  ready[thread] = true
}

/* Kernel::signal() from an interrupt: nothing comes in between. */
proctype interrupt() {
  byte to;
  do
  :: atomic {
       !masked ->
       if :: to = 0 :: to = 1 :: to = 2 fi;
       events[to] = events[to] | B;
       ghost[to] = ghost[to] | B;
       if
       :: (events[to] & wanted[to]) != 0 -> make_ready(to)
       :: else
       fi;
       to = 0
     }
  od
}

/* PendSV: Kernel::select_next(), with interrupts in between. */
proctype switch_threads() {
  byte rank;
  bool none;
end:
  do
  :: atomic { pending && !NO_SWITCH && !switching && !ticking -> pending = false; slack = false; switching = true };
     atomic { none = !ready[0]; rank = 0 };                   /* first word */
     if
     :: none -> atomic { if :: ready[1] -> rank = 1           /* the others */
                             :: !ready[1] && ready[2] -> rank = 2
                             :: else -> rank = IDLE fi }
     :: else
     fi;
#ifndef MUTANT_CEILING_IGNORED
     if
     :: owner != FREE && rank >= CEILING -> atomic { running_rank = CEILING; running = owner }
     :: else ->
#endif
        running_rank = rank;
        running = rank
#ifndef MUTANT_CEILING_IGNORED
     fi
#endif
     ;
     atomic { switching = false; none = false; rank = 0 }
  od
}

/* SysTick: Kernel::on_tick(), with interrupts in between; some time after the timer was armed. */
proctype tick() {
  bool other;
end:
  do
  :: atomic { armed && !NO_SWITCH && !switching -> ticking = true; armed = false; struck = true };
#ifdef MUTANT_TICK_WITHOUT_LOCK
     other = ready[2];                                        /* one word */
     atomic { if :: 1 < running_rank -> pending = true :: else fi };
     atomic { ready[1] = true; ready[2] = other; other = false };
#else
     masked = true;
     atomic { if :: 1 < running_rank -> pending = true :: else fi };
     ready[1] = true;
     masked = false;
#endif
     ticking = false
  od
}

#ifdef MUTANT_LOOK_OUTSIDE_THE_LOCK
#define LOCK_BEFORE_LOOK(me)
#define LOCK_AFTER_LOOK(me)  STEP(me, masked = true)
#else
#define LOCK_BEFORE_LOOK(me) STEP(me, masked = true)
#define LOCK_AFTER_LOOK(me)
#endif

/* Kernel::block() */
inline block(me) {
  STEP(me, wanted[me] = A | B);
  STEP(me, ready[me] = false);
#ifndef MUTANT_RUNNING_RANK_KEPT
  STEP(me, running_rank = NONE);
#endif
  STEP(me, pending = true)
}

/* Thread::take(): LDREX … STREX, which starts over when an interrupt came in between. */
inline take(me) {
#ifdef MUTANT_TAKEN_IN_TWO_STEPS
  STEP(me, taken = events[me]; ghost[me] = ghost[me] & ~taken);
  STEP(me, events[me] = 0)
#else
  STEP(me, taken = events[me]; ghost[me] = ghost[me] & ~taken; events[me] = 0)
#endif
}

inline take_back(me) {
  STEP(me, there = armed);
  if
  :: there -> STEP(me, assert(armed); armed = false)
  :: else
  fi
}

/* A timer that still stands: an event had come before. */
inline disarm(me) {
#ifndef MUTANT_TICK_IN_DISARM
  STEP(me, still = true);
#endif
  take_back(me);
  STEP(me, still = false)
}
/* Kernel::wait(A | B), without a deadline. */
inline wait(me) {
  taken = 0;
#ifndef MUTANT_OLD_TIMER_KEPT
  if
  :: me == 1 -> disarm(me)
  :: else
  fi;
#endif
  do
  :: taken == 0 ->
     LOCK_BEFORE_LOOK(me);
     STEP(me, there = ((events[me] & (A | B)) != 0));
     LOCK_AFTER_LOOK(me);
     if
     :: !there -> block(me)
     :: else
     fi;
     STEP(me, masked = false);
     take(me)
  :: else -> break
  od
}

/* … with one, until it is reached. Thread 1's: there is one timer. */
inline wait_until(me) {
  taken = 0;
  reached = false;
  STEP(me, struck = false);  /* by an old one */
  do
  :: taken == 0 && !reached ->
     STEP(me, there = ((events[me] & (A | B)) != 0));
     if
     :: !there ->
        STEP(me, still = true);
#ifndef MUTANT_ARMED_TWICE
        take_back(me);
#endif
        STEP(me, there = struck; assert(!armed); struck = false; armed = !there; reached = true);
#ifdef MUTANT_TICK_BETWEEN_ARM_AND_BLOCK
        STEP(me, still = false);
#endif
        if
        :: !there ->
           STEP(me, masked = true);
#ifndef MUTANT_NO_LOOK_AFTER_ARMING
           STEP(me, there = ((events[me] & (A | B)) != 0));
#endif
           if
           :: !there ->
              STEP(me, timed = true);
              block(me)
           :: else
           fi;
           STEP(me, masked = false)
        :: else
        fi;
        STEP(me, still = false)
     :: else
     fi;
     take(me);
     STEP(me, timed = false);
     STEP(me, reached = reached && !armed; struck = struck && !reached)
  :: else -> break
  od;
  reached = false
}

/* Kernel::signal() from a thread. */
inline signal(me, to) {
  STEP(me, masked = true);
  STEP(me, events[to] = events[to] | A; ghost[to] = ghost[to] | A);
  if
  :: (events[to] & wanted[to]) != 0 ->
#ifndef MUTANT_SWITCH_NOT_ASKED_FOR
     STEP(me, if :: to < running_rank -> pending = true :: else fi);
#endif
#ifdef MUTANT_READY_OUTSIDE_THE_LOCK
     STEP(me, masked = false);
#endif
     STEP(me, ready[to] = true)
  :: else
  fi;
  STEP(me, masked = false)
}

inline acquire(me) {
  STEP(me, masked = true);   /* against a change of ranks, which is not modelled */
  STEP(me, assert(owner == FREE); owner = me);
  STEP(me, running_rank = CEILING);
  STEP(me, masked = false)
}

inline release(me) {
  STEP(me, masked = true);
  STEP(me, assert(owner == me); owner = FREE);
#ifdef MUTANT_RELEASE_LOOKS_TOO_EARLY
  STEP(me, masked = false);
  STEP(me, if :: ready[0] || (me == 2 && ready[1]) -> pending = true :: else fi);
  STEP(me, running_rank = me)
#else
  STEP(me, running_rank = me);
#ifndef MUTANT_RELEASE_DOES_NOT_LOOK
  STEP(me, if :: ready[0] || (me == 2 && ready[1]) -> pending = true :: else fi);
#endif
  STEP(me, masked = false)
#endif
}

proctype high() {
  byte taken;
  bool there;
  do
  :: wait(0)
  od
}

/* A user of the mutex. */
proctype middle() {
  byte taken;
  bool there, reached;
  do
  :: if :: wait(1) :: wait_until(1) fi;
     acquire(1);
     release(1)
  od
}

/* The lowest user of the mutex. Goes on signalling, with and without it. */
proctype low() {
  byte taken;
  bool there;
  do
  :: wait(2)
  :: signal(2, 0)
  :: signal(2, 1)
  :: acquire(2);
     if :: signal(2, 0) :: signal(2, 1) :: true fi;
     release(2)
  od
}

proctype idle() {
  do
  :: STEP(IDLE, skip)
  od
}

init {
  atomic {
    ready[0] = true; ready[1] = true; ready[2] = true;
    run interrupt(); run switch_threads(); run tick(); run high(); run middle(); run low(); run idle()
  }
}
