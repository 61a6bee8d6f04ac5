/* SPDX-License-Identifier: Apache-2.0
 *
 * The contract net of core/coalition and the gate of core/mission, for one site: what a node holds,
 * and what each message, timeout and answer does to it. explore.pml lets anything happen that
 * may; replay.pml lets happen what a recorded mission says. Names are those of the code; what is left out
 * or allowed more freely than in the code is in docs/model.md.
 *
 * A driver defines V vehicles, T tasks, C coalitions, the times, and before this file:
 *   STAMP   the type of an instant      NOW(v)  by the clock of v
 *   NEVER   Instant::min()              EVER    Instant::max()
 *   COALITIONS  the type of a set of coalitions
 *   OWNERS  packed owners of all tasks, four bits each: 0 for none, else the vehicle + 1
 *   FORMED_AT(c)  when its newest round was to stand, noted by round_begins(c)
 *   EXISTS(t)  the site has that task
 *   UNTIL(t, u)  u, the end of a lease on task t, where that is looked at
 *   note_plan(v)  v has accepted the award m_*
 *   note_award(c, v)  an award of c to v is sent now
 *   SENT_BEFORE_AWARD(v)  the renewal m_* was sent before the award by which v holds its plan
 *   LEFT_BEFORE_AWARD(c, v)  what the allegiance m_* acknowledges was sent before the newest award to v
 *   note_award(c, v)  v is part of an award of c, made now
 *   SENT_BEFORE_AWARD(c, v)  the renewal m_* was sent before the award that v holds its plan by
 *   LEFT_BEFORE_AWARD(c, v)  v acknowledges by m_* something of before the newest award to it
 *   reply() puts what o_* says in the air
 */

#define IN(set, x)    ((((set) >> (x)) & 1) != 0)
#define ONLY(x)       (1 << (x))
#define OWNER(all, t) (((all) >> (4 * (t))) & 15)
#define ROUNDS        32                 /* of a coalition, in sets of rounds */
#define IS_DELIVERY(t) ((t) < DELIVERIES)

/* Mutants: one rule of the code broken each, for tests of the model itself. */
#ifdef MUTANT_LEASE_TOO_LONG             /* a member believes in its lease for longer than it was told */
#define LONGER MUTANT_LEASE_TOO_LONG
#else
#define LONGER 0
#endif
#ifdef MUTANT_NO_CLOCK_GUARD             /* given again when the leader's own clock says so */
#define WAITS 0
#else
#define WAITS GUARD
#endif
#ifdef MUTANT_SUCCESSOR_DOES_NOT_WAIT    /* a promise to the lost leader binds nobody */
#define PROMISE_OVER(v) true
#else
#define PROMISE_OVER(v) (NOW(v) >= prom[v] + GUARD)
#endif

#ifdef MUTANT_OLD_RENEWAL_COUNTS         /* a vote by a renewal that was sent before the award */
#define IS_OF_BEFORE_AWARD(v) false
#else
#define IS_OF_BEFORE_AWARD(v) SENT_BEFORE_AWARD(v)
#endif
#ifdef MUTANT_OLD_LEAVING_COUNTS         /* who is awarded anew is let go by what it said before */
#define HAS_LEFT(c, v) true
#else
#define HAS_LEFT(c, v) (!LEFT_BEFORE_AWARD(c, v))
#endif

/* Kinds of messages. */
#define ANNOUNCEMENT 1
#define BID          2
#define AWARD        3
#define CONFIRMATION 4
#define CANCEL       5
#define RENEWAL      6
#define STATUS       7
#define CLAIM        8
#define ALLEGIANCE   9
#define REQUEST      10
#define DECISION     11

/* A message as it is being handled, and one that answers it. Used within one step, so no part of
 * the state. c: coalition, r: its round, v: of whom it speaks, t: task, x: accepted, state, follows ..,
 * a, b, d, e: sets, w: owners, i: instance, s: stamp of its sender, u: until, n: coalition that it continues + 1. */
hidden byte m_k, m_c, m_r, m_v, m_t, m_x, m_i, m_n;
hidden int  m_a, m_b, m_d, m_e;
hidden int  m_w;
hidden int  m_s, m_u;
hidden byte o_k, o_c, o_r, o_v, o_t, o_x, o_i;
hidden int  o_a, o_b, o_d, o_e, o_w, o_s, o_u;
hidden byte o_n;

/* Scratch of one step. */
hidden byte q, z, many, needed;
hidden int  au, best;
hidden byte ok;

byte inst[V] = 1;                        /* of a vehicle's program */
bool alive[V] = true;

