/* SPDX-License-Identifier: Apache-2.0
 *
 * Whatever may happen to the contract net, within the bounds of one configuration (run.sh): messages are
 * lost, doubled, late and out of order, clocks differ, programs end and start anew. Time is whole
 * ticks, and what lies so far back that it decides nothing any more is one instant, so that there is no
 * last tick and the states are finitely many.
 */
#ifndef AHEAD
#define AHEAD 0
#endif
#ifndef DELIVERIES
#define DELIVERIES 0
#endif
#ifndef SILENCE
#define SILENCE LEASE
#endif
#ifndef CRASHES
#define CRASHES 0
#endif
#define CUT_MAX 100                      /* longer than anything here: nobody is given up for lost */
#define STAMP byte
#define NEVER 0
#define EVER  255
#define CLK   (LEASE + AHEAD + GUARD + 1)   /* now */
#define NOW(v) (CLK + skew[v])
#define OWNERS short
#define COALITIONS byte
#define EXISTS(t) true
#define RUN 1                            /* from gate to delivery */
#if defined(HEALS) && C > 1              /* a cut may have been longer than cut_max: two then lead */
#define BROKEN(what) skip
#else
#define BROKEN(what) assert(false)
#endif
#define PLAN_IS_DUE(v, q) false
/* AUTHORITY: who may lead, and no leases: a coalition of V stands, each with a task that it keeps. Clocks
 * need not agree for it; that leases end by other clocks is the guard in the invariant. */
#ifdef STANDS                            /* it does from the beginning, with a task for each of its members */
#define CLAIMS
#endif
#ifdef AUTHORITY
#define UNTIL(t, u) EVER
#define CLAIMS
#else
#define UNTIL(t, u) (u)
#endif

byte skew[V];
byte crashes = CRASHES;

/* The air: a set of K messages, packed. In it each may be heard by anybody, any number of times, until
 * the network takes it away; there may be no room for another. */
int  air_p[K], air_q[K];
byte air_s[K], air_u[K];
hidden int new_p, new_q, new_s, new_u, old;

/* Of each message: the vehicles that were awarded something after what it is about was sent. Stamps are
 * whole ticks, and at last all the same: they do not tell. */
#define AWARDED_SINCE 19
#define MORE_COALITIONS 26
#define SENT_BEFORE_AWARD(v)    IN(m_e, v)
#define LEFT_BEFORE_AWARD(c, v) IN(m_e, v)

#include "contract_net.pml"

/* HEALS: from some tick on nothing fails any more (healing.pml). */
#ifdef HEALS
bool healed;
#ifdef FAULT_TICKS
byte faulted;                            /* ticks, of as many at most */
#define FAULTS_GO_ON faulted < FAULT_TICKS -> faulted++
#else
#define FAULTS_GO_ON true
#endif
hidden byte h, again, living, turn, led;
#define UNTIL_HEALED provided (!healed)
#define NO_ROOM (!healed && air_p[HELD - 1] != 0)
#else
#define UNTIL_HEALED
#define FAULTS_GO_ON true
#define NO_ROOM (air_p[K - 1] != 0)
#define choose_hearers() skip
#define restart_wait(v) skip
#define tell_done(v) skip
#define check_rounds(c) skip
#endif

inline swap(new, all) { old = all; all = new; new = old }
#define AFTER(n) (new_p > air_p[n] || (new_p == air_p[n] && (new_q > air_q[n] || (new_q == air_q[n] && \
  (new_s > air_s[n] || (new_s == air_s[n] && new_u > air_u[n]))))))
#define SAME(n) (new_p == air_p[n] && new_q == air_q[n] && new_s == air_s[n] && new_u == air_u[n])

