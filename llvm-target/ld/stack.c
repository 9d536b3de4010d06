/* The worst stack depth: the deepest path through the call graph from the entry, and what makes it a lower bound only.

   A call puts the callee's frame below the caller's; a tail call puts it in the caller's place. Functions that can
   reach one another by calls are a recursion, of which the path goes round once. The components of the graph come from
   Tarjan's algorithm, callees first (R. E. Tarjan, Depth-first search and linear graph algorithms, 1972); the stacks of
   both walks are on the heap, since chains of calls can be long. */
#include "ld.h"

#include <stdlib.h>

#define NONE UINT32_MAX

typedef enum colour { WHITE, GREY, BLACK } colour;

typedef struct node {
  uint32_t order, low; /* Tarjan's numbers; order 0: not reached */
  uint32_t component;  /* NONE while on Tarjan's stack */
  uint32_t next;       /* the callee on the deepest path, or NONE */
  bool next_is_tail;
  colour colour;  /* of the walk within a recursion */
  uint64_t depth; /* bytes from here down */
} node;

typedef struct step { /* of a depth-first walk */
  uint32_t function, call;
} step;

typedef LD_VECTOR(uint32_t) index_list;

typedef struct walk {
  ld_context *ctx;
  node *nodes;        /* for each function */
  index_list reached; /* functions in the order of their first visit */
  index_list stack;   /* Tarjan's */
  LD_VECTOR(step) steps, inner_steps;
  LD_VECTOR(index_list) recursions; /* one cycle of each */
  uint32_t component_count;
} walk;

static const ld_function *function_of(const walk *walk, uint32_t index) {
  return &walk->ctx->functions.items[index];
}

static void push_step(walk *walk, uint32_t function) {
  step fresh = {.function = function};
  ld_push(walk->ctx, &walk->steps, fresh);
}

/* --- depth --- */

static void consider(walk *walk, uint32_t caller, ld_call call) {
  node *node = &walk->nodes[caller];
  uint64_t depth = walk->nodes[call.callee].depth + (call.is_tail ? 0 : function_of(walk, caller)->frame);
  if (depth > node->depth || (depth == node->depth && node->next == NONE && !call.is_tail)) {
    node->depth = depth;
    node->next = call.callee;
    node->next_is_tail = call.is_tail;
  }
}

/* Functions that only replace one another: the deepest counts for all. */
static void measure_tail_calls(walk *walk, const uint32_t *members, size_t count) {
  uint32_t component = walk->nodes[members[0]].component;
  uint32_t deepest = members[0];
  for (size_t i = 0; i < count; i++) {
    const ld_function *function = function_of(walk, members[i]);
    walk->nodes[members[i]].depth = function->frame;
    for (size_t c = 0; c < function->calls.count; c++)
      if (walk->nodes[function->calls.items[c].callee].component != component)
        consider(walk, members[i], function->calls.items[c]);
    if (walk->nodes[members[i]].depth > walk->nodes[deepest].depth)
      deepest = members[i];
  }
  for (size_t i = 0; i < count; i++)
    if (walk->nodes[members[i]].depth < walk->nodes[deepest].depth) {
      walk->nodes[members[i]].depth = walk->nodes[deepest].depth;
      walk->nodes[members[i]].next = deepest;
      walk->nodes[members[i]].next_is_tail = true;
    }
}

/* The deepest path from a member that does not come back to a function on it. */
static void measure_recursion(walk *walk, uint32_t member) {
  uint32_t component = walk->nodes[member].component;
  step first = {.function = member};
  walk->inner_steps.count = 0;
  if (walk->nodes[member].colour == WHITE)
    ld_push(walk->ctx, &walk->inner_steps, first);
  while (walk->inner_steps.count) {
    step *step = &walk->inner_steps.items[walk->inner_steps.count - 1];
    const ld_function *function = function_of(walk, step->function);
    node *node = &walk->nodes[step->function];
    if (node->colour == WHITE) {
      node->colour = GREY;
      node->depth = function->frame;
    } else { /* back from a callee */
      consider(walk, step->function, function->calls.items[step->call++]);
    }
    while (step->call < function->calls.count) {
      ld_call call = function->calls.items[step->call];
      const struct node *callee = &walk->nodes[call.callee];
      if (callee->component == component && callee->colour == WHITE)
        break;
      if (callee->component != component || callee->colour == BLACK)
        consider(walk, step->function, call);
      step->call++;
    }
    if (step->call == function->calls.count) {
      node->colour = BLACK;
      walk->inner_steps.count--;
    } else {
      struct step callee = {.function = function->calls.items[step->call].callee};
      ld_push(walk->ctx, &walk->inner_steps, callee);
    }
  }
}