/* ---- Initiator ---- */
#define NONE       0
#define ANNOUNCING 1                     /* allocating, too: the planner's time is not modelled */
#define AWARDING   2
#define EXECUTING  3
#define MONITORING 4
#define CLOSED     5
#define OPEN    0                        /* Ownership */
#define LEASED  1
#define DONE    2
#define UNKNOWN 3
#define S_PLANNED 0                      /* TaskState */
#define S_STARTED 1
#define S_DONE    2
#define S_FAILED  3
#define S_UNKNOWN 4
#define E(c, t) ((c) * T + (t))
#define M(c, v) ((c) * V + (v))

byte  state[C], round[C], leader[C];     /* of coalition c; leader + 1 */
bool  owes[C];                           /* a cancel of its round, before anything else */
byte  ownership[C * T], owner[C * T], eround[C * T], einst[C * T];
bool  started[C * T], maybe_flown[C * T];
STAMP elease[C * T];                     /* the latest that the owner may believe in */
STAMP begins[C * T], due[C * T];         /* gate and time of a delivery */
byte  bids[C], binst[C * V];
byte  asked[C], confirmed[C];            /* members of the award */
byte  electors[C], elinst[C * V];
STAMP ack[C * V];                        /* of ElectorEntry; its awarded_at is the driver's */
STAMP promised[C];
byte  majority[C];
int   granted[C];                        /* rounds that the operator authorised, as the leader heard */

/* ---- Participant ---- */
#define FREE     0
#define BIDDING  1                       /* rebidding, too: it holds nothing in either */
#define MEMBER   2
#define ORPHANED 3
byte  pst[V], pc[V], pr[V];              /* state, and round_: coalition + 1 and its number */
STAMP pat[V] = NEVER;                    /* award_->awarded_at */
byte  answered[V];                       /* confirmation_: 1 accepted, 2 refused */
byte  lt[V];                             /* its lease's task + 1 */
STAMP lun[V];
bool  begun[V];                          /* TaskState::started */
byte  finished[V];                       /* done here */

/* ---- Elector ---- */
byte   pln[V], prnd[V];                  /* plan_: coalition + 1, round */
OWNERS pown[V];
bool   elec[V], strayed[V];
byte   fol[V];                           /* follows_ + 1 */
STAMP  prom[V], ren[V] = NEVER;          /* promised_until_, renewed_at_ */
byte   els[V];
COALITIONS left[V];                      /* left_ */
STAMP  sack[V * V] = NEVER;              /* supporters_ */
byte   sinst[V * V], known_done[V];

/* ---- TaskFlight ---- */
#define PLANNED    1
#define AUTHORISED 2
#define COMMITTED  3
#define BEGUN      4
#define LATE       5
byte  fst[V];
STAMP fgate[V], fend[V];                 /* the planned gate and time of the delivery */
STAMP refused_at[V] = NEVER, decided_at[V] = NEVER;
int   heard_grants[V * C];               /* Leader::granted_: rounds, by coalition */

/* What has really happened: looked at by the invariants only. */
bool  flown[T];                          /* a delivery's gate was passed */
bool  really_done[T];

/* ---------- invariants ---------- */

/* One owner a task: whatever v believes in now, nobody else does. */
inline one_owner(v) {
  for (q : 0 .. V - 1) {
    if
    :: q != v && alive[q] && lt[v] != 0 && lt[q] == lt[v] && lun[q] > NOW(q) && lun[v] > NOW(v) ->
      BROKEN("two owners of a task")
    :: else
    fi
  }
}

/* ---------- the leader ---------- */

inline count_of(set) {
  many = 0;
  for (q : 0 .. V - 1) { many = many + (((set) >> q) & 1) }
}

/* authority_until() in au */
inline authority(c) {
  count_of(electors[c]);
  needed = (many + 1) / 2;
  au = promised[c];
  if
  :: needed > 1 ->
    best = NEVER;
    for (q : 0 .. V - 1) {
      if
      :: IN(electors[c], q) && q + 1 != leader[c] && ack[M(c, q)] > best ->
        many = 0;
        for (z : 0 .. V - 1) {
          if
          :: IN(electors[c], z) && z + 1 != leader[c] && ack[M(c, z)] >= ack[M(c, q)] -> many++
          :: else
          fi
        }
        if
        :: many + 1 >= needed -> best = ack[M(c, q)]
        :: else
        fi
      :: else
      fi
    }
    if
    :: best == NEVER -> au = NEVER
    :: best != NEVER && best + LEASE < au -> au = best + LEASE
    :: else
    fi
  :: else
  fi
#ifdef MUTANT_NO_PROMISES                /* the leader needs nobody behind it */
  au = EVER;
#endif
}

