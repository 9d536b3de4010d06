#include "dram/dram.h"

#include "machine/section.h"
#include "trax/gcd.h"

#include <stdlib.h>

static uint64_t latest(uint64_t a, uint64_t b) {
  return a > b ? a : b;
}

/* --- ticks and cycles --- */

__extension__ typedef unsigned __int128 wide;

/* number * numerator / denominator; the factors are below 2^18 */
static uint64_t scaled(uint64_t number, uint64_t numerator, uint64_t denominator, bool up) {
  const uint64_t rest = up ? denominator - 1 : 0;
  if (number < (uint64_t)1 << 44)
    return (number * numerator + rest) / denominator;
  return (uint64_t)(((wide)number * numerator + rest) / denominator);
}

/* The first tick of cycle t. */
static uint64_t first_tick(const struct trax_dram *dram, uint64_t t) {
  return scaled(t, dram->ticks, dram->cycles, true);
}

/* The first cycle that begins at the tick or after it. */
static uint64_t cycle_from(const struct trax_dram *dram, uint64_t tick) {
  return scaled(tick, dram->cycles, dram->ticks, true);
}

/* --- creation --- */

static bool create_channel(struct trax_dram_channel *channel, const struct trax_dram *dram) {
  const struct trax_config *config = dram->config;
  const uint32_t ranks = config->dram.ranks, banks = ranks * config->dram.banks;
  for (unsigned queue = 0; queue < TRAX_DRAM_QUEUES; queue++)
    channel->request[queue] = calloc(dram->capacity[queue], sizeof *channel->request[queue]);
  channel->rank = calloc(ranks, sizeof *channel->rank);
  channel->bank = calloc(banks, sizeof *channel->bank);
  if (!channel->request[TRAX_DRAM_READ] || !channel->request[TRAX_DRAM_WRITE] || !channel->rank || !channel->bank)
    return false;
  for (uint32_t i = 0; i < ranks; i++)
    channel->rank[i].refresh_due = (uint64_t)config->dram.trefi * (i + 1) / ranks;
  for (uint32_t i = 0; i < banks; i++)
    channel->bank[i].row = TRAX_DRAM_NO_ROW;
  return true;
}

struct trax_dram *trax_dram_create(const struct trax_config *config, struct trax_dram_stats *stats, trax_error *error) {
  struct trax_dram *dram = calloc(1, sizeof *dram);
  const uint64_t ticks = config->dram.mtps, cycles = 2 * (uint64_t)config->chip.clock_mhz;
  const uint64_t divisor = trax_gcd(ticks, cycles);
  bool complete = dram && (dram->channel = calloc(config->memory.channels, sizeof *dram->channel)) != NULL;
  if (complete) {
    dram->config = config;
    dram->stats = stats;
    dram->ticks = ticks / divisor;
    dram->cycles = cycles / divisor;
    dram->burst_bytes = config->dram.bus_bits / 8 * config->dram.burst_length;
    dram->burst = config->dram.burst_length / 2;
    dram->ahead = config->dram.trp + config->dram.trcd + config->dram.tcl;
    dram->capacity[TRAX_DRAM_READ] = config->dram.reads;
    dram->capacity[TRAX_DRAM_WRITE] = config->dram.writes;
    complete = trax_dram_map_create(&dram->map, config, error) == TRAX_OK;
  }
  for (uint32_t i = 0; complete && i < config->memory.channels; i++)
    complete = create_channel(&dram->channel[i], dram);
  if (complete)
    return dram;
  trax_fail(error, "out of memory for the DRAM");
  trax_dram_destroy(dram);
  return NULL;
}

void trax_dram_destroy(struct trax_dram *dram) {
  for (uint32_t i = 0; dram && dram->channel && dram->config && i < dram->config->memory.channels; i++) {
    for (unsigned queue = 0; queue < TRAX_DRAM_QUEUES; queue++)
      free(dram->channel[i].request[queue]);
    free(dram->channel[i].rank);
    free(dram->channel[i].bank);
  }
  free(dram ? dram->channel : NULL);
  free(dram);
}

/* --- requests --- */

uint32_t trax_dram_channel_of(const struct trax_dram *dram, uint32_t address) {
  return trax_dram_place_of(&dram->map, address).field[TRAX_DRAM_CHANNEL];
}