/* The shortest way back from the callee to the caller, within their component; breadth first. */
static void note_cycle(walk *walk, uint32_t caller, uint32_t callee, size_t size) {
  ld_context *ctx = walk->ctx;
  index_list queue = {0}, cycle = {0};
  ld_map from = {0};                                        /* function -> its predecessor + 1 */
  uint32_t *keys = ld_alloc_array(ctx, size, sizeof *keys); /* maps keep pointers to their keys */
  ld_push(ctx, &queue, callee);
  for (size_t i = 0; i < queue.count && queue.items[i] != caller; i++) {
    const ld_function *function = function_of(walk, queue.items[i]);
    for (size_t c = 0; c < function->calls.count; c++) {
      uint32_t next = function->calls.items[c].callee;
      if (walk->nodes[next].component != walk->nodes[caller].component || next == callee)
        continue;
      if (ld_map_find(&from, &next, sizeof next))
        continue;
      keys[queue.count] = next;
      *ld_map_at(ctx, &from, &keys[queue.count], sizeof next) = (uintptr_t)queue.items[i] + 1;
      ld_push(ctx, &queue, next);
    }
  }
  for (uint32_t at = caller; at != callee; at = (uint32_t)ld_map_find(&from, &at, sizeof at) - 1)
    ld_push(ctx, &cycle, at);
  ld_push(ctx, &cycle, callee);
  for (size_t i = 0; i < cycle.count / 2; i++) {
    uint32_t swapped = cycle.items[i];
    cycle.items[i] = cycle.items[cycle.count - 1 - i];
    cycle.items[cycle.count - 1 - i] = swapped;
  }
  ld_push(ctx, &walk->recursions, cycle);
}

/* Members of a component, the first reached last. */
static void finish_component(walk *walk, const uint32_t *members, size_t count) {
  for (size_t i = count; i-- > 0;) {
    const ld_function *function = function_of(walk, members[i]);
    for (size_t c = 0; c < function->calls.count; c++) {
      ld_call call = function->calls.items[c];
      if (call.is_tail || walk->nodes[call.callee].component != walk->nodes[members[i]].component)
        continue;
      note_cycle(walk, members[i], call.callee, count);
      for (size_t m = count; m-- > 0;)
        measure_recursion(walk, members[m]);
      return;
    }
  }
  measure_tail_calls(walk, members, count);
}

static void visit(walk *walk, uint32_t function) {
  node *node = &walk->nodes[function];
  node->next = node->component = NONE;
  ld_push(walk->ctx, &walk->reached, function);
  node->order = node->low = (uint32_t)walk->reached.count;
  ld_push(walk->ctx, &walk->stack, function);
}

static void leave(walk *walk, uint32_t function) {
  if (walk->nodes[function].low != walk->nodes[function].order)
    return;
  size_t first = walk->stack.count;
  do
    walk->nodes[walk->stack.items[--first]].component = walk->component_count;
  while (walk->stack.items[first] != function);
  /* The members lie from the top of the stack down to `function`, which was reached first. */
  size_t count = walk->stack.count - first;
  uint32_t *members = ld_alloc_array(walk->ctx, count, sizeof *members);
  for (size_t i = 0; i < count; i++)
    members[i] = walk->stack.items[walk->stack.count - 1 - i];
  walk->stack.count = first;
  walk->component_count++;
  finish_component(walk, members, count);
}

static void walk_from(walk *walk, uint32_t root) {
  push_step(walk, root);
  visit(walk, root);
  while (walk->steps.count) {
    step *step = &walk->steps.items[walk->steps.count - 1];
    const ld_function *function = function_of(walk, step->function);
    node *node = &walk->nodes[step->function];
    if (step->call == function->calls.count) {
      uint32_t done = step->function, low = node->low;
      leave(walk, done);
      walk->steps.count--;
      if (walk->steps.count) {
        struct node *caller = &walk->nodes[walk->steps.items[walk->steps.count - 1].function];
        if (low < caller->low && walk->nodes[done].component == NONE)
          caller->low = low;
      }
      continue;
    }
    uint32_t callee = function->calls.items[step->call++].callee;
    if (!walk->nodes[callee].order) {
      push_step(walk, callee);
      visit(walk, callee);
    } else if (walk->nodes[callee].component == NONE && walk->nodes[callee].order < node->low) {
      node->low = walk->nodes[callee].order;
    }
  }
}

