/* Waits by what is waited for: the instruction that wrote the register, a load in most cases, and the object that it
   accessed. A wait is charged to the instruction that needs the register (profile.c); here it has both. A load or store
   that another TP keeps from its bank of the data cache waits for its own access. So the columns add up to the
   statistics. */
#include "explain/objects.h"
#include "explain/page.h"
#include "explain/places.h"
#include "machine/timing.h"
#include "trax/grow.h"
#include "trax/map.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum {
  WAITS = TRAX_CAUSE_DATA_OTHER - TRAX_CAUSE_DATA_LOCAL + 1, /* columns: waits for a register, then for a bank */
  BANK = WAITS,
  COLUMNS
};

enum { SLOW_ACCESS = TRAX_NUM_REGISTERS };

/* The instruction that a thread's register waits for. */
struct writer {
  uint32_t index, address;
  bool accesses;
};

struct record {
  uint32_t awaited, object, waiting; /* indices of instructions; object: its number + 1, 0: none */
  uint64_t cycles[COLUMNS];
};

struct waits {
  struct trax_reader reader;
  struct writer (*writers)[TRAX_NUM_REGISTERS]; /* [threads] */
  struct record *records;
  size_t count, capacity;
  struct trax_map pair_of, record_of;   /* (awaited, waiting) to a number; (this number, object) to that of a record */
  uint32_t *latest_of;                  /* [places]: the latest record of the waiting instruction, + 1 */
  const struct trax_region **region_of; /* [places]: of the latest access of the instruction that was waited for */
  bool hits_are_awaited;                /* else the result of a load that hits is usable at once */
  uint8_t *slow;      /* [places]: the register, if it may be waited for, + SLOW_ACCESS of a memory access */
  uint32_t *others;   /* [places + 1]: of the instructions before, those that are waited for without global memory */
  uint32_t *other_at; /* these instructions */
};

static struct record *record_of(struct waits *waits, struct record wanted) {
  uint32_t *latest = &waits->latest_of[wanted.waiting];
  struct record *record = *latest ? &waits->records[*latest - 1] : NULL;
  if (record && record->awaited == wanted.awaited && record->object == wanted.object)
    return record;
  const struct trax_map_entry *entry = trax_map_put(
      &waits->pair_of, sizeof *entry, (uint64_t)wanted.awaited << 32 | wanted.waiting, (uint32_t)waits->pair_of.count);
  entry = entry ? trax_map_put(&waits->record_of, sizeof *entry, (uint64_t)entry->value << 32 | wanted.object,
                               (uint32_t)waits->count)
                : NULL;
  if (!entry || !trax_grow((void **)&waits->records, waits->count, &waits->capacity, sizeof *waits->records)) {
    waits->reader.explain->out_of_memory = true;
    return NULL;
  }
  const uint32_t number = entry->value;
  if (number == waits->count)
    waits->records[waits->count++] = wanted;
  *latest = number + 1;
  return &waits->records[number];
}

static void add(struct waits *waits, const struct writer *awaited, uint32_t waiting, unsigned column, uint64_t cycles) {
  const uint32_t object = awaited->accesses
                              ? (uint32_t)trax_objects_region_again(&waits->reader.explain->objects, awaited->address,
                                                                    &waits->region_of[awaited->index])
                                        ->number +
                                    1
                              : 0;
  struct record *record =
      record_of(waits, (struct record){.awaited = awaited->index, .object = object, .waiting = waiting});
  if (record)
    record->cycles[column] += cycles;
}

/* The part of a passage whose writes are known. */
struct written {
  const struct trax_piece *piece;
  const struct trax_accessed *accessed, *accessed_end;
  uint32_t at, of_piece; /* the number of the next instruction, and of the piece's first */
};

static void write_other(const struct waits *waits, struct writer *writers, uint32_t index) {
  const uint8_t slow = waits->slow[index];
  writers[slow % TRAX_NUM_REGISTERS] = (struct writer){index, TRAX_LOCAL_BASE, slow >= SLOW_ACCESS};
}