inline put_in_air() {
  for (z : 0 .. K - 1) {
    if
    :: SAME(z) -> new_p = 0; new_q = 0; new_s = 0; new_u = 0
    :: !SAME(z) && AFTER(z) ->
      swap(new_p, air_p[z]); swap(new_q, air_q[z]); swap(new_s, air_s[z]); swap(new_u, air_u[z])
    :: else
    fi
  }
}
inline reply() {
  new_p = o_k | ((o_c & 1) << 4) | ((o_c & 2) << MORE_COALITIONS) | (o_r << 5) | (o_v << 8) | (o_t << 10) | (o_x << 12) | (o_i << 15) | (o_n << 17) | (o_e << AWARDED_SINCE);
  new_q = o_a | (o_b << 4) | (o_d << 8) | (o_w << 12);
  new_s = o_s; new_u = o_u;
  choose_hearers();
  if
  :: NO_ROOM -> skip                     /* lost */
  :: else -> put_in_air()
  fi;
  o_k = 0; o_c = 0; o_r = 0; o_v = 0; o_t = 0; o_x = 0; o_i = 0; o_n = 0;
  o_a = 0; o_b = 0; o_d = 0; o_e = 0; o_s = 0; o_u = 0; o_w = 0
}

inline load(n) { read(air_p[n], air_q[n], air_s[n], air_u[n]) }
inline read(p_, q_, s_, u_) {
  m_k = p_ & 15; m_c = ((p_ >> 4) & 1) | ((p_ >> MORE_COALITIONS) & 2); m_r = (p_ >> 5) & 7; m_v = (p_ >> 8) & 3;
  m_t = (p_ >> 10) & 3; m_x = (p_ >> 12) & 7; m_i = (p_ >> 15) & 3; m_n = (p_ >> 17) & 3;
  m_e = (p_ >> AWARDED_SINCE) & 15;
  m_a = q_ & 15; m_b = (q_ >> 4) & 15; m_d = (q_ >> 8) & 15; m_w = (q_ >> 12) & 65535;
  m_s = s_; m_u = u_
}

/* The network takes message n away. */
inline vanish(n) {
  for (z : n .. K - 2) {
    air_p[z] = air_p[z + 1]; air_q[z] = air_q[z + 1]; air_s[z] = air_s[z + 1]; air_u[z] = air_u[z + 1]
  };
  air_p[K - 1] = 0; air_q[K - 1] = 0; air_s[K - 1] = 0; air_u[K - 1] = 0
}

/* Times of the awarded task q, as leader and as its owner see them. */
inline plan_times(c, q) {
  if
  :: IS_DELIVERY(q) -> due[E(c, q)] = NOW(leader[c] - 1) + AHEAD; begins[E(c, q)] = due[E(c, q)] - RUN
  :: else
  fi
}
inline set_out(v) {
  restart_wait(v);
  if
  :: IS_DELIVERY(lt[v] - 1) -> fend[v] = m_s + AHEAD; fgate[v] = fend[v] - RUN
  :: else -> fend[v] = NEVER; fgate[v] = NEVER
  fi
}
inline lease_over(v) { skip }
inline note_plan(v) { skip }
inline note_award(c, v) {
#ifdef REJOINS
  for (old : 0 .. K - 1) {
    if
    :: ((air_p[old] & 15) == RENEWAL && ((air_p[old] >> 4) & 1) == c) ||
       ((air_p[old] & 15) == ALLEGIANCE && ((air_p[old] >> 4) & 1) == c && ((air_p[old] >> 8) & 3) == v) ->
      air_p[old] = air_p[old] | (ONLY(v) << AWARDED_SINCE)
    :: else
    fi
  }
#else
  skip
#endif
}
inline round_begins(c) { check_rounds(c) }

/* What a closed coalition held says nothing any more. */
inline closing(c) {
  for (z : 0 .. T - 1) { forget_entry(E(c, z)); maybe_flown[E(c, z)] = false }
  for (z : 0 .. V - 1) { ack[M(c, z)] = NEVER; elinst[M(c, z)] = 0; binst[M(c, z)] = 0 }
  bids[c] = 0; asked[c] = 0; confirmed[c] = 0; electors[c] = 0; promised[c] = NEVER; majority[c] = 0
}

