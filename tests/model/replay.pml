/* SPDX-License-Identifier: Apache-2.0
 *
 * Lets the contract net do what recorded missions say that it did (mission_traces.cpp, on standard
 * input), and nothing else. What a vehicle said must be what the model lets it say then, a lease must end
 * when the model's does, a task begin when the model lets it. What goes on inside (expiries, promises, who is
 * an elector) is the model's own, and not in the trace. The first row that does not fit rejects its trace.
 */
#define V 8
#define T 7
#define C 24
#define STAMP int                        /* microseconds of the mission */
#define OWNERS int
#define COALITIONS int
#define NEVER (-1000000000)
#define EVER  1000000000
#define NOW(v) (clk + skew[v])
#ifndef LEASE                            /* as the scenario has them */
#define LEASE    15000000
#define GUARD    500000
#define SILENCE  5000000
#define CUT_MAX  60000000
#define FORMATION 1400000
#define FIRST    12200000                /* first_lease(), after a plan that took half a lease at most */
#endif
#define KNOWS_LATER 60000                /* vehicles look at the time every 40 ms; not all that is said has a time */
#define ROUNDED 2                        /* clocks differ by nanoseconds, too */
#define DELIVERIES deliveries
#define UNTIL(t, u) (u)
#define EXISTS(t) ((t) < tasks)
#define FORMED_AT(c) formed_at[c]

c_decl {
  \#include <stdio.h>
  \#include <string.h>
  static char word[32], mission[32];
  static const char *refusal;
  static long row, accepted, rejected, rows, site;
  static int f[16], planned_for[7];
  static void refuse(const char *what) { if (!refusal) refusal = what; }
}

hidden int clk, deliveries, tasks, kind, who, lk, failed;
hidden int m_times[T];
int skew[V];

#define BROKEN(what) c_code { refuse(what); }
#define CHECK(what, it) if :: (what) -> skip :: else -> c_code { refuse(it); } fi

#define PLAN_IS_DUE(v, q) (plan_time[(v) * T + (q)] <= NOW(v))

#define SENT_BEFORE_AWARD(v)    (m_s <= plan_at[v])
#define LEFT_BEFORE_AWARD(c, v) (m_s <= awarded_at[M(c, v)])

#include "contract_net.pml"

int  plan_at[V], awarded_at[C * V];      /* of the award that v has accepted, and of the newest to it */
int  plan_time[V * T];                   /* of the plan that v is part of */
int  approach[C * V];
byte sv_c[V], sv_r[V], sv_n[V], sv_many[V], deciding[V];   /* an award that is being answered */
int  sv_w[V], sv_s[V], sv_u[V], sv_times[V * T];
byte told_c[V], told_x[V];               /* whom it has said that it follows */
int  told_s[V];
byte over_t[V];                          /* the lease that v had last */
int  over_u[V];
int  formed_at[C];
int  called[C];                          /* the tasks of its newest announcement */
int  asked_for[C];                       /* rounds that were put before the operator */
int  passed_on_at[V];                    /* when its grant was taken over with its plan */

/* An allegiance may wait in the elector while the vehicle says something else. */
inline reply() {
  if
  :: o_k == ALLEGIANCE -> told_c[o_v] = o_c; told_x[o_v] = o_x; told_s[o_v] = o_s
  :: else
  fi;
  o_k = 0; o_c = 0; o_r = 0; o_v = 0; o_t = 0; o_x = 0; o_i = 0; o_n = 0
}
inline closing(c) { skip }
/* Who breaks off what it has begun has not flown it; of a program that ends nobody knows. */
inline lease_over(v) {
  over_t[v] = lt[v]; over_u[v] = lun[v];
  if
  :: begun[v] && kind != 40 -> flown[lt[v] - 1] = flown[lt[v] - 1] && really_done[lt[v] - 1]
  :: else
  fi
}
inline note_plan(v) { plan_at[v] = m_s }
inline note_award(c, v) { awarded_at[M(c, v)] = NOW(leader[c] - 1) }
inline round_begins(c) { formed_at[c] = NOW(leader[c] - 1) + FORMATION }
inline plan_times(c, q) {
  due[E(c, q)] = m_times[q];
  begins[E(c, q)] = m_times[q] - (IN(bids[c], z) -> approach[M(c, z)] : 15000000)
}
inline set_out(v) {
  fend[v] = sv_times[v * T + lt[v] - 1];
  for (q : 0 .. T - 1) { plan_time[v * T + q] = sv_times[v * T + q] }
}

