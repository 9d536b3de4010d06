/* Undefined symbols that live code needs: the places that need them, and names that may have been meant. */
#include "ld.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

/* --- suggestions --- */

static bool is_defined(const ld_symbol *symbol) {
  return symbol && (symbol->kind != LD_UNDEFINED || symbol->in_archive);
}

/* Whether one insertion, deletion, substitution or exchange of neighbours makes one name of the other. */
static bool is_near(const char *a, const char *b) {
  size_t a_length = strlen(a), b_length = strlen(b);
  if (a_length > b_length)
    return is_near(b, a);
  if (b_length - a_length > 1)
    return false;
  size_t same = 0;
  while (same < a_length && a[same] == b[same])
    same++;
  if (a_length < b_length)
    return strcmp(a + same, b + same + 1) == 0;
  if (same == a_length || strcmp(a + same + 1, b + same + 1) == 0)
    return true;
  return a[same] == b[same + 1] && a[same + 1] == b[same] && strcmp(a + same + 2, b + same + 2) == 0;
}

/* The identifier of a plain C++ function, "_Z3fooi" or "_ZL3foov", in *length characters; NULL for other names. */
static const char *mangled_identifier(const char *name, size_t *length) {
  if (!ld_starts_with(name, "_Z"))
    return NULL;
  name += name[2] == 'L' ? 3 : 2;
  *length = 0;
  for (; isdigit((unsigned char)*name) && *length < 10000; name++)
    *length = *length * 10 + (size_t)(*name - '0');
  return *length > 0 && *length <= strlen(name) ? name : NULL;
}

/* A defined name that an undefined one may have meant, or NULL. */
static const char *suggestion(ld_context *ctx, const char *name) {
  size_t length, other_length;
  const char *identifier = mangled_identifier(name, &length);
  if (identifier) {
    const char *plain = ld_format(ctx, "%.*s", (int)length, identifier);
    if (is_defined(ld_symbol_find(ctx, plain)))
      return ld_format(ctx, "did you mean to declare '%s' as extern \"C\"? '%s' is defined", plain, plain);
  }
  const char *near = NULL;
  for (size_t i = 0; i < ctx->symbols.count; i++) {
    const ld_symbol *symbol = ctx->symbols.items[i];
    if (!is_defined(symbol))
      continue;
    const char *other = mangled_identifier(symbol->name, &other_length);
    if (other && strlen(name) == other_length && memcmp(other, name, other_length) == 0)
      return ld_format(ctx, "did you mean to define '%s' as extern \"C\"? '%s' is defined", name, symbol->name);
    if (!near && (strcasecmp(name, symbol->name) == 0 || (strlen(name) > 2 && is_near(name, symbol->name))))
      near = symbol->name;
  }
  if (near)
    return ld_format(ctx, "did you mean '%s'?", near);
  for (size_t o = 0; o < ctx->objects.count; o++) {
    const ld_object *object = ctx->objects.items[o];
    for (size_t i = 1; i < object->first_global && i < object->symbol_count; i++)
      if (strcmp(object->symbols[i]->name, name) == 0)
        return ld_format(ctx, "%s has a '%s', but it is local (static)", object->name, name);
  }
  return NULL;
}

/* --- references --- */

#define SHOWN_REFERENCES 3

typedef struct missing {
  ld_symbol *symbol;
  struct {
    const char *place, *function;
  } references[SHOWN_REFERENCES];
  size_t count;
} missing;
typedef LD_VECTOR(missing) missing_list;

static void note_missing(ld_context *ctx, missing_list *list, const ld_section *section, const ld_reloc *reloc) {
  ld_symbol *symbol = reloc->symbol;
  if (!symbol->reported) {
    missing fresh = {.symbol = symbol};
    symbol->reported = true;
    symbol->value = (uint32_t)list->count; /* an undefined symbol has no other use for it */
    ld_push(ctx, list, fresh);
  }
  missing *missing = &list->items[symbol->value];
  if (missing->count < SHOWN_REFERENCES) {
    missing->references[missing->count].place = ld_place(ctx, section, reloc->offset);
    missing->references[missing->count].function = ld_in_function(ctx, section, reloc->offset);
  }
  missing->count++;
}

static void report_missing(ld_context *ctx, const missing *missing) {
  const char *text = ld_format(ctx, "%s: undefined symbol '%s'%s", missing->references[0].place, missing->symbol->name,
                               missing->references[0].function);
  for (size_t i = 1; i < missing->count && i < SHOWN_REFERENCES; i++)
    text = ld_format(ctx, "%s\n>>> also needed at %s%s", text, missing->references[i].place,
                     missing->references[i].function);
  if (missing->count > SHOWN_REFERENCES)
    text = ld_format(ctx, "%s\n>>> and at %zu more place%s", text, missing->count - SHOWN_REFERENCES,
                     missing->count - SHOWN_REFERENCES == 1 ? "" : "s");
  const char *hint = suggestion(ctx, missing->symbol->name);
  ld_error(ctx, "%s%s%s", text, hint ? "\n>>> " : "", hint ? hint : "");
}

bool ld_check_undefined(ld_context *ctx) {
  missing_list list = {0};
  for (size_t i = 0; i < ctx->sections.count; i++) {
    const ld_section *section = ctx->sections.items[i];
    if (!section->live || !(section->flags & SHF_ALLOC))
      continue;
    for (uint32_t r = 0; r < section->reloc_count; r++) {
      const ld_symbol *symbol = section->relocs[r].symbol;
      if (symbol->kind == LD_UNDEFINED && symbol->binding != STB_WEAK && section->relocs[r].type != R_TRAX_NONE)
        note_missing(ctx, &list, section, &section->relocs[r]);
    }
  }
  for (size_t i = 0; i < list.count; i++)
    report_missing(ctx, &list.items[i]);
  return ctx->error_count == 0;
}