void trax_dram_bring(struct trax_dram *dram, enum trax_dram_queue queue, uint32_t id, uint32_t address, uint32_t bytes,
                     uint64_t t) {
  const struct trax_dram_place place = trax_dram_place_of(&dram->map, address);
  struct trax_dram_channel *channel = &dram->channel[place.field[TRAX_DRAM_CHANNEL]];
  channel->request[queue][channel->count[queue]++] = (struct trax_dram_request){
      .came = first_tick(dram, t),
      .id = id,
      .row = place.field[TRAX_DRAM_ROW],
      .bank = place.field[TRAX_DRAM_RANK] * dram->config->dram.banks + place.field[TRAX_DRAM_BANK],
      .bursts = bytes / dram->burst_bytes};
}

/* --- commands --- */

/* The earliest commands of a request from tick `now` on. */
static struct trax_dram_commands plan(const struct trax_dram *dram, const struct trax_dram_channel *channel,
                                      const struct trax_dram_request *request, enum trax_dram_queue queue,
                                      uint64_t now) {
  const struct trax_config *config = dram->config;
  const struct trax_dram_bank *bank = &channel->bank[request->bank];
  const uint32_t rank_number = request->bank / config->dram.banks;
  const struct trax_dram_rank *rank = &channel->rank[rank_number];
  const bool reads = queue == TRAX_DRAM_READ;
  struct trax_dram_commands commands = {.activates = bank->row != request->row};
  if (commands.activates) {
    commands.activate = latest(latest(now, bank->activate_from),
                               latest(rank->activate_from, rank->window_from[rank->activations % TRAX_DRAM_WINDOW]));
    commands.precharges = bank->row != TRAX_DRAM_NO_ROW;
    if (commands.precharges) {
      commands.precharge = latest(now, bank->precharge_from);
      commands.activate = latest(commands.activate, commands.precharge + config->dram.trp);
    }
    commands.access = commands.activate + config->dram.trcd;
  } else {
    commands.access = latest(now, bank->access_from);
  }
  if (reads)
    commands.access = latest(commands.access, rank->read_from);
  const uint32_t latency = reads ? config->dram.tcl : config->dram.tcwl;
  const bool turns = channel->last_queue != queue || channel->last_rank != rank_number;
  commands.data = latest(commands.access + latency, channel->free_from + (turns ? config->dram.tturn : 0));
  commands.access = commands.data - latency;
  commands.over = commands.data + (uint64_t)request->bursts * dram->burst;
  return commands;
}

static void perform(struct trax_dram *dram, struct trax_dram_channel *channel, const struct trax_dram_request *request,
                    enum trax_dram_queue queue, const struct trax_dram_commands *commands) {
  const struct trax_config *config = dram->config;
  struct trax_dram_bank *bank = &channel->bank[request->bank];
  struct trax_dram_rank *rank = &channel->rank[request->bank / config->dram.banks];
  if (commands->activates) {
    bank->row = request->row;
    bank->access_from = commands->activate + config->dram.trcd;
    bank->precharge_from = commands->activate + config->dram.tras;
    rank->activate_from = commands->activate + config->dram.trrd;
    rank->window_from[rank->activations++ % TRAX_DRAM_WINDOW] = commands->activate + config->dram.tfaw;
  }
  const uint64_t last_access = commands->access + (uint64_t)(request->bursts - 1) * dram->burst;
  if (queue == TRAX_DRAM_READ) {
    bank->precharge_from = latest(bank->precharge_from, last_access + config->dram.trtp);
    dram->stats->reads += request->bursts;
  } else {
    bank->precharge_from = latest(bank->precharge_from, commands->over + config->dram.twr);
    rank->read_from = commands->over + config->dram.twtr;
    dram->stats->writes += request->bursts;
  }
  channel->free_from = commands->over;
  channel->last_queue = queue;
  channel->last_rank = request->bank / config->dram.banks;
  dram->stats->activates += commands->activates;
  dram->stats->conflicts += commands->precharges;
  dram->stats->row_hits += !commands->activates;
}

