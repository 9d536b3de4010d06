/* The model: each TP takes slot after slot, and the accesses of a slot one after another. All other instructions count
   as the duration of an access, which grows with the number of TPs that compete in the TM. A line that misses in the
   data cache arrives after those that were requested before, at the memory's bandwidth. These effects decide how cycles
   differ between parts of a picture. Arbitration, banks, instruction fetches and single units are left out. */
#include "prediction.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Cycles of a node's visit by a TP, alone in its TM and with all TPs at work; the others are relative to a node's.
   They were fitted once to the device program on the paper's chips. What matters is their relation to a miss. */
#define NODE_ALONE 45.0
#define NODE_CROWDED 137.0
#define TRIANGLE_NODES 1.5
#define RAY_NODES 2

enum {
  CHUNK = 1 << 20, /* steps that are collected before the model continues */
  SLOT_BYTES = 12, /* of a slot's atomic increment and pixel */
  TRIANGLE_BYTES = sizeof(struct trax_triangle),
  PAUSE = 2 /* a step without an access that takes as long */
};

struct trace {
  size_t begin, end; /* in steps */
  uint32_t number;   /* of the slot in its queue */
};

struct queue {
  struct trace *traces; /* [capacity]: slots that wait to be taken */
  size_t count, capacity, taken;
  uint32_t handed_out; /* slots, those that are no pixels included */
};

/* A TM. */
struct tm {
  double clock;
  double *wake;    /* [tps]: when the TP takes its next step; DBL_MAX: never */
  uint32_t *queue; /* [tps]: where it takes its slots */
  uint32_t first_queue;
  const trax_access **next; /* [tps] */
  const trax_access **end;  /* [tps] */
  uint32_t *line;           /* [sets * ways]: + 1; of a set the latest used or the latest loaded first */
  double *ready;            /* [sets * ways]: when it arrived */
};

struct model {
  struct trax_access_log log; /* first: the twin passes its address */
  trax_access *steps;         /* [capacity] */
  size_t capacity, begin;     /* of the present slot */
  struct queue *queues;       /* [queue_count] */
  uint32_t queue_count, tile_bits;
  uint32_t slots, place; /* how many there are, and how many were handed out */
  bool failed;
  uint64_t rays;

  double latency; /* of memory */
  bool by_use;    /* lines are replaced by when they were used, not by when they came */
  uint32_t line_bytes, ways, tms, tps, set_mask, noted; /* noted: blocks that are */
  unsigned line_shift;
  uint32_t address;
  double bus_free, cycles_per_byte;
  struct tm *tm; /* [tms] */
  struct trax_prediction *prediction;
};

/* --- the model --- */

/* The time when a transfer that is requested now arrives. */
static double transfer(struct model *model, double now, uint32_t bytes) {
  model->bus_free = (model->bus_free > now ? model->bus_free : now) + bytes * model->cycles_per_byte;
  return model->bus_free + model->latency;
}

/* The time when the data at an address can be used. */
static double load(struct model *model, struct tm *tm, uint32_t address, double now) {
  const uint32_t ways = model->ways, number = address >> model->line_shift;
  uint32_t *lines = tm->line + (size_t)(number & model->set_mask) * ways;
  double *ready = tm->ready + (size_t)(number & model->set_mask) * ways;
  uint32_t way = 0;
  while (way < ways && lines[way] != number + 1)
    way++;
  const bool hit = way < ways;
  const double time = hit ? ready[way] : transfer(model, now, model->line_bytes);
  if (hit && !model->by_use)
    return time;
  for (way = hit ? way : ways - 1; way > 0; way--) {
    lines[way] = lines[way - 1];
    ready[way] = ready[way - 1];
  }
  lines[0] = number + 1;
  ready[0] = time;
  return time;
}

static void note_block(struct model *model, double now) {
  double *cycles = model->prediction->cycles;
  cycles[model->noted] = model->noted && cycles[model->noted - 1] > now ? cycles[model->noted - 1] : now;
  uint32_t *handed_out = model->prediction->handed_out + (size_t)model->noted * model->queue_count;
  for (uint32_t i = 0; i < model->queue_count; i++)
    handed_out[i] = model->queues[i].handed_out;
  model->noted++;
}

/* Notes that a queue hands out its slot `number` now. */
static void hand_out(struct model *model, struct queue *queue, uint32_t number, double now) {
  while (model->noted * TRAX_PREDICTION_BLOCK <= model->place + (number - queue->handed_out)) {
    const uint32_t more = model->noted * TRAX_PREDICTION_BLOCK - model->place;
    queue->handed_out += more;
    model->place += more;
    note_block(model, now);
  }
  model->place += number + 1 - queue->handed_out;
  queue->handed_out = number + 1;
}

