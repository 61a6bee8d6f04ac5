/* SPDX-License-Identifier: Apache-2.0
 *
 * GATE: one delivery, which two leaders put before the operator, each for its own coalition: they did
 * not hear each other. How a coalition forms and renews its lease is one step here (the other configurations
 * look into it), heard by its member or not. What is asked, granted, taken back and told goes through the air.
 */
#define GROUND 3                         /* of whom a status speaks */
#define LATE_EVENT 12                    /* it gives the delivery up: late at its gate, or out of its coalition */

/* GroundAgent. A new start of it recalls all this from its recording. */
byte pending[C], decision[C];            /* the newest request: round + 1; 1 granted, 2 refused or taken back */
byte pwho[C], ptime[C];
byte gc, gr, gv, gtime, gat;             /* granted_: coalition + 1, round, vehicle, time, when */
bool gbegun, given_up, gdone;
#ifndef TAKE_BACKS
#define TAKE_BACKS 0
#endif
byte noes = TAKE_BACKS;                  /* refusals and grants taken back, still to come */

int truly_granted[C];                    /* rounds, for the invariants */

inline say_decision(c, yes) {
  o_k = DECISION; o_c = c; o_r = pending[c] - 1; o_x = yes; o_w = pwho[c] + 1; o_s = CLK; o_u = ptime[c];
  reply()
}
/* tell_what_is_over() and granted_to_another(), in many: 0 neither, 1 told, 2 wait */
inline what_is_over(c, who) {
  many = 0;
  o_c = c; o_v = GROUND;
  if
  :: gdone -> many = 1; o_k = STATUS; o_x = S_DONE; reply()
  :: !gdone && gc != 0 && gc != c + 1 && !given_up && gtime <= CLK -> many = 1; o_k = STATUS; o_x = S_UNKNOWN; reply()
#ifndef MUTANT_GRANTED_TWICE
  :: !gdone && gc != 0 && gc != c + 1 && !given_up && gtime > CLK && gv != who -> many = 2
#endif
  :: else
  fi;
  o_c = 0; o_v = 0
}
inline on_request(n) {
  load(n);
  if
  :: pending[m_c] >= m_r + 1 -> skip
  :: else ->
    what_is_over(m_c, OWNER(m_w, 0) - 1);
    if
    :: many == 0 -> pending[m_c] = m_r + 1; decision[m_c] = 0; pwho[m_c] = OWNER(m_w, 0) - 1; ptime[m_c] = m_u
    :: else
    fi
  fi
}
inline decide(c, yes) {
  what_is_over(c, pwho[c]);
  if
  :: yes && many == 0 ->
    decision[c] = 1;
    gc = c + 1; gr = pending[c] - 1; gv = pwho[c]; gtime = ptime[c]; gat = CLK; gbegun = false; given_up = false;
    truly_granted[c] = truly_granted[c] | ONLY(gr);
    say_decision(c, 1)
  :: !yes -> decision[c] = 2; gc = 0; say_decision(c, 0)
  :: else
  fi
}
/* What a vehicle tells of the delivery that it was granted. */
inline ground_on_status(n) {
  load(n);
  if
  :: m_v == GROUND -> skip
  :: m_v != GROUND && m_x == S_DONE -> gdone = true
  :: m_v != GROUND && m_x != S_DONE && gc != 0 && gv == m_v && ((gc == m_c + 1 && gr == m_r) || m_s > gat + GUARD) ->
    gbegun = gbegun || m_x == S_STARTED;
    given_up = given_up || (m_x == S_FAILED && !gbegun)
  :: else
  fi
}

/* The whole way to a coalition that stands, with b as the owner. */
#define MAY_FORM(c, b) (alive[b] && !begun[b] && finished[b] == 0 && round[c] < ROUNDS_MAX && ownership[E(c, 0)] == OPEN && \
  (pst[b] == FREE || pc[b] == c + 1))
inline forms(c, b) {
  start_round(c);
  bids[c] = ONLY(b); binst[M(c, b)] = inst[b] + 1;
  m_c = c; m_r = round[c]; m_w = b + 1; m_s = NOW(leader[c] - 1); m_u = m_s + FIRST; m_n = 0;
  send_award(c);
  confirmed[c] = asked[c];
  state[c] = EXECUTING;
  ok = false; many = 1;
  drop(b);
  m_x = 0;
  lt[b] = 1; lun[b] = m_u; begun[b] = false; fst[b] = PLANNED; decided_at[b] = NEVER;
  set_out(b);
  pc[b] = c + 1; pr[b] = m_r; pat[b] = m_s; pst[b] = MEMBER; answered[b] = 1
}
inline renew_owner(c, is_heard) {
  m_u = NOW(leader[c] - 1) + LEASE;
  elease[E(c, 0)] = m_u;
  if
  :: is_heard && lt[owner[E(c, 0)]] != 0 && pc[owner[E(c, 0)]] == c + 1 && lun[owner[E(c, 0)]] > NOW(owner[E(c, 0)]) ->
    lun[owner[E(c, 0)]] = m_u
  :: else
  fi
}
inline ask(c) {
  o_k = REQUEST; o_c = c; o_r = round[c]; o_w = owner[E(c, 0)] + 1; o_u = due[E(c, 0)];
  reply()
}