/* Performs the refreshes that are due in tick `now`. */
static void refresh(struct trax_dram *dram, struct trax_dram_channel *channel, uint64_t now) {
  const struct trax_config *config = dram->config;
  for (uint32_t i = 0; config->dram.trefi && i < config->dram.ranks; i++) {
    struct trax_dram_rank *rank = &channel->rank[i];
    if (rank->refresh_due > now)
      continue;
    const uint64_t earlier = (now - rank->refresh_due) / config->dram.trefi;
    uint64_t begin = rank->refresh_due + earlier * config->dram.trefi;
    rank->refresh_due = begin + config->dram.trefi;
    dram->stats->refreshes += earlier + 1;
    struct trax_dram_bank *banks = &channel->bank[(size_t)i * config->dram.banks];
    uint64_t precharge = begin;
    bool open = false;
    for (uint32_t bank = 0; bank < config->dram.banks; bank++)
      if (banks[bank].row != TRAX_DRAM_NO_ROW) {
        open = true;
        precharge = latest(precharge, banks[bank].precharge_from);
      } else {
        begin = latest(begin, banks[bank].activate_from);
      }
    if (open)
      begin = latest(begin, precharge + config->dram.trp);
    for (uint32_t bank = 0; bank < config->dram.banks; bank++) {
      banks[bank].row = TRAX_DRAM_NO_ROW;
      banks[bank].activate_from = begin + config->dram.trfc;
    }
  }
}

/* --- the choice --- */

/* Chooses between reads and writes in tick `now`. While reads wait, a batch of writes follows a read. */
static enum trax_dram_queue choose_queue(const struct trax_dram *dram, struct trax_dram_channel *channel,
                                         uint64_t now) {
  const struct trax_config *config = dram->config;
  const uint32_t writes = channel->count[TRAX_DRAM_WRITE], reads = channel->count[TRAX_DRAM_READ];
  if (!writes) {
    channel->batch = 0;
    return TRAX_DRAM_READ;
  }
  if (!channel->batch) {
    const bool waited = channel->request[TRAX_DRAM_WRITE]->came + config->dram.write_wait <= now;
    if (reads && (channel->last_queue == TRAX_DRAM_WRITE || (writes < config->dram.batch_from && !waited)))
      return TRAX_DRAM_READ;
    channel->batch = writes >= config->dram.batch_from ? writes - config->dram.batch_to : 1;
  }
  channel->batch--;
  return TRAX_DRAM_WRITE;
}

/* Chooses a request of the queue by first ready, first come, first served: the oldest to an open row, or else the one
   whose data begin first. Returns its place in the queue. */
static uint32_t choose(const struct trax_dram *dram, const struct trax_dram_channel *channel,
                       enum trax_dram_queue queue, uint64_t now) {
  const struct trax_dram_request *requests = channel->request[queue];
  if (channel->overtaken[queue] >= dram->config->dram.cap)
    return 0;
  for (uint32_t i = 0; i < channel->count[queue]; i++)
    if (channel->bank[requests[i].bank].row == requests[i].row)
      return i;
  uint32_t first = 0;
  uint64_t data = UINT64_MAX;
  for (uint32_t i = 0; i < channel->count[queue]; i++) {
    const uint64_t begins = plan(dram, channel, &requests[i], queue, now).data;
    if (begins < data) {
      data = begins;
      first = i;
    }
  }
  return first;
}

bool trax_dram_serve(struct trax_dram *dram, uint32_t number, uint64_t t, struct trax_dram_served *served) {
  struct trax_dram_channel *channel = &dram->channel[number];
  if (!channel->count[TRAX_DRAM_READ] && !channel->count[TRAX_DRAM_WRITE])
    return false;
  const uint64_t from = channel->free_from > dram->ahead ? channel->free_from - dram->ahead : 0;
  const uint64_t now = latest(first_tick(dram, t), from);
  if (now >= first_tick(dram, t + 1))
    return false;
  refresh(dram, channel, now);
  const enum trax_dram_queue queue = choose_queue(dram, channel, now);
  const uint32_t chosen = choose(dram, channel, queue, now);
  struct trax_dram_request *requests = channel->request[queue];
  served->commands = plan(dram, channel, &requests[chosen], queue, now);
  perform(dram, channel, &requests[chosen], queue, &served->commands);
  served->id = requests[chosen].id;
  served->over = cycle_from(dram, served->commands.over);
  channel->overtaken[queue] = chosen ? channel->overtaken[queue] + 1 : 0;
  channel->count[queue]--;
  for (uint32_t i = chosen; i < channel->count[queue]; i++)
    requests[i] = requests[i + 1];
  return true;
}

uint64_t trax_dram_next_cycle(const struct trax_dram *dram, uint32_t number) {
  const struct trax_dram_channel *channel = &dram->channel[number];
  if (!channel->count[TRAX_DRAM_READ] && !channel->count[TRAX_DRAM_WRITE])
    return UINT64_MAX;
  const uint64_t from = channel->free_from > dram->ahead ? channel->free_from - dram->ahead : 0;
  return scaled(from, dram->cycles, dram->ticks, false);
}