/* The next slot for a TP, or NULL. */
static const struct trace *take_slot(struct model *model, const struct tm *tm, uint32_t tp, double now) {
  for (;;) {
    struct queue *queue = &model->queues[tm->queue[tp]];
    if (queue->taken < queue->count) {
      const struct trace *trace = &queue->traces[queue->taken++];
      hand_out(model, queue, trace->number, now);
      return trace;
    }
    tm->queue[tp] = tm->queue[tp] + 1 < model->queue_count ? tm->queue[tp] + 1 : 0;
    if (tm->queue[tp] == tm->first_queue)
      return NULL;
  }
}

/* Takes the TP's next step, which lasts `node` cycles if it is a node's. Returns when the following one begins. */
static double step(struct model *model, struct tm *tm, uint32_t tp, double now, double node) {
  if (tm->next[tp] == tm->end[tp]) {
    const struct trace *trace = take_slot(model, tm, tp, now);
    if (!trace)
      return DBL_MAX;
    tm->next[tp] = model->steps + trace->begin;
    tm->end[tp] = model->steps + trace->end;
    return transfer(model, now, SLOT_BYTES);
  }
  const trax_access access = *tm->next[tp]++;
  const uint32_t address = model->address + (access & ~7u);
  double duration = node, loaded = 0;
  if (access & TRAX_ACCESS_TRIANGLE) {
    duration *= TRIANGLE_NODES;
    loaded = load(model, tm, address, now);
    if ((address ^ (address + TRIANGLE_BYTES - 1)) >> model->line_shift) {
      const double second = load(model, tm, address + TRIANGLE_BYTES - 1, now);
      loaded = second > loaded ? second : loaded;
    }
  } else if (!(access & PAUSE)) {
    loaded = load(model, tm, address, now);
  }
  return (loaded > now ? loaded : now) + duration;
}

/* All TPs of a TM that are due take a step. */
static void go_round(struct model *model, struct tm *tm) {
  const double now = tm->clock;
  uint32_t active = 0;
  for (uint32_t tp = 0; tp < model->tps; tp++)
    active += tm->wake[tp] <= now;
  const double node = NODE_ALONE + (NODE_CROWDED - NODE_ALONE) * active / model->tps;
  double next = DBL_MAX;
  for (uint32_t tp = 0; tp < model->tps; tp++) {
    if (tm->wake[tp] <= now)
      tm->wake[tp] = step(model, tm, tp, now, node);
    next = tm->wake[tp] < next ? tm->wake[tp] : next;
  }
  const double least = now + NODE_ALONE; /* TPs that are ready at about the same time go together */
  tm->clock = next < least ? least : next;
}

/* Whether there are slots for all TPs of a TM that may take one. */
static bool has_slots(const struct model *model, const struct tm *tm) {
  const struct queue *queue = &model->queues[tm->first_queue];
  return queue->count - queue->taken > model->tps;
}

/* Advances while there are slots for all TPs; with `last`, to the end. */
static void advance(struct model *model, bool last) {
  for (;;) {
    struct tm *tm = &model->tm[0];
    for (uint32_t i = 1; i < model->tms; i++)
      if (model->tm[i].clock < tm->clock)
        tm = &model->tm[i];
    if (tm->clock == DBL_MAX || (!last && !has_slots(model, tm)))
      return;
    go_round(model, tm);
  }
}

/* --- the log --- */