/* Half of the electors have not been heard for cut_max: the next coalition that stands chooses anew. */
inline start_anew(c) {
  authority(c);
  if
  :: au < NOW(leader[c] - 1) && NOW(leader[c] - 1) >= (au == NEVER -> FORMED_AT(c) : au) + CUT_MAX ->
    electors[c] = 0;
    promised[c] = EVER
  :: else
  fi
}

inline reopen(e) {
  if
  :: maybe_flown[e] -> ownership[e] = UNKNOWN
  :: else -> ownership[e] = OPEN
  fi;
  forget_entry(e)
}

/* What an entry held says nothing any more. */
inline forget_entry(e) {
  owner[e] = 0; eround[e] = 0; einst[e] = 0; started[e] = false; elease[e] = NEVER;
  begins[e] = NEVER; due[e] = NEVER;
}

/* The tasks of a new announcement in au, as a set. */
inline open_tasks(c) {
  au = 0;
  for (q : 0 .. T - 1) {
    if
    :: ownership[E(c, q)] != DONE && ownership[E(c, q)] != UNKNOWN && !maybe_flown[E(c, q)] &&
       !(ownership[E(c, q)] == LEASED && started[E(c, q)] && elease[E(c, q)] > NOW(leader[c] - 1)) ->
      au = au | ONLY(q)
    :: else
    fi
  }
}

inline start_round(c) {
  round[c]++;
  state[c] = ANNOUNCING;
  round_begins(c);
  bids[c] = 0; asked[c] = 0; confirmed[c] = 0;
  for (q : 0 .. V - 1) { binst[M(c, q)] = 0 }
}

/* A vehicle founds coalition c, with what it knows to be done. */
inline lead(c, v, known) {
  leader[c] = v + 1;
  round[c] = 0;
  promised[c] = EVER;
  electors[c] = 0;
  granted[c] = 0;
  for (q : 0 .. T - 1) {
    forget_entry(E(c, q));
    maybe_flown[E(c, q)] = false;
    ownership[E(c, q)] = (IN(known, q) || !EXISTS(q) -> DONE : OPEN);
  }
  start_round(c);
}

inline make_unknown(e) {
  ownership[e] = UNKNOWN;
  forget_entry(e)
}

/* The bid m_*: of a newer round, so what was not begun is given back (take_back()). */
inline on_bid(c) {
  for (q : 0 .. T - 1) {
    if
    :: ownership[E(c, q)] == LEASED && owner[E(c, q)] == m_v && eround[E(c, q)] < m_r ->
      if
      :: m_i == einst[E(c, q)] && started[E(c, q)] -> skip
      :: m_i != einst[E(c, q)] && IS_DELIVERY(q) &&
         (started[E(c, q)] || (IN(granted[c], eround[E(c, q)] % ROUNDS) && NOW(leader[c] - 1) >= begins[E(c, q)])) ->
#ifdef MUTANT_RESTARTED_BIDDER_TRUSTED   /* who has started anew is believed that it had not begun */
        reopen(E(c, q))
#else
        make_unknown(E(c, q))
#endif
      :: else -> reopen(E(c, q))
      fi
    :: else
    fi
  };
  if
  :: m_r == round[c] && state[c] == ANNOUNCING && !IN(bids[c], m_v) ->
    bids[c] = bids[c] | ONLY(m_v);
    binst[M(c, m_v)] = m_i
  :: else
  fi
}

/* An award of c to v. */
inline goes_to(c, v) {
#ifdef MUTANT_NEW_START_COUNTS           /* who has started anew is an elector as it was before */
  if
  :: IN(electors[c], v) -> elinst[M(c, v)] = inst[v]
  :: else
  fi;
#endif
  note_award(c, v)
}

/* send_award() of the owners m_w until m_u: instances by bid, or as electors. */
inline send_award(c) {
  asked[c] = 0; confirmed[c] = 0;
  for (q : 0 .. T - 1) {
    if
    :: OWNER(m_w, q) != 0 ->
      z = OWNER(m_w, q) - 1;
      ownership[E(c, q)] = LEASED;
      owner[E(c, q)] = z;
      eround[E(c, q)] = round[c];
      einst[E(c, q)] = (IN(bids[c], z) -> binst[M(c, z)] : elinst[M(c, z)]);
      started[E(c, q)] = false;
      elease[E(c, q)] = UNTIL(q, m_u);
      plan_times(c, q);
      asked[c] = asked[c] | ONLY(z);
      goes_to(c, z)
    :: else
    fi
  };
  state[c] = AWARDING
}

/* The owners m_w are open tasks, one each, of bidders. */
inline may_award(c) {
  ok = (m_w != 0);
  for (q : 0 .. T - 1) {
    if
    :: OWNER(m_w, q) != 0 ->
      ok = ok && ownership[E(c, q)] == OPEN && IN(bids[c], OWNER(m_w, q) - 1);
      for (z : 0 .. T - 1) { ok = ok && (z == q || OWNER(m_w, z) != OWNER(m_w, q)) }
    :: else
    fi
  }
}