/* Notes the writes of `count` neighbouring instructions, from `first` on, if they may be waited for. */
static void write_some(const struct waits *waits, struct writer *writers, struct written *written, uint32_t first,
                       uint32_t count) {
  const uint32_t *other = waits->other_at + waits->others[first], *const end =
                                                                      waits->other_at + waits->others[first + count];
  for (; written->accessed < written->accessed_end && written->accessed->at < written->at + count;
       written->accessed++) {
    const uint32_t index = first + (written->accessed->at - written->at);
    for (; other < end && *other < index; other++)
      write_other(waits, writers, *other);
    other += other < end && *other == index;
    if (waits->hits_are_awaited || written->accessed->outcome != TRAX_OUTCOME_HIT)
      writers[waits->slow[index] % TRAX_NUM_REGISTERS] = (struct writer){index, written->accessed->address, true};
  }
  for (; other < end; other++)
    write_other(waits, writers, *other);
}

static void write_up_to(const struct waits *waits, struct writer *writers, struct written *written, uint32_t end) {
  while (written->at < end) {
    const uint32_t begin = written->at - written->of_piece, left = written->piece->count - begin,
                   count = end - written->at < left ? end - written->at : left;
    write_some(waits, writers, written, written->piece->index + begin, count);
    written->at += count;
    if (count == left)
      written->of_piece += written->piece++->count;
  }
}

static void add_passage(void *self, const struct trax_passage *passage) {
  struct waits *waits = self;
  struct writer *writers = waits->writers[passage->thread];
  const struct trax_accessed *own = passage->accessed, *const end = own + passage->accessed_count;
  struct written written = {.piece = passage->piece, .accessed = own, .accessed_end = end};
  if (!passage->misses && !waits->hits_are_awaited)
    written.accessed = end;
  for (size_t i = 0; i < passage->charged_count; i++) {
    const struct trax_charged *charged = &passage->charged[i];
    if (charged->cause != TRAX_CAUSE_DCACHE_BANK && !trax_is_wait((trax_cause)charged->cause))
      continue;
    while (own < end && own->at < charged->at)
      own++;
    /* Only a memory access waits for a bank. If it has not been issued, its address is not known. A fence that waits
       for its thread's stores waits for no register. */
    const bool accesses = own < end && own->at == charged->at;
    const bool waits_for_bank = charged->cause == TRAX_CAUSE_DCACHE_BANK;
    const struct writer itself = {charged->index, accesses ? own->address : 0, accesses};
    if (passage->count && !waits_for_bank)
      write_up_to(waits, writers, &written, charged->at);
    add(waits, charged->rd ? &writers[charged->rd] : &itself, charged->index,
        waits_for_bank ? BANK : charged->cause - TRAX_CAUSE_DATA_LOCAL, charged->cycles);
  }
  write_up_to(waits, writers, &written, passage->count);
}

/* Refusals of an access are of its bank. */
static void add_counts(void *self, const struct trax_counts *counts) {
  struct waits *waits = self;
  if (!counts->others || trax_places_accesses(waits->reader.explain->places)[counts->index] == TRAX_ACCESS_NONE)
    return;
  const uint32_t object = counts->region ? (uint32_t)counts->region->number + 1 : 0;
  struct record *record =
      record_of(waits, (struct record){.awaited = counts->index, .object = object, .waiting = counts->index});
  if (record)
    record->cycles[BANK] += counts->others;
}

/* --- the table --- */

static int by_place(const void *a, const void *b) {
  const struct record *x = a, *y = b;
  const uint32_t keys[][2] = {{x->awaited, y->awaited}, {x->object, y->object}, {x->waiting, y->waiting}};
  for (unsigned i = 0; i < 3; i++)
    if (keys[i][0] != keys[i][1])
      return keys[i][0] < keys[i][1] ? -1 : 1;
  return 0;
}

static void put_place(const struct waits *waits, uint32_t index, FILE *out) {
  struct trax_places *places = waits->reader.explain->places;
  const struct trax_frame_place *frame = trax_places_at(places, index)->frames;
  fprintf(out, "0x%08x,", trax_places_pc(places, index));
  trax_objects_put_name(out, trax_places_name(places, frame->function));
  fputc(',', out);
  trax_objects_put_name(out, trax_places_name(places, frame->line));
  fputc(',', out);
}