/* What a leader's step begins with. */
inline leader_looks(c) {
  for (lk : 0 .. T - 1) {
    if
    :: HAS_EXPIRED(c, E(c, lk)) -> expire_entry(c, lk)
    :: else
    fi
  };
  if
  :: electors[c] != 0 -> start_anew(c)
  :: else
  fi;
  finish_if_done(c)
}
inline looks(v) {
  if
  :: RAN_OUT(v) && deciding[v] == 0 -> expire(v)
  :: else
  fi
}

#define LEADS(v, c) (alive[v] && leader[c] == (v) + 1 && state[c] != NONE && state[c] != CLOSED)

inline leader_said() {
  if
  :: kind == ANNOUNCEMENT && who < V ->
    CHECK(m_v == who, "an announcement of somebody else's coalition");
    if
    :: state[m_c] == NONE -> lead(m_c, who, ~m_a)
    :: state[m_c] == ANNOUNCING && m_r == round[m_c] -> CHECK(m_a == called[m_c], "other tasks in the same round")
    :: else ->
      CHECK((state[m_c] == EXECUTING || state[m_c] == MONITORING) && m_r == round[m_c] + 1, "no round can begin now");
      leader_looks(m_c);
      open_tasks(m_c);
      CHECK(au == m_a, "other tasks are open");
      start_round(m_c)
    fi;
    called[m_c] = m_a
  :: kind == AWARD ->
    CHECK(m_v == who, "an award in somebody else's round");
    if
    :: state[m_c] == NONE ->
      looks(who);
      CHECK(m_n != 0 && pln[who] == m_n, "it goes on with no plan of its own");
      best = m_w;
      lk = m_w;
      has_won(who);
      CHECK(ok, "no majority follows it");
      take_over(m_c, who);
      CHECK(m_w == lk, "another plan than what is left of the one it had");
      for (lk : 0 .. T - 1) {
        CHECK(OWNER(m_w, lk) == 0 || m_times[lk] == plan_time[who * T + lk], "another time than in that plan")
      };
      authority(m_c);
      CHECK(m_u <= au && m_u <= NOW(who) + FIRST, "a lease beyond what it is promised");
      send_award(m_c)
    :: state[m_c] == AWARDING && m_r == round[m_c] -> skip
    :: else ->
      leader_looks(m_c);
      CHECK(state[m_c] == ANNOUNCING && m_r == round[m_c], "no award is awaited");
      may_award(m_c);
      CHECK(ok, "an award of what is not open, or to who has not bid");
      authority(m_c);
      CHECK(m_u <= au && m_u <= NOW(who) + FIRST, "a lease beyond what it is promised");
      send_award(m_c)
    fi
  :: kind == CANCEL ->
    CHECK(m_v == who, "a cancel of somebody else's round");
    if
    :: m_t == 1 ->
      CHECK(m_r == round[m_c] && (state[m_c] == ANNOUNCING || state[m_c] == AWARDING || owes[m_c]), "that round has not failed");
      if
      :: !owes[m_c] -> not_formed(m_c)
      :: else
      fi;
      owes[m_c] = false
    :: m_t != 1 && state[m_c] != CLOSED -> CHECK(state[m_c] != NONE, "it leads nothing"); close(m_c)
    :: else
    fi
  :: kind == RENEWAL && who < V && m_x == 1 ->
    if
    :: LEADS(who, m_c) -> clk = clk + KNOWS_LATER; leader_looks(m_c); clk = clk - KNOWS_LATER
    :: else
    fi;
    CHECK(m_v == who && state[m_c] == CLOSED, "it is not over");
    tasks_that_are(m_c, DONE);
    CHECK((m_d & ~au) == 0, "it knows of more than was done")
  :: kind == RENEWAL && who < V && m_x == 0 ->
    CHECK(m_v == who && m_r == round[m_c], "a renewal of somebody else's leases");
    leader_looks(m_c);
    CHECK(state[m_c] != NONE && state[m_c] != CLOSED, "a renewal by who does not lead");
    renewable(m_c);
    CHECK((m_a & ~au) == 0, "a lease renewed that is none");
    CHECK(m_b == (promised[m_c] == EVER -> electors[m_c] : 0), "other electors");
    tasks_that_are(m_c, DONE);
    CHECK(m_d == (au & (ONLY(tasks) - 1)), "other tasks are done");
    CHECK(m_s == NOW(who), "another time");
    authority(m_c);
    au = (au < m_s + LEASE -> au : m_s + LEASE);
    CHECK(m_u == (au < 0 -> 0 : au), "a lease that reaches elsewhere than the electors' promises");
    heartbeat(m_c)
  :: else
  fi
}

