/* SPDX-License-Identifier: Apache-2.0
 *
 * HEALS: after any history of faults that explore.pml lets happen, nothing fails any more. No message is
 * lost, doubled or later than a tick, who is not there stays away or starts anew, and nobody else's program
 * ends. From then on the nodes go by their timers: each does once in a tick what its on_timeout() would, and the next tick comes when all have and everybody has heard what was said. So no fairness is assumed, and
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
byte waited[V];                          /* turns since its bid, its lease, or that its leader is lost */
byte left_over[C];                       /* tasks that were open at the award: not asked for while it is flown */
#if C > 1
#ifndef CUT                              /* cut_max, in ticks: longer than any lease and succession */
#define CUT (2 * LEASE + 2 * SILENCE + 2)
#endif
#define SUCCESSION (2 * SILENCE + GUARD)
#define STAGGER 2                        /* between the first claims of two electors, and two that relieve */
byte silent[V];                          /* turns since its promise was over */
byte unheard[V];                         /* turns since it heard that somebody leads the site */
byte alone[C];                           /* turns since its leader had authority last */
byte site_over[V];                       /* what it knows to be done there */
#endif

/* Of a message in the air after healing: who has still to hear it. Who has nothing to do with it is left out. */
#define HEARERS 23
#define HAS_TO_HEAR(v, n) (((air_p[n] >> (HEARERS + v)) & 1) != 0)
#define IS_FOR_LEADERS(k) ((k) == BID || (k) == CONFIRMATION || (k) == STATUS || (k) == ALLEGIANCE)
#define o_kind (new_p & 15)
#if C > 1                                /* claimants count who follows them, and what is done is known to all */
#define TELLS_OTHERS(v) ((o_kind == ALLEGIANCE && fol[v] == v + 1) || (o_kind == STATUS && ((new_p >> 12) & 7) == S_DONE))
#else
#define TELLS_OTHERS(v) false
#endif