/* Moves the steps that will be read again to a new array, with room behind them. */
static void compact(struct model *model) {
  size_t left = (size_t)(model->log.end - model->steps);
  size_t unread = model->begin;
  for (uint32_t i = 0; i < model->queue_count; i++) {
    const struct queue *queue = &model->queues[i];
    if (queue->taken < queue->count && queue->traces[queue->taken].begin < unread)
      unread = queue->traces[queue->taken].begin;
  }
  left -= unread;
  for (uint32_t i = 0; i < model->tms; i++)
    for (uint32_t tp = 0; tp < model->tps; tp++)
      left += (size_t)(model->tm[i].end[tp] - model->tm[i].next[tp]);
  while (left > model->capacity / 2)
    model->capacity *= 2;
  trax_access *steps = malloc(model->capacity * sizeof *steps), *to = steps;
  if (!steps) { /* further accesses are dropped */
    model->failed = true;
    model->begin = 0;
    for (uint32_t i = 0; i < model->queue_count; i++)
      model->queues[i].count = model->queues[i].taken = 0;
    model->capacity = (size_t)(model->log.limit - model->steps);
    model->log.end = model->steps;
    return;
  }
  for (uint32_t i = 0; i < model->tms; i++)
    for (uint32_t tp = 0; tp < model->tps; tp++) {
      const size_t count = (size_t)(model->tm[i].end[tp] - model->tm[i].next[tp]);
      if (count)
        memcpy(to, model->tm[i].next[tp], count * sizeof *to);
      model->tm[i].next[tp] = to;
      model->tm[i].end[tp] = to += count;
    }
  const size_t place = (size_t)(to - steps), count = (size_t)(model->log.end - model->steps) - unread;
  memcpy(to, model->steps + unread, count * sizeof *to);
  for (uint32_t i = 0; i < model->queue_count; i++) {
    struct queue *queue = &model->queues[i];
    size_t traces = 0;
    for (size_t j = queue->taken; j < queue->count; j++) {
      const struct trace *trace = &queue->traces[j];
      queue->traces[traces++] =
          (struct trace){trace->begin - unread + place, trace->end - unread + place, trace->number};
    }
    queue->count = traces;
    queue->taken = 0;
  }
  model->begin = model->begin - unread + place;
  free(model->steps);
  model->steps = steps;
  model->log.end = to + count;
  model->log.limit = steps + model->capacity;
}

static void make_room(struct trax_access_log *log) {
  struct model *model = (struct model *)log;
  advance(model, false);
  compact(model);
}

static void end_slot(struct trax_access_log *log, uint32_t slot, uint32_t rays) {
  struct model *model = (struct model *)log;
  model->rays += rays;
  for (uint32_t i = 0; i < rays * RAY_NODES; i++) {
    if (log->end == log->limit)
      make_room(log);
    *log->end++ = PAUSE;
  }
  const uint32_t tile = slot >> model->tile_bits, round = tile / model->queue_count;
  struct queue *queue = &model->queues[tile - round * model->queue_count];
  if (queue->count == queue->capacity) {
    const size_t capacity = queue->capacity ? 2 * queue->capacity : 4096;
    struct trace *traces = realloc(queue->traces, capacity * sizeof *traces);
    if (!traces) {
      model->failed = true;
      return;
    }
    queue->traces = traces;
    queue->capacity = capacity;
  }
  const size_t end = (size_t)(log->end - model->steps);
  const uint32_t number = round << model->tile_bits | (slot & ((1u << model->tile_bits) - 1));
  queue->traces[queue->count++] = (struct trace){model->begin, end, number};
  model->begin = end;
}

/* Hands out the slots behind the last pixels. */
static void end_blocks(struct model *model) {
  const uint32_t slots = model->slots, tile = 1u << model->tile_bits, tiles = slots >> model->tile_bits;
  for (uint32_t i = 0; i < model->queue_count; i++) {
    const uint32_t most = (tiles + model->queue_count - 1 - i) / model->queue_count * tile;
    if (most > model->queues[i].handed_out)
      hand_out(model, &model->queues[i], most - 1, model->bus_free);
  }
  while (model->noted <= model->prediction->blocks)
    note_block(model, model->bus_free);
}

/* --- the whole --- */

static bool make_tm(struct tm *tm, uint32_t number, const struct model *model) {
  const size_t lines = (size_t)(model->set_mask + 1) * model->ways;
  tm->first_queue = number % model->queue_count;
  tm->wake = calloc(model->tps, sizeof *tm->wake);
  tm->queue = calloc(model->tps, sizeof *tm->queue);
  tm->next = calloc(model->tps, sizeof *tm->next);
  tm->end = calloc(model->tps, sizeof *tm->end);
  tm->line = calloc(lines, sizeof *tm->line);
  tm->ready = calloc(lines, sizeof *tm->ready);
  if (!tm->wake || !tm->queue || !tm->next || !tm->end || !tm->line || !tm->ready)
    return false;
  for (uint32_t tp = 0; tp < model->tps; tp++) {
    tm->queue[tp] = tm->first_queue;
    tm->next[tp] = tm->end[tp] = model->steps;
  }
  return true;
}

