/* SPDX-License-Identifier: Apache-2.0
 *
 * HEALS: after any history of faults that explore.pml lets happen, nothing fails any more. No message is lost, doubled or
 * later than a tick, who is not there stays away or starts anew, and nobody else's program ends. From then on the nodes go by their
 * timers: each does once in a tick, at any time of it, what on_timeout() and on_status() would, and the next
 * tick comes when all have and everybody has heard what was said. So no fairness is assumed, and
 *   - a run without end in which something is left to do is an acceptance cycle (Clock),
 *   - one that stands still before all is done, an end state that is none,
 *   - one that asks on and on, a round beyond ROUNDS_END.
 * None of these: every task is done, and its leader knows.
 */
#ifndef WORK                             /* ticks from its lease to the begin of a task, and from there to its end: */
#define WORK (LEASE + 1)                 /* longer than a lease that is not renewed */
#endif
#ifndef WAIT_FOR_AWARD                   /* bidding_until_, in ticks */
#define WAIT_FOR_AWARD 2
#endif

byte acted;                              /* the nodes that have had their turn in this tick */
bool later[C];                           /* what state c waits for is not due with the leader's next turn */
byte waited[V];                          /* turns since its bid, or its lease */

/* Of a message in the air after healing: who has still to hear it. Who has nothing to do with it is left out. */
#define HEARERS 23
#define HAS_TO_HEAR(v, n) (((air_p[n] >> (HEARERS + v)) & 1) != 0)
#define IS_FOR_LEADERS(k) ((k) == BID || (k) == CONFIRMATION || (k) == STATUS || (k) == ALLEGIANCE)
hidden byte h, again, living, turn;

/* Of the message new_*, which has none yet. */
inline choose_hearers() {
  if
  :: healed ->
    living = 0;
    for (h : 0 .. V - 1) {
      if
      :: alive[h] && (!IS_FOR_LEADERS(new_p & 15) || LEADS_ANY(h)) -> living = living | ONLY(h)
      :: else
      fi
    };
    new_p = (living == 0 -> 0 : new_p | (living << HEARERS));
    assert(air_p[K - 1] == 0)            /* else it would be lost */
  :: else
  fi
}

/* v hears message n, and the next time somebody else does. */
inline take(v, n) {
  load(n);
  new_p = air_p[n] & ~(1 << (HEARERS + v)); new_q = air_q[n]; new_s = air_s[n]; new_u = air_u[n];
  vanish(n);
  new_p = ((new_p >> HEARERS) == 0 -> 0 : new_p);
  put_in_air();
  handle(v, true)
}

inline restart_wait(v) { waited[v] = 0 }
inline check_rounds(c) { assert(round[c] <= ROUNDS_END) }

/* A leader that announces what is done here has not heard of it. */
inline tell_done(v) {
  if
  :: healed && !begun[v] && (finished[v] & m_a) != 0 ->
    o_k = STATUS; o_c = m_c; o_r = m_r; o_v = v; o_x = S_DONE;
    o_t = ((finished[v] & m_a & 1) != 0 -> 0 : 1);
    reply()
  :: else
  fi
}

/* ---- what is due with a turn ---- */

inline flies(v) {
  waited[v]++;
  if
  :: !begun[v] && waited[v] >= WORK ->
    begun[v] = true; waited[v] = 0;
    say_begun(v)
  :: begun[v] && waited[v] >= WORK -> finish(v, S_DONE)
  :: begun[v] && waited[v] < WORK && ownership[E(pc[v] - 1, lt[v] - 1)] == LEASED && owner[E(pc[v] - 1, lt[v] - 1)] == v &&
     !started[E(pc[v] - 1, lt[v] - 1)] -> say_begun(v)
  :: else
  fi
}
inline say_begun(v) {
  o_k = STATUS; o_c = pc[v] - 1; o_r = pr[v]; o_v = v; o_t = lt[v] - 1; o_x = S_STARTED;
  reply()
}

inline member_turn(v) {
  if
  :: RAN_OUT(v) -> expire(v); waited[v] = 0
  :: !RAN_OUT(v) && pst[v] == BIDDING ->
    if
    :: waited[v] >= WAIT_FOR_AWARD -> leave(v)
    :: else -> waited[v]++
    fi
  :: !RAN_OUT(v) && pst[v] == MEMBER && lt[v] != 0 -> flies(v)
  :: else
  fi;
  waited[v] = (pst[v] == FREE -> 0 : waited[v])
}

