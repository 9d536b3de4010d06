/* The file format of a checkpoint, with all numbers little endian:

   - struct header
   - a deflate stream (zlib) of
     - the layout of the state (engine/layout.h)
     - the fields of its sections (machine/section.h)
     - the pages of memory that differ from their contents before cycle 0, each after its number in 4 bytes
     - the state of the program's host calls (calls/state.c)

   Before cycle 0, memory holds the program and its buffers. So a run can only be resumed with the same program, buffers
   and configuration: the header has a digest of configuration and memory. */
#include "host/checkpoint.h"

#include "calls/calls.h"
#include "engine/layout.h"
#include "engine/run.h"
#include "trax/grow.h"
#include "trax/input.h"
#include "trax/output.h"

#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>
#include <zlib.h>

enum { PAGE = 4096, VERSION = 7, LEVEL = 1, MOST_EXPANSION = 1100 /* deflate expands at most by this factor */ };

static const char magic[8] = "TRAXckpt";

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the file has the host's byte order");

struct header {
  char magic[8];
  uint32_t version;
  uint32_t pages;
  uint64_t cycle;      /* the next one */
  uint64_t state;      /* bytes */
  uint64_t compressed; /* bytes that follow */
  uint64_t run[2];     /* digest of configuration, segments, entry and memory before cycle 0 */
  uint64_t layouts;    /* entries */
  uint64_t calls;      /* bytes of the state of host calls */
  uint64_t complete;   /* 1: the program has ended; else 0 */
  uint64_t body[2];    /* digest of the header, with zero here, and of the bytes that follow */
};

struct trax_checkpoint {
  struct trax_machine *machine;
  struct trax_checkpoint_options options;
  struct trax_watch watch;
  XXH128_hash_t run;
  uint64_t *pages;  /* [size / PAGE]: hashes of their contents before cycle 0 */
  uint64_t written; /* the cycle of the latest checkpoint; TRAX_NEVER: none */
  /* The contents of the file to resume from. */
  struct header header;
  uint8_t *content;
  bool failed;
  trax_error error; /* valid if failed */
};

/* --- the state before cycle 0 --- */

static bool is_zero(const uint8_t *page) {
  return page[0] == 0 && memcmp(page, page + 1, PAGE - 1) == 0;
}

static uint64_t hash_page(const uint8_t *page) {
  return is_zero(page) ? 0 : XXH3_64bits(page, PAGE);
}

/* Calls visit, with their numbers, for all pages of memory that the host has allocated. All others are zero. */
static void visit_pages(const struct trax_space *space,
                        void (*visit)(void *context, uint32_t number, const uint8_t *page), void *context) {
  enum { BATCH = 1024, PRESENT = 63, SWAPPED = 62 };
  const size_t host_page = (size_t)sysconf(_SC_PAGESIZE);
  const int map = host_page == PAGE ? open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC) : -1;
  const uint32_t pages = (uint32_t)(space->size / PAGE);
  uint64_t entries[BATCH];
  for (uint32_t first = 0; first < pages; first += BATCH) {
    const uint32_t count = pages - first < BATCH ? pages - first : BATCH;
    const off_t place = (off_t)((uintptr_t)(space->bytes + (size_t)first * PAGE) / PAGE * sizeof *entries);
    const bool known =
        map >= 0 && pread(map, entries, count * sizeof *entries, place) == (ssize_t)(count * sizeof *entries);
    for (uint32_t i = 0; i < count; i++)
      if (!known || entries[i] >> SWAPPED)
        visit(context, first + i, space->bytes + (size_t)(first + i) * PAGE);
  }
  if (map >= 0)
    close(map);
}

static void record_page(void *context, uint32_t number, const uint8_t *page) {
  struct trax_checkpoint *checkpoint = context;
  checkpoint->pages[number] = hash_page(page);
}

static XXH128_hash_t digest_run(const struct trax_checkpoint *checkpoint) {
  const struct trax_machine *machine = checkpoint->machine;
  XXH3_state_t *state = XXH3_createState();
  XXH3_128bits_reset(state);
  for (size_t i = 0; i < trax_config_key_count; i++) {
    const double value = trax_config_value(&machine->config, &trax_config_keys[i]);
    XXH3_128bits_update(state, trax_config_keys[i].name, strlen(trax_config_keys[i].name) + 1);
    XXH3_128bits_update(state, &value, sizeof value);
    char text[TRAX_CONFIG_WORD];
    const char *word = trax_config_value_word(&trax_config_keys[i], value, text);
    if (word) /* the value may be a number of this build */
      XXH3_128bits_update(state, word, strlen(word) + 1);
  }
  for (size_t i = 0; i < machine->space.segment_count; i++) {
    const struct trax_segment *segment = &machine->space.segments[i];
    const uint32_t numbers[] = {segment->address, segment->bytes, segment->permissions};
    XXH3_128bits_update(state, numbers, sizeof numbers);
  }
  XXH3_128bits_update(state, &machine->entry, sizeof machine->entry);
  XXH3_128bits_update(state, &machine->other_entry, sizeof machine->other_entry);
  XXH3_128bits_update(state, checkpoint->pages, machine->space.size / PAGE * sizeof *checkpoint->pages);
  const XXH128_hash_t digest = XXH3_128bits_digest(state);
  XXH3_freeState(state);
  return digest;
}