#define LEADS(v, c) (alive[v] && leader[c] == (v) + 1 && state[c] != NONE && state[c] != CLOSED)
#if C > 2
#define LEADS_ANY(v) (LEADS(v, 0) || LEADS(v, 1) || LEADS(v, 2) || LEADS(v, C - 1))
#else
#define LEADS_ANY(v) (LEADS(v, 0) || LEADS(v, C - 1))
#endif
#if defined(HEALS) && C > 1
#define IS_ENGAGED(v) (LEADS_ANY(v) && !LEADS(v, m_c))
#else
#define IS_ENGAGED(v) false
#endif

/* v is handed message n, which stays in the air. */
inline hear(v, n, willing) {
  load(n);
  handle(v, willing)
}
inline handle(v, willing) {
  if
  :: m_k == ANNOUNCEMENT && MAY_BID(v) && !IS_ENGAGED(v) -> bid(v); restart_wait(v)
  :: m_k == ANNOUNCEMENT && !(MAY_BID(v) && !IS_ENGAGED(v)) -> tell_done(v)
  :: m_k == BID && LEADS(v, m_c) -> on_bid(m_c)
  :: m_k == AWARD ->
    judge_award(v);
    if
    :: best == 1 -> say_confirmation(v)
    :: best == 2 -> leave(v)
    :: best == 3 && willing -> accept(v)
    :: best == 3 && !willing -> refuse(v)
    :: else
    fi
  :: m_k == CONFIRMATION && LEADS(v, m_c) -> on_confirmation(m_c)
  :: m_k == CANCEL -> on_cancel(v)
  :: m_k == RENEWAL -> participant_on_renewal(v)
  :: m_k == STATUS ->
    m_n = m_c + 1;
#ifdef HEALS
    what_it_leads(v);
    if
    :: led < C -> on_status(led)
    :: else
    fi;
#else
    if
    :: LEADS(v, 0) -> on_status(0)
    :: else
    fi;
#if C > 1
    if
    :: LEADS(v, 1) -> on_status(1)
    :: else
    fi;
#endif
#endif
    if
    :: m_x == S_DONE && pln[v] == m_c + 1 -> known_done[v] = known_done[v] | ONLY(m_t)
    :: else
    fi
  :: m_k == CLAIM -> on_claim(v)
#if DELIVERIES > 0
  :: m_k == DECISION -> on_decision(v); on_decision_leader(v)
#endif
  :: m_k == ALLEGIANCE ->
    if
    :: LEADS(v, m_c) -> on_allegiance_leader(m_c)
    :: else
    fi;
    on_allegiance_claimant(v)
  :: else
  fi;
  one_authority()
}

#define HAS_AUTHORITY(c) (au > NOW(leader[c] - 1))

/* The whole way back of a vehicle that is free into the coalition of the founder: a round, its bid and award. */
inline rejoins(v) {
  authority(0);
  if
  :: HAS_AUTHORITY(0) ->
    goes_to(0, v);
    m_c = 0; m_r = round[0]; m_w = (v + 1) << (4 * v); m_n = 0; m_s = NOW(0); m_u = EVER; ok = false; many = v + 1;
    ownership[E(0, v)] = LEASED; owner[E(0, v)] = v;
    accept(v);
    asked[0] = ONLY(v); confirmed[0] = ONLY(v);
    bids[0] = ONLY(v); binst[M(0, v)] = inst[v];
    found(0);
    bids[0] = 0; binst[M(0, v)] = 0
  :: else
  fi
}

/* While one may lease tasks, the leases of the other have ended, by whatever clock. */
inline one_authority() {
#ifdef AUTHORITY
  if
  :: leader[1] != 0 && alive[leader[1] - 1] && state[1] != CLOSED && alive[leader[0] - 1] && state[0] != CLOSED ->
    authority(1);
    if
    :: au > NOW(leader[1] - 1) -> authority(0); assert(au + GUARD <= NOW(leader[0] - 1))
    :: else
    fi
  :: else
  fi
#else
  skip
#endif
}