inline begins_delivery(v) {
  fst[v] = BEGUN; begun[v] = true;
  assert(IN(truly_granted[pc[v] - 1], pr[v]));        /* no delivery without authorisation */
  assert(refused_at[v] == NEVER || refused_at[v] < decided_at[v]);  /* nor after it was taken back */
  assert(lun[v] > NOW(v) && lun[v] >= fend[v]);       /* and under its lease to the end */
  assert(!flown[0]);                                  /* no delivery twice */
  flown[0] = true;
  o_k = STATUS; o_c = pc[v] - 1; o_r = pr[v]; o_v = v; o_x = S_STARTED;
  reply()
}
inline is_late(v) {
  fst[v] = LATE;
  o_k = LATE_EVENT; o_c = pc[v] - 1; o_r = pr[v]; o_v = v; o_x = S_FAILED; o_s = NOW(v);
  reply()
}

/* The flight does not wait: what is due at this tick comes before the next. */
#define FLIES(v) (alive[v] && lt[v] != 0 && NOW(v) >= fgate[v])
#define AT_GATE(v) (FLIES(v) && (fst[v] == COMMITTED || NOW(v) > fgate[v] && (fst[v] == PLANNED || fst[v] == AUTHORISED)))
#define AT_END(v)  (FLIES(v) && fst[v] == BEGUN && NOW(v) >= fend[v] && lun[v] >= NOW(v))
#define FLIGHT_IS_DUE (AT_GATE(0) || AT_END(0) || AT_GATE(1) || AT_END(1) || AT_GATE(2) || AT_END(2))

#define FORMS(c, b) :: d_step { LEADS(v, c) && (state[c] == EXECUTING || state[c] == ANNOUNCING) && MAY_FORM(c, b) -> forms(c, b); skip }
#ifdef TWO_LEADERS                       /* their first leases reach to the end */
#define RENEWS_OWNER(c)
#else
#define RENEWS_OWNER(c) \
  :: d_step { LEADS(v, c) && ownership[E(c, 0)] == LEASED -> renew_owner(c, true); skip } \
  :: d_step { LEADS(v, c) && ownership[E(c, 0)] == LEASED -> renew_owner(c, false); skip }
#endif
#ifdef TWO_LEADERS                       /* the first of them takes no part itself */
#define FORMS_OF_OWN(c) FORMS(1, 1)
#else
#define FORMS_OF_OWN(c) FORMS(c, c)
#endif
#define LEADS_GATE(c) \
  FORMS_OF_OWN(c) FORMS(c, 2) \
  RENEWS_OWNER(c) \
  :: d_step { LEADS(v, c) && ownership[E(c, 0)] == LEASED && state[c] == EXECUTING -> ask(c); skip } \
  :: d_step { LEADS(v, c) && HAS_EXPIRED(c, E(c, 0)) -> expire_entry(c, 0); skip } \
  :: d_step { LEADS(v, c) && (HOLDS_AT_GATE(c) || KNOWS_NOTHING(c)) -> bids_again(c); skip }
/* Its owner is late, and bids in the next round: so it says that it has not begun. */
#define HOLDS_AT_GATE(c) (state[c] == EXECUTING && ownership[E(c, 0)] == LEASED && round[c] < ROUNDS_MAX && \
  alive[owner[E(c, 0)]] && pc[owner[E(c, 0)]] == c + 1 && fst[owner[E(c, 0)]] == LATE)
inline bids_again(c) {
  m_v = owner[E(c, 0)]; m_i = inst[m_v] + 1; m_r = round[c] + 1;
  on_bid(c);
  drop(m_v)
}
/* Who has started anew bids for the same leader: it cannot say what it had begun. */
#define KNOWS_NOTHING(c) (LEADS(v, c) && ownership[E(c, 0)] == LEASED && alive[owner[E(c, 0)]] && pc[owner[E(c, 0)]] == 0 && \
  inst[owner[E(c, 0)]] + 1 != einst[E(c, 0)])
#define MAY_COMMIT_NOW(v) (alive[v] && MAY_COMMIT(v) && NOW(v) == fgate[v])

proctype Operator() {
  do
#define GROUND_HEARS(n) \
  :: d_step { (air_p[n] & 15) == REQUEST -> on_request(n); skip } \
  :: d_step { (air_p[n] & 15) == STATUS || (air_p[n] & 15) == LATE_EVENT -> ground_on_status(n); skip }
  GROUND_HEARS(0) GROUND_HEARS(1)
#if K > 2
  GROUND_HEARS(2)
#endif
/* A no is later than the grant that it takes back, also in ticks. */
#define DECIDES(c) \
  :: d_step { pending[c] != 0 && decision[c] == 0 -> decide(c, true); skip } \
  :: d_step { pending[c] != 0 && decision[c] == 0 && noes > 0 && (gc == 0 || gat < CLK) -> noes--; decide(c, false); skip } \
  :: d_step { decision[c] == 1 && noes > 0 && !gbegun && !gdone && ptime[c] > CLK && gat < CLK -> noes--; decide(c, false); skip }
  DECIDES(0)
#ifdef TWO_LEADERS
  DECIDES(1)
#endif
  od
}