static XXH128_hash_t digest_file(struct header header, const uint8_t *body) {
  header.body[0] = header.body[1] = 0;
  XXH3_state_t *state = XXH3_createState();
  XXH3_128bits_reset(state);
  XXH3_128bits_update(state, &header, sizeof header);
  XXH3_128bits_update(state, body, header.compressed);
  const XXH128_hash_t digest = XXH3_128bits_digest(state);
  XXH3_freeState(state);
  return digest;
}

/* --- writing --- */

struct content {
  const struct trax_checkpoint *checkpoint;
  uint8_t *bytes;
  size_t count, capacity;
  uint32_t pages;
  bool failed;
};

static void add(void *context, const void *bytes, size_t size) {
  struct content *content = context;
  if (content->failed || !size)
    return;
  if (!trax_grow_to((void **)&content->bytes, content->count + size, &content->capacity, 1)) {
    content->failed = true;
    return;
  }
  memcpy(content->bytes + content->count, bytes, size);
  content->count += size;
}

static void add_section(void *context, const struct trax_section *section) {
  for (size_t i = 0; i < section->count; i++)
    for (size_t j = 0; j < section->field_count; j++)
      add(context, (uint8_t *)section->bytes + section->size * i + section->fields[j].offset, section->fields[j].size);
}

static void add_page(void *context, uint32_t number, const uint8_t *page) {
  struct content *content = context;
  if (hash_page(page) == content->checkpoint->pages[number])
    return;
  add(content, &number, sizeof number);
  add(content, page, PAGE);
  content->pages++;
}

static trax_status write_file(const char *path, const struct header *header, const uint8_t *body, trax_error *error) {
  trax_output output;
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  fwrite(header, sizeof *header, 1, output.file); /* trax_output_commit reports a failure */
  fwrite(body, 1, header->compressed, output.file);
  return trax_output_commit(&output, error);
}

static trax_status write_checkpoint(struct trax_checkpoint *checkpoint, struct trax_run *run, uint64_t t, bool complete,
                                    trax_error *error) {
  struct content content = {.checkpoint = checkpoint};
  trax_run_export(run);
  trax_run_settle(run, t);
  if (run->options->output)
    fflush(run->options->output); /* the output so far must not be lost or repeated when the run is resumed */
  struct trax_layout layouts[TRAX_MOST_LAYOUTS];
  struct header header = {
      .version = VERSION, .cycle = t, .layouts = trax_layout_of(run->engine, run->chip, layouts), .complete = complete};
  add(&content, layouts, header.layouts * sizeof *layouts);
  run->engine->visit(run->chip, add_section, &content);
  header.state = content.count - header.layouts * sizeof *layouts;
  memcpy(header.magic, magic, sizeof magic);
  visit_pages(&run->machine->space, add_page, &content);
  header.pages = content.pages;
  uint8_t *calls;
  size_t calls_size;
  content.failed |= !trax_calls_save(run->machine, &calls, &calls_size);
  add(&content, calls, calls_size);
  header.calls = calls_size;
  free(calls);
  header.run[0] = checkpoint->run.low64;
  header.run[1] = checkpoint->run.high64;
  uLongf size = compressBound(content.count);
  uint8_t *body = content.failed ? NULL : malloc(size);
  trax_status status = TRAX_ERROR;
  if (!body || compress2(body, &size, content.bytes, content.count, LEVEL) != Z_OK) {
    trax_fail(error, "%s: out of memory for the checkpoint", checkpoint->options.write);
  } else {
    header.compressed = size;
    const XXH128_hash_t digest = digest_file(header, body);
    header.body[0] = digest.low64;
    header.body[1] = digest.high64;
    status = write_file(checkpoint->options.write, &header, body, error);
    checkpoint->written = t;
    if (status == TRAX_OK && !complete) /* a run that is resumed from here on finds the files as they then are */
      status = trax_calls_commit(run->machine, error); /* else trax_calls_end makes the changes */
  }
  free(body);
  free(content.bytes);
  return status;
}

static uint64_t next_time(const struct trax_checkpoint_options *options, uint64_t t) {
  uint64_t next = options->every ? t - t % options->every + options->every : TRAX_NEVER;
  if (options->at > t && options->at < next)
    next = options->at;
  return next;
}