static trax_status put_table(void *self, FILE *out, trax_error *error) {
  const struct waits *waits = self;
  (void)error;
  if (waits->count)
    qsort(waits->records, waits->count, sizeof *waits->records, by_place); /* after the run: no map is used again */
  fputs("address,function,line,object,waiting_address,waiting_function,waiting_line", out);
  for (unsigned cause = TRAX_CAUSE_DATA_LOCAL; cause <= TRAX_CAUSE_DATA_OTHER; cause++)
    fprintf(out, ",%s", trax_cause_names[cause]);
  fprintf(out, ",%s\n", trax_cause_names[TRAX_CAUSE_DCACHE_BANK]);
  for (size_t i = 0; i < waits->count; i++) {
    const struct record *record = &waits->records[i];
    put_place(waits, record->awaited, out);
    trax_objects_put_name(out,
                          record->object ? trax_objects_name(&waits->reader.explain->objects, record->object - 1) : "");
    fputc(',', out);
    put_place(waits, record->waiting, out);
    for (unsigned column = 0; column < COLUMNS; column++)
      fprintf(out, "%" PRIu64 "%c", record->cycles[column], column + 1 < COLUMNS ? ',' : '\n');
  }
  return TRAX_OK;
}

static trax_status open_waits(void *self, trax_error *error) {
  struct waits *waits = self;
  const struct trax_explain *explain = waits->reader.explain;
  waits->writers = trax_explain_array(explain->machine->stats.threads, sizeof *waits->writers, error);
  waits->latest_of = trax_explain_array(trax_places_count(explain->places) + 2, sizeof *waits->latest_of, error);
  waits->slow = trax_explain_array(trax_places_count(explain->places) + 2, sizeof *waits->slow, error);
  waits->others = trax_explain_array(trax_places_count(explain->places) + 3, sizeof *waits->others, error);
  waits->region_of = trax_explain_array(trax_places_count(explain->places) + 2, sizeof *waits->region_of, error);
  waits->other_at = trax_explain_array(trax_places_count(explain->places), sizeof *waits->other_at, error);
  if (!waits->writers || !waits->latest_of || !waits->region_of || !waits->slow || !waits->others || !waits->other_at)
    return TRAX_ERROR;
  const uint32_t local = explain->machine->config.tp.local_latency_cycles;
  waits->hits_are_awaited = explain->machine->config.dcache.hit_latency_cycles > 1;
  for (uint32_t i = 0; i < trax_places_count(explain->places); i++) {
    const trax_inst *inst = trax_places_inst(explain->places, i);
    waits->others[i + 1] = waits->others[i];
    if (!(trax_op_table[inst->op].flags & TRAX_WRITES_RD) || !inst->rd)
      continue;
    if (trax_op_table[inst->op].access_bytes)
      waits->slow[i] = SLOW_ACCESS + inst->rd;
    else if (trax_timing_of(inst->op, &explain->machine->config).latency > 1)
      waits->slow[i] = inst->rd;
    if (waits->slow[i] && (waits->slow[i] < SLOW_ACCESS || local > 1))
      waits->other_at[waits->others[i + 1]++] = i;
  }
  return TRAX_OK;
}

static void close_waits(void *self) {
  struct waits *waits = self;
  free(waits->writers);
  free(waits->latest_of);
  free(waits->region_of);
  free(waits->slow);
  free(waits->others);
  free(waits->other_at);
  free(waits->records);
  trax_map_free(&waits->pair_of);
  trax_map_free(&waits->record_of);
}

const struct trax_reader_kind trax_waits_reader = {
    .bytes = sizeof(struct waits),
    .files = {{.path = TRAX_EXPLAIN_PATH(waits), .put = put_table, .member = "waits"}},
    .in_page = true,
    .open = open_waits,
    .passage = add_passage,
    .counts = add_counts,
    .close = close_waits};