/* Of the message new_*, which has none yet. */
inline choose_hearers() {
  if
  :: healed ->
    living = 0;
    for (h : 0 .. V - 1) {
      if
      :: alive[h] && (!IS_FOR_LEADERS(o_kind) || LEADS_ANY(h) || TELLS_OTHERS(h)) -> living = living | ONLY(h)
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
  put_in_air()
}

inline restart_wait(v) { waited[v] = 0 }
inline check_rounds(c) { assert(round[c] <= ROUNDS_END) }

/* A leader that announces what is done here has not heard of it. */
inline tell_done(v) {
  if
#ifdef MUTANT_DONE_IS_TOLD_ONCE
  :: false ->
#else
  :: healed && !begun[v] && (finished[v] & m_a) != 0 ->
#endif
    o_k = STATUS; o_c = m_c; o_r = m_r; o_v = v; o_x = S_DONE;
    o_t = ((finished[v] & m_a & 1) != 0 -> 0 : 1);
    reply()
  :: else
  fi
}

/* One coalition at a time. */
inline what_it_leads(v) {
  led = C;
  for (again : 0 .. C - 1) { led = (LEADS(v, again) -> again : led) }
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
#ifndef MUTANT_BIDDERS_WAIT_ON           /* for an award that was lost */
    :: waited[v] >= WAIT_FOR_AWARD -> leave(v)
#endif
    :: else -> waited[v] = (waited[v] < 10 -> waited[v] + 1 : 10)
    fi
  :: !RAN_OUT(v) && pst[v] == MEMBER && lt[v] != 0 -> flies(v)
#if C > 1
  :: pst[v] == ORPHANED ->
    if
    :: waited[v] >= SUCCESSION -> no_successor(v)
    :: else -> waited[v]++
    fi
#endif
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
#ifdef MUTANT_SILENT_ARE_RENEWED         /* of whom nothing is heard keeps its lease */
  m_a = au;
#endif
#ifdef MUTANT_NOT_RENEWED                /* the lease of the award must do */
  m_a = 0;
#endif
  if
  :: m_a != 0 || C > 1 -> renew(c, m_a)
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
  :: else ->
    award(c, t, b);
    left_over[c] = turn & ~ONLY(t)
  fi
}

/* An open task waits where others are flown that were awarded in its stead. */
inline asks_again(c) {
  tasks_that_are(c, LEASED);
  turn = (au != 0 -> left_over[c] : 0);
  tasks_that_are(c, OPEN);
  if
  :: state[c] == EXECUTING && (au & ~turn) == 0 -> skip
  :: else -> try_again(c)
  fi
}

inline leader_looks(c) {
#ifndef MUTANT_LEASES_NEVER_END          /* who is lost keeps its task */
  for (h : 0 .. T - 1) {
    if
    :: HAS_EXPIRED(c, E(c, h)) -> expire_entry(c, h)
    :: else
    fi
  };
#endif
#ifndef MUTANT_END_NOT_LOOKED_FOR        /* done while its award was answered: nobody says so again */
  finish_if_done(c);
#endif
#if C > 1
  authority(c);
  if
  :: state[c] != CLOSED && !HAS_AUTHORITY(c) ->
    alone[c]++;
    if
#ifdef MUTANT_WAITS_FOR_ITS_ELECTORS     /* for ever, although they have started anew */
    :: alone[c] >= CUT -> alone[c] = 0
#else
    :: alone[c] >= CUT -> electors[c] = 0; promised[c] = EVER; alone[c] = 0
#endif
    :: else
    fi
  :: else -> alone[c] = 0
  fi;
#endif
  skip
}
inline leader_turn(c, t, b) {
  if
  :: state[c] != CLOSED -> heartbeat_turn(c)
  :: else
  fi;
  if
  :: state[c] == ANNOUNCING && later[c] -> say_announcement(c)
  :: state[c] == ANNOUNCING && !later[c] -> close_bids(c, t, b)
  :: state[c] == AWARDING && !later[c] -> ends_in_vain(c)
#ifdef MUTANT_ASKS_ONCE                  /* a round in vain is not followed by another */
  :: state[c] == EXECUTING && !later[c] -> asks_again(c)
#else
  :: (state[c] == MONITORING || state[c] == EXECUTING) && !later[c] -> asks_again(c)
#endif
  :: state[c] == CLOSED -> left_over[c] = 0
  :: else
  fi;
  later[c] = false
}

#if C > 1
/* One site is led once: who leads it hears somebody else who does (Initiator::on_rival). */
inline meet_rival(c) {
  authority(c);
  turn = (electors[c] != 0 && HAS_AUTHORITY(c));
  ok = m_k == AWARD || (m_k == RENEWAL && m_b != 0 && m_u > m_s);
  if
  :: (turn == ok && (leader[c] < leader[m_c] || (leader[c] == leader[m_c] && c < m_c))) || (turn != ok && turn) -> skip
  :: else ->
    for (h_ : 0 .. T - 1) {
      if
      :: ownership[E(c, h_)] == DONE -> o_k = STATUS; o_c = m_c; o_r = m_r; o_v = leader[c] - 1; o_t = h_; o_x = S_DONE; reply()
      :: else
      fi
    };
    give_up(c)
  fi
}
hidden byte h_, rank, slot;
#define IS_OF_LEADER(k) ((k) == ANNOUNCEMENT || (k) == AWARD || (k) == RENEWAL)
inline note_heard(v) {
  if
  :: IS_OF_LEADER(m_k) ->
    unheard[v] = 0;
    site_over[v] = site_over[v] | (m_k == RENEWAL -> m_d : 0);
    what_it_leads(v);
    if
    :: led < C && led != m_c -> meet_rival(led)
    :: else
    fi
  :: m_k == STATUS && m_x == S_DONE -> site_over[v] = site_over[v] | ONLY(m_t)
  :: else
  fi
}

/* A coalition that there was not yet. */
inline next_coalition() {
  slot = 0;
  do
  :: slot < C - 1 && leader[slot] != 0 -> slot++
  :: else -> break
  od;
  assert(leader[slot] == 0)              /* that is: they do not found one after the other without end */
}

inline elector_turn(v) {
  if
  :: elec[v] && !LEADS_ANY(v) && fol[v] == v + 1 ->
    has_won(v);
    if
    :: ok ->
      next_coalition();
      m_n = pln[v];
      has_won(v);
      take_over(slot, v);
      m_u = (best + LEASE < NOW(v) + FIRST -> best + LEASE : NOW(v) + FIRST);
      send_award(slot);
      o_k = AWARD; o_c = slot; o_r = 1; o_w = m_w; o_s = NOW(v); o_u = UNTIL(0, m_u); o_n = m_n;
      reply()
    :: else -> claim(v)
    fi
  :: elec[v] && !LEADS_ANY(v) && fol[v] != v + 1 && PROMISE_OVER(v) ->
    rank = 0;
    for (h : 0 .. V - 1) {
      if
      :: h < v && IN(els[v], h) && h + 1 != leader[pln[v] - 1] -> rank++
      :: else
      fi
    };
    if
    :: silent[v] >= STAGGER * rank -> claim(v); silent[v] = 0
    :: else -> silent[v]++
    fi
  :: else -> silent[v] = 0
  fi
}

/* Nobody was heard to lead the site: who has nothing else to do does. Who has forgotten it finds it anew. */
inline relief_turn(v) {
  if
  :: LEADS_ANY(v) -> unheard[v] = 0
  :: !LEADS_ANY(v) && unheard[v] < CUT + STAGGER * v -> unheard[v]++
#ifdef MUTANT_NO_RELIEF                  /* a site whose leader is lost, and its successor, is nobody's */
  :: false ->
#else
  :: !LEADS_ANY(v) && unheard[v] >= CUT + STAGGER * v && pst[v] == FREE ->
#endif
    next_coalition();
    lead(slot, v, site_over[v]);
    unheard[v] = 0;
    say_announcement(slot)
  :: else
  fi
}
#else
inline note_heard(v) { skip }
#endif

#define IS_AT_WORK(c) (leader[c] != 0 && alive[leader[c] - 1] && state[c] != NONE && state[c] != CLOSED)
#if T == 1
#define ALL_DONE really_done[0]
#else
#define ALL_DONE (really_done[0] && really_done[1])
#endif
#if C == 1
#define IS_OVER (ALL_DONE && !IS_AT_WORK(0))
#else
#define IS_OVER (ALL_DONE && !IS_AT_WORK(0) && !IS_AT_WORK(1) && !IS_AT_WORK(2) && !IS_AT_WORK(C - 1))
#endif
/* Its planner has the choice of all who have bid, and of all that is open. */
#define CHOOSES(v, c) (LEADS(v, c) && state[c] == ANNOUNCING && !later[c] && bids[c] != 0)
#define PLAN(c, t, b) :: CHOOSES(v, c) && IN(bids[c], b) && (ownership[E(c, t)] == OPEN || T == 1) -> task = t; bidder = b
#define PLANS(c, t) PLAN(c, t, 0) PLAN(c, t, 1) PLAN(c, t, 2)
#if T == 1
#define PLANS_OF(c) PLANS(c, 0)
#else
#define PLANS_OF(c) PLANS(c, 0) PLANS(c, 1)
#endif
hidden byte task, bidder;
#define HAS_ACTED(v) (!alive[v] || IN(acted, v))
#define HAS_TURN(v) (!IS_OVER && alive[v] && !IN(acted, v))

/* What the vehicles in `hasty` (V: the leaders) wait for is due; others have just begun to wait. Of those that are not there,
 * those in `back` start anew. */
hidden byte hasty, back;
inline heal() {
  tick();
  healed = true;
#ifdef FAULT_TICKS
  faulted = 0;
#endif
  for (h : 0 .. V - 1) {
    if
    :: IN(back, h) && !alive[h] -> restart(h)
    :: else
    fi;
    waited[h] = (IN(hasty, h) && pst[h] != FREE -> 10 : 0);
#if C > 1
    silent[h] = (IN(hasty, h) -> 10 : 0);
    unheard[h] = (IN(hasty, h) -> 100 : 0)
#endif
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
#ifdef HEARD_TOGETHER                    /* fewer states: what is said is heard by all at once; all are hasty, or nobody */
#define CHOOSE_HASTY if :: hasty = 0 :: hasty = 2 * ONLY(V) - 1 fi
#else
#define CHOOSE_HASTY select (hasty : 0 .. 2 * ONLY(V) - 1)
#endif
#define HEALS_NOW \
  :: atomic { \
      CHOOSE_HASTY; \
      back = ALL_BACK; \
      if :: back = 0 :: back != 0 fi; \
      d_step { heal(); skip } }

#ifdef HEARD_TOGETHER                    /* before the next says something */
#define MAY_SPEAK (air_p[0] == 0)
#else
#define MAY_SPEAK true
#endif
#define HEARS(n) :: atomic { !IS_OVER && HAS_TO_HEAR(v, n) -> d_step { take(v, n); note_heard(v); skip }; d_step { handle(v, true); skip } }

proctype Healed(byte v) provided (healed) {
end_healed:
  do
#ifndef HEARD_TOGETHER
  HEARS(0) HEARS(1) HEARS(2) HEARS(3) HEARS(4) HEARS(5) HEARS(6) HEARS(7)
#if K > 8
  HEARS(8) HEARS(9)
#endif
#endif
  :: atomic {
      HAS_TURN(v) && MAY_SPEAK ->
      if
      PLANS_OF(0)
#if C > 1
      PLANS_OF(1)
#endif
#if C > 2
      PLANS_OF(2)
#endif
#if C > 3
      PLANS_OF(3)
#endif
      :: else -> task = 0; bidder = 0
      fi;
      d_step { member_turn(v); skip };
#if C > 1
      d_step { elector_turn(v); skip };
#endif
      d_step { what_it_leads(v); skip };
      if
      :: led < C ->
        d_step { leader_looks(led); skip };
        d_step { leader_turn(led, task, bidder); skip }
      :: else
      fi;
#if C > 1
      d_step { relief_turn(v); skip };
#endif
      acted = acted | ONLY(v) }
  od
}

#ifdef HEARD_TOGETHER
hidden byte to;
hidden int all_p, all_q, all_s, all_u;
#define PICKS(n) :: !IS_OVER && air_p[n] != 0 -> turn = n
proctype Air() provided (healed) {
end_healed:
  do
  :: atomic {
      if
      PICKS(0) PICKS(1) PICKS(2) PICKS(3) PICKS(4) PICKS(5) PICKS(6) PICKS(7)
#if K > 8
      PICKS(8) PICKS(9)
#endif
      fi;
      d_step {
        all_p = air_p[turn]; all_q = air_q[turn]; all_s = air_s[turn]; all_u = air_u[turn];
        vanish(turn)
      };
      to = 0;
      do
      :: to < V ->
        if
        :: ((all_p >> (HEARERS + to)) & 1) != 0 ->
          d_step { read(all_p, all_q, all_s, all_u); note_heard(to); skip };
          d_step { read(all_p, all_q, all_s, all_u); handle(to, true); skip }
        :: else
        fi;
        to++
      :: else -> break
      od }
  od
}
#endif

proctype Clock() {
  healed;
accept_unfinished:
  do
  :: d_step { !IS_OVER && air_p[0] == 0 && HAS_ACTED(0) && HAS_ACTED(1) && HAS_ACTED(2) -> tick(); acted = 0; skip }
  :: IS_OVER -> break
  od
}