/* Who holds a lease says so every second: of it a leader hears. */
#define IS_HEARD(c, v) (alive[v] && pc[v] == c + 1 && lt[v] != 0)
inline heartbeat_turn(c) {
  renewable(c);
  m_a = au;
  for (h : 0 .. V - 1) {
    if
    :: IN(m_a, h) && !IS_HEARD(c, h) -> m_a = m_a & ~ONLY(h)
    :: else
    fi
  };
  if
  :: m_a != 0 -> renew(c, m_a)
  :: else
  fi
}

inline ends_in_vain(c) { not_formed(c); cancel(c) }

/* The round's plan gives task t to b; where nobody has bid, there is none. */
inline close_bids(c, t, b) {
  tasks_that_are(c, OPEN);
  turn = au;
  authority(c);
  if
  :: turn == 0 || bids[c] == 0 || au < NOW(leader[c] - 1) + FIRST -> ends_in_vain(c)
  :: else -> award(c, t, b)
  fi
}

inline leader_turn(c, t, b) {
  for (h : 0 .. T - 1) {
    if
    :: HAS_EXPIRED(c, E(c, h)) -> expire_entry(c, h)
    :: else
    fi
  };
  finish_if_done(c);
  if
  :: state[c] != CLOSED -> heartbeat_turn(c)
  :: else
  fi;
  if
  :: state[c] == ANNOUNCING && later[c] -> say_announcement(c)
  :: state[c] == ANNOUNCING && !later[c] -> close_bids(c, t, b)
  :: state[c] == AWARDING && !later[c] -> ends_in_vain(c)
  :: (state[c] == MONITORING || state[c] == EXECUTING) && !later[c] -> try_again(c)
  :: else
  fi;
  later[c] = false
}

/* Its planner has the choice of all who have bid. */
#define HAS_A_CHOICE(v) (LEADS(v, 0) && state[0] == ANNOUNCING && !later[0] && bids[0] != 0)
inline take_turn(v, t, b) {
  member_turn(v);
  if
  :: LEADS(v, 0) -> leader_turn(0, t, b)
  :: else
  fi;
  acted = acted | ONLY(v)
}

#define IS_OVER (really_done[0] && state[0] == CLOSED)
#define HAS_ACTED(v) (!alive[v] || IN(acted, v))
#define HAS_TURN(v) (alive[v] && !IN(acted, v))

/* What the vehicles in `hasty` (V: the leaders) wait for is due; others have just begun to wait. Of those that are not there,
 * those in `back` start anew. */
hidden byte hasty, back;
inline heal() {
  tick();
  healed = true;
  for (h : 0 .. V - 1) {
    if
    :: IN(back, h) && !alive[h] -> restart(h)
    :: else
    fi;
    waited[h] = (IN(hasty, h) && pst[h] != FREE -> 10 : 0)
  };
  for (h : 0 .. C - 1) { later[h] = !IN(hasty, V) };
  turn = 0;
  for (h : 0 .. HELD - 1) { turn = turn + (air_p[h] != 0) };
  for (again : 1 .. HELD) {
    if
    :: again <= turn ->
      new_p = air_p[turn - 1]; new_q = air_q[turn - 1]; new_s = air_s[turn - 1]; new_u = air_u[turn - 1];
      vanish(turn - 1);
      choose_hearers();
      put_in_air()
    :: else
    fi
  }
}
#define ALL_BACK ((alive[0] -> 0 : 1) | (alive[1] -> 0 : 2) | (alive[2] -> 0 : 4))
#define HEALS_NOW \
  :: atomic { \
      select (hasty : 0 .. 2 * ONLY(V) - 1); \
      back = ALL_BACK; \
      if :: back = 0 :: back != 0 fi; \
      d_step { heal(); skip } }

#define HEARS(n) :: d_step { HAS_TO_HEAR(v, n) -> take(v, n); skip }
#define CHOOSES(t, b) :: d_step { HAS_TURN(v) && HAS_A_CHOICE(v) && IN(bids[0], b) -> take_turn(v, t, b); skip }

proctype Healed(byte v) provided (healed && !IS_OVER) {
end_healed:
  do
  HEARS(0) HEARS(1) HEARS(2) HEARS(3) HEARS(4) HEARS(5) HEARS(6) HEARS(7) HEARS(8) HEARS(9)
  :: d_step { HAS_TURN(v) && !HAS_A_CHOICE(v) -> take_turn(v, 0, 0); skip }
  CHOOSES(0, 0) CHOOSES(0, 1) CHOOSES(0, 2)
  od
}

proctype Clock() {
  healed;
accept_unfinished:
  do
  :: d_step { !IS_OVER && air_p[0] == 0 && HAS_ACTED(0) && HAS_ACTED(1) && HAS_ACTED(2) -> tick(); acted = 0; skip }
  :: IS_OVER -> break
  od
}