/* ---- what leaders do by themselves ---- */

inline say_announcement(c) {
  open_tasks(c);
  o_k = ANNOUNCEMENT; o_c = c; o_r = round[c]; o_a = au;
  reply()
}
/* Of one open task; others wait (left_over), or have rounds of their own. */
inline award(c, t, v) {
  m_w = (v + 1) << (4 * t);
  may_award(c);
  authority(c);
  m_u = NOW(leader[c] - 1) + FIRST;
  if
  :: ok && au >= m_u ->
    send_award(c);
    o_k = AWARD; o_c = c; o_r = round[c]; o_w = m_w; o_s = NOW(leader[c] - 1); o_u = m_u;
    reply()
  :: else
  fi
}
inline renew(c, whom) {
  renewable(c);
  m_a = whom;
  if
  :: (m_a & ~au) == 0 ->
    authority(c);
    m_u = (au < NOW(leader[c] - 1) + LEASE -> au : NOW(leader[c] - 1) + LEASE);
    heartbeat(c);
    tasks_that_are(c, DONE);
    o_k = RENEWAL; o_c = c; o_r = round[c]; o_a = m_a; o_b = (promised[c] == EVER -> electors[c] : 0);
    o_d = au; o_s = NOW(leader[c] - 1); o_u = UNTIL(0, m_u);
    reply()
  :: else
  fi
}
inline try_again(c) {
  authority(c);
  if
  :: HAS_AUTHORITY(c) ->
    tasks_that_are(c, OPEN);
    if
    :: au != 0 || state[c] == MONITORING -> start_round(c); say_announcement(c)
    :: else
    fi
  :: else
  fi
}
inline cancel(c) {
  owes[c] = false;
  o_k = CANCEL; o_c = c; o_r = round[c];
  reply()
}
inline give_up(c) {
  for (q : 0 .. T - 1) {
    if
    :: ownership[E(c, q)] == LEASED && eround[E(c, q)] != round[c] ->
      o_k = CANCEL; o_c = c; o_r = eround[E(c, q)];
      reply()
    :: else
    fi
  };
  cancel(c);
  close(c)
}
inline succeed(v) {
  has_won(v);
  if
  :: ok ->
    m_n = pln[v];
    take_over(1, v);
    m_u = (best + LEASE < NOW(v) + FIRST -> best + LEASE : NOW(v) + FIRST);
    send_award(1);
    o_k = AWARD; o_c = 1; o_r = 1; o_w = m_w; o_s = NOW(v); o_u = UNTIL(0, m_u); o_n = m_n;
    reply();
    one_authority()
  :: else
  fi
}

#ifdef GATE
#include "gate.pml"
#endif

