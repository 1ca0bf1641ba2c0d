/* Transfer, activation, trial and what outlasts a reset (docs/link.md; server.cpp, keeper.cpp, program_store.cpp), for spin to try in
   every order: two hosts with a program each, whose frames are lost and doubled, and the power that goes between any two steps of the
   board, faults of a program in its trial, and rollbacks.

   A program is its number, an image two parts that have one. A write to the store takes two steps: what is written is torn between
   them. What RAM holds is lost with the power.

   What is found: an image that runs and is not whole; a host that is told that its program runs while another one does; a robot
   that had a program and starts with none, or with one that it neither kept nor was about to keep; a program that is
   kept although it has faulted in its trial; a board that can do nothing any more.

   With a MUTANT_… defined the model has a mistake, which must be found: check_model.py tries all. */

#define HOSTS   2
#define NONE    0
#define TORN    9
#define UPLOADS 2     /* of each host */
#define CUTS    2

/* The store. Record r counts if it is whole and has the higher number. */
byte slot[2];
byte number[2], kept_of[2], previous_of[2];
bit slot_of[2];

/* The board. */
bool up = false;
byte running = NONE;
byte kept = NONE, previous = NONE, count = 0;
bit at = 0;                 /* slot of the kept one */
bool faulted = false;       /* the running program, in its trial */
byte session = NONE;
byte room[2];               /* what has been received … */
byte announced = NONE, parts = 0;

/* The books. */
byte committed = NONE, committing = NONE;
bool failed_here[4];        /* has faulted in its last trial */
byte cuts = 0;
bool wish = false;          /* a rollback is asked for */

/* --- hosts: what the board does with a request, it does in one piece --- */

inline receive(host, part) {
  if
  :: session == host && announced != NONE && parts == part -> room[part] = host; parts = part + 1
  :: else
  fi
}

inline activate(host, told) {
  told = false;
  if
#ifdef MUTANT_ACTIVATE_NAMES_NOTHING
  :: announced != NONE && parts == 2 -> running = announced; told = true; faulted = false; failed_here[announced] = false; parts = 0; announced = NONE
#else
  :: session == host && announced == host && parts == 2 ->
     if
#ifdef MUTANT_NAME_NOT_OF_THE_BYTES
     :: true ->
#else
     :: room[0] == host && room[1] == host ->
#endif
        assert(room[0] == room[1]);
        running = host; told = true; faulted = false; failed_here[host] = false
     :: else
     fi;
     parts = 0; announced = NONE
#endif
  :: else
  fi;
  assert(!told || running == host)
}

proctype host(byte me) {
  byte uploads = 0;
  bool told;
end:
  do
  :: uploads < UPLOADS ->
     uploads++;
     do                                 /* frames, in any number: lost and doubled */
     :: atomic { up -> session = me }
     :: atomic { up -> if :: session == me -> announced = me; parts = 0 :: else fi }
     :: atomic { up -> receive(me, 0) }
     :: atomic { up -> receive(me, 1) }
     :: atomic { up -> activate(me, told); told = false; break }
     :: break                           /* gone away */
     od
  od
}

/* --- the keeper --- */

inline read_records() {
  count = 0; kept = NONE; previous = NONE;
  if :: number[0] > number[1] -> count = number[0]; kept = kept_of[0]; previous = previous_of[0]; at = slot_of[0]
     :: number[1] > number[0] -> count = number[1]; kept = kept_of[1]; previous = previous_of[1]; at = slot_of[1]
     :: else
  fi
}

inline start_kept() {
  if
  :: slot[at] == kept -> running = kept
  :: slot[at] != kept && slot[1 - at] == previous -> running = previous
  :: else -> running = NONE
  fi;
  assert(running != TORN)
}

/* The record that counts less is written; what is torn has number 0. */
#ifdef MUTANT_RECORD_OVER_THE_NEWEST
#define PLACE 0
#else
#define PLACE ((count + 1) % 2)
#endif
inline commit(new, old, where) {
  atomic { committing = new; number[PLACE] = 0 };
  atomic {
    kept_of[PLACE] = new; previous_of[PLACE] = old; slot_of[PLACE] = where; number[PLACE] = count + 1;
    previous = old; kept = new; at = where; count = count + 1;
    assert(!failed_here[new]);
    committed = new; committing = NONE
  }
}

#ifdef MUTANT_IMAGE_OVER_THE_KEPT
#define FREE at
#else
#define FREE (1 - at)
#endif

inline write_image() {
  if :: previous != NONE -> commit(kept, NONE, at) :: else fi;
  atomic { mine = running; slot[FREE] = TORN };
  atomic { slot[FREE] = mine }
}

proctype board() {
  byte mine;
end:
  do
  :: atomic {
         up = true;
         session = NONE; announced = NONE; parts = 0; running = NONE; faulted = false; wish = false;
         read_records();
         if :: kept != NONE -> start_kept() :: else fi;
         assert(committed == NONE || running == committed || (committing != NONE && running == committing));
         if :: running != NONE && running == committing -> committed = running :: else fi;
         committing = NONE
     };
     {
endserving:
       do
       :: running != NONE && running != kept && !faulted && count < 6 ->
#ifdef MUTANT_RECORD_BEFORE_THE_IMAGE
          mine = running;
          commit(mine, kept, FREE);
          write_image()
#else
          write_image();
          if                            /* the trial is over; another program may run by now */
          :: atomic { running == mine && !faulted } -> commit(mine, kept, FREE)
          :: else
          fi
#endif
       :: atomic { running != NONE && running != kept && !faulted -> faulted = true; failed_here[running] = true }
       :: atomic { faulted && running != kept && kept != NONE -> faulted = false; start_kept() }
       :: atomic { faulted && kept == NONE -> failed_here[running] = false; running = NONE; faulted = false }
       :: atomic { running != NONE && running == kept && previous != NONE && count < 6 && !wish -> wish = true };
          if
          :: slot[1 - at] == previous ->
             atomic { mine = previous; running = mine; failed_here[running] = false };
             commit(mine, kept, (1 - at))
          :: else
          fi
       od
     } unless { !up }
  od
}

proctype power() {
end:
  do
  :: atomic { up && cuts < CUTS -> cuts++; up = false }
  od
}

init {
  atomic { run board(); run host(1); run host(2); run power() }
}