inline not_formed(c) {
  state[c] = MONITORING;
  owes[c] = true;
}

/* found(): who may choose another leader is settled the first time. */
inline found(c) {
#ifndef WITHOUT_ELECTORS
  ok = true;
  if
  :: promised[c] != EVER ->
    count_of(confirmed[c] & electors[c] & ~ONLY(leader[c] - 1));
    if
    :: many + 1 < majority[c] -> ok = false
    :: else -> promised[c] = EVER; electors[c] = 0
    fi
  :: else
  fi;
  count_of(electors[c]);
  if
  :: ok && many <= 1 ->
    electors[c] = confirmed[c] | ONLY(leader[c] - 1);
    for (q : 0 .. V - 1) {
      ack[M(c, q)] = NEVER;
      elinst[M(c, q)] = (IN(electors[c], q) -> (IN(bids[c], q) -> binst[M(c, q)] : elinst[M(c, q)]) : 0)
    }
    ack[M(c, leader[c] - 1)] = NOW(leader[c] - 1)
  :: else
  fi
#else
  skip
#endif
}

inline on_confirmation(c) {
  if
  :: m_r != round[c] || !IN(asked[c], m_v) -> skip
  :: m_r == round[c] && IN(asked[c], m_v) && m_x == 2 ->
    for (q : 0 .. T - 1) {
      if
      :: ownership[E(c, q)] == LEASED && owner[E(c, q)] == m_v && eround[E(c, q)] == m_r -> reopen(E(c, q))
      :: else
      fi
    }
    if
    :: state[c] == AWARDING -> not_formed(c)
    :: else
    fi
  :: else ->
    confirmed[c] = confirmed[c] | ONLY(m_v);
    if
    :: state[c] == AWARDING && confirmed[c] == asked[c] -> state[c] = EXECUTING; found(c)
    :: else
    fi
  fi
}

/* What a member, or the ground station, says of the task m_t. */
inline on_status(c) {
  if
  :: ownership[E(c, m_t)] == DONE -> skip
  :: ownership[E(c, m_t)] != DONE && m_x == S_DONE ->
    ownership[E(c, m_t)] = DONE;
    forget_entry(E(c, m_t))
  :: ownership[E(c, m_t)] != DONE && m_x == S_UNKNOWN ->
    if
    :: ownership[E(c, m_t)] == UNKNOWN -> skip
    :: ownership[E(c, m_t)] == OPEN -> make_unknown(E(c, m_t))
    :: else -> maybe_flown[E(c, m_t)] = true
    fi
  :: else ->
    if
    :: m_n == c + 1 && ownership[E(c, m_t)] == LEASED && owner[E(c, m_t)] == m_v ->
      if
      :: m_x == S_FAILED && m_r == eround[E(c, m_t)] -> reopen(E(c, m_t))
      :: m_x == S_STARTED -> started[E(c, m_t)] = true
      :: else
      fi
    :: else
    fi
  fi;
  finish_if_done(c)
}

inline finish_if_done(c) {
  ok = (state[c] == EXECUTING || state[c] == MONITORING);
  for (q : 0 .. T - 1) { ok = ok && (ownership[E(c, q)] == DONE || ownership[E(c, q)] == UNKNOWN) }
  if
  :: ok -> state[c] = CLOSED; closing(c)
  :: else
  fi
}

/* May the lease of entry e be taken for ended? And then it is. */
#define HAS_EXPIRED(c, e) (ownership[e] == LEASED && NOW(leader[c] - 1) >= elease[e] + WAITS)
inline expire_entry(c, t) {
#ifdef MUTANT_SILENT_DELIVERY_GIVEN_AGAIN
  reopen(E(c, t));
#else
  if
  :: IS_DELIVERY(t) && (started[E(c, t)] ||
       (IN(granted[c], eround[E(c, t)] % ROUNDS) && due[E(c, t)] <= elease[E(c, t)])) -> make_unknown(E(c, t))
  :: else -> reopen(E(c, t))
  fi;
#endif
  finish_if_done(c)
}

/* The owners that a heartbeat may renew, in au. */
inline renewable(c) {
  au = 0;
  for (q : 0 .. T - 1) {
    if
    :: ownership[E(c, q)] == LEASED && !maybe_flown[E(c, q)] &&
       (eround[E(c, q)] != round[c] || !IN(asked[c], owner[E(c, q)]) || IN(confirmed[c], owner[E(c, q)])) ->
      au = au | ONLY(owner[E(c, q)])
    :: else
    fi
  }
}