uint64_t trax_dram_idle_from(const struct trax_dram *dram, uint32_t number) {
  return cycle_from(dram, dram->channel[number].free_from);
}

/* --- states read from files --- */

/* A bound of the ticks that a request takes, if requests are served one after the other. */
static uint64_t most_ticks(const struct trax_dram *dram) {
  const struct trax_config *config = dram->config;
  const uint64_t commands = (uint64_t)config->dram.trcd + config->dram.trp + config->dram.tcl + config->dram.tcwl +
                            config->dram.tras + config->dram.trrd + config->dram.tfaw + config->dram.twtr +
                            config->dram.twr + config->dram.trtp + config->dram.tturn + config->dram.trfc;
  return 2 * (commands + (uint64_t)(config->dram.row_bytes / dram->burst_bytes + 1) * dram->burst);
}

static bool check_queue(const struct trax_dram *dram, const struct trax_dram_channel *channel,
                        enum trax_dram_queue queue, uint64_t now) {
  const uint32_t banks = dram->config->dram.ranks * dram->config->dram.banks;
  bool good = channel->count[queue] <= dram->capacity[queue];
  for (uint32_t i = 0; good && i < channel->count[queue]; i++) {
    const struct trax_dram_request *request = &channel->request[queue][i];
    good = request->bank < banks && request->bursts > 0 &&
           request->bursts <= dram->config->dram.row_bytes / dram->burst_bytes + 1 && request->came <= now &&
           (i == 0 || request[-1].came <= request->came);
  }
  return good;
}

bool trax_dram_check(const struct trax_dram *dram, uint32_t number, uint64_t t, uint64_t requests) {
  const struct trax_dram_channel *channel = &dram->channel[number];
  const struct trax_config *config = dram->config;
  if (t >= (uint64_t)1 << 44)
    return false;
  const uint64_t last = first_tick(dram, t) + requests * most_ticks(dram);
  bool good = check_queue(dram, channel, TRAX_DRAM_READ, first_tick(dram, t)) &&
              check_queue(dram, channel, TRAX_DRAM_WRITE, first_tick(dram, t)) && channel->free_from <= last &&
              channel->last_rank < config->dram.ranks && channel->last_queue < TRAX_DRAM_QUEUES &&
              channel->batch <= TRAX_DRAM_MAX_QUEUE;
  for (unsigned queue = 0; queue < TRAX_DRAM_QUEUES; queue++)
    good &= channel->overtaken[queue] <= config->dram.cap;
  for (uint32_t i = 0; good && i < config->dram.ranks; i++) {
    const struct trax_dram_rank *rank = &channel->rank[i];
    good = rank->activate_from <= last && rank->read_from <= last && rank->refresh_due <= last + config->dram.trefi;
    for (unsigned j = 0; j < TRAX_DRAM_WINDOW; j++)
      good &= rank->window_from[j] <= last;
  }
  for (uint32_t i = 0; good && i < config->dram.ranks * config->dram.banks; i++) {
    const struct trax_dram_bank *bank = &channel->bank[i];
    good = bank->activate_from <= last && bank->access_from <= last && bank->precharge_from <= last;
  }
  return good;
}

/* --- the state --- */

void trax_dram_visit(const struct trax_dram *dram, const struct trax_visitor *visitor) {
  const struct trax_config *config = dram->config;
  TRAX_VISIT_ALL(trax_dram_channel, TRAX_DRAM_CHANNEL_STATE, dram->channel, config->memory.channels);
  for (uint32_t i = 0; i < config->memory.channels; i++) {
    struct trax_dram_channel *channel = &dram->channel[i];
    for (unsigned queue = 0; queue < TRAX_DRAM_QUEUES; queue++)
      TRAX_VISIT_ALL(trax_dram_request, TRAX_DRAM_REQUEST_STATE, channel->request[queue], dram->capacity[queue]);
    TRAX_VISIT_ALL(trax_dram_rank, TRAX_DRAM_RANK_STATE, channel->rank, config->dram.ranks);
    TRAX_VISIT_ALL(trax_dram_bank, TRAX_DRAM_BANK_STATE, channel->bank, config->dram.ranks * config->dram.banks);
  }
}