/* --- report --- */

/* "f, a.o:(.text.f)" */
static const char *describe(const walk *walk, uint32_t index) {
  const ld_function *function = function_of(walk, index);
  const ld_section *section = function->section;
  if (!section)
    return function->name;
  const char *offset = function->start ? ld_format(walk->ctx, "+0x%x", function->start) : "";
  return ld_format(walk->ctx, "%s, %s:(%s%s)", function->name, section->object->name, section->name, offset);
}

static void print_path(const walk *walk, uint32_t root, const char *margin, FILE *out) {
  uint64_t depth = 0;
  fprintf(out, "%s%8s %8s  %s\n", margin, "frame", "depth", "function");
  for (uint32_t at = root; at != NONE; at = walk->nodes[at].next) {
    const ld_function *function = function_of(walk, at);
    bool replaced = walk->nodes[at].next != NONE && walk->nodes[at].next_is_tail;
    depth += function->frame;
    fprintf(out, "%s%8u %8llu  %s%s\n", margin, function->frame, (unsigned long long)depth, describe(walk, at),
            replaced ? ", leaves by a tail call" : "");
    if (replaced)
      depth -= function->frame;
  }
}

static size_t print_unbounded(const walk *walk, FILE *out) {
  size_t count = walk->recursions.count;
  for (size_t i = 0; i < walk->recursions.count; i++) {
    const index_list *cycle = &walk->recursions.items[i];
    uint32_t last = cycle->items[cycle->count - 1];
    fprintf(out, "  recursion: %s", function_of(walk, last)->name);
    for (size_t m = 0; m + 1 < cycle->count; m++)
      fprintf(out, " -> %s", function_of(walk, cycle->items[m])->name);
    fprintf(out, " -> %s\n", describe(walk, last));
  }
  for (size_t i = 0; i < walk->reached.count; i++) {
    const ld_function *function = function_of(walk, walk->reached.items[i]);
    const char *described = describe(walk, walk->reached.items[i]);
    if (function->indirect_calls)
      fprintf(out, "  %u indirect call%s: %s\n", function->indirect_calls, function->indirect_calls == 1 ? "" : "s",
              described);
    if (!function->has_record)
      fprintf(out, "  %s: %s\n", function->moves_sp ? "frame of variable size" : "frame of unknown size", described);
    count += (function->indirect_calls != 0) + !function->has_record;
  }
  return count;
}

/* The bytes that a stack may take, and where they come from. */
static uint64_t stack_limit(const ld_context *ctx, const char **where) {
  const ld_symbol *global = ld_symbol_find(ctx, "__trax_stack_size");
  if (ctx->options.stack_size) {
    *where = "-z stack-size";
    return ctx->options.stack_size;
  }
  if (global && (global->kind == LD_DEFSYM || global->kind == LD_ABSOLUTE)) {
    *where = "__trax_stack_size";
    return ld_symbol_address(ctx, global);
  }
  *where = ctx->local_size ? ld_format((ld_context *)ctx, "%u of local memory less %u of thread-local data",
                                       TRAX_LOCAL_SIZE, ctx->local_size)
                           : "local memory";
  return TRAX_LOCAL_SIZE - ctx->local_size;
}

static uint32_t find_entry(const ld_context *ctx) {
  for (size_t i = 0; i < ctx->functions.count; i++) {
    const ld_function *function = &ctx->functions.items[i];
    uint32_t start = ld_section_address(function->section, function->start);
    if (ctx->entry >= start && ctx->entry - start < function->end - function->start)
      return (uint32_t)i;
  }
  return NONE;
}

typedef struct text { /* that is printed into memory */
  FILE *out;
  char *bytes;
  size_t size;
} text;

static void open_text(const walk *walk, text *text) {
  text->bytes = NULL;
  text->out = open_memstream(&text->bytes, &text->size);
  if (!text->out)
    longjmp(walk->ctx->out_of_memory, 1);
}