inline tasks_that_are(c, what) {
  au = 0;
  for (q : 0 .. T - 1) {
    if
    :: ownership[E(c, q)] == what -> au = au | ONLY(q)
    :: else
    fi
  }
}

/* The heartbeat to the members m_a has been said, until m_u. */
inline heartbeat(c) {
  for (q : 0 .. T - 1) {
    if
    :: ownership[E(c, q)] == LEASED && IN(m_a, owner[E(c, q)]) && elease[E(c, q)] < m_u -> elease[E(c, q)] = m_u
    :: else
    fi
  }
}

/* An elector's answer to a heartbeat. */
inline on_allegiance_leader(c) {
  if
  :: !IN(electors[c], m_v) || m_v + 1 == leader[c] || m_s > NOW(leader[c] - 1) -> skip
  :: elinst[M(c, m_v)] != m_i -> skip
  :: else ->
    if
    :: m_x == 0 && !HAS_LEFT(c, m_v) -> skip
    :: m_x == 0 && HAS_LEFT(c, m_v) -> electors[c] = electors[c] & ~ONLY(m_v); ack[M(c, m_v)] = NEVER; elinst[M(c, m_v)] = 0
    :: m_x == leader[c] ->
      if
      :: m_s > ack[M(c, m_v)] -> ack[M(c, m_v)] = m_s
      :: else
      fi
    :: else
    fi
  fi
}

inline close(c) {
  state[c] = CLOSED;
  closing(c)
}

/* ---------- every vehicle: Elector ---------- */

inline elector_leave(v) {
  if
  :: pln[v] != 0 && !strayed[v] -> left[v] = left[v] | ONLY(pln[v] - 1)
  :: else
  fi;
  pln[v] = 0; prnd[v] = 0; pown[v] = 0; elec[v] = false; els[v] = 0; fol[v] = 0; ren[v] = NEVER; strayed[v] = false;
  prom[v] = NEVER;                       /* asked of electors only, and then given anew */
  clear_supporters(v)
}

inline elector_cancelled(v) {
  if
  :: elec[v] && !strayed[v] ->
    o_k = ALLEGIANCE; o_c = pln[v] - 1; o_v = v; o_i = inst[v]; o_x = 0; o_s = ren[v]; o_e = m_e & ONLY(v);
    reply()
  :: else
  fi
}

inline clear_supporters(v) {
  for (q : 0 .. V - 1) { sack[v * V + q] = NEVER; sinst[v * V + q] = 0 }
}

/* succeeds() of the award m_*, in ok */
inline succeeds(v) {
  ok = elec[v] && m_n == pln[v] && m_n != 0 && fol[v] == leader[m_c] && fol[v] != leader[m_n - 1]
}

inline elector_accepted(v) {
#ifndef WITHOUT_ELECTORS
  if
  :: pln[v] != m_c + 1 ->
    succeeds(v);
    if
    :: !ok -> known_done[v] = 0
    :: else
    fi;
    elector_leave(v)
  :: else
  fi;
  pln[v] = m_c + 1; prnd[v] = m_r; pown[v] = m_w;
  note_plan(v)
#else
  skip
#endif
}

inline follow(v, whom) {
  fol[v] = whom;
  strayed[v] = strayed[v] || whom != leader[pln[v] - 1];
  prom[v] = NOW(v) + LEASE;
  o_k = ALLEGIANCE; o_c = pln[v] - 1; o_v = v; o_i = inst[v]; o_x = whom; o_s = m_s;
  reply()
}

inline elector_on_renewal(v) {
  if
  :: leader[m_c] == v + 1 -> skip
  :: leader[m_c] != v + 1 && IN(left[v], m_c) ->
    if
    :: IN(m_b, v) -> o_k = ALLEGIANCE; o_c = m_c; o_v = v; o_i = inst[v]; o_x = 0; o_s = m_s; o_e = m_e & ONLY(v); reply()
    :: else
    fi
  :: leader[m_c] != v + 1 && !IN(left[v], m_c) && pln[v] == m_c + 1 ->
    known_done[v] = known_done[v] | m_d;
    if
    :: m_s < ren[v] || !IN(m_b, v) || IS_OF_BEFORE_AWARD(v) -> skip
    :: m_s >= ren[v] && !IS_OF_BEFORE_AWARD(v) && IN(m_b, v) && elec[v] && fol[v] != leader[m_c] && !PROMISE_OVER(v) -> skip
    :: else ->
      elec[v] = true; ren[v] = m_s; els[v] = m_b;
      clear_supporters(v);
      follow(v, leader[m_c])
    fi
  :: else
  fi
}