/* All instants are one tick further back; those not after `dead` decide nothing any more, and are one. */
#define AGE(x, dead) if :: x > NEVER && x != EVER -> x--; x = (x <= (dead) -> NEVER : x) :: else fi
#if DELIVERIES > 0
#define OVER 0                           /* the lease of a delivery is compared with its time */
#else
#define OVER (CLK - GUARD)
#endif
#if DELIVERIES > 0
#define STALE 0
#define USELESS(n) false
#elif defined(WITHOUT_ELECTORS)
#define STALE (CLK - LEASE)              /* a renewal of then reaches no further than now */
#define USELESS(n) ((air_p[n] & 15) == RENEWAL && air_u[n] == NEVER)
#else
#define STALE (CLK - LEASE - 1)          /* too old for a promise; of older ones none is the newer */
#define USELESS(n) false
#endif
#define PAST (CLK - GUARD - 1)
inline tick() {
  for (q : 0 .. C - 1) {
    AGE(promised[q], CLK);
    for (z : 0 .. T - 1) { AGE(elease[E(q, z)], OVER); AGE(begins[E(q, z)], CLK); AGE(due[E(q, z)], 0) }
    for (z : 0 .. V - 1) { AGE(ack[M(q, z)], CLK - LEASE) }
  }
  for (q : 0 .. V - 1) {
    AGE(pat[q], STALE); AGE(lun[q], CLK); AGE(prom[q], CLK - GUARD); AGE(ren[q], STALE); AGE(fgate[q], PAST); AGE(fend[q], PAST);
    AGE(refused_at[q], 0); AGE(decided_at[q], 0);
    for (z : 0 .. V - 1) { AGE(sack[q * V + z], CLK - SILENCE) }
  }
#ifdef GATE
  AGE(ptime[0], PAST); AGE(ptime[1], PAST); AGE(gtime, PAST); AGE(gat, 0);
#endif
  for (q : 0 .. K - 1) {
    AGE(air_s[q], STALE);
    AGE(air_u[q], (DELIVERIES > 0 -> PAST : CLK));
    if
    :: (air_p[q] & 15) == AWARD && air_u[q] == NEVER -> air_s[q] = NEVER
    :: else
    fi
  };
  /* What has become the same is one message, and a renewal of leases that are over is none. */
  q = K - 1;
  do
  :: (air_p[q] != 0 && q > 0 && air_p[q] == air_p[q - 1] && air_q[q] == air_q[q - 1] && air_s[q] == air_s[q - 1] &&
      air_u[q] == air_u[q - 1]) || USELESS(q) -> vanish(q)
  :: else ->
    if
    :: q == 0 -> break
    :: else -> q--
    fi
  od
}

/* Others have nothing to do with it. */
#define CONCERNS(v, n) (KIND(n) != 0 && ((KIND(n) != BID && KIND(n) != CONFIRMATION && KIND(n) != STATUS && KIND(n) != ALLEGIANCE) || \
  LEADS_ANY(v) || (KIND(n) == ALLEGIANCE && fol[v] == v + 1)))
#define KIND(n)   (air_p[n] & 15)
/* A single message makes room for its answer. */
#define HEAR_LAST :: atomic { alive[v] && CONCERNS(v, 0) -> \
    d_step { load(0); vanish(0); note_heard(v); skip }; d_step { handle(v, true); skip } }
#if defined(HEALS) && C > 1              /* more than spin has room for in one d_step */
#define HEAR(n)   :: atomic { alive[v] && CONCERNS(v, n) -> d_step { load(n); note_heard(v); skip }; d_step { handle(v, true); skip } }
#else
#define HEAR(n)   :: d_step { alive[v] && CONCERNS(v, n) -> hear(v, n, true); skip }
#endif
#define REFUSE(n) :: d_step { alive[v] && (air_p[n] & 15) == AWARD -> hear(v, n, false); skip }
#define VANISH(n) :: d_step { air_p[n] != 0 -> vanish(n); skip }
#define AWARDS(c, t, b) :: d_step { LEADS(v, c) && state[c] == ANNOUNCING && IN(bids[c], b) -> award(c, t, b); skip }
#define RENEW(c, whom)  :: d_step { LEADS(v, c) -> renew(c, whom); skip }
#if defined(AUTHORITY)
#define RENEWALS(c) RENEW(c, au)
#elif T == 1
#define RENEWALS(c) RENEW(c, ONLY(owner[E(c, 0)]))
#else
#define RENEWALS(c) RENEW(c, 0) RENEW(c, 1) RENEW(c, 2) RENEW(c, 3) RENEW(c, 4) RENEW(c, 5) RENEW(c, 6) RENEW(c, 7)
#endif
#define EXPIRE(c, t)    :: d_step { LEADS(v, c) && HAS_EXPIRED(c, E(c, t)) -> expire_entry(c, t); skip }

#ifdef AUTHORITY
#define LEADS_AS(c) \
  RENEWALS(c)
