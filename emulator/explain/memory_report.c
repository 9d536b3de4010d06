/* The report of the check of memory: each site once, with a count, in the order of the first occurrences. */
#include "explain/memory_check.h"
#include "report/place.h"
#include "trax/grow.h"

#include <inttypes.h>
#include <string.h>

enum { MOST_SITES = 1000, MOST_CALLERS = 16 };

void trax_memory_note(struct trax_memory_check *check, enum trax_memory_finding finding,
                      const struct trax_memory_event *event, uint32_t address, uint32_t bytes, bool write,
                      uint32_t object) {
  const uint64_t key = ((uint64_t)event->context << 32 | event->pc) ^ (uint64_t)finding << 60;
  struct trax_map_entry *entry = trax_map_put(&check->site_of, sizeof *entry, key, (uint32_t)check->site_count);
  if (!entry) {
    check->reader.explain->out_of_memory = true;
    return;
  }
  if (entry->value == check->site_count) {
    if (!trax_grow((void **)&check->sites, check->site_count, &check->site_capacity, sizeof *check->sites)) {
      check->reader.explain->out_of_memory = true;
      return;
    }
    check->sites[check->site_count++] = (struct trax_memory_site){.finding = finding,
                                                                  .event = *event,
                                                                  .address = address,
                                                                  .bytes = bytes,
                                                                  .write = write,
                                                                  .object = object == MEMORY_MIXED ? 0 : object};
  }
  check->sites[entry->value].count++;
  check->sites[entry->value].total += bytes;
}

static void print_thread(const struct trax_memory_check *check, const struct trax_memory_event *event, FILE *out) {
  fprintf(out, "  %-*s%u (TM %u, TP %u), cycle %" PRIu64 "\n", TRAX_LABEL, "thread", event->thread,
          event->thread / check->tps, event->thread % check->tps, event->cycle);
}

static void print_chain(const struct trax_memory_check *check, const char *label, const struct trax_memory_event *event,
                        FILE *out) {
  trax_print_place(check->loaded, label, event->pc, out);
  unsigned callers = 0;
  for (uint32_t context = event->context; context; context = check->contexts[context].parent) {
    if (++callers > MOST_CALLERS) {
      fprintf(out, "  %-*s...\n", TRAX_LABEL, "called by");
      break;
    }
    trax_print_place(check->loaded, "called by", check->contexts[context].pc, out);
  }
}

static const char *plural(uint64_t count) {
  return count == 1 ? "" : "s";
}

/* "4 bytes behind the end of", "8 bytes before", "at byte 4 of" */
static void print_distance(uint32_t address, uint32_t begin, uint32_t end, FILE *out) {
  if (address - begin < end - begin)
    fprintf(out, "at byte %u of ", address - begin);
  else if (address - end < begin - address)
    fprintf(out, "%u byte%s behind the end of ", address - end, plural(address - end));
  else
    fprintf(out, "%u byte%s before ", begin - address, plural(begin - address));
}

static void print_object(const struct trax_memory_check *check, const struct trax_memory_site *site, FILE *out) {
  const struct trax_memory_object *it = &check->objects[site->object];
  fprintf(out, "  %-*s", TRAX_LABEL, "object");
  if (site->bytes || site->finding == MEMORY_INVALID_FREE)
    print_distance(site->address, it->own_begin, it->own_end, out);
  if (it->kind == MEMORY_BLOCK) {
    fprintf(out, "a block of %u byte%s at 0x%08x\n", it->end - it->begin, plural(it->end - it->begin), it->begin);
    print_chain(check, "allocated", &it->allocation, out);
    if (it->freed && (site->finding == MEMORY_FREED || site->finding == MEMORY_DOUBLE_FREE)) {
      print_chain(check, "freed", &it->release, out);
      print_thread(check, &it->release, out);
    }
  } else {
    fprintf(out, "%s, of %u byte%s at 0x%08x\n", it->name, it->own_end - it->own_begin,
            plural(it->own_end - it->own_begin), it->own_begin);
  }
}

static void print_access(const struct trax_memory_check *check, const struct trax_memory_site *site, FILE *out) {
  const struct trax_symbol *symbol = check->loaded ? trax_image_symbol_at(check->loaded->image, site->address) : NULL;
  const char *what = site->finding == MEMORY_OUTPUT    ? "output"
                     : site->finding == MEMORY_BRANCH  ? "value"
                     : site->finding == MEMORY_ADDRESS ? "value"
                     : site->bytes == 0                ? "free"
                     : site->write                     ? "store"
                                                       : "load";
  fprintf(out, "  %-*s%s", TRAX_LABEL, "access", what);
  if (site->bytes)
    fprintf(out, " of %u byte%s", site->bytes, plural(site->bytes));
  fprintf(out, " %s 0x%08x", !site->bytes ? "of" : site->write ? "to" : "from", site->address);
  if (symbol && symbol->type != TRAX_SYMBOL_PLAIN) {
    fputs(" (", out);
    trax_print_symbol(symbol, site->address, out);
    fputc(')', out);
  }
  if (site->count > 1)
    fprintf(out, "; %" PRIu64 " times", site->count);
  fputc('\n', out);
}

static void print_site(const struct trax_memory_check *check, const struct trax_memory_site *site, FILE *out) {
  static const char *const texts[] = {"",
#define TEXT(NAME, TEXT) TEXT,
                                      MEMORY_FINDINGS(TEXT)
#undef TEXT
  };
  fprintf(out, "trax-sim: memory: %s\n", texts[site->finding]);
  if (site->finding == MEMORY_LEAK) {
    fprintf(out, "  %-*s%" PRIu64 " byte%s in %" PRIu64 " block%s\n", TRAX_LABEL, "lost", site->total,
            plural(site->total), site->count, plural(site->count));
    print_chain(check, "allocated", &site->event, out);
    print_thread(check, &site->event, out);
    return;
  }
  print_access(check, site, out);
  print_chain(check, "in", &site->event, out);
  print_thread(check, &site->event, out);
  if (site->object)
    print_object(check, site, out);
}

void trax_memory_print(const struct trax_memory_check *check, FILE *out) {
  for (size_t i = 0; i < check->site_count && i < MOST_SITES; i++)
    print_site(check, &check->sites[i], out);
  if (check->site_count > MOST_SITES)
    fprintf(out, "trax-sim: memory: %zu further sites\n", check->site_count - MOST_SITES);
}