inline on_claim(v) {
  if
  :: !elec[v] || m_c + 1 != pln[v] || m_v == v || !IN(els[v], m_v) -> skip
  :: elec[v] && m_c + 1 == pln[v] && m_v != v && IN(els[v], m_v) && fol[v] != m_v + 1 &&
     !(fol[v] == v + 1 && m_v < v) && !PROMISE_OVER(v) -> skip
  :: else ->
    clear_supporters(v);
    follow(v, m_v + 1)
  fi
}

#define MAY_CLAIM(v) (elec[v] && (fol[v] == v + 1 || PROMISE_OVER(v)))
inline claim(v) {
  if
  :: fol[v] != v + 1 -> clear_supporters(v)
  :: else
  fi;
  fol[v] = v + 1; strayed[v] = true; prom[v] = NOW(v) + LEASE;
  sack[v * V + v] = NOW(v); sinst[v * V + v] = inst[v];
  o_k = CLAIM; o_c = pln[v] - 1; o_v = v; o_s = NOW(v);
  reply()
}

inline on_allegiance_claimant(v) {
  if
  :: elec[v] && m_c + 1 == pln[v] && m_x == v + 1 && fol[v] == v + 1 && IN(els[v], m_v) && m_s <= NOW(v) ->
    if
    :: m_s > sack[v * V + m_v] -> sack[v * V + m_v] = m_s
    :: else
    fi;
    sinst[v * V + m_v] = m_i
  :: else
  fi
}

/* count_supporters(): has v a majority (ok), from when (best), who (au)? */
inline has_won(v) {
  au = 0; best = NOW(v); many = 0;
  for (q : 0 .. V - 1) {
    if
    :: sack[v * V + q] != NEVER && NOW(v) <= sack[v * V + q] + SILENCE ->
      au = au | ONLY(q);
      many++;
      if
      :: sack[v * V + q] < best -> best = sack[v * V + q]
      :: else
      fi
    :: else
    fi
  }
  needed = many;
  count_of(els[v]);
  many = many / 2 + 1;
#ifdef MUTANT_HALF_IS_ENOUGH             /* as many as the lost leader needs */
  many = many - 1;
#endif
  ok = elec[v] && fol[v] == v + 1 && needed >= many
}

/* v leads on as coalition c, after has_won(). m_w: what is left of the plan with its supporters. */
inline take_over(c, v) {
  leader[c] = v + 1;
  promised[c] = best + LEASE;
  majority[c] = many;
  electors[c] = au;
  round[c] = 1;
  granted[c] = 0;
  bids[c] = 0;
  for (q : 0 .. V - 1) {
    ack[M(c, q)] = (IN(au, q) -> best : NEVER);
    elinst[M(c, q)] = (IN(au, q) -> sinst[v * V + q] : 0);
    binst[M(c, q)] = 0
  }
  m_w = 0;
  for (q : 0 .. T - 1) {
    forget_entry(E(c, q));
    maybe_flown[E(c, q)] = false;
    z = OWNER(pown[v], q);
    if
    :: IN(known_done[v], q) || !EXISTS(q) -> ownership[E(c, q)] = DONE
    :: EXISTS(q) && !IN(known_done[v], q) && z != 0 && IN(au, z - 1) ->
      ownership[E(c, q)] = OPEN;
      m_w = m_w | (z << (4 * q))
    :: EXISTS(q) && !IN(known_done[v], q) && !(z != 0 && IN(au, z - 1)) && IS_DELIVERY(q) &&
       IN(heard_grants[v * C + pln[v] - 1], prnd[v] % ROUNDS) && (z == 0 || PLAN_IS_DUE(v, q)) -> ownership[E(c, q)] = UNKNOWN
    :: else -> ownership[E(c, q)] = OPEN
    fi
  }
}

/* ---------- every vehicle: Participant ---------- */

inline say_failed(v) {
  o_k = STATUS; o_c = pc[v] - 1; o_r = pr[v]; o_v = v; o_t = lt[v] - 1; o_x = S_FAILED;
  reply()
}

/* Its lease is over; so is its flight to it. */
inline drop(v) {
  if
  :: lt[v] != 0 -> lease_over(v)
  :: else
  fi;
  lt[v] = 0; lun[v] = NEVER; begun[v] = false; fst[v] = 0; fgate[v] = NEVER; fend[v] = NEVER;
  decided_at[v] = NEVER
}

inline leave(v) {
  drop(v);
  elector_leave(v);
  pst[v] = FREE; pat[v] = NEVER
}

/* May v bid in the round of the announcement m_*? */
#define DONE_HERE(v)   ((finished[v] & m_a) != 0)
#define NEWER(v)       (m_c + 1 == pc[v] && m_r > pr[v])
#ifdef MUTANT_BIDS_WHAT_IT_HAS_DONE
#define KEEPS_QUIET(v) false
#else
#define KEEPS_QUIET(v) DONE_HERE(v)
#endif
#define MAY_BID(v) (!KEEPS_QUIET(v) && !begun[v] && \
  (pst[v] == FREE || (pst[v] == ORPHANED && !(m_c + 1 == pc[v] && m_r <= pr[v])) || \
   (pst[v] != FREE && pst[v] != ORPHANED && NEWER(v))))