inline member_said() {
  if
  :: kind == BID ->
    if
    :: pc[who] == m_c + 1 && pr[who] == m_r && pst[who] == BIDDING -> skip
    :: else ->
      m_a = called[m_c];
      looks(who);
      if
      :: pst[who] == BIDDING && !NEWER(who) -> leave(who)
      :: else
      fi;
      if
      :: lun[who] <= NOW(who) + KNOWS_LATER && RAN_OUT(who) -> expire(who)
      :: else
      fi;
      CHECK(MAY_BID(who), "it may not bid");
      CHECK(state[m_c] != NONE && m_r <= round[m_c], "a bid in no round");
      CHECK(m_i == inst[who], "a bid of another start");
      bid(who)
    fi
  :: kind == CONFIRMATION ->
    if
    :: deciding[who] != 0 ->
      m_c = sv_c[who]; m_r = sv_r[who]; m_w = sv_w[who]; m_s = sv_s[who]; m_u = sv_u[who]; m_n = sv_n[who];
      many = sv_many[who]; ok = deciding[who] - 1;
      deciding[who] = 0;
      if
      :: m_x == 1 && ok && fst[who] == AUTHORISED -> passed_on_at[who] = clk
      :: else
      fi;
      if
      :: m_x == 1 -> accept(who)
      :: else -> refuse(who)
      fi
    :: else -> CHECK(pc[who] == m_c + 1 && pr[who] == m_r && answered[who] == m_x, "it confirms what it was not awarded")
    fi
  :: kind == STATUS && who < V ->
    if
    :: lt[who] == m_t + 1 && pc[who] == m_c + 1 && pr[who] == m_r ->
      if
      :: m_x == S_STARTED && !begun[who] ->
        CHECK(pst[who] == MEMBER && lun[who] > NOW(who), "it begins without a lease");
        if
        :: IS_DELIVERY(m_t) ->
          if
          :: fst[who] == PLANNED && clk - passed_on_at[who] < 1500000 -> fst[who] = AUTHORISED
          :: else
          fi;
          CHECK(MAY_COMMIT(who), "it passes its gate without a grant, or without a lease to the end");
          CHECK(!flown[m_t], "a delivery is flown twice");
          flown[m_t] = true
        :: else
        fi;
        begun[who] = true; fst[who] = BEGUN
      :: m_x == S_DONE -> CHECK(begun[who], "done, and never begun"); finish(who, S_DONE)
      :: m_x == S_FAILED ->
        if
        :: pst[who] == ORPHANED -> no_successor(who)
        :: else -> finish(who, S_FAILED)
        fi
      :: else
      fi
    :: else -> CHECK(m_x != S_DONE || really_done[m_t], "done, and never flown")
    fi
  :: kind == CLAIM ->
    looks(who);
    CHECK(m_v == who && pln[who] == m_c + 1 && elec[who], "it is no elector");
    CHECK(m_s == NOW(who), "another time");
    clk = clk + ROUNDED;
    CHECK(MAY_CLAIM(who), "its promise is not over");
    clk = clk - ROUNDED;
    claim(who)
  :: kind == ALLEGIANCE ->
    CHECK(m_v == who && told_c[who] == m_c && told_x[who] == m_x && told_s[who] == m_s && m_i == inst[who], "it follows another")
  :: kind == REQUEST -> CHECK(m_v == who && state[m_c] == EXECUTING && m_r == round[m_c], "no plan to ask for");
    asked_for[m_c] = asked_for[m_c] | ONLY(m_r % ROUNDS)
  :: kind == DECISION -> CHECK(m_x == 0 || IN(asked_for[m_c], m_r % ROUNDS), "granted, and never asked for")
  :: else
  fi
}