static trax_status inspect(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct trax_checkpoint *checkpoint = watch->context;
  watch->next = next_time(&checkpoint->options, t);
  if (t == run->begin || write_checkpoint(checkpoint, run, t, false, &checkpoint->error) == TRAX_OK)
    return TRAX_OK;
  checkpoint->failed = true;
  return TRAX_INTERRUPTED;
}

/* A run that was interrupted or stopped can be resumed from its last cycle. So can one whose program has ended, because
   this process may be killed before it has changed all files of the host. */
static void end(struct trax_watch *watch, struct trax_run *run, trax_status status, uint64_t t) {
  struct trax_checkpoint *checkpoint = watch->context;
  const bool unfinished = status == TRAX_INTERRUPTED || status == TRAX_STUCK ||
                          (status == TRAX_OK && trax_calls_pending(checkpoint->machine));
  if (unfinished && !checkpoint->failed && checkpoint->written != t)
    checkpoint->failed = write_checkpoint(checkpoint, run, t, status == TRAX_OK, &checkpoint->error) != TRAX_OK;
}

/* --- reading --- */

static trax_status refuse(const char *path, const char *why, trax_error *error) {
  return trax_fail(error, "%s: %s", path, why);
}

/* Reads the header, and the compressed bytes after it into input->bytes. Errors: damaged, or of another version. */
static trax_status read_file(trax_input *input, struct header *header, trax_error *error) {
  trax_status status = trax_input_read(input, sizeof *header, error);
  if (status != TRAX_OK)
    return status;
  if (input->size < sizeof *header || memcmp(input->bytes, magic, sizeof magic) != 0)
    return refuse(input->path, "not a checkpoint", error);
  memcpy(header, input->bytes, sizeof *header);
  if (header->version != VERSION)
    return trax_fail(error, "%s: a checkpoint of version %" PRIu32 "; this program reads version %u", input->path,
                     header->version, VERSION);
  if (input->expected - sizeof *header == header->compressed)
    status = trax_input_read(input, input->expected, error);
  if (status != TRAX_OK)
    return status;
  if (input->size - sizeof *header != header->compressed)
    return refuse(input->path, "truncated or damaged", error);
  const XXH128_hash_t digest = digest_file(*header, input->bytes + sizeof *header);
  return digest.low64 == header->body[0] && digest.high64 == header->body[1]
             ? TRAX_OK
             : refuse(input->path, "damaged: its digest does not match", error);
}

static trax_status expand_file(struct trax_checkpoint *checkpoint, const trax_input *input, trax_error *error) {
  const char *path = input->path;
  const struct header *header = &checkpoint->header;
  if (header->run[0] != checkpoint->run.low64 || header->run[1] != checkpoint->run.high64)
    return refuse(path, "a checkpoint of another program, machine, or buffer", error);
  if (header->pages > checkpoint->machine->space.size / PAGE || header->layouts > TRAX_MOST_LAYOUTS ||
      header->state / MOST_EXPANSION > header->compressed || header->calls / MOST_EXPANSION > header->compressed)
    return refuse(path, "damaged: it is too short for the sizes in its header", error);
  uLongf size = header->layouts * sizeof(struct trax_layout) + header->state +
                (uint64_t)header->pages * (PAGE + sizeof(uint32_t)) + header->calls;
  const uLongf expected = size;
  checkpoint->content = malloc(size);
  if (!checkpoint->content ||
      uncompress(checkpoint->content, &size, input->bytes + sizeof *header, header->compressed) != Z_OK ||
      size != expected)
    return refuse(path, "damaged, or too large for this host's memory", error);
  return TRAX_OK;
}

static trax_status read_checkpoint(struct trax_checkpoint *checkpoint, trax_error *error) {
  trax_input input;
  trax_status status = trax_input_open(&input, checkpoint->options.resume, error);
  if (status == TRAX_OK)
    status = read_file(&input, &checkpoint->header, error);
  if (status == TRAX_OK)
    status = expand_file(checkpoint, &input, error);
  trax_input_close(&input);
  return status;
}

struct reader {
  const uint8_t *bytes;
  size_t left;
  bool failed;
};

static void take(struct reader *reader, void *bytes, size_t size) {
  reader->failed |= size > reader->left;
  if (reader->failed)
    return;
  memcpy(bytes, reader->bytes, size);
  reader->bytes += size;
  reader->left -= size;
}

static void take_section(void *context, const struct trax_section *section) {
  for (size_t i = 0; i < section->count; i++)
    for (size_t j = 0; j < section->field_count; j++)
      take(context, (uint8_t *)section->bytes + section->size * i + section->fields[j].offset, section->fields[j].size);
}