inline bid(v) {
  if
  :: lt[v] != 0 && pc[v] != m_c + 1 -> say_failed(v)
  :: else
  fi;
  pst[v] = BIDDING;
#ifndef MUTANT_BID_KEEPS_TASK            /* who bids anew gives back what it has not begun */
  drop(v);
#endif
  pc[v] = m_c + 1; pr[v] = m_r; pat[v] = NEVER; answered[v] = 0;
  o_k = BID; o_c = m_c; o_r = m_r; o_v = v; o_i = inst[v];
  reply()
}

/* Of the award m_*: what v has in it, as task + 1, in many; more than one in needed. */
inline mine(v) {
  many = 0; needed = 0;
  for (q : 0 .. T - 1) {
    if
    :: OWNER(m_w, q) == v + 1 -> many = q + 1; needed++
    :: else
    fi
  }
}

/* What the award m_* is to v, in ok: 0 nothing, 1 its confirmation again, 2 it is free, 3 to be answered. */
inline judge_award(v) {
  succeeds(v);
  ok = ok && pst[v] == ORPHANED;
  mine(v);
  if
  :: !(m_c + 1 == pc[v] && m_r == pr[v]) && !ok -> best = 0
  :: m_c + 1 == pc[v] && m_r == pr[v] && !ok && answered[v] != 0 && !(pst[v] == BIDDING) -> best = 1
  :: m_c + 1 == pc[v] && m_r == pr[v] && !ok && answered[v] == 0 && !(pst[v] == BIDDING) -> best = 0
  :: else ->
    if
    :: many == 0 || NOW(v) >= m_u -> best = (ok -> 0 : 2)
    :: else -> best = 3
    fi
  fi
}

/* It can fly that, and does. `ok`: it goes on with the plan that it held. */
inline accept(v) {
  if
  :: ok && lt[v] == many ->              /* the path is flown already */
#ifndef MUTANT_GRANT_PASSES_ON           /* a grant is of one round */
    fst[v] = (fst[v] == AUTHORISED -> PLANNED : fst[v]);
#endif
    lun[v] = UNTIL(lt[v] - 1, m_u + LONGER)
  :: else ->
    lt[v] = many; lun[v] = UNTIL(lt[v] - 1, m_u + LONGER); begun[v] = false; fst[v] = PLANNED;
    decided_at[v] = NEVER;
    set_out(v)
  fi;
  elector_accepted(v);
  pc[v] = m_c + 1; pr[v] = m_r; pat[v] = m_s; pst[v] = MEMBER; answered[v] = 1;
  finished[v] = finished[v] & ~ONLY(lt[v] - 1);
  one_owner(v);
  say_confirmation(v)
}
inline say_confirmation(v) {
  o_k = CONFIRMATION; o_c = pc[v] - 1; o_r = pr[v]; o_v = v; o_x = answered[v];
  reply()
}
inline refuse(v) {
  leave(v);
  pc[v] = m_c + 1; pr[v] = m_r; answered[v] = 2;
  say_confirmation(v)
}

/* m_x: by the operator */
inline on_cancel(v) {
  if
  :: m_c + 1 != pc[v] || m_r != pr[v] || pst[v] == FREE -> skip
  :: m_c + 1 == pc[v] && m_r == pr[v] && pst[v] != FREE && m_x == 1 && begun[v] && IS_DELIVERY(lt[v] - 1) ->
    elector_leave(v)                     /* that one is not broken off */
  :: else ->
    if
    :: begun[v] -> say_failed(v)
    :: else
    fi;
    elector_cancelled(v);
    leave(v)
  fi
}

inline participant_on_renewal(v) {
  elector_on_renewal(v);
  if
  :: IN(m_a, v) && m_c + 1 == pc[v] && m_r >= pr[v] && (pat[v] == NEVER || m_s > pat[v]) ->
    ok = pst[v] == ORPHANED && m_r == pr[v] && m_u > NOW(v) && elec[v] && fol[v] == leader[pln[v] - 1];
    if
    :: ok -> pst[v] = MEMBER
    :: else
    fi;
    if
    :: lt[v] != 0 && m_u > lun[v] && (lun[v] > NOW(v) || ok) -> lun[v] = m_u + LONGER; one_owner(v)
    :: else
    fi
  :: else
  fi
}