inline heard() {
  kind = kind - 20;
  if
  :: !alive[who] -> c_code { refuse("who is not there hears"); }
  :: kind == BID && LEADS(who, m_c) -> approach[M(m_c, m_v)] = (IN(bids[m_c], m_v) && m_r == round[m_c] -> approach[M(m_c, m_v)] : m_u); on_bid(m_c)
  :: kind == AWARD ->
    judge_award(who);
    if
    :: best == 2 -> leave(who)
    :: best == 3 ->
      deciding[who] = ok + 1; sv_many[who] = many;
      sv_c[who] = m_c; sv_r[who] = m_r; sv_w[who] = m_w; sv_s[who] = m_s; sv_u[who] = m_u; sv_n[who] = m_n;
      for (q : 0 .. T - 1) { sv_times[who * T + q] = m_times[q] }
    :: else
    fi
  :: kind == CONFIRMATION && LEADS(who, m_c) -> on_confirmation(m_c)
  :: kind == CANCEL -> on_cancel(who)
  :: kind == RENEWAL -> participant_on_renewal(who)
  :: kind == STATUS ->
    m_n = m_c + 1;
    for (lk : 0 .. C - 1) {
      if
      :: LEADS(who, lk) -> on_status(lk)
      :: else
      fi
    };
    if
    :: m_x == S_DONE && pln[who] == m_c + 1 -> known_done[who] = known_done[who] | ONLY(m_t)
    :: else
    fi
  :: kind == CLAIM -> on_claim(who)
  :: kind == ALLEGIANCE ->
    if
    :: LEADS(who, m_c) -> on_allegiance_leader(m_c)
    :: else
    fi;
    on_allegiance_claimant(who)
  :: kind == DECISION ->
    m_u = (lt[who] != 0 -> m_times[lt[who] - 1] : 0);
    on_decision(who);
    on_decision_leader(who)
  :: else
  fi;
  if
  :: begun[who] && fend[who] <= NOW(who) -> skip  /* it says that first, before it looks at its lease */
  :: else -> looks(who)
  fi
}

inline told() {
  if
  :: kind == 40 -> crash(who); deciding[who] = 0
  :: kind == 41 -> restart(who)
  :: kind == 42 ->
    if
    :: pst[who] == BIDDING -> leave(who)
    :: pst[who] == ORPHANED -> no_successor(who)
    :: pst[who] == MEMBER -> looks(who);
      CHECK(pst[who] == FREE, "it bids elsewhere, and is a member")
    :: else
    fi;
    pc[who] = 0; pr[who] = 0; answered[who] = 0
  :: kind == 50 -> m_s = (lt[who] == m_t + 1 -> lun[who] : over_u[who]) - skew[who];
    CHECK((lt[who] == m_t + 1 || over_t[who] == m_t + 1) && m_s - m_u <= ROUNDED && m_u - m_s <= ROUNDED, "another lease")
  :: kind == 51 && lt[who] == m_t + 1 && pc[who] == m_c + 1 && pr[who] == m_r ->
    if
    :: m_x == 1 && pst[who] == ORPHANED && m_n == 1 -> skip
    :: m_x == 1 && pst[who] != ORPHANED ->
      CHECK(lun[who] <= NOW(who), "its lease has not run out");
      expire(who);
      CHECK((pst[who] == ORPHANED) == (m_n == 1), "it holds its plan for a successor, or does not")
    :: m_x == 2 -> CHECK(begun[who], "done, and never begun"); finish(who, S_DONE)
    :: m_x == 3 -> finish(who, S_FAILED)
    :: else ->
      CHECK(pst[who] == ORPHANED, "its lease has ended for no reason of the model's");
      no_successor(who)
    fi
  :: kind == 52 && pc[who] == m_c + 1 && pr[who] == m_r && pst[who] != FREE -> withdraw(who)
  :: kind == 53 -> CHECK(fst[who] != PLANNED && fst[who] != 0, "it takes for granted what is not")
  :: kind == 56 && lt[who] == m_t + 1 && fst[who] != BEGUN -> fst[who] = LATE
  :: kind == 54 && m_x == 1 && state[m_c] != CLOSED -> leader_looks(m_c); CHECK(ownership[E(m_c, m_t)] != LEASED || eround[E(m_c, m_t)] != m_r, "given up before its lease was over")
  :: kind == 55 && state[m_c] != CLOSED -> leader_looks(m_c); CHECK(ownership[E(m_c, m_t)] == UNKNOWN, "unknown, and it is not")
  :: else
  fi
}

