/* docs/timing-memory.md, "DRAM", without an engine: commands computed by hand, every command of random requests against
   the rules, and rates against formulas and the figures of data sheets. */
#include "bench.h"

#include "dram/dram.h"
#include "generate.h"
#include "host/dram_presets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROW = 1 << 15, BANK = 1 << 12, LINE = 64 }; /* bytes, by the default mapping with one channel and rank */

/* A tick is a cycle. Times are those of the defaults: trcd 15, trp 15, tcl 12, tcwl 6, tras 34, trrd 8, tfaw 40, twtr
   6, twr 12, trtp 6, tturn 2; a line takes 8 ticks. */
static struct trax_config by_hand(void) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  config.memory.model = TRAX_MEMORY_DRAM;
  config.dram.mtps = 1000;
  config.dram.trefi = 0;
  return config;
}

struct fixture {
  struct trax_config config;
  struct trax_dram_stats stats;
  struct trax_dram *dram;
  uint64_t t;
  struct trax_dram_served served; /* the latest */
};

static struct fixture *begin(const struct trax_config *config) {
  struct fixture *fixture = calloc(1, sizeof *fixture);
  trax_error error;
  fixture->config = *config;
  if (trax_config_validate(config, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  fixture->dram = trax_dram_create(&fixture->config, &fixture->stats, &error);
  assert_non_null(fixture->dram);
  return fixture;
}

static void end(struct fixture *fixture) {
  trax_dram_destroy(fixture->dram);
  free(fixture);
}

static void bring(struct fixture *fixture, enum trax_dram_queue queue, uint32_t id, uint32_t address) {
  trax_dram_bring(fixture->dram, queue, id, address, LINE, fixture->t);
}

/* Serves the next request of channel 0 in the first cycle in which it can be; returns its id. */
static uint32_t serve(struct fixture *fixture) {
  const uint64_t next = trax_dram_next_cycle(fixture->dram, 0);
  if (next > fixture->t && next != UINT64_MAX) {
    assert_false(trax_dram_serve(fixture->dram, 0, next - 1, &fixture->served)); /* not before */
    fixture->t = next;
  }
  assert_true(trax_dram_serve(fixture->dram, 0, fixture->t, &fixture->served));
  return fixture->served.id;
}

/* Brings a request, serves it, and compares the ticks of its commands; NO: there must be no such command. */
enum { NO = -1 };
static void expect(struct fixture *fixture, enum trax_dram_queue queue, uint32_t address, int64_t precharge,
                   int64_t activate, uint64_t access, uint64_t data, uint64_t over) {
  bring(fixture, queue, 7, address);
  assert_int_equal(serve(fixture), 7);
  const struct trax_dram_commands *commands = &fixture->served.commands;
  assert_int_equal(commands->precharges ? (int64_t)commands->precharge : NO, precharge);
  assert_int_equal(commands->activates ? (int64_t)commands->activate : NO, activate);
  assert_int_equal(commands->access, access);
  assert_int_equal(commands->data, data);
  assert_int_equal(commands->over, over);
}

static void test_commands_by_hand(void **state) {
  (void)state;
  const struct trax_config config = by_hand();
  struct fixture *one = begin(&config);
  expect(one, TRAX_DRAM_READ, 0, NO, 0, 15, 27, 35);
  expect(one, TRAX_DRAM_READ, LINE, NO, NO, 23, 35, 43);          /* an open row: after the data before */
  expect(one, TRAX_DRAM_READ, BANK, NO, 8, 31, 43, 51);           /* another bank: trrd; the bus decides */
  expect(one, TRAX_DRAM_READ, ROW, 34, 49, 64, 76, 84);           /* another row: tras, trp */
  expect(one, TRAX_DRAM_WRITE, ROW + LINE, NO, NO, 80, 86, 94);   /* tturn */
  expect(one, TRAX_DRAM_READ, ROW, NO, NO, 100, 112, 120);        /* twtr */
  expect(one, TRAX_DRAM_READ, 2 * ROW, 110, 125, 140, 152, 160);  /* trtp, after the last access in 104 */
  expect(one, TRAX_DRAM_WRITE, 2 * ROW, NO, NO, 156, 162, 170);   /* tturn again */
  expect(one, TRAX_DRAM_WRITE, 3 * ROW, 182, 197, 212, 218, 226); /* twr */
  assert_int_equal(one->stats.activates, 5);
  assert_int_equal(one->stats.conflicts, 3);
  assert_int_equal(one->stats.row_hits, 4);
  assert_int_equal(one->stats.reads, 12);
  assert_int_equal(one->stats.writes, 6);
  end(one);
}

static void test_window_of_four_activations(void **state) {
  (void)state;
  const struct trax_config config = by_hand();
  struct fixture *one = begin(&config);
  static const uint64_t activations[] = {0, 8, 16, 24, 40, 48, 56, 64, 80};
  for (uint32_t i = 0; i < 8; i++) {
    const uint64_t access = activations[i] + 15, data = access + 12;
    expect(one, TRAX_DRAM_READ, i * BANK, NO, (int64_t)activations[i], access, data, data + 8);
  }
  end(one);
}

static void test_ranks(void **state) {
  (void)state;
  struct trax_config config = by_hand();
  config.dram.ranks = 2;
  struct fixture *one = begin(&config);
  expect(one, TRAX_DRAM_READ, 0, NO, 0, 15, 27, 35);
  expect(one, TRAX_DRAM_READ, 8 * BANK, NO, 0, 25, 37, 45); /* the other rank: no trrd, but tturn */
  expect(one, TRAX_DRAM_WRITE, 8 * BANK, NO, NO, 41, 47, 55);
  expect(one, TRAX_DRAM_READ, LINE, NO, NO, 45, 57, 65); /* no twtr */
  end(one);
}

static void test_refresh(void **state) {
  (void)state;
  struct trax_config config = by_hand();
  config.dram.trefi = 200;
  config.dram.trfc = 50;
  struct fixture *one = begin(&config);
  expect(one, TRAX_DRAM_READ, 0, NO, 0, 15, 27, 35);
  one->t = 199;
  expect(one, TRAX_DRAM_READ, 0, NO, NO, 199, 211, 219); /* not due yet */
  assert_int_equal(one->stats.refreshes, 0);
  one->t = 201; /* due in 200; the row can be closed in 203 + 6 + 15 */
  expect(one, TRAX_DRAM_READ, 0, NO, 274, 289, 301, 309);
  assert_int_equal(one->stats.refreshes, 1);
  one->t = 1010; /* due in 400, 600, 800, 1000: the last one takes time */
  expect(one, TRAX_DRAM_READ, 0, NO, 1065, 1080, 1092, 1100);
  assert_int_equal(one->stats.refreshes, 5);
  end(one);
}

static void expect_order(struct fixture *fixture, const char *ids) {
  for (; *ids; ids++)
    assert_int_equal(serve(fixture), *ids);
  assert_true(trax_dram_next_cycle(fixture->dram, 0) == UINT64_MAX);
}

static void order_with_cap(uint32_t cap, const char *ids) {
  struct trax_config config = by_hand();
  config.dram.cap = cap;
  struct fixture *one = begin(&config);
  bring(one, TRAX_DRAM_READ, 'a', 0);
  assert_int_equal(serve(one), 'a'); /* opens row 0 of bank 0 */
  bring(one, TRAX_DRAM_READ, 'r', ROW);
  bring(one, TRAX_DRAM_READ, 'b', 2 * BANK); /* its data can begin before those of r */
  bring(one, TRAX_DRAM_READ, 'h', LINE);
  bring(one, TRAX_DRAM_READ, 'i', 2 * LINE);
  bring(one, TRAX_DRAM_READ, 'j', 3 * LINE);
  expect_order(one, ids);
  end(one);
}

static void test_first_ready_with_a_cap(void **state) {
  (void)state;
  order_with_cap(16, "hijbr");
  order_with_cap(4, "hijbr");
  order_with_cap(3, "hijrb");
  order_with_cap(2, "hirbj"); /* r closes the row of j */
  order_with_cap(1, "hrbij");
  order_with_cap(0, "rbhij");
}

static void test_batches_of_writes(void **state) {
  (void)state;
  struct trax_config config = by_hand();
  config.dram.writes = 8;
  config.dram.batch_from = 4;
  config.dram.batch_to = 1;
  struct fixture *one = begin(&config);
  for (uint32_t i = 0; i < 3; i++)
    bring(one, TRAX_DRAM_WRITE, 'A' + i, i * LINE);
  for (uint32_t i = 0; i < 3; i++)
    bring(one, TRAX_DRAM_READ, 'a' + i, BANK + i * LINE);
  expect_order(one, "abcABC"); /* too few writes for a batch, until no read waits */
  for (uint32_t i = 0; i < 8; i++)
    bring(one, TRAX_DRAM_WRITE, 'A' + i, i * LINE);
  for (uint32_t i = 0; i < 3; i++)
    bring(one, TRAX_DRAM_READ, 'a' + i, BANK + i * LINE);
  expect_order(one, "aABCDEFGbcH"); /* after a read, a batch that leaves one */
  end(one);

  config.dram.write_wait = 20;
  one = begin(&config);
  bring(one, TRAX_DRAM_WRITE, 'A', 0);
  for (uint32_t i = 0; i < 12; i++)
    bring(one, TRAX_DRAM_READ, 'a' + i, BANK + i * LINE);
  /* The n-th request is chosen in tick 8 n - 23 from the third on, so the sixth in tick 25. */
  expect_order(one, "abcdeAfghijkl");
  end(one);
}

static void test_ticks_and_cycles(void **state) {
  (void)state;
  struct trax_config config = by_hand();
  config.dram.mtps = 1600; /* 8 ticks in 5 cycles */
  struct fixture *one = begin(&config);
  one->t = 1; /* from tick 2 on */
  bring(one, TRAX_DRAM_READ, 1, 0);
  serve(one);
  assert_int_equal(one->served.commands.activate, 2);
  assert_int_equal(one->served.commands.over, 37);
  assert_int_equal(one->served.over, 24); /* 23.125 */
  assert_int_equal(trax_dram_idle_from(one->dram, 0), 24);
  assert_true(trax_dram_check(one->dram, 0, one->t, 1));
  end(one);
  one = begin(&config); /* so late that ticks times cycles have more than 64 bits */
  one->t = UINT64_C(5) << 59;
  bring(one, TRAX_DRAM_READ, 1, 0);
  assert_true(trax_dram_serve(one->dram, 0, one->t, &one->served));
  assert_true(one->served.commands.activate == UINT64_C(8) << 59);
  assert_true(one->served.commands.over == (UINT64_C(8) << 59) + 35);
  assert_true(one->served.over == one->t + 22);           /* 21.875 */
  assert_false(trax_dram_check(one->dram, 0, one->t, 1)); /* in a checkpoint, no cycle is that late */
  end(one);
}

static void test_mappings(void **state) {
  (void)state;
  struct trax_config config = by_hand();
  struct trax_dram_map map;
  config.memory.channels = 2;
  config.dram.ranks = 2;
  assert_int_equal(trax_dram_map_create(&map, &config, NULL), TRAX_OK);
  /* From the lowest bit: 5 of the burst, 3 of the column, 1 channel, 4 of the column, 3 banks, 1 rank. */
  struct trax_dram_place place = trax_dram_place_of(&map, 5u << 17 | 1u << 16 | 6u << 13 | 9u << 9 | 1u << 8 | 3u << 5);
  assert_int_equal(place.field[TRAX_DRAM_ROW], 5);
  assert_int_equal(place.field[TRAX_DRAM_RANK], 1);
  assert_int_equal(place.field[TRAX_DRAM_BANK], 6);
  assert_int_equal(place.field[TRAX_DRAM_CHANNEL], 1);
  assert_int_equal(place.field[TRAX_DRAM_COLUMN], 9 << 3 | 3);
  /* Whole bursts of 32 bytes are moved. */
  assert_int_equal(trax_dram_bytes(&config, 31, 1), 32);
  assert_int_equal(trax_dram_bytes(&config, 32, 32), 32);
  assert_int_equal(trax_dram_bytes(&config, 28, 8), 64);
  static const struct {
    const char *mapping, *message;
  } wrong[] = {{"row:rank:bank:channel:column3", "column lacks 4 of its 7 bits"},
               {"row:rank:bank:column", "channel lacks 1"},
               {"row:rank:bank:column:channel:column", "one part without a number at most"},
               {"row:rank:bank:column:channel:column8", "column has 7 bits"},
               {"row:rank:bank:column:channel", "32 bytes lie together"},
               {"rank:bank:column:channel:column2", "row lacks 15"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    trax_error error;
    assert_true(trax_dram_mapping_parse(wrong[i].mapping, &config.dram.mapping));
    assert_int_equal(trax_config_validate(&config, &error), TRAX_ERROR);
    if (!strstr(error.message, wrong[i].message) || !strstr(error.message, wrong[i].mapping))
      fail_msg("%s: %s", wrong[i].mapping, error.message);
  }
  static const char *const none[] = {
      "",          "row",        "rows",     "row:",  ":row",
      "row:bank0", "row:bank16", "row bank", "row3x", "row:rank:bank:column:channel:column1:column1:column1"};
  for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
    double value;
    if (trax_dram_mapping_parse(none[i], &value) != (strcmp(none[i], "row") == 0))
      fail_msg("\"%s\"", none[i]);
  }
}

/* --- random requests against the rules --- */

struct done {
  uint32_t rank, bank, row;
  bool writes, activates;
  uint64_t precharge, activate, access, last_access, data, over;
};

struct log {
  struct done *done; /* [count] */
  size_t count;
};

struct waiting {
  uint32_t id, rank, bank, row, bursts;
  uint64_t came;
};

static uint64_t most(uint64_t a, uint64_t b) {
  return a > b ? a : b;
}

/* The commands of a request as the table of the page has them, from all commands so far. `closed`: of the rank, the end
   of the latest refresh and the index of the first request after it. */
struct closed {
  uint64_t until;
  size_t since;
};

static struct done predict(const struct log *log, const struct trax_config *config, const struct closed *closed,
                           const struct waiting *request, bool writes, uint64_t k) {
  const uint32_t b = config->dram.burst_length / 2;
  struct done next = {.rank = request->rank, .bank = request->bank, .row = request->row, .writes = writes};
  const struct done *latest = NULL; /* of the bank, since its rank was refreshed */
  uint64_t activation = k, precharge = k, access = k;
  uint32_t activations = 0;
  uint64_t activated = 0;
  for (size_t i = log->count; i-- > 0;) {
    const struct done *other = &log->done[i];
    if (other->rank != request->rank)
      continue;
    if (other->activates) {
      activations++;
      if (activations == 1)
        activation = most(activation, other->activate + config->dram.trrd);
      if (activations == 4)
        activation = most(activation, other->activate + config->dram.tfaw);
    }
    if (other->writes && !writes)
      access = most(access, other->over + config->dram.twtr);
    if (other->bank != request->bank || i < closed[request->rank].since)
      continue;
    if (!latest)
      latest = other;
    if (other->row == latest->row && other->activates)
      activated = most(activated, other->activate);
    precharge =
        most(precharge, other->writes ? other->over + config->dram.twr : other->last_access + config->dram.trtp);
    if (other->activates)
      precharge = most(precharge, other->activate + config->dram.tras);
  }
  activation = most(activation, closed[request->rank].until);
  next.activates = !latest || latest->row != request->row;
  if (next.activates) {
    next.precharge = latest ? precharge : 0;
    next.activate = latest ? most(activation, precharge + config->dram.trp) : activation;
    activated = next.activate;
  }
  access = most(access, activated + config->dram.trcd);
  const struct done *before = log->count ? &log->done[log->count - 1] : NULL;
  const bool turns = before ? before->writes != writes || before->rank != request->rank : writes || request->rank;
  const uint32_t latency = writes ? config->dram.tcwl : config->dram.tcl;
  next.data = most(access + latency, (before ? before->over : 0) + (turns ? config->dram.tturn : 0));
  next.access = next.data - latency;
  next.last_access = next.access + (uint64_t)(request->bursts - 1) * b;
  next.over = next.data + (uint64_t)request->bursts * b;
  return next;
}

static void refresh(const struct log *log, const struct trax_config *config, struct closed *closed, uint64_t *seen,
                    uint64_t k) {
  for (uint32_t rank = 0; config->dram.trefi && rank < config->dram.ranks; rank++) {
    uint64_t due = (uint64_t)config->dram.trefi * (rank + 1) / config->dram.ranks;
    if (due > k)
      continue;
    due += (k - due) / config->dram.trefi * config->dram.trefi;
    if (seen[rank] == due)
      continue;
    seen[rank] = due;
    uint64_t begins = most(due, closed[rank].until);
    for (size_t i = closed[rank].since; i < log->count; i++) {
      const struct done *done = &log->done[i];
      bool open = done->rank == rank;
      for (size_t j = i + 1; j < log->count; j++) /* a later row of the bank has closed this one */
        open &= log->done[j].rank != rank || log->done[j].bank != done->bank || log->done[j].row == done->row;
      if (!open)
        continue;
      begins = most(begins, due + config->dram.trp);
      begins = most(begins, config->dram.trp +
                                (done->writes ? done->over + config->dram.twr : done->last_access + config->dram.trtp));
      if (done->activates)
        begins = most(begins, config->dram.trp + done->activate + config->dram.tras);
    }
    closed[rank] = (struct closed){begins + config->dram.trfc, log->count};
  }
}

/* The request that the page chooses. */
static size_t choice(const struct log *log, const struct trax_config *config, const struct closed *closed,
                     const struct waiting *waiting, size_t count, bool writes, uint32_t overtaken, uint64_t k) {
  size_t first = 0;
  uint64_t begins = UINT64_MAX;
  if (overtaken >= config->dram.cap)
    return 0;
  for (size_t i = 0; i < count; i++)
    if (!predict(log, config, closed, &waiting[i], writes, k).activates)
      return i;
  for (size_t i = 0; i < count; i++) {
    const uint64_t data = predict(log, config, closed, &waiting[i], writes, k).data;
    if (data < begins) {
      begins = data;
      first = i;
    }
  }
  return first;
}

static struct trax_config any_dram_config(void) {
  struct trax_config config;
  do
    config = any_config(1, 1);
  while (config.memory.model != TRAX_MEMORY_DRAM);
  config.memory.channels = 1;
  config.chip.clock_mhz = any(1, 1000);
  config.dram.mtps = any(config.chip.clock_mhz, 6 * config.chip.clock_mhz); /* half a tick to three in a cycle */
  return config;
}

static void random_requests(uint32_t rounds) {
  const struct trax_config config = any_dram_config();
  if (trax_config_validate(&config, NULL) != TRAX_OK)
    return; /* the mapping lacks the channel's bits */
  struct fixture *one = begin(&config);
  struct log log = {.done = calloc(rounds, sizeof *log.done)};
  struct waiting queue[2][TRAX_DRAM_MAX_QUEUE];
  size_t count[2] = {0};
  struct closed closed[TRAX_DRAM_MAX_RANKS] = {{0}};
  uint64_t seen[TRAX_DRAM_MAX_RANKS];
  uint32_t overtaken[2] = {0}, batch = 0, id = 0;
  memset(seen, 0xFF, sizeof seen);
  const uint64_t numerator = config.dram.mtps, denominator = 2 * (uint64_t)config.chip.clock_mhz;
  const uint32_t span = any_power(1024, 1u << 20), busy = any(1, 4);
  while (log.count < rounds) {
    for (uint32_t n = any(0, 3); n > 0 && any(0, 3) < busy; n--) {
      const unsigned kind = any(0, 2) == 0;
      if (!trax_dram_has_place(one->dram, 0, kind))
        continue;
      const uint32_t address = any(0, span - 1) & ~63u, bytes = any(1, 64);
      const uint32_t moved = trax_dram_bytes(&config, address, bytes);
      const struct trax_dram_place place = trax_dram_place_of(&one->dram->map, address);
      trax_dram_bring(one->dram, kind, ++id, address, moved, one->t);
      queue[kind][count[kind]++] = (struct waiting){.id = id,
                                                    .rank = place.field[TRAX_DRAM_RANK],
                                                    .bank = place.field[TRAX_DRAM_BANK],
                                                    .row = place.field[TRAX_DRAM_ROW],
                                                    .bursts = moved / one->dram->burst_bytes,
                                                    .came = (one->t * numerator + denominator - 1) / denominator};
    }
    const uint64_t now = (one->t * numerator + denominator - 1) / denominator;
    const uint64_t then = ((one->t + 1) * numerator + denominator - 1) / denominator;
    while (log.count < rounds) {
      const uint64_t free_from = log.count ? log.done[log.count - 1].over : 0;
      const uint64_t ahead = config.dram.trp + config.dram.trcd + config.dram.tcl;
      const uint64_t k = most(now, free_from > ahead ? free_from - ahead : 0);
      const bool serves = count[0] + count[1] > 0 && k < then;
      assert_int_equal(trax_dram_serve(one->dram, 0, one->t, &one->served), serves);
      if (!serves)
        break;
      refresh(&log, &config, closed, seen, k);
      bool writes = batch > 0 && count[1];
      if (!writes && count[1]) {
        const bool after_write = log.count && log.done[log.count - 1].writes;
        const bool due = count[1] >= config.dram.batch_from || queue[1][0].came + config.dram.write_wait <= k;
        writes = !count[0] || (!after_write && due);
        batch = !writes ? 0 : count[1] >= config.dram.batch_from ? (uint32_t)count[1] - config.dram.batch_to : 1;
      }
      batch = writes ? batch - 1 : 0;
      const size_t chosen = choice(&log, &config, closed, queue[writes], count[writes], writes, overtaken[writes], k);
      const struct done done = predict(&log, &config, closed, &queue[writes][chosen], writes, k);
      assert_int_equal(one->served.id, queue[writes][chosen].id);
      assert_int_equal(one->served.commands.over, done.over);
      assert_int_equal(one->served.commands.access, done.access);
      assert_int_equal(one->served.commands.activates ? one->served.commands.activate : 0, done.activate);
      assert_int_equal(one->served.commands.precharges ? one->served.commands.precharge : 0, done.precharge);
      assert_int_equal(one->served.over, (done.over * denominator + numerator - 1) / numerator);
      log.done[log.count++] = done;
      overtaken[writes] = chosen ? overtaken[writes] + 1 : 0;
      memmove(&queue[writes][chosen], &queue[writes][chosen + 1], (--count[writes] - chosen) * sizeof **queue);
    }
    one->t += any(0, 20) ? 1 : any(1, 4000);
  }
  free(log.done);
  end(one);
}

static void test_random_requests(void **state) {
  (void)state;
  for (uint32_t seed = 1; seed <= 300; seed++) {
    random_state = seed * 0x9E3779B97F4A7C15u;
    random_requests(150);
  }
}

/* --- rates --- */

enum { REQUESTS = 40000 };

/* The ticks of many reads whose addresses `next` gives, if the queue is always full. */
static double ticks_of(const struct trax_config *config, uint32_t (*next)(uint32_t i)) {
  struct fixture *one = begin(config);
  uint32_t brought = 0;
  for (uint32_t served = 0; served < REQUESTS; served++) {
    for (; brought < REQUESTS && trax_dram_has_place(one->dram, 0, TRAX_DRAM_READ); brought++)
      bring(one, TRAX_DRAM_READ, brought, next(brought));
    const uint64_t cycle = trax_dram_next_cycle(one->dram, 0);
    one->t = cycle > one->t ? cycle : one->t;
    assert_true(trax_dram_serve(one->dram, 0, one->t, &one->served));
  }
  const double ticks = (double)one->served.commands.over;
  end(one);
  return ticks;
}

static uint32_t in_a_row(uint32_t i) {
  return i * LINE;
}

static uint32_t rows_of_a_bank(uint32_t i) {
  return i % 60000 * ROW;
}

static uint32_t anywhere(uint32_t i) {
  (void)i;
  return any(0, 0x3FFFFFFF) & ~63u;
}

static struct trax_config standard(const char *name) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  trax_error error;
  config.memory.model = TRAX_MEMORY_DRAM;
  if (trax_dram_preset_apply(&config, name, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  return config;
}

static const char *const standards[] = {"lpddr2-1066", "lpddr3-1600", "lpddr4-3200"};

static void test_rates(void **state) {
  (void)state;
  for (size_t i = 0; i < 3; i++) {
    struct trax_config config = standard(standards[i]);
    config.memory.channels = 1;
    const double line = LINE * 8.0 / config.dram.bus_bits / 2; /* ticks of the bus */
    const double refreshed = (double)config.dram.trfc / config.dram.trefi;
    /* A stream: the peak, but for each refresh. */
    const double peak = REQUESTS * line, stream = ticks_of(&config, in_a_row);
    const double lost = config.dram.trfc + config.dram.tras + 2 * config.dram.trp + config.dram.trcd + config.dram.tcl;
    assert_true(stream >= peak && stream <= peak / (1 - lost / config.dram.trefi));
    /* Rows of one bank: a row cycle each. */
    config.dram.trefi = 0;
    const double cycle = config.dram.tras + config.dram.trp;
    assert_true(fabs(ticks_of(&config, rows_of_a_bank) / REQUESTS / cycle - 1) < 0.001);
    /* Anywhere: four activations in a window, or the bus; never faster, and nearly as fast. */
    random_state = 88172645463325252u;
    const double bound = fmax(config.dram.tfaw / 4.0, line), random = ticks_of(&config, anywhere) / REQUESTS;
    print_message("%s: stream %.4f of the peak, refresh alone %.4f; random %.3f ticks, bound %.3f\n", standards[i],
                  peak / stream, 1 - refreshed, random, bound);
    assert_true(peak / stream > 0.95 * (1 - refreshed));
    assert_true(random >= bound * 0.9999 && random < bound * 1.15);
  }
}

/* Data sheets: peak bandwidth, row cycle, and the power of their loops of commands (mA at VDD1 and VDD2). */
static void test_data_sheets(void **state) {
  (void)state;
  static const struct {
    double gbps, trc_ns, vdd[2], idd0[2], idd4r[2], idd4w[2], idd5_mj;
  } sheets[] = {{8.528, 58, {1.8, 1.2}, {15, 70}, {3, 220}, {10, 190}, 0},
                {12.8, 60, {1.8, 1.2}, {8, 60}, {2, 230}, {2, 190}, 0},
                {25.6, 60.6, {1.8, 1.1}, {3.5, 45}, {2.25, 275}, {2.25, 210}, 0}};
  for (size_t i = 0; i < 3; i++) {
    const struct trax_config config = standard(standards[i]);
    const double ns = 2000.0 / config.dram.mtps; /* of a tick */
    const double trc = (config.dram.tras + config.dram.trp) * ns, burst = config.dram.burst_length / 2 * ns;
    assert_true(fabs(trax_memory_gbps(&config) - sheets[i].gbps) < 1e-9);
    assert_true(trc >= sheets[i].trc_ns - 0.5 && trc < sheets[i].trc_ns * 1.03);
#define POWER(IDD) (sheets[i].vdd[0] * sheets[i].IDD[0] + sheets[i].vdd[1] * sheets[i].IDD[1])
    /* Reading and writing without a pause, mW. */
    assert_true(fabs(config.dram.read_nj / burst * 1e3 + config.dram.background_mw - POWER(idd4r)) < 1);
    assert_true(fabs(config.dram.write_nj / burst * 1e3 + config.dram.background_mw - POWER(idd4w)) < 1);
    /* A row cycle after the other: more by what the bank saves while it is closed, which the background does not. */
    const double cycles = config.dram.activate_nj / trc * 1e3 + config.dram.background_mw;
    assert_true(cycles > POWER(idd0) * 0.97 && cycles < POWER(idd0) * 1.06);
#undef POWER
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_commands_by_hand),
                                     cmocka_unit_test(test_window_of_four_activations),
                                     cmocka_unit_test(test_ranks),
                                     cmocka_unit_test(test_refresh),
                                     cmocka_unit_test(test_first_ready_with_a_cap),
                                     cmocka_unit_test(test_batches_of_writes),
                                     cmocka_unit_test(test_ticks_and_cycles),
                                     cmocka_unit_test(test_mappings),
                                     cmocka_unit_test(test_random_requests),
                                     cmocka_unit_test(test_rates),
                                     cmocka_unit_test(test_data_sheets)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