static const char *close_text(const walk *walk, text *text) {
  fclose(text->out);
  const char *copy = ld_format(walk->ctx, "%s", text->bytes);
  free(text->bytes);
  return copy;
}

static const char *path_text(const walk *walk, uint32_t root, const char *margin) {
  text text;
  open_text(walk, &text);
  print_path(walk, root, margin, text.out);
  return close_text(walk, &text);
}

static void report_depth(const walk *walk, uint32_t root, uint64_t limit, const char *where) {
  ld_context *ctx = walk->ctx;
  text text;
  open_text(walk, &text);
  bool is_bounded = print_unbounded(walk, text.out) == 0;
  const char *unbounded = close_text(walk, &text);
  ctx->stack_is_bounded = is_bounded;
  ctx->stack_report = ld_format(ctx, "stack: at %s %llu bytes, of %llu (%s)\n%s%s%s", is_bounded ? "most" : "least",
                                (unsigned long long)ctx->stack_depth, (unsigned long long)limit, where,
                                path_text(walk, root, "  "), is_bounded ? "" : "  not counted:\n", unbounded);
}

/* The depth if every indirect call can reach every function whose address is taken. It is a bound unless there is
   recursion or a frame of unknown size, and often far above the real depth. Adds these calls to the graph. */
static void add_estimate(ld_context *ctx, uint32_t root) {
  uint32_t any = (uint32_t)ctx->functions.count;
  ld_function callees = {.has_record = true};
  for (uint32_t i = 0; i < any; i++) {
    ld_function *function = &ctx->functions.items[i];
    ld_call call = {.callee = i, .is_tail = true};
    if (function->address_taken)
      ld_push(ctx, &callees.calls, call);
    call = (ld_call){.callee = any};
    if (function->indirect_calls)
      ld_push(ctx, &function->calls, call);
  }
  if (callees.calls.count == 0)
    return;
  callees.name =
      ld_format(ctx, "(%zu function%s by address)", callees.calls.count, callees.calls.count == 1 ? "" : "s");
  ld_push(ctx, &ctx->functions, callees);
  walk walk = {.ctx = ctx};
  walk.nodes = ld_alloc_array(ctx, ctx->functions.count, sizeof *walk.nodes);
  walk_from(&walk, root);
  if (walk.nodes[root].depth > ctx->stack_depth)
    ctx->stack_report =
        ld_format(ctx, "%s  with indirect calls of any function whose address is taken, %llu bytes:\n%s",
                  ctx->stack_report, (unsigned long long)walk.nodes[root].depth, path_text(&walk, root, "  "));
}

static void refuse(const walk *walk, uint32_t root, uint64_t limit, const char *where) {
  ld_context *ctx = walk->ctx;
  void (*report)(ld_context *, const char *, ...) = ctx->options.stack_check == LD_STACK_ERROR ? ld_error : ld_warning;
  report(ctx,
         "the stack takes %s%llu bytes, there are %llu (%s); the deepest path is\n%s"
         ">>> %s, --stack-check=none links all the same",
         ctx->stack_is_bounded ? "" : "at least ", (unsigned long long)ctx->stack_depth, (unsigned long long)limit,
         where, path_text(walk, root, ">>> "),
         ld_symbol_find(ctx, "__trax_stack_size") ? "-mstack-size= makes it larger"
                                                  : "-mstack=global gives the stack more room");
}

bool ld_check_stack(ld_context *ctx) {
  walk walk = {.ctx = ctx};
  walk.nodes = ld_alloc_array(ctx, ctx->functions.count + 1, sizeof *walk.nodes);
  uint32_t root = find_entry(ctx);
  if (root == NONE)
    return true; /* an entry without code was reported */
  walk_from(&walk, root);
  ctx->stack_depth = walk.nodes[root].depth;

  const char *where;
  uint64_t limit = stack_limit(ctx, &where);
  report_depth(&walk, root, limit, where);
  if (ctx->stack_depth > limit && ctx->options.stack_check != LD_STACK_NONE)
    refuse(&walk, root, limit, where);
  add_estimate(ctx, root);
  if (ctx->options.print_stack)
    fputs(ld_demangle(ctx, ctx->stack_report), stdout);
  return ctx->error_count == 0;
}