/* Before a trace nothing is, and every vehicle's program has begun. */
inline begin() {
  for (lk : 0 .. C - 1) {
    leader[lk] = 1; lead(lk, 0, 0); state[lk] = NONE; leader[lk] = 0; round[lk] = 0; owes[lk] = false; called[lk] = 0; asked_for[lk] = 0;
    majority[lk] = 0;
    for (q : 0 .. V - 1) { ack[M(lk, q)] = NEVER; elinst[M(lk, q)] = 0; approach[M(lk, q)] = 0; awarded_at[M(lk, q)] = NEVER }
  };
  for (lk : 0 .. V - 1) {
    alive[lk] = true; crash(lk); alive[lk] = true; inst[lk] = 1; deciding[lk] = 0; passed_on_at[lk] = NEVER
  };
  for (q : 0 .. T - 1) { flown[q] = false; really_done[q] = false }
  clk = 0
}

/* Row by row; nothing is left to chance, so each row is one step. */
init {
  atomic {
    do
    :: c_code {
        lk = 0;
        if (scanf("%31s", word) == 1) {
          lk = strcmp(word, "mission") == 0 ? 1 : strcmp(word, "site") == 0 ? 2 : strcmp(word, "end") == 0 ? 3 : 4;
        }
        if (lk == 1) {
          int n, i;
          if (scanf("%31s %d", mission, &n) != 2) lk = 0;
          for (i = 0; i < n; ++i) if (scanf("%d", &now.skew[i]) != 1) lk = 0;
        }
        if (lk == 2) {
          if (scanf("%ld %d %d", &site, &tasks, &deliveries) != 3) lk = 0;
          refusal = 0; row = 0;
        }
        if (lk == 3) {
          if (refusal) { ++rejected; } else { ++accepted; }
        }
        if (lk == 4) {
          int i;
          kind = atoi(word); ++row; ++rows;
          for (i = 1; i < 16; ++i) if (scanf("%d", &f[i]) != 1) lk = 0;
          who = f[1]; clk = f[2]; m_c = f[3]; m_r = f[4]; m_v = f[5]; m_t = f[6]; m_x = f[7]; m_i = f[8]; m_n = f[9];
          m_a = f[10]; m_b = f[11]; m_d = f[12]; m_w = f[13]; m_s = f[14]; m_u = f[15];
          if (kind < 40 && (kind % 20 == 3 || kind % 20 == 11))
            for (i = 0; i < 7; ++i) if (scanf("%d", &m_times[i]) != 1) lk = 0;
          if (refusal) lk = 5;
        }
      };
      if
      :: lk == 0 -> break
      :: lk == 2 -> d_step { begin(); skip }
      :: lk == 4 ->
        if
        :: kind == ANNOUNCEMENT || kind == AWARD || kind == CANCEL || kind == RENEWAL -> d_step { leader_said(); skip }
        :: kind < 20 && kind != ANNOUNCEMENT && kind != AWARD && kind != CANCEL && kind != RENEWAL -> d_step { member_said(); skip }
        :: kind >= 20 && kind < 40 -> d_step { heard(); skip }
        :: else -> d_step { told(); skip }
        fi;
        c_code { if (refusal) printf("rejected: mission %s, site %ld, row %ld (%d of vehicle %d at %.3f s): %s\n", mission, site, row, kind, who + 1, clk * 1e-6, refusal); }
      :: else
      fi
    od;
    c_code { printf("%ld traces of %ld rows accepted, %ld rejected\n", accepted, rows, rejected); fflush(stdout); exit(rejected != 0); }
  }
}