/* expire_leases(): its lease has run out; the plan is held where a successor may come. */
#define RAN_OUT(v) (lt[v] != 0 && pst[v] != ORPHANED && lun[v] <= NOW(v))
inline expire(v) {
  if
  :: pst[v] == MEMBER && elec[v] && !begun[v] -> pst[v] = ORPHANED
  :: else ->
    say_failed(v);
    if
    :: pst[v] == MEMBER -> leave(v)
    :: else -> drop(v)
    fi
  fi
}
inline no_successor(v) { say_failed(v); leave(v) }

inline finish(v, how) {
  if
  :: how == S_DONE -> finished[v] = finished[v] | ONLY(lt[v] - 1); really_done[lt[v] - 1] = true
  :: else
  fi;
  o_k = STATUS; o_c = pc[v] - 1; o_r = pr[v]; o_v = v; o_t = lt[v] - 1; o_x = how;
  reply();
  if
  :: pst[v] == MEMBER || pst[v] == ORPHANED -> leave(v)
  :: else -> drop(v)
  fi
}

/* It can fly no task now, or is told not to. */
inline withdraw(v) {
  if
  :: lt[v] != 0 -> finish(v, S_FAILED)
  :: else
  fi;
  if
  :: pst[v] != FREE -> leave(v)
  :: else
  fi
}

/* Its program ends, and with it all that it knew; what it leads is lost. */
inline crash(v) {
  for (q : 0 .. C - 1) {
    if
    :: leader[q] == v + 1 && state[q] != NONE -> state[q] = CLOSED; closing(q)
    :: else
    fi
  };
  leave(v);
  pc[v] = 0; pr[v] = 0; answered[v] = 0; finished[v] = 0; left[v] = 0; known_done[v] = 0; prom[v] = NEVER;
  refused_at[v] = NEVER;
  for (q : 0 .. C - 1) { heard_grants[v * C + q] = 0 }
  alive[v] = false
}
inline restart(v) { alive[v] = true; inst[v]++ }

/* ---------- the gate: TaskFlight ---------- */

/* The decision m_*: x granted, s decided at, w deliveries. */
#ifdef MUTANT_ANY_ROUND_GRANTS
#define OF_ITS_ROUND(v) (m_c + 1 == pc[v])
#else
#define OF_ITS_ROUND(v) (m_c + 1 == pc[v] && m_r == pr[v])
#endif
#ifdef MUTANT_LATE_COPY_GRANTS           /* as if a grant could not come after its own withdrawal */
#define NOT_REFUSED_SINCE(v) true
#else
#define NOT_REFUSED_SINCE(v) (refused_at[v] == NEVER || m_s > refused_at[v])
#endif
inline on_decision(v) {
  if
  :: m_x == 0 ->
    if
    :: m_s > refused_at[v] -> refused_at[v] = m_s
    :: else
    fi;
    if
    :: lt[v] != 0 && IS_DELIVERY(lt[v] - 1) && pst[v] != FREE && m_s > decided_at[v] &&
       (fst[v] == AUTHORISED || fst[v] == COMMITTED || fst[v] == BEGUN) ->
      if
      :: fst[v] == BEGUN -> elector_leave(v)
      :: else -> withdraw(v)
      fi
    :: else
    fi
  :: else ->
    if
    :: lt[v] != 0 && IS_DELIVERY(lt[v] - 1) && OF_ITS_ROUND(v) && NOT_REFUSED_SINCE(v) &&
       OWNER(m_w, lt[v] - 1) == v + 1 && m_u == fend[v] && m_u >= NOW(v) ->
      decided_at[v] = (fst[v] == PLANNED || fst[v] == LATE -> m_s : decided_at[v]);
      fst[v] = (fst[v] == PLANNED -> AUTHORISED : fst[v])
    :: else
    fi
  fi
}

/* Leader::on_authorisation() of v */
inline on_decision_leader(v) {
  if
  :: m_x == 1 ->
    heard_grants[v * C + m_c] = heard_grants[v * C + m_c] | ONLY(m_r % ROUNDS);
    if
    :: leader[m_c] == v + 1 -> granted[m_c] = granted[m_c] | ONLY(m_r % ROUNDS)
    :: else
    fi
  :: else
  fi
}

#ifdef MUTANT_GATE_WITHOUT_GRANT
#define MAY_COMMIT(v) (lt[v] != 0 && (fst[v] == AUTHORISED || fst[v] == PLANNED) && lun[v] > NOW(v) && lun[v] >= fend[v])
#else
#ifdef MUTANT_GATE_WITHOUT_LEASE
#define MAY_COMMIT(v) (lt[v] != 0 && fst[v] == AUTHORISED)
#else
#define MAY_COMMIT(v) (lt[v] != 0 && fst[v] == AUTHORISED && lun[v] > NOW(v) && lun[v] >= fend[v])
#endif
#endif