#else
#define LEADS_AS(c) \
  :: d_step { LEADS(v, c) && (state[c] == EXECUTING || state[c] == MONITORING) && round[c] < ROUNDS_MAX -> try_again(c); skip } \
  :: d_step { LEADS(v, c) && state[c] == ANNOUNCING -> say_announcement(c); skip } \
  :: d_step { LEADS(v, c) && (state[c] == ANNOUNCING || state[c] == AWARDING) -> not_formed(c); skip } \
  :: d_step { LEADS(v, c) && owes[c] -> cancel(c); skip } \
  RENEWALS(c)
#endif

/* REJOINS: one vehicle goes, starts anew and comes back; another claims the lead. */
#ifdef REJOINS
#define GOES(v) (v == 1)
#define CLAIMS_IT(v) (v == 2)
#define WAITS_ON(v) false
#else
#ifdef LEADER_STAYS
#define GOES(v) (v != 0)
#else
#define GOES(v) true
#endif
#define CLAIMS_IT(v) true
#define WAITS_ON(v) true
#endif

#ifdef HEALS
#include "healing.pml"
#endif

proctype Vehicle(byte v) UNTIL_HEALED {
end_faults:
  do
#if defined(HEALS) && HELD == 1
  HEAR(0) HEAR_LAST
#else
  HEAR(0) HEAR(1)
#endif
#if K > 2
  HEAR(2)
#endif
#if K > 3
  HEAR(3)
#endif
#ifdef REFUSALS
  REFUSE(0) REFUSE(1)
#endif
  :: d_step { alive[v] && (RAN_OUT(v) || (lun[v] == EVER && elec[v] && pst[v] == MEMBER)) -> expire(v); skip }
  :: d_step { WAITS_ON(v) && alive[v] && pst[v] == ORPHANED -> no_successor(v); skip }
#ifdef TENDERS
  :: d_step { alive[v] && pst[v] == BIDDING -> leave(v); skip }
#endif
#ifdef CLAIMS
  :: d_step { CLAIMS_IT(v) && alive[v] && MAY_CLAIM(v) && pln[v] == 1 && !LEADS_ANY(v) -> claim(v); skip }
  :: d_step { alive[v] && fol[v] == v + 1 && pln[v] == 1 && !LEADS_ANY(v) && state[1] == NONE -> succeed(v); skip }
#endif
#ifdef WORKS
  :: d_step { alive[v] && lt[v] != 0 && !IS_DELIVERY(lt[v] - 1) && !begun[v] && pst[v] == MEMBER && lun[v] > NOW(v) ->
      begun[v] = true;
      o_k = STATUS; o_c = pc[v] - 1; o_r = pr[v]; o_v = v; o_t = lt[v] - 1; o_x = S_STARTED;
      reply(); skip }
  :: d_step { alive[v] && begun[v] && lun[v] > NOW(v) -> finish(v, S_DONE); skip }
#endif
#ifdef REJOINS
  :: d_step { v == 1 && alive[v] && pst[v] == FREE && LEADS(0, 0) -> rejoins(v); skip }
#endif
#ifdef WITHDRAWALS
  :: d_step { GOES(v) && alive[v] && pst[v] != FREE -> withdraw(v); skip }
#endif
#if CRASHES > 0
  :: d_step { GOES(v) && alive[v] && crashes > 0 -> crashes--; crash(v); skip }
  :: d_step { !alive[v] -> restart(v); skip }
#endif
#ifdef GATE
  LEADS_GATE(0)
#ifdef TWO_LEADERS
  LEADS_GATE(1)
#endif
  :: d_step { MAY_COMMIT_NOW(v) -> fst[v] = COMMITTED; skip }
  :: d_step { FLIES(v) && fst[v] == COMMITTED -> begins_delivery(v); skip }
  :: d_step { FLIES(v) && NOW(v) > fgate[v] && (fst[v] == PLANNED || fst[v] == AUTHORISED) -> is_late(v); skip }
  :: d_step { AT_END(v) -> finish(v, S_DONE); skip }
#else
  LEADS_AS(0)
#ifdef TENDERS
  AWARDS(0, 0, 0) AWARDS(0, 0, 1) AWARDS(0, 0, 2)
  EXPIRE(0, 0)
#if T > 1
  AWARDS(0, 1, 0) AWARDS(0, 1, 1) AWARDS(0, 1, 2)
  EXPIRE(0, 1)
#endif
#endif
#if C > 1
  LEADS_AS(1)
#ifdef TENDERS
  AWARDS(1, 0, 0) AWARDS(1, 0, 1) AWARDS(1, 0, 2)
  EXPIRE(1, 0)
#if T > 1
  AWARDS(1, 1, 0) AWARDS(1, 1, 1) AWARDS(1, 1, 2)
  EXPIRE(1, 1)
#endif
#endif
#endif
#endif
#ifdef GIVES_UP
  :: d_step { LEADS(v, 0) -> give_up(0); skip }
#endif
  od
}