/* Refuses the layout of another build, with the first section that differs. */
static trax_status check_layouts(const struct trax_checkpoint *checkpoint, struct trax_run *run, trax_error *error) {
  struct trax_layout ours[TRAX_MOST_LAYOUTS];
  const size_t count = trax_layout_of(run->engine, run->chip, ours);
  for (size_t i = 0; i < count || i < checkpoint->header.layouts; i++) {
    const struct trax_layout *its = (const struct trax_layout *)checkpoint->content + i;
    if (i < count && i < checkpoint->header.layouts && memcmp(&ours[i], its, sizeof *its) == 0)
      continue;
    return trax_fail(error, "%s: its state has another layout, from %s on: it was written by another build of trax-sim",
                     checkpoint->options.resume, i < count ? ours[i].name : "its last section");
  }
  return TRAX_OK;
}

/* A run is complete only if all of its threads have ended. */
static bool can_be_complete(struct trax_run *run) {
  bool ended = true;
  for (uint32_t thread = 0; thread < run->machine->stats.threads; thread++)
    ended &= trax_run_thread(run, thread).ended;
  return ended;
}

/* Restores the state; called by trax_machine.prepare. */
static trax_status resume(void *context, struct trax_run *run, trax_error *error) {
  struct trax_checkpoint *checkpoint = context;
  const struct header *header = &checkpoint->header;
  struct reader reader = {checkpoint->content + header->layouts * sizeof(struct trax_layout), header->state, false};
  char wrong[128];
  if (check_layouts(checkpoint, run, error))
    return TRAX_ERROR;
  trax_run_export(run); /* no bursts have been executed before their issue after this */
  run->engine->visit(run->chip, take_section, &reader);
  if (reader.failed || reader.left)
    return refuse(checkpoint->options.resume, "its state is of another size", error);
  reader.left = (size_t)header->pages * (PAGE + sizeof(uint32_t));
  for (uint32_t i = 0; i < header->pages; i++) {
    uint32_t number = UINT32_MAX;
    take(&reader, &number, sizeof number);
    if (number >= run->machine->space.size / PAGE)
      return refuse(checkpoint->options.resume, "a page lies outside memory", error);
    take(&reader, run->machine->space.bytes + (size_t)number * PAGE, PAGE);
  }
  trax_error reason;
  if (trax_calls_restore(run->machine, reader.bytes, header->calls, &reason) != TRAX_OK)
    return refuse(checkpoint->options.resume, reason.message, error);
  if (run->engine->check(run->chip, header->cycle, wrong))
    return trax_fail(error, "%s: its state cannot be: %s", checkpoint->options.resume, wrong);
  if (header->complete > 1 || (header->complete && !can_be_complete(run)))
    return refuse(checkpoint->options.resume, "its state cannot be: the program ends in the midst of its run", error);
  trax_run_import(run, header->cycle);
  run->begin = header->cycle;
  run->complete = header->complete;
  free(checkpoint->content);
  checkpoint->content = NULL;
  return TRAX_OK;
}

/* --- the run --- */

trax_status trax_checkpoint_begin(struct trax_checkpoint **result, trax_machine *machine,
                                  const struct trax_checkpoint_options *options, trax_error *error) {
  *result = NULL;
  if (!options->write && !options->resume)
    return TRAX_OK;
  struct trax_checkpoint *checkpoint = calloc(1, sizeof *checkpoint);
  uint64_t *pages = calloc(machine->space.size / PAGE, sizeof *pages);
  if (!checkpoint || !pages) {
    free(checkpoint);
    free(pages);
    return trax_fail(error, "out of memory");
  }
  checkpoint->machine = machine;
  trax_calls_defer(machine);
  checkpoint->options = *options;
  checkpoint->pages = pages;
  checkpoint->written = TRAX_NEVER;
  visit_pages(&machine->space, record_page, checkpoint);
  checkpoint->run = digest_run(checkpoint);
  if (options->resume && read_checkpoint(checkpoint, error)) {
    trax_checkpoint_end(checkpoint, NULL);
    return TRAX_ERROR;
  }
  if (options->resume) {
    machine->prepare = resume;
    machine->prepare_context = checkpoint;
  }
  if (options->write) {
    checkpoint->watch = (struct trax_watch){
        .next = next_time(options, checkpoint->header.cycle), .inspect = inspect, .end = end, .context = checkpoint};
    trax_machine_watch(machine, &checkpoint->watch);
  }
  *result = checkpoint;
  return TRAX_OK;
}

trax_status trax_checkpoint_end(struct trax_checkpoint *checkpoint, trax_error *error) {
  if (!checkpoint)
    return TRAX_OK;
  trax_machine_unwatch(checkpoint->machine, &checkpoint->watch);
  checkpoint->machine->prepare = NULL;
  const trax_status status = checkpoint->failed ? trax_fail(error, "%s", checkpoint->error.message) : TRAX_OK;
  free(checkpoint->content);
  free(checkpoint->pages);
  free(checkpoint);
  return status;
}