static trax_status begin_model(struct model *model, struct trax_prediction *prediction, const struct trax_frame *frame,
                               uint32_t queues, const struct trax_config *config, uint32_t scene_address,
                               trax_error *error) {
  const uint32_t slots = frame->params->slot_count;
  const uint32_t line_bytes = (uint32_t)trax_config_get(config, "dcache.line_bytes");
  const uint32_t ways = (uint32_t)trax_config_get(config, "dcache.ways");
  const double bytes_per_microsecond = 1000 * trax_config_get(config, "memory.bandwidth_gbps");
  *prediction = (struct trax_prediction){.blocks = (slots + TRAX_PREDICTION_BLOCK - 1) / TRAX_PREDICTION_BLOCK};
  *model = (struct model){.log = {.full = make_room, .slot = end_slot},
                          .capacity = CHUNK,
                          .queue_count = queues,
                          .slots = slots,
                          .tile_bits = 2 * frame->params->tile_log2_side,
                          .latency = trax_config_get(config, "memory.latency_cycles"),
                          .by_use = strcmp(trax_config_word(config, "dcache.replacement"), "fifo") != 0,
                          .line_bytes = line_bytes,
                          .ways = ways,
                          .tms = (uint32_t)trax_config_get(config, "chip.tms"),
                          .tps = (uint32_t)trax_config_get(config, "chip.tps_per_tm"),
                          .set_mask = (uint32_t)trax_config_get(config, "dcache.bytes") / line_bytes / ways - 1,
                          .line_shift = (unsigned)__builtin_ctz(line_bytes),
                          .address = scene_address,
                          .cycles_per_byte = trax_config_get(config, "chip.clock_mhz") / bytes_per_microsecond,
                          .prediction = prediction};
  prediction->cycles = calloc(prediction->blocks + 1, sizeof *prediction->cycles);
  prediction->handed_out = calloc(((size_t)prediction->blocks + 1) * queues, sizeof *prediction->handed_out);
  model->queues = calloc(queues, sizeof *model->queues);
  model->steps = malloc(model->capacity * sizeof *model->steps);
  model->tm = calloc(model->tms, sizeof *model->tm);
  bool made = prediction->cycles && prediction->handed_out && model->queues && model->steps && model->tm;
  for (uint32_t i = 0; i < model->tms && made; i++)
    made = make_tm(&model->tm[i], i, model);
  model->log.end = model->steps;
  model->log.limit = model->steps + model->capacity;
  return made ? TRAX_OK : trax_fail(error, "out of memory for the prediction");
}

static void end_model(struct model *model) {
  for (uint32_t i = 0; model->tm && i < model->tms; i++) {
    struct tm *tm = &model->tm[i];
    free(tm->wake);
    free(tm->queue);
    free(tm->next);
    free(tm->end);
    free(tm->line);
    free(tm->ready);
  }
  free(model->tm);
  for (uint32_t i = 0; model->queues && i < model->queue_count; i++)
    free(model->queues[i].traces);
  free(model->queues);
  free(model->steps);
}

trax_status trax_predict(struct trax_prediction *prediction, struct trax_picture *picture,
                         const struct trax_frame *frame, uint32_t queues, const struct trax_config *config,
                         uint32_t scene_address, struct trax_render_run *run, trax_error *error) {
  struct model model;
  struct trax_render_run logged = *run;
  trax_status status = begin_model(&model, prediction, frame, queues, config, scene_address, error);
  logged.accesses = &model.log;
  if (status == TRAX_OK)
    status = trax_render_twin(picture, frame, 1, &logged, error);
  if (status == TRAX_OK && model.failed) {
    trax_picture_release(picture);
    status = trax_fail(error, "out of memory for the prediction");
  }
  if (status == TRAX_OK) {
    advance(&model, false);
    advance(&model, true);
    end_blocks(&model);
    run->rays = model.rays;
    memcpy(run->kinds, logged.kinds, sizeof run->kinds);
  } else {
    trax_prediction_release(prediction);
  }
  end_model(&model);
  return status;
}

/* Whether the model has this part of the machine: cores, lines, the bus and its latency. */
static bool is_modelled(const char *key) {
  static const char *const modelled[] = {"chip.",           "dcache.bytes",         "dcache.line_bytes",
                                         "dcache.ways",     "dcache.replacement",   "memory.bandwidth_gbps",
                                         "memory.size_mib", "memory.latency_cycles"};
  for (size_t i = 0; i < sizeof modelled / sizeof *modelled; i++)
    if (strncmp(key, modelled[i], strlen(modelled[i])) == 0)
      return true;
  return false;
}

const char *trax_prediction_doubt(const struct trax_frame *frame, bool other_program,
                                  const struct trax_config *config) {
  if (other_program)
    return "another program";
  if (frame->params->features & TRAX_PATH_FEATURES)
    return "another workload";
  const char *changed = trax_config_next_change(config, NULL);
  while (changed && is_modelled(changed))
    changed = trax_config_next_change(config, changed);
  return changed;
}

void trax_prediction_release(struct trax_prediction *prediction) {
  free(prediction->cycles);
  free(prediction->handed_out);
  *prediction = (struct trax_prediction){0};
}