proctype World() UNTIL_HEALED {
end_faults:
  do
#ifdef GATE
  :: d_step { !FLIGHT_IS_DUE -> tick(); skip }
#else
  :: d_step { FAULTS_GO_ON -> tick(); skip }
#endif
#ifdef HEALS
  HEALS_NOW
#endif
  VANISH(0) VANISH(1)
#if K > 2
  VANISH(2)
#endif
#if K > 3
  VANISH(3)
#endif
  od
}

init {
  atomic {
#ifndef AUTHORITY
    if                                   /* the leader's clock is ahead of the others, or behind */
    :: skew[0] = GUARD
    :: skew[1] = GUARD; skew[2] = GUARD
    fi;
#endif
    d_step {
#ifdef AUTHORITY
      leader[0] = 1; state[0] = EXECUTING; round[0] = 1; promised[0] = EVER;
      electors[0] = ONLY(V) - 1; asked[0] = electors[0]; confirmed[0] = electors[0]; ack[0] = NOW(0);
      for (q : 0 .. V - 1) {
        ownership[q] = LEASED; owner[q] = q; eround[q] = 1; elease[q] = EVER;
        pst[q] = MEMBER; pc[q] = 1; pr[q] = 1; pat[q] = NEVER; answered[q] = 1; lt[q] = q + 1; lun[q] = EVER;
        fst[q] = PLANNED; pln[q] = 1; prnd[q] = 1; elinst[q] = 1;
        for (z : 0 .. V - 1) { pown[q] = pown[q] | ((z + 1) << (4 * z)) }
      }
#elif defined(STANDS)
      leader[0] = 1; state[0] = EXECUTING; round[0] = 1; promised[0] = EVER;
      electors[0] = ONLY(V) - 1;
      for (q : 0 .. V - 1) { ack[q] = NOW(0); elinst[q] = 1 }
      for (q : 0 .. T - 1) {
        ownership[q] = LEASED; owner[q] = q + 1; eround[q] = 1; einst[q] = 1; elease[q] = NOW(0) + LEASE;
        asked[0] = asked[0] | ONLY(q + 1);
        pown[1] = pown[1] | ((q + 2) << (4 * q))
      };
      confirmed[0] = asked[0];
      for (q : 1 .. V - 1) {
        pst[q] = MEMBER; pc[q] = 1; pr[q] = 1; answered[q] = 1; lt[q] = q; lun[q] = NOW(0) + LEASE; fst[q] = PLANNED;
        pln[q] = 1; prnd[q] = 1; elec[q] = true; els[q] = electors[0]; fol[q] = 1; prom[q] = NOW(0) + LEASE; ren[q] = NOW(0);
        pown[q] = pown[1]
      }
#else
      lead(0, 0, 0);
#ifdef TWO_LEADERS
      lead(1, 1, 0);
#endif
#endif
    }
    run Vehicle(0); run Vehicle(1); run Vehicle(2);
#if V > 3
    run Vehicle(3);
#endif
#ifdef GATE
    run Operator();
#endif
#ifdef HEALS
    run Healed(0); run Healed(1); run Healed(2);
#ifdef HEARD_TOGETHER
    run Air();
#endif
    run Clock();
#endif
    run World()
  }
}
